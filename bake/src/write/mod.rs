//! Writers: one for each file format, and the one way a file comes into being.
//!
//! An output file is written under a temporary name in its own directory and renamed when it is
//! complete, so that nobody ever sees half of it and a failure leaves what was there before.

pub mod obj;
pub mod off;
pub mod vtu;

use crate::error::{Error, Result};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Creates or replaces `file` with what `content` writes, all or nothing.
pub fn atomically(file: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let cannot =
        |error: std::io::Error| Error::new(format!("cannot be written: {error}")).in_file(file);
    let directory = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".octruss-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file: the user's mask takes away what others may not do.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(directory).map_err(cannot)?;
    let mut writer = BufWriter::new(temporary);
    content(&mut writer).map_err(|error| error.in_file(file))?;
    let temporary = writer
        .into_inner()
        .map_err(|error| cannot(error.into_error()))?;
    temporary
        .persist(file)
        .map_err(|error| cannot(error.error))?;
    Ok(())
}

/// The error of a failed write, to be given a file name by [`atomically`].
pub(crate) fn failed(error: std::io::Error) -> Error {
    Error::new(format!("cannot be written: {error}"))
}
