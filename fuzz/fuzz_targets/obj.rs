//! The reader `read::obj`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::obj;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::model(obj::read(bytes)));
