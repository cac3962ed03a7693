//! The reader `read::gmsh`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::gmsh;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::solid(gmsh::read(bytes)));
