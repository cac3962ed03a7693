//! The crate's mixed scheme on the host, over any value type. Every buffer that it is lent is longer
//! than it needs, and what lies behind the part that it may fill is held against guards afterwards.

use std::collections::BTreeMap;
use std::fmt::Debug;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero as _;
use octruss::blend::{Blend, Distortion, FixedBlend, GuardedBlend};
use octruss::mesh::{
    BoundarySizes, MeshError, MixedBoundaryBuffers, MixedNumbering, MixedNumberingBuffers,
    MixedNumberingSizes, QuadDiagonal, QuadFace, Solid, boundary_faces,
};
use octruss::solid::mixed::{
    self, MixedBuffers, PointBuffers, VertexDistortion, VertexState, refine_points, split,
    split_counts,
};

use crate::reference_mixed::{Boundary, Mesh};

/// How many guard elements lie behind every buffer.
const GUARDS: usize = 3;

/// A number that no index of a test mesh has.
const GUARD: u32 = 0xdead_beef;

/// The crate's name of a boundary choice.
pub fn core_boundary(boundary: Boundary) -> mixed::Boundary {
    match boundary {
        Boundary::TriQuad => mixed::Boundary::TriQuad,
        Boundary::Interior => mixed::Boundary::Interior,
        Boundary::Fixed => mixed::Boundary::Fixed,
    }
}

/// The crate's view of a mesh.
pub fn view(mesh: &Mesh) -> Solid<'_> {
    Solid {
        vertex_count: mesh.vertex_count,
        tetrahedra: &mesh.tetrahedra,
        octahedra: &mesh.octahedra,
        prisms: &mesh.prisms,
        hexahedra: &mesh.hexahedra,
        surface: &mesh.triangles,
        surface_quads: &mesh.quads,
        creases: &mesh.creases,
        corners: &mesh.corners,
    }
}

fn guarded<T: Clone>(needed: usize, guard: T) -> Vec<T> {
    vec![guard; needed + GUARDS]
}

fn check<T: PartialEq + Debug>(name: &str, buffer: &[T], filled: usize, guard: &T) {
    let is_kept = buffer.iter().skip(filled).all(|element| element == guard);
    assert!(is_kept, "{name}: only {filled} may be written");
}

/// Takes the boundary that the crate finds as the mesh's surface.
///
/// # Errors
/// The crate's own.
pub fn find_boundary(mesh: &mut Mesh) -> Result<(), MeshError> {
    let sizes = BoundarySizes::of(&view(mesh)).ok_or(MeshError::TooLarge)?;
    let mut triangles = guarded(sizes.triangles, [GUARD; 3]);
    let mut quads = guarded(sizes.quads, [GUARD; 4]);
    let buffers = MixedBoundaryBuffers {
        triangles: &mut triangles,
        quads: &mut quads,
    };
    let faces = boundary_faces(&view(mesh), buffers)?;
    let (of_three, of_four) = (faces.triangles.to_vec(), faces.quads.to_vec());
    check("triangles", &triangles, sizes.triangles, &[GUARD; 3]);
    check("quads", &quads, sizes.quads, &[GUARD; 4]);
    (mesh.triangles, mesh.quads) = (of_three, of_four);
    Ok(())
}

/// The memory of one numbering.
struct Lists {
    sizes: MixedNumberingSizes,
    edges: Vec<[u32; 2]>,
    quads: Vec<QuadFace>,
    diagonals: Vec<QuadDiagonal>,
    prism_triangles: Vec<[u32; 3]>,
    octahedra: Vec<u32>,
    hexahedra: Vec<u32>,
}

impl Lists {
    fn new(sizes: MixedNumberingSizes) -> Self {
        Self {
            sizes,
            edges: guarded(sizes.edges, [GUARD; 2]),
            quads: guarded(sizes.quads, QuadFace::default()),
            diagonals: guarded(sizes.diagonals, QuadDiagonal::default()),
            prism_triangles: guarded(sizes.prism_triangles, [GUARD; 3]),
            octahedra: guarded(sizes.octahedra, GUARD),
            hexahedra: guarded(sizes.hexahedra, GUARD),
        }
    }

