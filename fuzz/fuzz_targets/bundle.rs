//! `Bundle::new_checked`, and everything that can be applied of what it lets through.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::bundle(bytes));
