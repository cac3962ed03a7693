//! Random solids of several materials: labels of cells, a crease surface wherever two labels
//! meet, and scalar channels of vertices.

use std::collections::BTreeMap;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_mesh::{Limits, random_points, random_solid};
use crate::reference::{Boundary, Solid, cell_faces};

/// One random case with `D` channels.
#[derive(Clone, Debug)]
pub struct DataCase<const D: usize> {
    /// The seed that made it.
    pub seed: u64,
    /// Connectivity at level 0; its sheets are the faces between different labels.
    pub solid: Solid,
    /// A label for each cell, tetrahedra first.
    pub labels: Vec<u32>,
    /// Values of the vertices, raw bits.
    pub channels: Vec<[i32; D]>,
    /// What the boundary follows.
    pub boundary: Boundary,
    /// How often to refine.
    pub levels: u32,
}

impl<const D: usize> DataCase<D> {
    /// The case of a seed. Boundary choices take turns, so that equally many cases have each.
    pub fn new(seed: u64, limits: &Limits) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let levels = rng.random_range(1..=limits.levels);
        let limits = Limits {
            levels,
            sheets: false,
            ..*limits
        };
        let mut solid = random_solid(&mut rng, &limits);
        let kinds = rng.random_range(2..=3);
        let label = |_| rng.random_range(0..kinds);
        let labels: Vec<u32> = (0..solid.cells().count()).map(label).collect();
        solid.sheets = interfaces(&solid, &labels);
        let channels = random_points(&mut rng, solid.vertex_count);
        Self {
            seed,
            solid,
            labels,
            channels,
            boundary: Boundary::ALL[(seed % 5) as usize],
            levels,
        }
    }
}

/// The triangles between cells of different labels, each once, as seen from the first of the two
/// cells, ascending.
pub fn interfaces(solid: &Solid, labels: &[u32]) -> Vec<[u32; 3]> {
    let (of_tetrahedra, of_octahedra) = labels.split_at(solid.tetrahedra.len());
    let of_faces = of_tetrahedra
        .iter()
        .flat_map(|label| [label; 4])
        .chain(of_octahedra.iter().flat_map(|label| [label; 8]));
    let mut first_seen = BTreeMap::new();
    let mut between = Vec::new();
    for (face, label) in cell_faces(solid).into_iter().zip(of_faces) {
        let mut sorted = face;
        sorted.sort_unstable();
        match first_seen.get(&sorted) {
            None => {
                first_seen.insert(sorted, (face, label));
            }
            Some((other, other_label)) if *other_label != label => between.push(*other),
            Some(_) => {}
        }
    }
    between.sort_unstable();
    between
}

#[cfg(test)]
mod tests {
    use super::{DataCase, interfaces};
    use crate::meshes::two_tetrahedra;
    use crate::random_mesh::Limits;

    #[test]
    fn two_materials_meet_in_one_face() {
        let solid = two_tetrahedra();
        let mut faces = interfaces(&solid, &[4, 9]);
        faces.iter_mut().for_each(|face| face.sort_unstable());
        assert_eq!(faces, [[0, 1, 2]]);
        assert_eq!(interfaces(&solid, &[4, 4]), [[0; 3]; 0]);
    }

    /// Crease surfaces of one face and of several occur, between cells of every pair of shapes.
    #[test]
    fn crease_surfaces_occur() {
        let (mut with_surface, mut great, mut at_octahedron) = (0, 0, 0);
        for seed in 0..300 {
            let case = DataCase::<1>::new(seed, &Limits::default());
            case.solid.check().expect("a sound solid");
            let sheets = &case.solid.sheets;
            with_surface += usize::from(!sheets.is_empty());
            great += usize::from(sheets.len() > 2);
            let meets = |cell: &[u32; 6]| {
                let holds = |sheet: &[u32; 3]| sheet.iter().all(|vertex| cell.contains(vertex));
                sheets.iter().any(holds)
            };
            at_octahedron += usize::from(case.solid.octahedra.iter().any(meets));
        }
        assert!(
            with_surface > 150,
            "{with_surface} cases with a crease surface"
        );
        assert!(great > 50, "{great} cases with more than two triangles");
        assert!(at_octahedron > 30, "{at_octahedron} cases at an octahedron");
    }
}
