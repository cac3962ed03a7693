//! The order in which faces of a control mesh give new vertices their numbers.

use core::cmp::Ordering;

use super::control_mesh::{ControlMesh, index};
use super::error::{Arena, MeshError};
use super::numbering::require;

/// The faces of a control mesh by ascending sorted corners (faces with the same corners by their
/// place in the list).
#[derive(Clone, Copy, Debug)]
pub struct FaceOrder<'a> {
    order: &'a [u32],
}

impl<'a> FaceOrder<'a> {
    /// Sorts the faces of a mesh that passed [`ControlMesh::check`]. `order` must hold one index
    /// for each face.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`] before anything is written.
    pub fn new(mesh: &ControlMesh<'_>, order: &'a mut [u32]) -> Result<Self, MeshError> {
        let needed = mesh.face_count();
        require(Arena::FaceOrder, needed, order.len())?;
        let order = order.get_mut(..needed).unwrap_or_default();
        for (slot, face) in order.iter_mut().zip(0..) {
            *slot = face;
        }
        order.sort_unstable_by(|&one, &other| {
            compare(mesh.face(index(one)), mesh.face(index(other))).then(one.cmp(&other))
        });
        Ok(Self { order })
    }

    /// Every face's place in the mesh's list, in the order of the faces' new vertices.
    pub fn iter(&self) -> impl Iterator<Item = usize> + use<'a> {
        self.order.iter().map(|&face| index(face))
    }

    /// Number of faces.
    #[must_use]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// True for the mesh without faces.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }
}

/// Compares faces by their sorted corners, corner by corner; no face has a corner twice.
fn compare(one: &[u32], other: &[u32]) -> Ordering {
    let (mut low_one, mut low_other) = (least(one, None), least(other, None));
    loop {
        match (low_one, low_other) {
            (Some(a), Some(b)) if a == b => {
                low_one = least(one, low_one);
                low_other = least(other, low_other);
            }
            (None, None) => return Ordering::Equal,
            // A face that runs out of corners first comes first: `None` is less than `Some`.
            _ => return low_one.cmp(&low_other),
        }
    }
}

/// The least corner above `above`.
fn least(face: &[u32], above: Option<u32>) -> Option<u32> {
    face.iter()
        .copied()
        .filter(|&corner| above.is_none_or(|above| corner > above))
        .min()
}
