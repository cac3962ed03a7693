//! Judges a solid mesh: what no refinement can mend, and what it had better not be built on.

use crate::error::{Error, Result, count};
use crate::geometry::tetrahedron_volume_6;
use crate::locate::curved::{Hexahedron, Prism};
use crate::locate::octahedron::Octahedron;
use crate::mesh::{Cells, Point, Shape, SolidMesh, Vertex, canonical_quad};
use std::collections::HashMap;

/// The volumes of the cells of a mesh. Tetrahedra are judged exactly; the volumes of the others
/// are sums of exact signs' determinants, each rounded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Volumes {
    /// Cells of negative volume, as places in [`crate::mesh::Cells::corners`].
    pub inverted: Vec<usize>,
    /// Cells without volume.
    pub flat: Vec<usize>,
    /// Cells of positive volume that are folded all the same: octahedra that no diagonal cuts into
    /// four positive tetrahedra, and prisms and hexahedra with a corner at which their three edges
    /// do not span a positive tetrahedron (there the cell's map has no positive Jacobian; decided
    /// exactly).
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
        let mut cell = cells.tetrahedra.len();
        for corners in &cells.octahedra {
            let shape = Octahedron::new(corners.map(position));
            volumes.sort_in(cell, shape.volume_6(), shape.is_sound());
            cell += 1;
        }
        for corners in &cells.prisms {
            let shape = Prism::new(corners.map(position));
            volumes.sort_in(cell, shape.volume_12(), shape.is_sound());
            cell += 1;
        }
        for corners in &cells.hexahedra {
            let shape = Hexahedron::new(corners.map(position));
            volumes.sort_in(cell, shape.volume_12(), shape.is_sound());
            cell += 1;
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
    match volumes.folded.first() {
        None => Ok(()),
        Some(cell) => Err(folded(mesh, volumes.folded.len(), *cell)),
    }
}

fn folded(mesh: &SolidMesh, number: usize, first: usize) -> Error {
    let (shape, place) = mesh.cells.place(first);
    let (singular, _) = shape.names();
    let (why, advice) = match shape {
        Shape::Octahedron => (
            "no diagonal cuts it into four tetrahedra of positive volume",
            "move its corners apart, or cut it into tetrahedra",
        ),
        _ => (
            "at one of its corners the three edges do not span a positive volume",
            "move its corners apart, list them in the order of the format, or cut it into tetrahedra",
        ),
    };
    Error::new(format!(
        "{number} of {} folded, first {singular} {place} (counted from 0 in file order): {why}",
        count(mesh.cells.len(), "cell is", "cells are"),
    ))
    .advise(advice)
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
    let faces = FaceUses::of(&mesh.cells);
    match faces.most_crowded() {
        None => Ok(()),
        Some((corners, uses)) => Err(Error::new(format!(
            "{uses} cells share the face of vertices {} (counted from 0)",
            listed(&corners)
        ))
        .advise(
            "cells overlap there; a face belongs to one cell on the boundary and to two inside",
        )),
    }
}

/// "1, 2 and 3".
fn listed(vertices: &[Vertex]) -> String {
    let words: Vec<String> = vertices.iter().map(ToString::to_string).collect();
    match words.split_last() {
        Some((last, others)) if !others.is_empty() => {
            format!("{} and {last}", others.join(", "))
        }
        _ => words.concat(),
    }
}

/// How many cells have each face.
pub(crate) struct FaceUses {
    /// Triangles with ascending corners.
    pub triangles: HashMap<[Vertex; 3], u32>,
    /// Quadrilaterals, as [`canonical_quad`] turns them.
    pub quads: HashMap<[Vertex; 4], u32>,
}

impl FaceUses {
    /// Of all cells.
    pub fn of(cells: &Cells) -> Self {
        let mut uses = Self {
            triangles: HashMap::new(),
            quads: HashMap::new(),
        };
        for mut face in cells.triangles() {
            face.sort_unstable();
            *uses.triangles.entry(face).or_default() += 1;
        }
        for face in cells.quads() {
            *uses.quads.entry(canonical_quad(face)).or_default() += 1;
        }
        uses
    }

    /// How many cells have a triangle on the half of a quadrilateral that leaves out the corner at
    /// this place.
    pub fn on_half(&self, quad: &[Vertex; 4], left_out: usize) -> u32 {
        let mut half = [1, 2, 3].map(|step| quad[(left_out + step) % 4]);
        half.sort_unstable();
        self.triangles.get(&half).copied().unwrap_or(0)
    }

    /// The least face that more than two cells share; a triangle on half of a quadrilateral shares
    /// that.
    fn most_crowded(&self) -> Option<(Vec<Vertex>, u32)> {
        let of_triangles = self.triangles.iter();
        let of_triangles = of_triangles.map(|(face, uses)| (face.to_vec(), *uses));
        let of_quads = self.quads.iter().map(|(face, uses)| {
            let halves = (0..4).map(|left_out| self.on_half(face, left_out));
            (face.to_vec(), uses + halves.max().unwrap_or(0))
        });
        let mut crowded = of_triangles.chain(of_quads).filter(|(_, uses)| *uses > 2);
        let first = crowded.next()?;
        Some(crowded.fold(first, Ord::min))
    }
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
