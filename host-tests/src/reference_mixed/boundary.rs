//! The boundary: faces of one cell only, less what triangles cover of quadrilaterals.

use std::collections::{BTreeMap, BTreeSet};

use super::Mesh;
use super::faces::{Face, faces, sorted};

/// Takes the boundary of the cells as the mesh's surface.
pub fn find_boundary(mesh: &mut Mesh) {
    let mut by_corners: BTreeMap<Vec<u32>, Vec<Face>> = BTreeMap::new();
    for face in mesh.cells().iter().flat_map(faces) {
        by_corners.entry(face.sorted()).or_default().push(face);
    }
    let single: Vec<Face> = by_corners
        .into_values()
        .filter(|faces| faces.len() == 1)
        .flatten()
        .collect();
    let (quads, triangles): (Vec<Face>, Vec<Face>) =
        single.into_iter().partition(|face| face.cycle.len() == 4);
    let mut covering = BTreeSet::new();
    let mut found: BTreeMap<Vec<u32>, Vec<u32>> = BTreeMap::new();
    mesh.quads.clear();
    for quad in &quads {
        let on_it: Vec<&Face> = triangles
            .iter()
            .filter(|triangle| quad.is_touched_by(&triangle.cycle))
            .collect();
        covering.extend(on_it.iter().map(|triangle| triangle.sorted()));
        match on_it.as_slice() {
            [] => mesh
                .quads
                .push(turned(&quad.cycle).try_into().expect("four")),
            [one] => {
                // What is left is the quadrilateral without the corner across from its free one.
                let free = quad.free_corner(&one.cycle);
                let lost = quad.opposite(free).expect("a corner");
                let mut rest = quad.cycle.clone();
                rest.retain(|corner| *corner != lost);
                found.insert(sorted(&rest), rest);
            }
            _ => {}
        }
    }
    for triangle in triangles {
        if !covering.contains(&triangle.sorted()) {
            found.insert(triangle.sorted(), triangle.cycle);
        }
    }
    mesh.triangles = found
        .into_values()
        .map(|cycle| turned(&cycle).try_into().expect("three"))
        .collect();
}

/// The same cycle with its least corner first.
fn turned(cycle: &[u32]) -> Vec<u32> {
    let least = (0..cycle.len()).min_by_key(|place| cycle[*place]);
    let mut turned = cycle.to_vec();
    turned.rotate_left(least.unwrap_or(0));
    turned
}
