//! Labels of cells, handed on to their children.

use crate::mesh::{Arena, MeshError, require};

/// A label for every cell (a material, a region), by shape in the order of a
/// [`Solid`](crate::mesh::Solid).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellLabels<'a, L> {
    /// Of the tetrahedra.
    pub tetrahedra: &'a [L],
    /// Of the octahedra.
    pub octahedra: &'a [L],
    /// Of the prisms.
    pub prisms: &'a [L],
    /// Of the hexahedra.
    pub hexahedra: &'a [L],
}

impl<L> Default for CellLabels<'_, L> {
    fn default() -> Self {
        Self {
            tetrahedra: &[],
            octahedra: &[],
            prisms: &[],
            hexahedra: &[],
        }
    }
}

/// Where the labels of a refined solid are written.
#[derive(Debug)]
pub struct LabelBuffers<'a, L> {
    /// Of the tetrahedra: four for each tetrahedron, eight for each octahedron.
    pub tetrahedra: &'a mut [L],
    /// Of the octahedra: one for each tetrahedron, six for each octahedron.
    pub octahedra: &'a mut [L],
    /// Of the prisms: eight for each.
    pub prisms: &'a mut [L],
    /// Of the hexahedra: eight for each.
    pub hexahedra: &'a mut [L],
}

impl<L> Default for LabelBuffers<'_, L> {
    fn default() -> Self {
        Self {
            tetrahedra: &mut [],
            octahedra: &mut [],
            prisms: &mut [],
            hexahedra: &mut [],
        }
    }
}

/// The labels of the cells that a split makes: every child has its parent's.
///
/// All schemes for solids split cells alike and in the same order, so this serves all of them. Writes
/// one label for each refined cell and returns the filled part.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written, and [`MeshError::TooLarge`].
pub fn split_labels<'a, L: Copy>(
    labels: &CellLabels<'_, L>,
    buffers: LabelBuffers<'a, L>,
) -> Result<CellLabels<'a, L>, MeshError> {
    let none: &[L] = &[];
    let (of_tetrahedra, of_octahedra) = (labels.tetrahedra, labels.octahedra);
    let lists = [
        ([(of_tetrahedra, 4), (of_octahedra, 8)], buffers.tetrahedra),
        ([(of_tetrahedra, 1), (of_octahedra, 6)], buffers.octahedra),
        ([(labels.prisms, 8), (none, 0)], buffers.prisms),
        ([(labels.hexahedra, 8), (none, 0)], buffers.hexahedra),
    ];
    for (parents, buffer) in &lists {
        require(Arena::Labels, children(parents)?, buffer.len())?;
    }
    let [tetrahedra, octahedra, prisms, hexahedra] =
        lists.map(|(parents, buffer)| hand_on(&parents, buffer));
    Ok(CellLabels {
        tetrahedra: tetrahedra?,
        octahedra: octahedra?,
        prisms: prisms?,
        hexahedra: hexahedra?,
    })
}

/// Labels of parents, and how many children each has.
type Parents<'a, L> = [(&'a [L], usize); 2];

fn children<L>(parents: &Parents<'_, L>) -> Result<usize, MeshError> {
    let [first, second] = parents.map(|(parents, each)| parents.len().checked_mul(each));
    first
        .zip(second)
        .and_then(|(first, second)| first.checked_add(second))
        .ok_or(MeshError::TooLarge)
}

fn hand_on<'a, L: Copy>(
    parents: &Parents<'_, L>,
    buffer: &'a mut [L],
) -> Result<&'a [L], MeshError> {
    let filled = children(parents)?;
    let buffer = buffer.get_mut(..filled).unwrap_or_default();
    let labels = parents
        .iter()
        .flat_map(|&(parents, each)| parents.iter().map(move |&label| (label, each)))
        .flat_map(|(label, each)| core::iter::repeat_n(label, each));
    for (slot, label) in buffer.iter_mut().zip(labels) {
        *slot = label;
    }
    Ok(buffer)
}

#[cfg(test)]
mod tests {
    use super::{CellLabels, LabelBuffers, split_labels};
    use crate::mesh::{Arena, MeshError};

    /// Numbers of children: section 2.1 of "Smooth Subdivision of Tetrahedral Meshes" for tetrahedra and
    /// octahedra; prisms and hexahedra fall into eight each.
    #[test]
    fn children_have_their_parents_labels() {
        let labels = CellLabels {
            tetrahedra: &['a', 'b'],
            octahedra: &['c'],
            prisms: &['d'],
            hexahedra: &['e', 'f'],
        };
        let (mut tetrahedra, mut octahedra) = (['?'; 17], ['?'; 9]);
        let (mut prisms, mut hexahedra) = (['?'; 8], ['?'; 16]);
        let buffers = LabelBuffers {
            tetrahedra: &mut tetrahedra,
            octahedra: &mut octahedra,
            prisms: &mut prisms,
            hexahedra: &mut hexahedra,
        };
        let refined = split_labels(&labels, buffers);
        let wanted = CellLabels {
            tetrahedra: &[
                'a', 'a', 'a', 'a', 'b', 'b', 'b', 'b', 'c', 'c', 'c', 'c', 'c', 'c', 'c', 'c',
            ],
            octahedra: &['a', 'b', 'c', 'c', 'c', 'c', 'c', 'c'],
            prisms: &['d'; 8],
            hexahedra: &[
                'e', 'e', 'e', 'e', 'e', 'e', 'e', 'e', 'f', 'f', 'f', 'f', 'f', 'f', 'f', 'f',
            ],
        };
        assert_eq!(refined, Ok(wanted));
        assert_eq!(
            (tetrahedra.last(), octahedra.last()),
            (Some(&'?'), Some(&'?'))
        );
    }

    #[test]
    fn a_short_buffer_is_refused_and_left_alone() {
        let labels = CellLabels {
            tetrahedra: &[1],
            ..CellLabels::default()
        };
        let (mut tetrahedra, mut octahedra) = ([0; 4], [0; 0]);
        let buffers = LabelBuffers {
            tetrahedra: &mut tetrahedra,
            octahedra: &mut octahedra,
            ..LabelBuffers::default()
        };
        let error = MeshError::ArenaTooSmall {
            arena: Arena::Labels,
            needed: 1,
            given: 0,
        };
        assert_eq!(split_labels(&labels, buffers), Err(error));
        assert_eq!(tetrahedra, [0; 4]);
    }
}