    fn buffers(&mut self) -> MixedNumberingBuffers<'_> {
        MixedNumberingBuffers {
            edges: &mut self.edges,
            quads: &mut self.quads,
            diagonals: &mut self.diagonals,
            prism_triangles: &mut self.prism_triangles,
            octahedra: &mut self.octahedra,
            hexahedra: &mut self.hexahedra,
        }
    }

    fn check(&self) {
        let sizes = self.sizes;
        check("edges", &self.edges, sizes.edges, &[GUARD; 2]);
        check("quads", &self.quads, sizes.quads, &QuadFace::default());
        let unused = QuadDiagonal::default();
        check("diagonals", &self.diagonals, sizes.diagonals, &unused);
        let triangles = &self.prism_triangles;
        check("triangles", triangles, sizes.prism_triangles, &[GUARD; 3]);
        check("octahedra", &self.octahedra, sizes.octahedra, &GUARD);
        check("hexahedra", &self.hexahedra, sizes.hexahedra, &GUARD);
    }
}

/// Refines once over any value type.
///
/// # Errors
/// The crate's own.
pub fn refine_with<B: GuardedBlend>(
    blend: &mut B,
    mesh: &Mesh,
    boundary: Boundary,
    points: &[B::Point],
) -> Result<(Mesh, Vec<B::Point>), MeshError>
where
    B::Point: PartialEq + Debug,
{
    let solid = view(mesh);
    let sizes = MixedNumberingSizes::of(&solid).ok_or(MeshError::TooLarge)?;
    let mut lists = Lists::new(sizes);
    let numbering = MixedNumbering::new(&solid, lists.buffers())?;
    let next = split_once(&solid, &numbering)?;

    let vertices = next.vertex_count as usize;
    let zero = blend.zero();
    let guard = blend.divide(&zero, 1);
    let mut out = guarded(vertices, guard.clone());
    let buffers = PointBuffers {
        out: &mut out,
        sums: &mut vec![blend.guarded_zero(); vertices],
        states: &mut vec![VertexState::default(); vertices],
        distortions: &mut vec![VertexDistortion::new(&zero); points.len()],
    };
    let boundary = core_boundary(boundary);
    let filled = refine_points(blend, &solid, &numbering, boundary, points, buffers)?.len();
    assert_eq!(filled, vertices, "number of refined values");
    check("points", &out, vertices, &guard);
    lists.check();
    out.truncate(vertices);
    Ok((next, out))
}

fn split_once(solid: &Solid<'_>, numbering: &MixedNumbering<'_>) -> Result<Mesh, MeshError> {
    let counts = split_counts(solid, numbering).ok_or(MeshError::TooLarge)?;
    let mut tetrahedra = guarded(counts.tetrahedra, [GUARD; 4]);
    let mut octahedra = guarded(counts.octahedra, [GUARD; 6]);
    let mut prisms = guarded(counts.prisms, [GUARD; 6]);
    let mut hexahedra = guarded(counts.hexahedra, [GUARD; 8]);
    let mut surface = guarded(counts.surface, [GUARD; 3]);
    let mut surface_quads = guarded(counts.surface_quads, [GUARD; 4]);
    let mut creases = guarded(counts.creases, [GUARD; 2]);
    let mut corners = guarded(counts.corners, GUARD);
    let buffers = MixedBuffers {
        tetrahedra: &mut tetrahedra,
        octahedra: &mut octahedra,
        prisms: &mut prisms,
        hexahedra: &mut hexahedra,
        surface: &mut surface,
        surface_quads: &mut surface_quads,
        creases: &mut creases,
        corners: &mut corners,
    };
    let refined = split(solid, numbering, buffers)?;
    let next = Mesh {
        vertex_count: refined.vertex_count,
        tetrahedra: refined.tetrahedra.to_vec(),
        octahedra: refined.octahedra.to_vec(),
        prisms: refined.prisms.to_vec(),
        hexahedra: refined.hexahedra.to_vec(),
        triangles: refined.surface.to_vec(),
        quads: refined.surface_quads.to_vec(),
        creases: refined.creases.to_vec(),
        corners: refined.corners.to_vec(),
    };
    check("tetrahedra", &tetrahedra, counts.tetrahedra, &[GUARD; 4]);
    check("octahedra", &octahedra, counts.octahedra, &[GUARD; 6]);
    check("prisms", &prisms, counts.prisms, &[GUARD; 6]);
    check("hexahedra", &hexahedra, counts.hexahedra, &[GUARD; 8]);
    check("surface", &surface, counts.surface, &[GUARD; 3]);
    check("quads", &surface_quads, counts.surface_quads, &[GUARD; 4]);
    check("creases", &creases, counts.creases, &[GUARD; 2]);
    check("corners", &corners, counts.corners, &GUARD);
    Ok(next)
}

