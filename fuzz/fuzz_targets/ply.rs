//! The reader `read::ply`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::ply;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::model(ply::read(bytes)));
