//! The table's machinery: one row is one mistake, and what it must not do is the same for all.

use crate::common::{Folder, octruss};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;

/// What an output held before the command failed.
const OLD: &[u8] = b"what was there before";

/// One mistake.
pub struct Row {
    /// What is wrong, for the test's own messages.
    pub what: String,
    /// The arguments, parted by spaces; a word that starts with `@` is a file of the row's folder.
    pub command: String,
    /// Files that stand beside the sound ones, or in their place.
    pub files: Vec<(String, Vec<u8>)>,
    /// Links, and what they lead to.
    pub links: Vec<(String, &'static str)>,
    /// What the error says: the first line after `error: `, and of the rest as much as is given.
    pub message: String,
}

/// A row; `file` and `content` are the one file that is wrong.
pub fn row(what: &str, command: &str, file: &str, content: impl AsRef<[u8]>, message: &str) -> Row {
    Row {
        what: what.to_owned(),
        command: command.to_owned(),
        files: vec![(file.to_owned(), content.as_ref().to_vec())],
        links: Vec::new(),
        message: message.to_owned(),
    }
}

/// A row of sound files alone.
pub fn command(what: &str, command: &str, message: &str) -> Row {
    Row {
        what: what.to_owned(),
        command: command.to_owned(),
        files: Vec::new(),
        links: Vec::new(),
        message: message.to_owned(),
    }
}

/// Bakes a model, which is to follow.
pub const BAKE: &str = "bake @sound.msh --levels 1 -o @out.oct --rust @out.rs --c @out.c --model";

/// The row for a model that is wrong.
pub fn model(what: &str, file: &str, content: impl AsRef<[u8]>, message: &str) -> Row {
    row(what, &format!("{BAKE} @{file}"), file, content, message)
}

/// The row for a cage that is wrong, as a file or in itself.
pub fn cage(what: &str, file: &str, content: impl AsRef<[u8]>, message: &str) -> Row {
    let command = format!("bake @{file} --model @sound.obj --levels 1 -o @out.oct");
    row(what, &command, file, content, message)
}

impl Row {
    /// The row with a link.
    #[cfg(target_os = "linux")]
    pub fn link(mut self, name: &str, to: &'static str) -> Self {
        self.links.push((name.to_owned(), to));
        self
    }

    /// The row with one more file.
    pub fn and(mut self, file: &str, content: impl AsRef<[u8]>) -> Self {
        self.files
            .push((file.to_owned(), content.as_ref().to_vec()));
        self
    }
}

/// The text with one piece replaced, which must be there.
pub fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?} is not in the text");
    text.replacen(from, to, 1)
}

/// The text up to a piece, which must be there.
pub fn cut<'a>(text: &'a str, at: &str) -> &'a str {
    &text[..text
        .find(at)
        .unwrap_or_else(|| panic!("{at:?} is not in the text"))]
}

/// The bytes with one replaced.
pub fn changed(bytes: &[u8], place: usize, value: u8) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[place] = value;
    bytes
}

/// A new folder with these files.
fn folder_with<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Folder {
    let folder = Folder::new();
    for (name, content) in files {
        folder.write(name, content);
    }
    folder
}

/// Runs every row: the error says what the row says, the exit status is 1, nothing panics and nothing
/// is printed as a result. Every output keeps what it held, or is not there if it was not there, and no
/// other file comes or goes.
pub fn check(sound: &BTreeMap<&'static str, Vec<u8>>, rows: &[Row]) {
    let mut wrong = Vec::new();
    for row in rows {
        for has_old in [true, false] {
            let sound = sound
                .iter()
                .map(|(name, content)| (*name, content.as_slice()));
            let own = row
                .files
                .iter()
                .map(|(name, content)| (name.as_str(), content.as_slice()));
            let folder = folder_with(sound.chain(own));
            #[cfg(unix)]
            for (name, to) in &row.links {
                std::os::unix::fs::symlink(to, folder.path(name)).unwrap();
            }
            let outputs = outputs(&row.command, &folder);
            if has_old {
                outputs
                    .iter()
                    .for_each(|output| std::fs::write(output, OLD).unwrap());
            }
            let before = contents(&folder.path(""));
            let output = octruss()
                .current_dir(folder.path(""))
                .args(arguments(&row.command, &folder))
                .output()
                .unwrap();
            let after = contents(&folder.path(""));
            if let Err(complaint) = judge(&output, &row.message, &folder) {
                wrong.push(format!(
                    "{}: octruss {}\n{complaint}",
                    row.what, row.command
                ));
            }
            assert!(
                before == after,
                "{}: octruss {}: files changed",
                row.what,
                row.command
            );
        }
    }
    wrong.dedup();
    assert!(
        wrong.is_empty(),
        "{} of {} rows:\n\n{}",
        wrong.len(),
        rows.len(),
        wrong.join("\n\n")
    );
}

fn judge(output: &Output, expected: &str, folder: &Folder) -> Result<(), String> {
    let text = String::from_utf8_lossy(&output.stderr);
    let place = format!("{}/", folder.path("").display()).replace("//", "/");
    let text = text.replace(&place, "");
    let error = text.lines().position(|line| line.starts_with("error: "));
    let message: Vec<&str> = text.lines().skip(error.unwrap_or(usize::MAX)).collect();
    let message = message.join("\n");
    let found = message.strip_prefix("error: ").unwrap_or("");
    let is_as_expected = !expected.is_empty() && found.starts_with(expected);
    if is_as_expected
        && output.status.code() == Some(1)
        && output.stdout.is_empty()
        && !text.contains("panicked")
    {
        return Ok(());
    }
    Err(format!(
        "expected {expected:?}\n   found {found:?}\n  {}, {} bytes of output, standard error:\n{text}",
        output.status,
        output.stdout.len(),
    ))
}

fn arguments(command: &str, folder: &Folder) -> Vec<String> {
    let word = |word: &str| match word.strip_prefix('@') {
        Some(name) => folder.path(name).display().to_string(),
        None => word.to_owned(),
    };
    command.split(' ').map(word).collect()
}

/// The files of the folder that the command is to write, where there can be one.
fn outputs(command: &str, folder: &Folder) -> Vec<PathBuf> {
    const OPTIONS: [&str; 5] = ["-o", "--rust", "--c", "--picture", "--skin"];
    let words: Vec<&str> = command.split(' ').collect();
    let pairs = words.windows(2).filter(|pair| OPTIONS.contains(&pair[0]));
    pairs
        .filter_map(|pair| pair[1].strip_prefix('@'))
        .map(|name| folder.path(name))
        .filter(|path| path.parent().is_some_and(Path::is_dir) && !path.exists())
        .collect()
}

/// Every file under a folder with its content, every link with what it leads to.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_symlink() {
            let to = std::fs::read_link(&path).unwrap();
            found.insert(path, to.into_os_string().into_encoded_bytes());
        } else if path.is_dir() {
            found.extend(contents(&path));
            found.insert(path, Vec::new());
        } else {
            let content = std::fs::read(&path).unwrap();
            found.insert(path, content);
        }
    }
    found
}