/// One level in raw 32-bit coordinates: the mesh, its points, how many saturated.
///
/// # Errors
/// The crate's own.
pub fn refine_bits<const D: usize>(
    mesh: &Mesh,
    boundary: Boundary,
    points: &[[i32; D]],
) -> Result<(Mesh, Vec<[i32; D]>, usize), MeshError> {
    let mut blend = FixedBlend::<i32, D>::new();
    let (next, points) = refine_with(&mut blend, mesh, boundary, points)?;
    Ok((next, points, blend.saturated() as usize))
}

/// An exact weighted sum of control points.
pub type Row = BTreeMap<u32, BigRational>;

/// The fraction `numerator / denominator`.
pub fn ratio(numerator: i64, denominator: i64) -> BigRational {
    BigRational::new(numerator.into(), denominator.into())
}

/// `row += factor * other`, without weights of zero.
pub fn add_scaled(row: &mut Row, factor: &BigRational, other: &Row) {
    for (point, weight) in other {
        let sum = row.entry(*point).or_insert_with(BigRational::zero);
        *sum += factor * weight;
        if sum.is_zero() {
            row.remove(point);
        }
    }
}

/// The control points themselves.
pub fn unit_rows(count: u32) -> Vec<Row> {
    (0..count)
        .map(|point| Row::from([(point, ratio(1, 1))]))
        .collect()
}

/// Rows of rational numbers as a value type: what comes out is the crate's own mask.
///
/// The scheme can be asked to leave its unzip out, to show what it is good for.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExactRows {
    /// Clones are the vertices themselves.
    pub without_unzip: bool,
}

impl Blend for ExactRows {
    type Point = Row;
    type Sum = Row;

    fn zero(&self) -> Row {
        Row::new()
    }

    fn add(&self, sum: &mut Row, weight: i64, point: &Row) {
        add_scaled(sum, &BigRational::from(BigInt::from(weight)), point);
    }

    fn add_sum(&self, sum: &mut Row, weight: i64, other: &Row) {
        self.add(sum, weight, other);
    }

    fn divide(&mut self, sum: &Row, denominator: i64) -> Row {
        let mut row = Row::new();
        add_scaled(&mut row, &ratio(1, denominator), sum);
        row
    }
}

impl GuardedBlend for ExactRows {
    type Guarded = Row;
    type GuardedSum = Row;

    fn guard(&self, point: &Row) -> Row {
        point.clone()
    }

    fn distort(&self, own: &Row, parts: &[Distortion<'_, Row>], denominator: u32) -> Row {
        let mut row = own.clone();
        for part in parts {
            if part.count != 0 && !self.without_unzip {
                let sign = if part.is_negative { -1 } else { 1 };
                let divisor = i64::from(part.count) * i64::from(denominator);
                add_scaled(&mut row, &ratio(sign, divisor), part.sum);
            }
        }
        row
    }

    fn guarded_zero(&self) -> Row {
        Row::new()
    }

    fn add_guarded(&self, sum: &mut Row, weight: i64, value: &Row) {
        self.add(sum, weight, value);
    }

    fn add_guarded_sum(&self, sum: &mut Row, weight: i64, other: &Row) {
        self.add(sum, weight, other);
    }

    fn divide_guarded(&mut self, sum: &Row, denominator: i64) -> Row {
        self.divide(sum, denominator)
    }
}

/// The masks of one level.
///
/// # Panics
/// If the mesh is not sound.
pub fn masks(mesh: &Mesh, boundary: Boundary, blend: &mut ExactRows) -> (Mesh, Vec<Row>) {
    let points = unit_rows(mesh.vertex_count);
    refine_with(blend, mesh, boundary, &points).expect("a sound mesh")
}

/// The clones of every vertex, for tetrahedra and octahedra, prisms, and hexahedra, as exact rows.
///
/// # Panics
/// If the mesh is not sound.
pub fn clones(mesh: &Mesh) -> Vec<[Row; 3]> {
    let solid = view(mesh);
    let mut lists = Lists::new(MixedNumberingSizes::of(&solid).expect("it fits"));
    let numbering = MixedNumbering::new(&solid, lists.buffers()).expect("a sound mesh");
    let points = unit_rows(mesh.vertex_count);
    let mut distortions = vec![VertexDistortion::new(&Row::new()); points.len()];
    let mut out = vec![[Row::new(), Row::new(), Row::new()]; points.len()];
    let blend = ExactRows::default();
    mixed::unzip(
        &blend,
        &solid,
        &numbering,
        &points,
        &mut distortions,
        &mut out,
    )
    .expect("enough memory");
    out
}
