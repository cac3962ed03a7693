//! The reader `read::off`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::off;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::model(off::read(bytes)));
