//! The readers of lists that go with a mesh: features, values at vertices, major diagonals.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octruss_bake::mesh::Cells;
use octruss_bake::read::{channel, diagonals, features};

fuzz_target!(|bytes: &[u8]| {
    let cells = Cells {
        tetrahedra: vec![[0, 1, 2, 6], [0, 2, 1, 7]],
        octahedra: vec![[0, 1, 2, 3, 4, 5]],
        ..Cells::default()
    };
    let _ = octruss_fuzz::shown(features::read(bytes, 8));
    let _ = octruss_fuzz::shown(channel::read(bytes, 8));
    let _ = octruss_fuzz::shown(diagonals::read(bytes, &cells));
});
