//! Limit normals of Loop's, Catmull and Clark's and Doo and Sabin's surfaces.
//!
//! Two weighted sums of a vertex's neighbourhood are tangents of the limit surface: the left
//! eigenvectors of the subdominant eigenvalues of the subdivision matrix. Their cross product, brought to
//! unit length, is the normal there. A crease has a normal on either side, so
//! [`limit_normals`] gives one for every *corner of a face*, in the order of the mesh's `indices`; all
//! corners between the same two sharp edges share theirs.
//!
//! # Rules
//!
//! A *sector* is a run of faces around a vertex `c` between two sharp edges, or all round it. Its `k`
//! faces have the edges `e_0, e_1, ..` counter-clockwise and, where faces are quads, the vertices `f_i`
//! across, between `e_i` and `e_(i+1)`. Weights of `c` are minus the sum of the others.
//!
//! * **Smooth** (faces all round; valence `n`): with `x = 2 pi / n`, `a_i = cos((i - s) x)` for
//!   `s = 0` and for the quarter turn `s = floor((n + 2) / 4)`. Loop, all weight families:
//!   `sum(a_i e_i)`. Catmull-Clark (Halstead, Kass, DeRose 1993): `sum(a_i e_i + (a_i + a_(i+1)) / A f_i)`,
//!   `A = 1 + cos x + sqrt((9 + cos x) (1 + cos x))`. The closed ring starts at the vertex's first corner in
//!   `indices` (at a cone's one sharp edge, if it has one). A dart (the end of one crease) is taken as smooth, as OpenSubdiv takes it, in positions as in
//!   normals.
//! * **Crease and spline rim** (`k` faces, `x = pi / k`): along, `e_0 - e_k`. Across, for a single face,
//!   `e_0 + e_1 - 2 c`; otherwise `a_i = sin(i x) / sin x` at the edges inside and, at both ends, the weight
//!   `w` that makes the sum a left eigenvector of the sector's own matrix. Loop:
//!   `w = -cos x / ((1 - cos x) (1 + 2 cos x))`. Catmull-Clark: with `l = (A + 4) / 16` and `A` as above,
//!   `(a_i + a_(i+1)) / A` at `f_i` and
//!   `w = ((3/8 + 1/(2A)) / (1 - cos x) + (l - 3/4) (1/2 + 2/A)) / (2 (4 l - 1) (l - 1))`.
//!   At `k = 3` (Loop) and `k = 2` (Catmull-Clark) these are the masks of the regular rim that
//!   OpenSubdiv has. At other `k` its masks are those of Biermann, Levin and Zorin (2000), who also
//!   change the rules of edges beside a crease; the ones here belong to the rules that
//!   [`features`](super::features) has.
//! * **Rim that stays** ([`Rim::Fixed`]): as a crease, because the edges of a rim's polygon alone say
//!   little of the surface beside it.
//! * **Corner** (tagged, or more than two sharp edges meet): `e_0 - c` and `e_k - c`, on the side to
//!   which the crease's tangents point, so that concave corners are not turned over; where the two are
//!   parallel, as a crease.
//! * **Cone** (a vertex that stays with at most one sharp edge, so that faces go all round): as smooth.
//! * **Doo-Sabin** ([`face_normals`]): a face's centre is a limit position, and `sum(a_i p_i)` over its `n`
//!   corners, `a_i` as for a smooth vertex and starting at the face's first corner, are tangents there.
//!
//! Fewer than three faces all round, or tangents that are parallel, give a normal of zero, which is counted.
//! Where more than six triangles lie between two sharp edges, a third eigenvalue of Loop's exceeds 1/2: the limit surface
//! is not smooth there, and the normal is that of the tangents above, by convention.
//!
//! # Scaling and overflow
//!
//! Weights are multiples of 2^-30; the cosine, sine and root that make them are exact where they are rational
//! (valences 3, 4 and 6). See [`FixedTangents`] for the sums.

mod masks;
mod sector;
mod tangent;

pub use tangent::{FixedTangents, TangentBlend};

