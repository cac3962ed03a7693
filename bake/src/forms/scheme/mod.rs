//! The surface schemes that forms exist for: refinement, facets, and the order of a facet's
//! control points.
//!
//! A *facet* is a piece of the limit surface that its control points determine: a quadrilateral
//! of a Catmull-Clark mesh, a triangle of a Loop mesh, a vertex of a Doo-Sabin mesh. It is named
//! by a half-edge at its irregular place. After [`Scheme::steps`] refinements a facet has at most
//! one irregular place, and its *valence* is the number of edges (of corners, for Doo-Sabin) there.
//!
//! Control points are in the order of Hakenberg, Reif, Schaefer and Warren, counted from 0 here.

mod catmull_clark;
mod doo_sabin;
mod row;
mod triangles;

use std::fmt;

pub use row::Row;
pub(crate) use row::{RowBuilder, apply};

use super::error::FormError;
use super::exact::Field;
use super::mesh::{ClosedMesh, HalfEdge};
use crate::surface::SurfaceScheme;

/// A surface scheme with a trilinear form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, clap::ValueEnum)]
pub enum Scheme {
    /// Doo and Sabin: any polygons; weights 1/4 + 5/(4n) and (3 + 2 cos(2 pi i / n)) / (4n)
    DooSabin,
    /// Catmull and Clark: any polygons; weights of 1978
    CatmullClark,
    /// Loop: triangles; weights of 1987
    Loop,
    /// Loop's scheme with Warren's weights: 3/(8n), and 3/16 at n = 3
    LoopWarren,
}

