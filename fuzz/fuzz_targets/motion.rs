//! The reader of motions as `.csv`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::motion;

fuzz_target!(|bytes: &[u8]| {
    let _ = octruss_fuzz::shown(motion::read_csv(bytes, 2));
});