use crate::blend::IrrationalWeight;
use crate::mesh::{Arena, ControlMesh, MeshError, SurfaceEdges, index, require};
use crate::surface::features::{Rim, Rule, VertexState, classify};
use masks::{Crease, ONE, Ring};
use sector::{Around, Sector};

/// Which masks of tangents apply.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TangentMasks {
    /// Loop's surfaces of triangles, whatever the weight family.
    Loop,
    /// Catmull and Clark's surfaces, on quads.
    CatmullClark,
}

/// Where normals and the scratch to compute them are written.
#[derive(Debug)]
pub struct NormalBuffers<'a, N> {
    /// One normal for each of the mesh's `indices`.
    pub out: &'a mut [N],
    /// Scratch: one for each of the mesh's `indices`.
    pub done: &'a mut [bool],
    /// Scratch: one state for each vertex and each edge.
    pub states: &'a mut [VertexState],
}

/// Computes the limit normal of every corner of every face, in the order of the mesh's `indices`: what the
/// surface's normal is at that corner's vertex, on that face's side of creases. `points` holds one value for
/// each vertex. Returns the filled part of `out`.
///
/// Faces that are listed counter-clockwise, seen from outside, have normals that point outward.
///
/// # Errors
///
/// [`MeshError::NotATriangle`] or [`MeshError::NotAQuad`] where the scheme wants such;
/// [`MeshError::Orientation`]; [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn limit_normals<'a, T: TangentBlend>(
    blend: &mut T,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    masks: TangentMasks,
    rim: Rim,
    points: &[T::Point],
    buffers: NormalBuffers<'a, T::Normal>,
) -> Result<&'a mut [T::Normal], MeshError> {
    require_faces(mesh, masks)?;
    let (vertices, corners) = (index(mesh.vertex_count), mesh.indices.len());
    let all = vertices
        .checked_add(index(edges.count()))
        .ok_or(MeshError::TooLarge)?;
    require(Arena::InputPoints, vertices, points.len())?;
    require(Arena::OutputPoints, corners, buffers.out.len())?;
    require(Arena::FaceCorners, corners, buffers.done.len())?;
    require(Arena::States, all, buffers.states.len())?;
    edges.check_orientation(mesh)?;
    let out = buffers.out.get_mut(..corners).unwrap_or_default();
    let done = buffers.done.get_mut(..corners).unwrap_or_default();
    let states = buffers.states.get_mut(..all).unwrap_or_default();
    done.fill(false);
    states.fill(VertexState::default());
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    if rim == Rim::Fixed {
        for state in states.iter_mut().take(vertices) {
            if state.rim > 0 && state.sharp == 2 {
                state.rule = Rule::Crease;
            }
        }
    }
    let around = Around {
        mesh,
        edges,
        states,
    };
    for corner in (0..).take(corners) {
        if done.get(index(corner)) != Some(&false) {
            continue;
        }
        let sector = around.sector(corner).ok_or(MeshError::OtherNumbering)?;
        let normal = sector_normal(blend, &around, &sector, masks, points)
            .ok_or(MeshError::OtherNumbering)?;
        for of_sector in around.corners(&sector) {
            let place = index(of_sector);
            *done.get_mut(place).ok_or(MeshError::OtherNumbering)? = true;
            *out.get_mut(place).ok_or(MeshError::OtherNumbering)? = normal.clone();
        }
    }
    Ok(out)
}

fn require_faces(mesh: &ControlMesh<'_>, masks: TangentMasks) -> Result<(), MeshError> {
    let sides = match masks {
        TangentMasks::Loop => 3,
        TangentMasks::CatmullClark => 4,
    };
    for (face, corners) in mesh.faces().enumerate() {
        let corners = corners.len();
        if corners != sides {
            return Err(match masks {
                TangentMasks::Loop => MeshError::NotATriangle { face, corners },
                TangentMasks::CatmullClark => MeshError::NotAQuad { face, corners },
            });
        }
    }
    Ok(())
}

