//! Core's box-spline scheme, driven on the host: over raw bits between guard words, and over rows
//! of rational numbers, so that it hands out its exact masks.

use std::fmt::Debug;

use octruss::blend::{Blend, FixedBlend};
use octruss::mesh::{
    MeshError, Numbering, Solid, SolidBuffers, boundary_triangles, edge_capacity, face_capacity,
};
use octruss::solid::box_spline::{
    Boundary, DiagonalBuffers, Diagonals, Face, Neighbours, PointBuffers, Scheme, VertexState,
    choose_diagonals, improper_faces, neighbour_capacity, refine_points, split, split_counts,
    split_diagonals,
};

use crate::rational::{Row, RowBlend, unit_row};

/// How many guard elements lie behind every buffer.
const GUARDS: usize = 5;

/// A number that no index of a test mesh has.
const GUARD: u32 = 0xdead_beef;

/// A byte that no diagonal is.
const GUARD_BYTE: u8 = 0xa5;

/// A solid with everything that the scheme needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoxSolid {
    /// Number of vertices.
    pub vertex_count: u32,
    /// Corners of the tetrahedra.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Corners of the octahedra.
    pub octahedra: Vec<[u32; 6]>,
    /// Boundary triangles and sheets.
    pub surface: Vec<[u32; 3]>,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Corners.
    pub corners: Vec<u32>,
    /// Major diagonals of the tetrahedra.
    pub of_tetrahedra: Vec<u8>,
    /// Major diagonals of the octahedra.
    pub of_octahedra: Vec<u8>,
    /// The averaged scheme, which looks at no diagonals.
    pub is_averaged: bool,
}

impl BoxSolid {
    /// Core's view of it.
    pub fn view(&self) -> Solid<'_> {
        Solid {
            vertex_count: self.vertex_count,
            tetrahedra: &self.tetrahedra,
            octahedra: &self.octahedra,
            surface: &self.surface,
            creases: &self.creases,
            corners: &self.corners,
            ..Solid::default()
        }
    }

    /// The major diagonals.
    pub fn diagonals(&self) -> Diagonals<'_> {
        Diagonals {
            tetrahedra: &self.of_tetrahedra,
            octahedra: &self.of_octahedra,
        }
    }

    /// The scheme that core is asked for.
    pub fn scheme(&self) -> Scheme<'_> {
        if self.is_averaged {
            Scheme::Averaged
        } else {
            Scheme::MajorDiagonals(self.diagonals())
        }
    }

    /// Adds the boundary that core finds to the surface.
    ///
    /// # Errors
    /// Core's own.
    pub fn find_boundary(&mut self) -> Result<(), MeshError> {
        let needed = face_capacity(&self.view()).ok_or(MeshError::TooLarge)?;
        let mut faces = guarded(needed, [GUARD; 3]);
        let boundary = boundary_triangles(&self.view(), &mut faces)?.to_vec();
        self.surface.splice(..0, boundary);
        Ok(())
    }

    /// Takes the diagonals that core chooses.
    ///
    /// # Errors
    /// Core's own.
    ///
    /// # Panics
    /// If core wrote past the part of a buffer that it says it fills.
    pub fn choose(&mut self) -> Result<(), MeshError> {
        let needed = face_capacity(&self.view()).ok_or(MeshError::TooLarge)?;
        let (tetrahedra, octahedra) = (self.tetrahedra.len(), self.octahedra.len());
        let mut faces = guarded(needed, Face::default());
        let mut queue = guarded(tetrahedra + octahedra, GUARD);
        let mut of_tetrahedra = guarded(tetrahedra, GUARD_BYTE);
        let mut of_octahedra = guarded(octahedra, GUARD_BYTE);
        let buffers = DiagonalBuffers {
            tetrahedra: &mut of_tetrahedra,
            octahedra: &mut of_octahedra,
        };
        choose_diagonals(&self.view(), buffers, &mut faces, &mut queue)?;
        check_guards("faces", &faces, needed, &Face::default());
        check_guards("queue", &queue, tetrahedra + octahedra, &GUARD);
        check_guards("diagonals", &of_tetrahedra, tetrahedra, &GUARD_BYTE);
        check_guards("diagonals", &of_octahedra, octahedra, &GUARD_BYTE);
        of_tetrahedra.truncate(tetrahedra);
        of_octahedra.truncate(octahedra);
        self.of_tetrahedra = of_tetrahedra;
        self.of_octahedra = of_octahedra;
        Ok(())
    }

    /// Corners of the faces where diagonals clash, as core finds them.
    ///
    /// # Errors
    /// Core's own.
    pub fn improper(&self) -> Result<Vec<[u32; 3]>, MeshError> {
        let needed = face_capacity(&self.view()).ok_or(MeshError::TooLarge)?;
        let mut faces = vec![Face::default(); needed];
        let improper = improper_faces(&self.view(), &self.diagonals(), &mut faces)?;
        Ok(improper.iter().map(Face::corners).collect())
    }

    /// The midpoint's index in the next level.
    ///
    /// # Panics
    /// If `a b` is not an edge.
    pub fn midpoint(&self, a: u32, b: u32) -> u32 {
        self.numbered(|numbering| numbering.midpoint(a, b).expect("an edge"))
    }

    /// The indices in the next level of the midpoints of edges.
    ///
    /// # Panics
    /// If one of them is no edge.
    pub fn midpoints(&self, edges: &[(u32, u32)]) -> Vec<u32> {
        let middle = |numbering: &Numbering<'_>, &(a, b): &(u32, u32)| {
            numbering.midpoint(a, b).expect("an edge")
        };
        self.numbered(|numbering| edges.iter().map(|edge| middle(numbering, edge)).collect())
    }

    /// The index in the next level of the centroid of an octahedron.
    ///
    /// # Panics
    /// If there is no such octahedron.
    pub fn centroid(&self, octahedron: usize) -> u32 {
        self.numbered(|numbering| {
            let mut centroids = numbering.centroids();
            let found = centroids.find(|(place, _)| *place == octahedron);
            found.expect("an octahedron").1
        })
    }

    fn numbered<T>(&self, ask: impl FnOnce(&Numbering<'_>) -> T) -> T {
        let view = self.view();
        let mut edges = vec![[0; 2]; edge_capacity(&view).expect("fits")];
        let mut order = vec![0; self.octahedra.len()];
        ask(&Numbering::new(&view, &mut edges, &mut order).expect("a sound solid"))
    }
}

