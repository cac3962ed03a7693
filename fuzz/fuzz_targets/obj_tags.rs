//! The reader of crease tags in `.obj` files.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::obj_tags;

fuzz_target!(|bytes: &[u8]| {
    let _ = octruss_fuzz::shown(obj_tags::read(bytes, 8));
});
