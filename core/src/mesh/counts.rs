//! How many elements a mesh has, and how many its refinements will have.

/// Numbers of elements of a solid.
///
/// This is what arenas are sized by: [`Counts::refined`] says it for the next level without
/// refining anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Vertices.
    pub vertices: usize,
    /// Edges of cells, each counted once.
    pub edges: usize,
    /// Triangles of cells, each counted once.
    pub faces: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Octahedra.
    pub octahedra: usize,
    /// Surface triangles.
    pub surface: usize,
    /// Crease edges.
    pub creases: usize,
    /// Corners.
    pub corners: usize,
}

impl Counts {
    /// The counts one level up, or `None` where a count does not fit.
    ///
    /// A split halves every edge, adds three edges on every face and twelve from every
    /// octahedron's centroid. It cuts every face into four, and adds four faces inside a
    /// tetrahedron (to its middle octahedron) and 24 inside an octahedron (three on each of its
    /// eight face tetrahedra).
    #[must_use]
    pub fn refined(self) -> Option<Self> {
        Some(Self {
            vertices: weighted([(1, self.vertices), (1, self.edges), (1, self.octahedra)])?,
            edges: weighted([(2, self.edges), (3, self.faces), (12, self.octahedra)])?,
            faces: weighted([(4, self.faces), (4, self.tetrahedra), (24, self.octahedra)])?,
            tetrahedra: weighted([(4, self.tetrahedra), (8, self.octahedra), (0, 0)])?,
            octahedra: weighted([(1, self.tetrahedra), (6, self.octahedra), (0, 0)])?,
            surface: self.surface.checked_mul(4)?,
            creases: self.creases.checked_mul(2)?,
            corners: self.corners,
        })
    }
}

/// The sum of factor times count, checked.
fn weighted(terms: [(usize, usize); 3]) -> Option<usize> {
    terms.into_iter().try_fold(0_usize, |sum, (factor, count)| {
        sum.checked_add(factor.checked_mul(count)?)
    })
}