/// A buffer of `needed` elements and the guards behind them.
fn guarded<T: Clone>(needed: usize, guard: T) -> Vec<T> {
    vec![guard; needed + GUARDS]
}

/// Holds what lies behind the filled part of a buffer against the guard.
fn check_guards<T: PartialEq + Debug>(name: &str, buffer: &[T], filled: usize, guard: &T) {
    for (place, element) in buffer.iter().enumerate().skip(filled) {
        assert!(
            element == guard,
            "{name}: element {place} is {element:?}, only {filled} may be written"
        );
    }
}

/// Refines once with core over any value type; `guards` stand behind values and sums.
///
/// # Errors
/// Core's own.
///
/// # Panics
/// If core wrote past the part of a buffer that it says it fills.
pub fn refine_with<B: Blend>(
    blend: &mut B,
    level: &BoxSolid,
    boundary: Boundary,
    points: &[B::Point],
    guards: (&B::Point, &B::Sum),
) -> Result<(BoxSolid, Vec<B::Point>), MeshError>
where
    B::Point: PartialEq + Debug,
    B::Sum: PartialEq + Debug,
{
    let view = level.view();
    let edges_needed = edge_capacity(&view).ok_or(MeshError::TooLarge)?;
    let mut edges = guarded(edges_needed, [GUARD; 2]);
    let mut order = guarded(view.octahedra.len(), GUARD);
    let numbering = Numbering::new(&view, &mut edges, &mut order)?;
    let next = split_with_guards(level, &numbering)?;

    let scheme = level.scheme();
    let neighbours_needed = neighbour_capacity(&view, &scheme).ok_or(MeshError::TooLarge)?;
    let mut arena = guarded(neighbours_needed, [GUARD; 3]);
    let neighbours = Neighbours::new(&view, scheme, &mut arena)?;

    let vertices = next.vertex_count as usize;
    let mut out = guarded(vertices, guards.0.clone());
    let mut sums = guarded(vertices, guards.1.clone());
    let mut states = guarded(vertices, VertexState::default());
    let buffers = PointBuffers {
        out: &mut out,
        sums: &mut sums,
        states: &mut states,
    };
    let filled = refine_points(
        blend,
        &view,
        &numbering,
        &neighbours,
        boundary,
        points,
        buffers,
    )?
    .len();
    assert_eq!(filled, vertices, "number of refined values");
    check_guards("edges", &edges, edges_needed, &[GUARD; 2]);
    check_guards("octahedron order", &order, view.octahedra.len(), &GUARD);
    check_guards("neighbours", &arena, neighbours_needed, &[GUARD; 3]);
    check_guards("points", &out, vertices, guards.0);
    check_guards("sums", &sums, vertices, guards.1);
    check_guards("states", &states, vertices, &VertexState::default());
    out.truncate(vertices);
    Ok((next, out))
}