/// The normal of a sector; `None` if the mesh is another one.
fn sector_normal<T: TangentBlend>(
    blend: &mut T,
    around: &Around<'_>,
    sector: &Sector,
    masks: TangentMasks,
    points: &[T::Point],
) -> Option<T::Normal> {
    let own = points.get(index(sector.vertex))?;
    if sector.is_closed {
        if sector.faces < 3 {
            return Some(blend.no_normal());
        }
        let ring = Ring::new(masks, sector.faces)?;
        let mut tangents = [blend.zero(), blend.zero()];
        for (sum, turn) in tangents.iter_mut().zip([0, ring.quarter()]) {
            for (place, corner) in (0..).zip(around.corners(sector)) {
                let [next, across] = around.neighbours(corner)?;
                blend.add(sum, ring.edge(place, turn), points.get(index(next))?, own);
                if masks == TangentMasks::CatmullClark {
                    let weight = ring.face(place, turn);
                    blend.add(sum, weight, points.get(index(across))?, own);
                }
            }
        }
        let [one, other] = &tangents;
        return Some(blend.normal(one, other));
    }
    let first = points.get(index(around.next(sector.first)?))?;
    let last = points.get(index(around.before(sector.last)?))?;
    let mut along = blend.zero();
    blend.add(&mut along, ONE, first, own);
    blend.add(&mut along, masks::negative(ONE), last, own);
    let across = across(blend, around, sector, masks, points)?;
    if sector.is_corner {
        let mut edges = [blend.zero(), blend.zero()];
        for (sum, point) in edges.iter_mut().zip([first, last]) {
            blend.add(sum, ONE, point, own);
        }
        return Some(blend.corner_normal(&edges, &[along, across]));
    }
    Some(blend.normal(&along, &across))
}

/// The tangent across a crease, into the sector.
fn across<T: TangentBlend>(
    blend: &T,
    around: &Around<'_>,
    sector: &Sector,
    masks: TangentMasks,
    points: &[T::Point],
) -> Option<T::Sum> {
    let own = points.get(index(sector.vertex))?;
    let crease = Crease::new(masks, sector.faces)?;
    let mut sum = blend.zero();
    for (place, corner) in (0..).zip(around.corners(sector)) {
        let [next, beyond] = around.neighbours(corner)?;
        let weight: IrrationalWeight = crease.edge(place);
        blend.add(&mut sum, weight, points.get(index(next))?, own);
        if masks == TangentMasks::CatmullClark && sector.faces > 1 {
            blend.add(
                &mut sum,
                crease.face(place),
                points.get(index(beyond))?,
                own,
            );
        }
    }
    let last = points.get(index(around.before(sector.last)?))?;
    blend.add(&mut sum, crease.edge(sector.faces), last, own);
    Some(sum)
}

/// Computes the normals of a Doo-Sabin surface at its faces' centres, where
/// [`doo_sabin::limit_points`](super::doo_sabin::limit_points) has its limit positions: one for each face.
/// Returns the filled part of `out`.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] for a mesh that does
/// not pass its check.
pub fn face_normals<'a, T: TangentBlend>(
    blend: &mut T,
    mesh: &ControlMesh<'_>,
    points: &[T::Point],
    out: &'a mut [T::Normal],
) -> Result<&'a mut [T::Normal], MeshError> {
    let count = mesh.face_count();
    require(Arena::InputPoints, index(mesh.vertex_count), points.len())?;
    require(Arena::OutputPoints, count, out.len())?;
    let out = out.get_mut(..count).unwrap_or_default();
    for (slot, face) in out.iter_mut().zip(mesh.faces()) {
        *slot = face_normal(blend, face, points).ok_or(MeshError::OtherNumbering)?;
    }
    Ok(out)
}

fn face_normal<T: TangentBlend>(
    blend: &mut T,
    face: &[u32],
    points: &[T::Point],
) -> Option<T::Normal> {
    let ring = Ring::new(TangentMasks::Loop, u32::try_from(face.len()).ok()?)?;
    let own = points.get(index(*face.first()?))?;
    let mut tangents = [blend.zero(), blend.zero()];
    for (sum, turn) in tangents.iter_mut().zip([0, ring.quarter()]) {
        for (place, &corner) in (0..).zip(face) {
            blend.add(sum, ring.edge(place, turn), points.get(index(corner))?, own);
        }
    }
    let [one, other] = &tangents;
    Some(blend.normal(one, other))
}
