//! Control meshes of surfaces on the host: core's own subdivision over vectors.
//!
//! [`SurfaceMesh`] is a control mesh as it stands in a file, [`SurfaceLevel`] one level of it in
//! core's lists. Masks and numbering are core's; any values may be taken along.

mod level;
mod tangents;

pub use level::{SurfaceLevel, SurfaceStep};
pub use tangents::RealTangents;

use crate::mesh::{Features, Point};
use crate::read::models::Model;
use octruss::surface::{LoopWeights, Rim};

/// A control mesh of triangles, quads and polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// Vertex positions in file order, in the file's units. All finite.
    pub points: Vec<Point>,
    /// Corners of the faces, counter-clockwise from outside.
    pub faces: Vec<Vec<u32>>,
    /// Creases and corners.
    pub features: Features,
    /// What a reader left out or found odd, a sentence each.
    pub notes: Vec<String>,
}

impl From<Model> for SurfaceMesh {
    /// The points and polygons of a model, without creases and corners.
    fn from(model: Model) -> Self {
        Self {
            points: model.points,
            faces: model.faces,
            ..Self::default()
        }
    }
}

/// The subdivision scheme of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceScheme {
    /// Loop's surfaces of triangles, with his weights of 1987
    Loop,
    /// Loop's surfaces with Warren's weights: 3/(8n), and 3/16 at n = 3
    LoopWarren,
    /// Catmull and Clark's surfaces of any polygons
    CatmullClark,
    /// Doo and Sabin's surfaces of any polygons
    DooSabin,
    /// Kobbelt's square-root-3 surfaces of triangles
    Sqrt3,
    /// The butterfly of 1990, through all vertices of a triangle mesh
    Butterfly,
    /// The modified butterfly of 1996
    ButterflyModified,
    /// Schaefer and Warren's surfaces of triangles and quads together
    TriQuad,
}

impl SurfaceScheme {
    /// The scheme's number in a bundle's header.
    pub fn code(self) -> u32 {
        use octruss::bundle as b;
        match self {
            Self::Loop => b::SCHEME_LOOP,
            Self::LoopWarren => b::SCHEME_LOOP_WARREN,
            Self::CatmullClark => b::SCHEME_CATMULL_CLARK,
            Self::DooSabin => b::SCHEME_DOO_SABIN,
            Self::Sqrt3 => b::SCHEME_SQRT3,
            Self::Butterfly => b::SCHEME_BUTTERFLY,
            Self::ButterflyModified => b::SCHEME_BUTTERFLY_MODIFIED,
            Self::TriQuad => b::SCHEME_TRI_QUAD,
        }
    }

    /// Loop's weight family, for his schemes.
    fn loop_weights(self) -> Option<LoopWeights> {
        match self {
            Self::Loop => Some(LoopWeights::Loop),
            Self::LoopWarren => Some(LoopWeights::Warren),
            _ => None,
        }
    }
}

/// What the rim of an open control mesh follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RimRule {
    /// A cubic B-spline of the rim's vertices (butterfly: the four-point rule)
    #[default]
    Spline,
    /// The same, but a rim vertex in a single face stays
    SplineWithCorners,
    /// The rim's polygon stays as it is
    Fixed,
}

impl RimRule {
    /// The rule's number in a bundle's header.
    pub fn code(self) -> u32 {
        use octruss::bundle as b;
        match self {
            Self::Spline => b::RIM_SPLINE,
            Self::SplineWithCorners => b::RIM_SPLINE_WITH_CORNERS,
            Self::Fixed => b::RIM_FIXED,
        }
    }

    /// The rule as core takes it.
    pub fn to_core(self) -> Rim {
        match self {
            Self::Spline => Rim::Spline,
            Self::SplineWithCorners => Rim::SplineWithCorners,
            Self::Fixed => Rim::Fixed,
        }
    }
}
