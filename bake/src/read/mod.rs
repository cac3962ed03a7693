//! Readers: one for each file format, bytes in, mesh out.
//!
//! A reader takes the whole file as bytes and gives a mesh, or an error that names line or byte;
//! it never panics, whatever the bytes. It does not touch the file system: that is done here,
//! together with the choice of the reader by the file name's extension. A new format is one more
//! file and one more line in [`solid`] or [`model`].

pub mod channel;
pub mod control;
pub mod diagonals;
pub mod features;
pub mod gmsh;
mod lines;
pub mod medit;
pub mod models;
pub mod motion;
pub mod obj;
pub mod obj_tags;
pub mod off;
pub mod ply;
pub mod points;
pub mod pyramids;
pub mod stl;
pub mod tetgen;
pub mod vtk;
pub mod vtu;
pub(crate) mod words;

use crate::error::{Error, Result};
use crate::mesh::SolidMesh;
use crate::refine::DiagonalLists;
use crate::surface::SurfaceMesh;
use models::Model;
use std::path::Path;

/// The bytes of a file.
pub fn bytes(file: &Path) -> Result<Vec<u8>> {
    std::fs::read(file)
        .map_err(|error| Error::new(format!("cannot be read: {error}")).in_file(file))
}

/// The extension of a file name in lower case, empty if it has none.
pub fn extension(file: &Path) -> String {
    file.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

/// The error for a file whose extension tells of no format that holds `what`.
fn no_reader(what: &str, extension: &str) -> Error {
    Error::new(match extension {
        "" => format!("the name has no extension, which tells the format of {what}"),
        other => format!("no reader of {what} for \".{other}\" files"),
    })
}

/// The extensions of the files that [`solid`] reads.
pub const SOLID_EXTENSIONS: [&str; 6] = ["msh", "vtu", "vtk", "mesh", "node", "ele"];

/// Reads a solid mesh in the format that the file's extension names. Of a TetGen mesh either file
/// may be named.
pub fn solid(file: &Path) -> Result<SolidMesh> {
    let reader = match extension(file).as_str() {
        "msh" => gmsh::read,
        "vtu" => vtu::read,
        "vtk" => vtk::read,
        "mesh" => medit::read,
        "node" | "ele" => {
            let (node, ele) = (file.with_extension("node"), file.with_extension("ele"));
            return tetgen::read((&node, &bytes(&node)?), (&ele, &bytes(&ele)?));
        }
        other => {
            return Err(no_reader("solid meshes", other)
            .advise("solid meshes are read from Gmsh .msh (2.2 and 4.1), VTK .vtu and .vtk, Medit .mesh and TetGen .node with .ele")
            .in_file(file));
        }
    };
    reader(&bytes(file)?).map_err(|error| error.in_file(file))
}

/// Reads a solid mesh and adds the features of a feature file to it.
pub fn solid_with_features(file: &Path, features: Option<&Path>) -> Result<SolidMesh> {
    let mut mesh = solid(file)?;
    if let Some(features) = features {
        let more = features::read(&bytes(features)?, mesh.points.len())
            .map_err(|error| error.in_file(features))?;
        mesh.add_features(more);
    }
    Ok(mesh)
}

/// Reads the major diagonals of a mesh's cells, if there is a file of them.
pub fn diagonals(file: Option<&Path>, mesh: &SolidMesh) -> Result<Option<DiagonalLists>> {
    let read = |file: &Path| {
        diagonals::read(&bytes(file)?, &mesh.cells).map_err(|error| error.in_file(file))
    };
    file.map(read).transpose()
}

/// Reads a control mesh in the format that the file's extension names, with its crease tags, and
/// adds the features of a feature file to it.
pub fn surface_with_features(file: &Path, features: Option<&Path>) -> Result<SurfaceMesh> {
    let mut mesh = surface(file)?;
    if let Some(features) = features {
        let more = features::read(&bytes(features)?, mesh.points.len())
            .map_err(|error| error.in_file(features))?;
        if !more.faces.is_empty() || !more.sheets.is_empty() {
            return Err(Error::new(
                "crease-face and sheet are for solids; a surface has crease edges and corners",
            )
            .in_file(features));
        }
        mesh.features.creases.extend(more.creases);
        mesh.features.corners.extend(more.corners);
        mesh.features.normalise();
    }
    Ok(mesh)
}

/// Reads a control mesh in the format that the file's extension names.
pub fn surface(file: &Path) -> Result<SurfaceMesh> {
    let read = match extension(file).as_str() {
        "obj" => |bytes: &[u8]| {
            let model = obj::read(bytes)?;
            let (features, notes) = obj_tags::read(bytes, model.points.len())?;
            Ok(SurfaceMesh {
                points: model.points,
                faces: model.faces,
                features,
                notes,
            })
        },
        "off" => |bytes: &[u8]| off::read(bytes).map(SurfaceMesh::from),
        "ply" => |bytes: &[u8]| ply::read(bytes).map(SurfaceMesh::from),
        "stl" => |bytes: &[u8]| stl::read(bytes).map(SurfaceMesh::from),
        other => {
            return Err(
                no_reader("control meshes", other)
                    .advise("control meshes of surfaces are read from .obj, .ply, .stl and .off; for a cage of cells choose a scheme of solids")
                    .in_file(file),
            );
        }
    };
    read(&bytes(file)?).map_err(|error| error.in_file(file))
}

/// Reads a model in the format that the file's extension names.
pub fn model(file: &Path) -> Result<Model> {
    let reader = match extension(file).as_str() {
        "obj" => obj::read,
        "ply" => ply::read,
        "stl" => stl::read,
        "off" => off::read,
        other => {
            return Err(no_reader("models", other)
                .advise("models are read from .obj, .ply, .stl and .off")
                .in_file(file));
        }
    };
    reader(&bytes(file)?).map_err(|error| error.in_file(file))
}
