//! Data on the cells and points of VTK's grids: labels and channels.
//!
//! The label of a cell is its number in the array of integers that has one of the names in
//! [`LABEL_NAMES`], the first of these that there is; failing that, in the only array of integers with one component. Every array of real
//! numbers with one component on the points is a scalar channel. Other arrays are left out with a
//! note.

use super::cell::Kept;
use crate::error::{Error, Result};
use crate::mesh::{Channel, SolidMesh};

/// Names of arrays of labels, as octruss, Gmsh and other programs write them.
pub const LABEL_NAMES: [&str; 7] = [
    "label",
    "gmsh:physical",
    "medit:ref",
    "CellEntityIds",
    "MaterialIds",
    "Material",
    "region",
];

/// Numbers of one array.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Integers(Vec<i64>),
    /// Double precision.
    Reals(Vec<f64>),
}

/// An array of data on cells or points.
#[derive(Clone, Debug, PartialEq)]
pub struct DataArray {
    /// Its name.
    pub name: String,
    /// Numbers for each cell or point.
    pub components: usize,
    /// All numbers.
    pub values: Values,
}

/// Takes what a mesh can hold from arrays of a file whose cells went where `kept` says.
pub type Add = fn(&[DataArray], &[Kept], &mut SolidMesh) -> Result<()>;

/// Takes labels from data on cells.
pub fn add_labels(arrays: &[DataArray], kept: &[Kept], mesh: &mut SolidMesh) -> Result<()> {
    let is_named = |array: &&DataArray, name: &str| array.name.eq_ignore_ascii_case(name);
    let candidates = || {
        let integers = |array: &&DataArray| {
            array.components == 1 && matches!(array.values, Values::Integers(_))
        };
        arrays.iter().filter(integers)
    };
    let named = LABEL_NAMES
        .iter()
        .find_map(|name| candidates().find(|array| is_named(array, name)));
    let only = || candidates().next().filter(|_| candidates().count() == 1);
    let chosen = named.or_else(only);
    let others = arrays
        .iter()
        .filter(|array| !chosen.is_some_and(|chosen| std::ptr::eq(chosen, *array)));
    note_left_out("cells", others, mesh);
    let Some(DataArray {
        name,
        values: Values::Integers(values),
        ..
    }) = chosen
    else {
        return Ok(());
    };
    if values.len() != kept.len() {
        return Err(wrong_length(name, kept.len(), "cells", values.len()));
    }
    // Their tetrahedra are behind all others.
    let mut of_pyramids = Vec::new();
    for (cell, (value, kept)) in values.iter().zip(kept).enumerate() {
        let label = i32::try_from(*value).map_err(|_| {
            Error::new(format!(
                "the label {value} of cell {cell} (counted from 0) exceeds 32 bits"
            ))
        });
        match kept {
            Kept::Tetrahedron => mesh.labels.tetrahedra.push(label?),
            Kept::Octahedron => mesh.labels.octahedra.push(label?),
            Kept::Prism => mesh.labels.prisms.push(label?),
            Kept::Hexahedron => mesh.labels.hexahedra.push(label?),
            Kept::Pyramid => of_pyramids.extend([label?; 2]),
            Kept::LeftOut => {}
        }
    }
    mesh.labels.tetrahedra.extend(of_pyramids);
    mesh.labels.drop_if_zero();
    Ok(())
}

/// Takes channels from data on points.
pub fn add_channels(arrays: &[DataArray], _kept: &[Kept], mesh: &mut SolidMesh) -> Result<()> {
    let is_channel =
        |array: &&DataArray| array.components == 1 && matches!(array.values, Values::Reals(_));
    note_left_out(
        "points",
        arrays.iter().filter(|array| !is_channel(array)),
        mesh,
    );
    for array in arrays.iter().filter(is_channel) {
        let (name, Values::Reals(values)) = (&array.name, &array.values) else {
            continue;
        };
        if values.len() != mesh.points.len() {
            return Err(wrong_length(
                name,
                mesh.points.len(),
                "points",
                values.len(),
            ));
        }
        if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
            return Err(Error::new(format!(
                "the array \"{name}\" has a value at point {bad} (counted from 0) that is no finite number"
            ))
            .advise("remove the array, or give every point a value"));
        }
        if mesh.channels.iter().any(|channel| channel.name == *name) {
            return Err(Error::new(format!(
                "two arrays on points are named \"{name}\""
            )));
        }
        mesh.channels.push(Channel {
            name: name.clone(),
            values: values.clone(),
        });
    }
    Ok(())
}

fn wrong_length(name: &str, expected: usize, what: &str, found: usize) -> Error {
    Error::new(format!(
        "expected a value for each of {expected} {what} in the array \"{name}\", found {found}"
    ))
}

fn note_left_out<'a>(
    what: &str,
    arrays: impl Iterator<Item = &'a DataArray>,
    mesh: &mut SolidMesh,
) {
    let names: Vec<String> = arrays.map(|array| format!("\"{}\"", array.name)).collect();
    if !names.is_empty() {
        mesh.notes.push(format!(
            "left out of the data on {what}: {} (one integer a cell is a label, one real number a point a channel)",
            names.join(", ")
        ));
    }
}
