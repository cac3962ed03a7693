//! Expected text in files, rewritten on request.
//!
//! The files lie in `host-tests/snapshots`. With the environment variable `OCTRUSS_BLESS` set
//! to 1 a difference is written to the file instead of being an error; the change then shows
//! in the version history.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// The environment variable that rewrites snapshots.
pub const BLESS: &str = "OCTRUSS_BLESS";

/// Holds text against the snapshot of a name, which is a file name in `host-tests/snapshots`.
///
/// # Errors
/// If the file is missing, cannot be read or written, or differs; the message shows both texts.
pub fn check(name: &str, text: &str) -> Result<(), String> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots");
    let bless = env::var_os(BLESS).is_some_and(|value| value == "1");
    check_file(&directory.join(name), text, bless)
}

fn check_file(path: &PathBuf, text: &str, bless: bool) -> Result<(), String> {
    let expected = fs::read_to_string(path);
    if expected.as_deref().is_ok_and(|expected| expected == text) {
        return Ok(());
    }
    if bless {
        let written = path.parent().map_or(Ok(()), fs::create_dir_all);
        return written
            .and_then(|()| fs::write(path, text))
            .map_err(|error| format!("{}: {error}", path.display()));
    }
    let expected = match expected {
        Ok(expected) => format!("expected:\n{expected}"),
        Err(error) => format!("it cannot be read: {error}\n"),
    };
    Err(format!(
        "{} differs; if the new text is right, run again with {BLESS}=1\n{expected}new:\n{text}",
        path.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::check_file;

    #[test]
    fn blessing_writes_what_then_passes() {
        let name = format!("octruss-snapshot-{}", std::process::id());
        let path = std::env::temp_dir().join(name).join("figures.txt");
        let missing = check_file(&path, "1\n", false).expect_err("there is no file");
        assert!(missing.contains("OCTRUSS_BLESS=1"));
        check_file(&path, "1\n", true).expect("it is written");
        check_file(&path, "1\n", false).expect("it is the same");
        let other = check_file(&path, "2\n", false).expect_err("it differs");
        assert!(other.contains("expected:\n1\nnew:\n2\n"));
        std::fs::remove_dir_all(path.parent().expect("a directory")).expect("it was made here");
    }
}
