//! What the end-to-end tests share.

#![allow(dead_code, reason = "every test file takes what it needs")]

use assert_cmd::Command;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The binary under test.
pub fn octruss() -> Command {
    assert_cmd::cargo::cargo_bin_cmd!("octruss")
}

/// A file of the project's example.
pub fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../models")
        .join(name)
}

/// A file of this package's test data.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// A folder that vanishes after the test, with files in it.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.0.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// Two tetrahedra on a common face, in MSH 2.2, with a crease, a corner and what is left out.
pub const TWO_TETRAHEDRA_2: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 7 \"Corner top\"
1 8 \"crease rim\"
3 9 \"body\"
$EndPhysicalNames
$Comments
anything $Nodes may stand here
$EndComments
$Nodes
5
10 0 0 0
20 2 0 0
30 0 2 0
40 0.5 0.25 2
50 0.5 0.5 -2
$EndNodes
$Elements
6
1 15 2 7 4 40
2 1 2 8 1 20 10
3 1 2 0 2 20 30
4 2 2 0 1 10 20 30
5 4 2 9 1 10 20 30 40
6 4 2 9 1 10 30 20 50
$EndElements
";

/// The same mesh in MSH 4.1; parametric coordinates on the curve's node.
pub const TWO_TETRAHEDRA_4: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 7 \"Corner top\"
1 8 \"crease rim\"
3 9 \"body\"
$EndPhysicalNames
$Entities
1 2 1 1
4 0.5 0.25 2 1 7
1 0 0 0 2 0 0 1 8 2 5 -6
2 0 0 0 2 2 0 0 0
1 0 0 0 2 2 0 0 3 1 2 3
1 0 0 -2 2 2 2 1 9 1 1
$EndEntities
$Nodes
2 5 10 50
1 1 1 1
10
0 0 0 0.75
3 1 0 4
20
30
40
50
2 0 0
0 2 0
0.5 0.25 2
0.5 0.5 -2
$EndNodes
$Elements
5 6 1 6
0 4 15 1
1 40
1 1 1 1
2 20 10
1 2 1 1
3 20 30
2 1 2 1
4 10 20 30
3 1 4 2
5 10 20 30 40
6 10 30 20 50
$EndElements
";
