//! Refinement on the host: core's own subdivision over vectors.
//!
//! Which vertices a split adds, how they are numbered and which weights make them is core's
//! business alone. This module lends core the memory ([`Level`]) and brings the value types that
//! only the host has: double precision ([`RealBlend`]) and sparse rows ([`rows`]).

mod channels;
mod counts;
mod crease_faces;
mod diagonals;
mod level;
mod mixed;
mod real;
pub mod rows;

pub use channels::Channels;
pub use counts::MixedLevelCounts;
pub use diagonals::{DiagonalLists, Interior};
pub use level::{Level, Refinement};
pub use real::RealBlend;

use crate::error::Result;
use crate::surface::SurfaceScheme;
use clap::ValueEnum;
use octruss::solid::tet_oct::Boundary;
use octruss::surface::LoopWeights;

/// What the boundary of a solid follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BoundaryRule {
    /// Loop's scheme with its weights of 1987
    #[default]
    Loop,
    /// Loop's scheme with Warren's weights: 3/(8n), and 3/16 at n = 3
    LoopWarren,
    /// Loop's scheme with 3/(8n) at every valence, as the triangle/quadrilateral scheme has it
    TriQuad,
    /// No rule of its own: the interior smoothing everywhere; the boundary shrinks
    Interior,
    /// The boundary polyhedron stays as it is
    Fixed,
}

impl BoundaryRule {
    /// The rule as core takes it.
    pub fn to_core(self) -> Boundary {
        match self {
            Self::Loop => Boundary::Surface(LoopWeights::Loop),
            Self::LoopWarren => Boundary::Surface(LoopWeights::Warren),
            Self::TriQuad => Boundary::Surface(LoopWeights::TriQuad),
            Self::Interior => Boundary::Interior,
            Self::Fixed => Boundary::Fixed,
        }
    }

    /// The surface scheme that the boundary follows, if it follows one.
    pub fn surface_scheme(self) -> Option<SurfaceScheme> {
        match self {
            Self::Loop => Some(SurfaceScheme::Loop),
            Self::LoopWarren => Some(SurfaceScheme::LoopWarren),
            Self::TriQuad => Some(SurfaceScheme::TriQuad),
            Self::Interior | Self::Fixed => None,
        }
    }

    /// The rule's number in a bundle's header.
    pub fn code(self) -> u32 {
        use octruss::bundle as b;
        match self {
            Self::Loop => b::BOUNDARY_LOOP,
            Self::LoopWarren => b::BOUNDARY_LOOP_WARREN,
            Self::TriQuad => b::BOUNDARY_TRI_QUAD,
            Self::Interior => b::BOUNDARY_INTERIOR,
            Self::Fixed => b::BOUNDARY_FIXED,
        }
    }
}

/// The subdivision scheme of a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Smooth subdivision of tetrahedra and octahedra (Schaefer, Hakenberg, Warren)
    #[default]
    TetOct,
    /// Box-spline solids with major diagonals (Chang, Qin)
    BoxSpline,
    /// Box-spline solids averaged over the three diagonals (Chang, Qin, appendix A)
    BoxSplineAveraged,
    /// Smooth subdivision of tetrahedra, octahedra, prisms and hexahedra together (Hakenberg)
    Mixed,
}

impl Scheme {
    /// Its name on the command line.
    pub fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// What the boundary follows where nothing else was asked for.
    pub fn default_boundary(self) -> BoundaryRule {
        match self {
            Self::Mixed => BoundaryRule::TriQuad,
            Self::TetOct | Self::BoxSpline | Self::BoxSplineAveraged => BoundaryRule::Loop,
        }
    }

    /// The boundary rule that was asked for, or the scheme's own.
    ///
    /// # Errors
    /// If the scheme does not know the rule.
    pub fn boundary(self, asked: Option<BoundaryRule>) -> Result<BoundaryRule> {
        let rule = asked.unwrap_or(self.default_boundary());
        if self == Self::Mixed {
            mixed::mixed_boundary(rule.to_core())?;
        }
        Ok(rule)
    }

    /// The scheme's number in a bundle's header.
    pub fn code(self) -> u32 {
        use octruss::bundle as b;
        match self {
            Self::TetOct => b::SCHEME_TET_OCT,
            Self::BoxSpline => b::SCHEME_BOX_SPLINE,
            Self::BoxSplineAveraged => b::SCHEME_BOX_SPLINE_AVERAGED,
            Self::Mixed => b::SCHEME_MIXED,
        }
    }
}