impl Scheme {
    /// All schemes, in the order that they are listed in.
    pub const ALL: [Self; 4] = [
        Self::DooSabin,
        Self::CatmullClark,
        Self::Loop,
        Self::LoopWarren,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::DooSabin => "doo-sabin",
            Self::CatmullClark => "catmull-clark",
            Self::Loop => "loop",
            Self::LoopWarren => "loop-warren",
        }
    }

    /// The scheme of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name() == name)
    }

    /// The form scheme of a surface scheme, if it has forms for each valence; the
    /// others have them for each [neighbourhood](super::neighbourhood).
    #[must_use]
    pub fn of_surface(scheme: SurfaceScheme) -> Option<Self> {
        match scheme {
            SurfaceScheme::Loop => Some(Self::Loop),
            SurfaceScheme::LoopWarren => Some(Self::LoopWarren),
            SurfaceScheme::CatmullClark => Some(Self::CatmullClark),
            SurfaceScheme::DooSabin => Some(Self::DooSabin),
            SurfaceScheme::Sqrt3
            | SurfaceScheme::Butterfly
            | SurfaceScheme::ButterflyModified
            | SurfaceScheme::TriQuad => None,
        }
    }

    /// The surface scheme of this form scheme.
    #[must_use]
    pub fn surface(self) -> SurfaceScheme {
        match self {
            Self::DooSabin => SurfaceScheme::DooSabin,
            Self::CatmullClark => SurfaceScheme::CatmullClark,
            Self::Loop => SurfaceScheme::Loop,
            Self::LoopWarren => SurfaceScheme::LoopWarren,
        }
    }

    /// The valence of a regular facet.
    #[must_use]
    pub fn regular_valence(self) -> usize {
        match self {
            Self::DooSabin | Self::CatmullClark => 4,
            Self::Loop | Self::LoopWarren => 6,
        }
    }

    /// The number of control points of a facet of this valence.
    #[must_use]
    pub fn control_point_count(self, valence: usize) -> usize {
        match self {
            Self::DooSabin => valence + 5,
            Self::CatmullClark => 2 * valence + 8,
            Self::Loop | Self::LoopWarren => valence + 6,
        }
    }

    /// The control points of a facet, counted from 0, that determine the surface at its irregular
    /// place: those that the scheme maps to themselves.
    #[must_use]
    pub fn outer_control_points(self) -> &'static [usize] {
        match self {
            Self::DooSabin => &[0, 1, 2, 3, 6],
            Self::CatmullClark => &[0, 1, 2, 3, 4, 8, 12],
            Self::Loop | Self::LoopWarren => &[0, 1, 2, 3, 6],
        }
    }

    /// How often a mesh must be refined until every facet has at most one irregular place.
    ///
    /// # Errors
    ///
    /// [`FormError::NotTriangles`] if the scheme takes triangles only and the mesh has others.
    pub fn steps(self, mesh: &ClosedMesh) -> Result<usize, FormError> {
        match self {
            Self::DooSabin => Ok(2),
            Self::CatmullClark => Ok(catmull_clark::steps(mesh)),
            Self::Loop | Self::LoopWarren => {
                triangles::require(mesh)?;
                Ok(1)
            }
        }
    }

    /// The connectivity after one step.
    #[must_use]
    pub fn refine(self, mesh: &ClosedMesh) -> ClosedMesh {
        let (vertices, faces) = match self {
            Self::DooSabin => doo_sabin::refine(mesh),
            Self::CatmullClark => catmull_clark::refine(mesh),
            Self::Loop | Self::LoopWarren => triangles::refine(mesh),
        };
        ClosedMesh::new(vertices, &faces).expect("a refined closed surface is a closed surface")
    }

    /// The weights of a vertex of the refined mesh, or `None` if they do not lie in the field.
    #[must_use]
    pub fn row<F: Field>(self, mesh: &ClosedMesh, vertex: usize) -> Option<Row<F>> {
        match self {
            Self::DooSabin => doo_sabin::row(mesh, vertex),
            Self::CatmullClark => Some(catmull_clark::row(mesh, vertex)),
            Self::Loop => triangles::row(mesh, vertex, triangles::loop_weight),
            Self::LoopWarren => triangles::row(mesh, vertex, triangles::warren_weight),
        }
    }

    /// The valences (numbers of corners, for Doo-Sabin) that the weights of a step depend on.
    #[must_use]
    pub fn weight_valences(self, mesh: &ClosedMesh) -> Vec<usize> {
        match self {
            Self::DooSabin => (0..mesh.faces())
                .map(|face| mesh.face(face).len())
                .collect(),
            _ => (0..mesh.vertices())
                .map(|vertex| mesh.valence(vertex))
                .collect(),
        }
    }

    /// The weights of every vertex of the refined mesh.
    ///
    /// # Errors
    ///
    /// [`FormError::NotExact`] if they do not lie in the field.
    pub fn rows<F: Field>(
        self,
        mesh: &ClosedMesh,
        refined: &ClosedMesh,
    ) -> Result<Vec<Row<F>>, FormError> {
        let row = |vertex| {
            let valence = match self {
                Self::DooSabin => mesh.sides(vertex),
                _ if vertex < mesh.vertices() => mesh.valence(vertex),
                _ => 0,
            };
            self.row(mesh, vertex)
                .ok_or(FormError::NotExact { valence })
        };
        (0..refined.vertices()).map(row).collect()
    }

    /// The facets of a mesh that was refined [`Scheme::steps`] times, each by a half-edge at its
    /// irregular place (at any corner if there is none).
    #[must_use]
    pub fn facets(self, mesh: &ClosedMesh) -> Vec<HalfEdge> {
        let regular = self.regular_valence();
        let choose = |candidates: Vec<HalfEdge>| {
            let irregular = candidates
                .iter()
                .find(|&&half_edge| self.valence(mesh, half_edge) != regular);
            *irregular.unwrap_or(&candidates[0])
        };
        match self {
            Self::DooSabin => (0..mesh.vertices())
                .map(|vertex| choose(mesh.around(vertex)))
                .collect(),
            _ => (0..mesh.faces())
                .map(|face| choose(mesh.face(face).collect()))
                .collect(),
        }
    }

    /// The valence of the facet that a half-edge names.
    #[must_use]
    pub fn valence(self, mesh: &ClosedMesh, facet: HalfEdge) -> usize {
        match self {
            Self::DooSabin => mesh.sides(facet),
            _ => mesh.valence(mesh.origin(facet)),
        }
    }

    /// The control points of a facet, in the order of the form.
    #[must_use]
    pub fn control_points(self, mesh: &ClosedMesh, facet: HalfEdge) -> Vec<usize> {
        match self {
            Self::DooSabin => doo_sabin::control_points(mesh, facet),
            Self::CatmullClark => catmull_clark::control_points(mesh, facet),
            Self::Loop | Self::LoopWarren => triangles::control_points(mesh, facet),
        }
    }

    /// The four facets of the refined mesh that a facet is split into: three regular ones and, last,
    /// the one that keeps the irregular place.
    #[must_use]
    pub fn children(self, mesh: &ClosedMesh, facet: HalfEdge) -> [HalfEdge; 4] {
        match self {
            Self::DooSabin => doo_sabin::children(mesh, facet),
            Self::CatmullClark => catmull_clark::children(mesh, facet),
            Self::Loop | Self::LoopWarren => triangles::children(mesh, facet),
        }
    }

    /// A closed mesh with a facet of this valence whose surroundings are regular far enough that
    /// its control points are all different, and the half-edge that names it.
    #[must_use]
    pub(crate) fn template(self, valence: usize) -> (ClosedMesh, HalfEdge) {
        let (vertices, faces) = match self {
            Self::DooSabin => prism(valence),
            _ => double_pyramid(valence),
        };
        let mut mesh = ClosedMesh::new(vertices, &faces).expect("a convex solid is closed");
        for _ in 0..3 {
            mesh = self.refine(&mesh);
        }
        // Old faces come first in a refined Doo-Sabin mesh, old vertices in the others.
        let facet = match self {
            Self::DooSabin => 0,
            _ => mesh.around(0)[0],
        };
        (mesh, facet)
    }

    /// The number `d` so that all weights of these valences lie in Q(sqrt d); 1 for the rationals.
    ///
    /// # Errors
    ///
    /// [`FormError::NotExact`] if they lie in no single quadratic field.
    pub fn exact_radicand(self, valences: &[usize]) -> Result<u32, FormError> {
        let mut radicand = 1;
        for &valence in valences {
            let own = match (self, valence) {
                (Self::CatmullClark | Self::LoopWarren, _) | (_, 1 | 2 | 3 | 4 | 6) => 1,
                (_, 5 | 10) => 5,
                (_, 8) => 2,
                (_, 12) => 3,
                _ => return Err(FormError::NotExact { valence }),
            };
            if own != 1 && radicand != 1 && own != radicand {
                return Err(FormError::NotExact { valence });
            }
            radicand = radicand.max(own);
        }
        Ok(radicand)
    }
}

impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The faces of a prism over a polygon: the polygon first.
fn prism(sides: usize) -> (usize, Vec<Vec<u32>>) {
    let n = u32::try_from(sides).expect("valences are small");
    let mut faces = vec![(0..n).collect(), (n..2 * n).rev().collect()];
    faces.extend((0..n).map(|i| {
        let j = (i + 1) % n;
        vec![j, i, n + i, n + j]
    }));
    (2 * sides, faces)
}

/// The faces of a double pyramid over a polygon: vertex 0 is an apex.
fn double_pyramid(sides: usize) -> (usize, Vec<Vec<u32>>) {
    let n = u32::try_from(sides).expect("valences are small");
    let mut faces = Vec::new();
    for i in 0..n {
        let (a, b) = (2 + i, 2 + (i + 1) % n);
        faces.extend([vec![0, a, b], vec![1, b, a]]);
    }
    (sides + 2, faces)
}
