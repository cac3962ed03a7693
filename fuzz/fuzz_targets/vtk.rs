//! The reader `read::vtk`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::read::vtk;

fuzz_target!(|bytes: &[u8]| octruss_fuzz::solid(vtk::read(bytes)));