fn split_with_guards(level: &BoxSolid, numbering: &Numbering<'_>) -> Result<BoxSolid, MeshError> {
    let view = level.view();
    let counts = split_counts(&view, numbering).ok_or(MeshError::TooLarge)?;
    let mut tetrahedra = guarded(counts.tetrahedra, [GUARD; 4]);
    let mut octahedra = guarded(counts.octahedra, [GUARD; 6]);
    let mut surface = guarded(counts.surface, [GUARD; 3]);
    let mut creases = guarded(counts.creases, [GUARD; 2]);
    let mut corners = guarded(counts.corners, GUARD);
    let buffers = SolidBuffers {
        tetrahedra: &mut tetrahedra,
        octahedra: &mut octahedra,
        surface: &mut surface,
        creases: &mut creases,
        corners: &mut corners,
    };
    let mut next = {
        let refined = split(&view, numbering, buffers)?;
        BoxSolid {
            vertex_count: refined.vertex_count,
            tetrahedra: refined.tetrahedra.to_vec(),
            octahedra: refined.octahedra.to_vec(),
            surface: refined.surface.to_vec(),
            creases: refined.creases.to_vec(),
            corners: refined.corners.to_vec(),
            is_averaged: level.is_averaged,
            ..BoxSolid::default()
        }
    };
    check_guards("tetrahedra", &tetrahedra, counts.tetrahedra, &[GUARD; 4]);
    check_guards("octahedra", &octahedra, counts.octahedra, &[GUARD; 6]);
    check_guards("surface", &surface, counts.surface, &[GUARD; 3]);
    check_guards("creases", &creases, counts.creases, &[GUARD; 2]);
    check_guards("corners", &corners, counts.corners, &GUARD);
    if !level.is_averaged {
        let mut of_tetrahedra = guarded(counts.tetrahedra, GUARD_BYTE);
        let mut of_octahedra = guarded(counts.octahedra, GUARD_BYTE);
        let buffers = DiagonalBuffers {
            tetrahedra: &mut of_tetrahedra,
            octahedra: &mut of_octahedra,
        };
        let refined = split_diagonals(&level.diagonals(), buffers)?;
        next.of_tetrahedra = refined.tetrahedra.to_vec();
        next.of_octahedra = refined.octahedra.to_vec();
        check_guards("diagonals", &of_tetrahedra, counts.tetrahedra, &GUARD_BYTE);
        check_guards("diagonals", &of_octahedra, counts.octahedra, &GUARD_BYTE);
    }
    Ok(next)
}

/// Refines once in raw bits; also returns how many coordinates saturated.
///
/// # Errors
/// Core's own.
pub fn refine_bits(
    level: &BoxSolid,
    boundary: Boundary,
    points: &[[i32; 3]],
) -> Result<(BoxSolid, Vec<[i32; 3]>, u32), MeshError> {
    let mut blend = FixedBlend::<i32, 3>::new();
    let guards = (&[0x5555_aaaa; 3], &[0x5555_aaaa_5555; 3]);
    let (next, out) = refine_with(&mut blend, level, boundary, points, guards)?;
    Ok((next, out, blend.saturated()))
}

/// Core's exact masks of one level: for each refined vertex its row over the old ones.
///
/// # Panics
/// If core refuses the solid.
pub fn masks(level: &BoxSolid, boundary: Boundary) -> (BoxSolid, Vec<Row>) {
    let units: Vec<_> = (0..level.vertex_count).map(unit_row).collect();
    let guard = unit_row(GUARD);
    refine_with(&mut RowBlend, level, boundary, &units, (&guard, &guard)).expect("a sound solid")
}
