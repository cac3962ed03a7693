//! The value of `--scheme`: a scheme of solids or of surfaces.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use octruss_bake::refine::Scheme;
use octruss_bake::surface::SurfaceScheme;
use std::sync::LazyLock;

/// A scheme by its name on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnyScheme {
    /// For cages of cells.
    Solid(Scheme),
    /// For control meshes of polygons.
    Surface(SurfaceScheme),
}

static ALL: LazyLock<Vec<AnyScheme>> = LazyLock::new(|| {
    let solids = Scheme::value_variants().iter().copied();
    let surfaces = SurfaceScheme::value_variants().iter().copied();
    solids
        .map(AnyScheme::Solid)
        .chain(surfaces.map(AnyScheme::Surface))
        .collect()
});

impl ValueEnum for AnyScheme {
    fn value_variants<'a>() -> &'a [Self] {
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Solid(scheme) => scheme.to_possible_value(),
            Self::Surface(scheme) => scheme.to_possible_value(),
        }
    }
}

impl Default for AnyScheme {
    fn default() -> Self {
        Self::Solid(Scheme::default())
    }
}
