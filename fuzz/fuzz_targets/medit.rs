//! The reader `read::medit`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::medit;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::solid(medit::read(bytes)));
