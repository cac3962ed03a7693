//! The reader `read::tetgen`: the two files are parted by a zero byte.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::tetgen;

fuzz_target!(|bytes: &[u8]| {
    let mut files = bytes.splitn(2, |byte| *byte == 0);
    let node = files.next().unwrap_or_default();
    let ele = files.next().unwrap_or_default();
    octruss_fuzz::solid(tetgen::read(
        (Path::new("a.node"), node),
        (Path::new("a.ele"), ele),
    ));
});
