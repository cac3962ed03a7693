//! The reader `read::vtu`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::vtu;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::solid(vtu::read(bytes)));
