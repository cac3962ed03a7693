//! What the commands share about schemes.

use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::SolidMesh;
use octruss_bake::read;
use octruss_bake::refine::{DiagonalLists, Level, Scheme};
use std::path::Path;

/// The major diagonals of a file, which only `box-spline` has a use for.
pub fn diagonals(
    scheme: Scheme,
    file: Option<&Path>,
    mesh: &SolidMesh,
) -> Result<Option<DiagonalLists>> {
    if let Some(file) = file.filter(|_| scheme != Scheme::BoxSpline) {
        return Err(
            Error::new("major diagonals are of use to the scheme box-spline only")
                .advise("add --scheme box-spline, or leave --diagonals out")
                .in_file(file),
        );
    }
    read::diagonals(file, mesh)
}

/// Says at how many faces of a mesh the diagonals clash.
pub fn warn_of_improper_faces(
    mesh: &SolidMesh,
    scheme: Scheme,
    diagonals: Option<&DiagonalLists>,
) -> Result<()> {
    if scheme != Scheme::BoxSpline {
        return Ok(());
    }
    let improper = Level::of_scheme(mesh, scheme, diagonals)?.improper_faces()?;
    if !improper.is_empty() {
        eprintln!(
            "note: the major diagonals clash at {}; `octruss info --scheme box-spline` names them",
            count(improper.len(), "face", "faces")
        );
    }
    Ok(())
}
