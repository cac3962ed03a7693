//! Major diagonals of box-spline solids in memory.

use super::Scheme;
use crate::error::Result;
use crate::refine::level::mesh_error;
use octruss::mesh::{MeshError, Solid, face_capacity};
use octruss::solid::box_spline::{
    DiagonalBuffers, Diagonals, Face, choose_diagonals, improper_faces, split_diagonals,
};

/// The major diagonal of every cell: 0, 1 or 2.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DiagonalLists {
    /// Of the tetrahedra, in their order.
    pub tetrahedra: Vec<u8>,
    /// Of the octahedra, in their order.
    pub octahedra: Vec<u8>,
}

impl DiagonalLists {
    /// The diagonals that core's search chooses.
    pub fn choose(solid: &Solid<'_>) -> Result<Self> {
        let mut lists = Self::zeros(solid.tetrahedra.len(), solid.octahedra.len());
        let mut queue = vec![0; solid.tetrahedra.len() + solid.octahedra.len()];
        choose_diagonals(solid, lists.buffers(), &mut faces(solid)?, &mut queue)
            .map_err(mesh_error)?;
        Ok(lists)
    }

    /// The view that core takes.
    pub fn view(&self) -> Diagonals<'_> {
        Diagonals {
            tetrahedra: &self.tetrahedra,
            octahedra: &self.octahedra,
        }
    }

    /// Corners of the faces at which the diagonals of two cells clash.
    pub fn improper(&self, solid: &Solid<'_>) -> Result<Vec<[u32; 3]>> {
        let mut faces = faces(solid)?;
        let improper = improper_faces(solid, &self.view(), &mut faces).map_err(mesh_error)?;
        Ok(improper.iter().map(Face::corners).collect())
    }

    /// The diagonals of the children of these cells, which are so many.
    pub(super) fn split(&self, tetrahedra: usize, octahedra: usize) -> Result<Self> {
        let mut next = Self::zeros(tetrahedra, octahedra);
        split_diagonals(&self.view(), next.buffers()).map_err(mesh_error)?;
        Ok(next)
    }

    fn zeros(tetrahedra: usize, octahedra: usize) -> Self {
        Self {
            tetrahedra: vec![0; tetrahedra],
            octahedra: vec![0; octahedra],
        }
    }

    fn buffers(&mut self) -> DiagonalBuffers<'_> {
        DiagonalBuffers {
            tetrahedra: &mut self.tetrahedra,
            octahedra: &mut self.octahedra,
        }
    }
}

fn faces(solid: &Solid<'_>) -> Result<Vec<Face>> {
    let capacity = face_capacity(solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
    Ok(vec![Face::default(); capacity])
}

/// What the interior of a solid follows, with what that needs at one level.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Interior {
    /// Smoothed cells.
    #[default]
    TetOct,
    /// The box spline along these diagonals.
    BoxSpline(DiagonalLists),
    /// The averaged box spline.
    BoxSplineAveraged,
    /// Unzipped, split and averaged cells of all shapes.
    Mixed,
}

impl Interior {
    /// What a scheme needs at level 0: diagonals that were given, or those that are chosen.
    pub(super) fn new(
        scheme: Scheme,
        solid: &Solid<'_>,
        given: Option<&DiagonalLists>,
    ) -> Result<Self> {
        Ok(match (scheme, given) {
            (Scheme::TetOct, _) => Self::TetOct,
            (Scheme::BoxSplineAveraged, _) => Self::BoxSplineAveraged,
            (Scheme::Mixed, _) => Self::Mixed,
            (Scheme::BoxSpline, None) => Self::BoxSpline(DiagonalLists::choose(solid)?),
            (Scheme::BoxSpline, Some(given)) => {
                given.view().check(solid).map_err(mesh_error)?;
                Self::BoxSpline(given.clone())
            }
        })
    }
}
