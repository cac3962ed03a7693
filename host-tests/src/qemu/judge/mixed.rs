//! Mixed solids.

use octruss_firmware::cases::{MIXED, MIXED_OWNED, SECTION_BOUNDARY, SECTION_MIXED_CELLS, summary};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_mixed::MixedCase;
use crate::reference_mixed::{Boundary, Mesh, find_boundary, refine};

/// Most cells before any refinement.
const CELLS: usize = 14;
/// The same in core's own arenas, which are refined once.
const OWNED_CELLS: usize = 2;

/// Vertices that the image's memory holds in a refined solid.
const VERTICES_AT_MOST: u32 = 430;

/// The case of a seed. Of every ten, eight refine in slices, one in core's own arenas, and one is
/// damaged.
pub(super) fn case(seed: u32) -> Judged {
    // What the boundary follows takes turns by eights.
    let drawn = u64::from(seed) + u64::from(seed) / 10;
    if seed % 10 == 1 {
        let case = MixedCase::new(drawn, OWNED_CELLS);
        return mixed(seed, MIXED_OWNED, MixedCase { levels: 1, ..case });
    }
    let judged = mixed(seed, MIXED, MixedCase::new(drawn, CELLS));
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

fn mixed(seed: u32, kind: u32, case: MixedCase) -> Judged {
    let boundary = match case.boundary {
        Boundary::TriQuad => 1,
        Boundary::Interior => 2,
        Boundary::Fixed => 3,
    };
    let mut expected = Expected::default();
    if kind == MIXED {
        expected.push_boundary(&case.mesh);
    }
    let (mut mesh, mut points, mut done) = (case.mesh.clone(), case.points.clone(), 0);
    while done < case.levels {
        let (next, next_points, saturated) = refine(&mesh, case.boundary, &points);
        if next.vertex_count > VERTICES_AT_MOST {
            break;
        }
        (mesh, points) = (next, next_points);
        done += 1;
        expected.push_mixed_cells(done, &mesh);
        expected.push_points(done, &points, saturated);
    }
    let mut words = vec![boundary, done];
    push_solid(&mut words, &case.mesh, &case.points);
    Judged::sound(kind, seed, words, expected)
}

/// The solid as a case tells it.
fn push_solid(words: &mut Vec<u32>, mesh: &Mesh, points: &[[i32; 3]]) {
    let counts = [
        mesh.tetrahedra.len(),
        mesh.octahedra.len(),
        mesh.prisms.len(),
        mesh.hexahedra.len(),
        mesh.triangles.len(),
        mesh.quads.len(),
        mesh.creases.len(),
        mesh.corners.len(),
    ];
    words.push(mesh.vertex_count);
    words.extend(counts.map(word));
    words.extend(mesh.tetrahedra.as_flattened());
    words.extend(mesh.octahedra.as_flattened());
    words.extend(mesh.prisms.as_flattened());
    words.extend(mesh.hexahedra.as_flattened());
    words.extend(mesh.triangles.as_flattened());
    words.extend(mesh.quads.as_flattened());
    words.extend(mesh.creases.as_flattened());
    words.extend(&mesh.corners);
    words.extend(bits(points));
}

impl Expected {
    /// The boundary of the cells, whatever the case's own surface is.
    fn push_boundary(&mut self, mesh: &Mesh) {
        let mut found = mesh.clone();
        find_boundary(&mut found);
        let lists = [summary(&found.triangles), summary(&found.quads)];
        self.sections.push(Section {
            tag: SECTION_BOUNDARY,
            words: lists.concat(),
        });
    }

    fn push_mixed_cells(&mut self, level: u32, mesh: &Mesh) {
        let lists = [
            [level, mesh.vertex_count],
            summary(&mesh.tetrahedra),
            summary(&mesh.octahedra),
            summary(&mesh.prisms),
            summary(&mesh.hexahedra),
            summary(&mesh.triangles),
            summary(&mesh.quads),
            summary(&mesh.creases),
            summary(&mesh.corners),
        ];
        self.sections.push(Section {
            tag: SECTION_MIXED_CELLS,
            words: lists.concat(),
        });
    }
}
