//! The reader `read::stl`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::stl;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::model(stl::read(bytes)));
