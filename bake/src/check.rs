//! Judges a solid mesh: what no refinement can mend, and what it had better not be built on.

use crate::error::{Error, Result, count};
use crate::geometry::tetrahedron_volume_6;
use crate::locate::octahedron::Octahedron;
use crate::mesh::{Cells, Point, SolidMesh, Vertex};
use octruss::mesh::{OCTAHEDRON_FACES, TETRAHEDRON_FACES};
use std::collections::HashMap;

/// The volumes of the cells of a mesh, judged exactly.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Volumes {
    /// Cells of negative volume, as places in [`crate::mesh::Cells::corners`].
    pub inverted: Vec<usize>,
    /// Cells without volume.
    pub flat: Vec<usize>,
    /// Octahedra of positive volume that no diagonal cuts into four positive tetrahedra.
    pub folded: Vec<usize>,
}

impl Volumes {
    /// Looks at every cell.
    pub fn of(cells: &Cells, points: &[Point]) -> Self {
        let position = |vertex: Vertex| points[vertex as usize];
        let mut volumes = Self::default();
        for (cell, corners) in cells.tetrahedra.iter().enumerate() {
            volumes.sort_in(cell, tetrahedron_volume_6(corners.map(position)), true);
        }
        for (cell, corners) in (cells.tetrahedra.len()..).zip(&cells.octahedra) {
            let shape = Octahedron::new(corners.map(position));
            volumes.sort_in(cell, shape.volume_6(), shape.is_sound());
        }
        volumes
    }

    fn sort_in(&mut self, cell: usize, volume: f64, is_sound: bool) {
        if volume < 0.0 {
            self.inverted.push(cell);
        } else if volume == 0.0 {
            self.flat.push(cell);
        } else if !is_sound {
            self.folded.push(cell);
        }
    }
}

/// Error unless a map can be built on this mesh at rest: every cell has positive volume.
///
/// A cell of negative volume is never turned round silently: it may be one whose corners are
/// listed in the other order, but as well one that the rest shape really turns inside out.
pub fn require_positive_volumes(mesh: &SolidMesh) -> Result<()> {
    let volumes = Volumes::of(&mesh.cells, &mesh.points);
    let cells = mesh.cells.len();
    let first = |list: &[usize]| list.first().map(|cell| mesh.cells.name(*cell));
    if let Some(name) = first(&volumes.inverted) {
        let number = volumes.inverted.len();
        let advice = if number == cells {
            "every cell is: the mesh is mirrored, or written by a program that lists corners in the other order; exchange the first two corners of every cell, or mirror the mesh"
        } else {
            "mend the mesh so that no cell is turned inside out, or exchange two corners of those that are only listed in the other order"
        };
        return Err(Error::new(format!(
            "{} of {} of negative volume, first {name} (counted from 0 in file order)",
            number,
            count(cells, "cell is", "cells are")
        ))
        .advise(advice));
    }
    if let Some(name) = first(&volumes.flat) {
        return Err(Error::new(format!(
            "{} of {} without volume, first {name} (counted from 0 in file order)",
            volumes.flat.len(),
            count(cells, "cell is", "cells are")
        ))
        .advise("remove the flat cells, for example with Gmsh's Mesh.Optimize"));
    }
    if let Some(name) = first(&volumes.folded) {
        return Err(Error::new(format!(
            "{} of {} folded, first {name} (counted from 0 in file order): no diagonal cuts it into four tetrahedra of positive volume",
            volumes.folded.len(),
            count(mesh.cells.octahedra.len(), "octahedron is", "octahedra are")
        ))
        .advise("move its corners apart, or cut it into tetrahedra"));
    }
    Ok(())
}

/// Error if the connectivity is none of a solid: a cell that names a vertex twice, two cells with
/// the same corners, or a face of more than two cells.
pub fn require_sound_connectivity(mesh: &SolidMesh) -> Result<()> {
    let mut seen: HashMap<Vec<Vertex>, usize> = HashMap::new();
    for (cell, corners) in mesh.cells.corners().enumerate() {
        let mut sorted = corners.to_vec();
        sorted.sort_unstable();
        if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Error::new(format!(
                "{} (counted from 0 in file order) names vertex {} twice",
                mesh.cells.name(cell),
                twice[0]
            ))
            .advise("remove the degenerate cell"));
        }
        if let Some(other) = seen.insert(sorted, cell) {
            return Err(Error::new(format!(
                "{} and {} (counted from 0 in file order) have the same corners",
                mesh.cells.name(other),
                mesh.cells.name(cell)
            ))
            .advise("remove one; Gmsh's MSH 2.2 lists a cell once for each physical group that holds it"));
        }
    }
    let mut uses: HashMap<[Vertex; 3], u32> = HashMap::new();
    for face in faces(mesh) {
        let mut key = face;
        key.sort_unstable();
        *uses.entry(key).or_default() += 1;
    }
    match uses.into_iter().filter(|(_, uses)| *uses > 2).min() {
        None => Ok(()),
        Some(([a, b, c], uses)) => Err(Error::new(format!(
            "{uses} cells share the face of vertices {a}, {b} and {c} (counted from 0)"
        ))
        .advise(
            "cells overlap there; a face belongs to one cell on the boundary and to two inside",
        )),
    }
}

/// The faces of all cells, counter-clockwise from outside of a positive cell.
pub(crate) fn faces(mesh: &SolidMesh) -> impl Iterator<Item = [Vertex; 3]> {
    let of_tetrahedra = mesh
        .cells
        .tetrahedra
        .iter()
        .flat_map(|cell| TETRAHEDRON_FACES.map(|face| face.map(|corner| cell[corner])));
    let of_octahedra = mesh
        .cells
        .octahedra
        .iter()
        .flat_map(|cell| OCTAHEDRON_FACES.map(|face| face.map(|corner| cell[corner])));
    of_tetrahedra.chain(of_octahedra)
}

/// Vertices that no cell and no sheet uses: control points that move nothing.
pub fn unused_vertices(mesh: &SolidMesh) -> Vec<usize> {
    let mut used = vec![false; mesh.points.len()];
    let sheets = mesh.features.sheets.iter().flatten();
    for vertex in mesh.cells.corners().flatten().chain(sheets) {
        used[*vertex as usize] = true;
    }
    used.iter()
        .enumerate()
        .filter(|(_, used)| !**used)
        .map(|(vertex, _)| vertex)
        .collect()
}
