//! What the fuzz targets have in common: what becomes of a mesh, a model or a bundle once its
//! bytes have been accepted.
//!
//! A target fails if anything panics, hangs or asks for more memory than the fuzzer allows. No
//! result is judged here; the tests do that.

mod bundle;

pub use bundle::bundle;

use octruss_bake::error::Result;
use octruss_bake::mesh::SolidMesh;
use octruss_bake::read::models::Model;
use octruss_bake::refine::Scheme;
use octruss_bake::{check, inspect, write};

/// Drops a result; an error must have words.
pub fn shown<T>(result: Result<T>) -> Option<T> {
    result
        .inspect_err(|error| assert!(!error.to_string().is_empty()))
        .ok()
}

/// A solid that a reader gave is checked, looked at and written.
pub fn solid(result: Result<SolidMesh>) {
    let Some(mesh) = shown(result) else {
        return;
    };
    let _ = shown(check::require_sound_connectivity(&mesh));
    let _ = shown(check::require_positive_volumes(&mesh));
    for scheme in [Scheme::TetOct, Scheme::Mixed] {
        let _ = shown(inspect::inspect(&mesh, scheme, 2));
    }
    for format in write::SOLID_EXTENSIONS {
        let _ = shown(write::solid(format, &mesh, &mut std::io::sink()));
    }
}

/// A model that a reader gave is cut into triangles and written with its points moved.
pub fn model(result: Result<Model>) {
    let Some(model) = shown(result) else {
        return;
    };
    let _ = model.triangles();
    let moved: Vec<_> = model
        .points
        .iter()
        .map(|[x, y, z]| [y + 1.0, z - 0.5, *x])
        .collect();
    shown(model.write_with(&moved, &mut std::io::sink())).expect("a sink takes everything");
}
