//! Every reader on every beginning of a file: an error that names the file, unless all is there.

use crate::common::{Folder, TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4};
use crate::sound::{self, CUP, ELE, MEDIT, NODE, OBJ, OFF, PLY, STL};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::error::Error;
use octruss_bake::read::{self, gmsh, medit, obj, obj_tags, off, ply, stl, tetgen, vtk, vtu};
use std::path::Path;

/// Reads bytes and forgets what was in them; the name is of the file they stand for.
type Read = fn(&Path, &[u8]) -> Result<(), Error>;

fn solid(name: &Path, bytes: &[u8]) -> Result<(), Error> {
    match read::extension(name).as_str() {
        "msh" => gmsh::read(bytes),
        "vtu" => vtu::read(bytes),
        "vtk" => vtk::read(bytes),
        "mesh" => medit::read(bytes),
        "node" => tetgen::read((name, bytes), (name, ELE.as_bytes())),
        _ => tetgen::read((name, NODE.as_bytes()), (name, bytes)),
    }
    .map(drop)
}

fn model(name: &Path, bytes: &[u8]) -> Result<(), Error> {
    match read::extension(name).as_str() {
        "obj" => obj::read(bytes),
        "ply" => ply::read(bytes),
        "stl" => stl::read(bytes),
        _ => off::read(bytes),
    }
    .map(drop)
}

fn control_mesh(_: &Path, bytes: &[u8]) -> Result<(), Error> {
    let model = obj::read(bytes)?;
    obj_tags::read(bytes, model.points.len()).map(drop)
}

fn bundle(_: &Path, bytes: &[u8]) -> Result<(), Error> {
    let bytes = BundleBytes::new(bytes);
    assert_eq!(bytes.open()?.rest_cage().len(), 5);
    Ok(())
}

/// Reads the file itself.
fn from_file(file: &Path) -> Result<(), Error> {
    match read::extension(file).as_str() {
        "obj" | "ply" | "stl" | "off" => read::model(file).map(drop),
        "oct" => {
            let bytes = BundleBytes::read(file)?;
            let opened = bytes.open().map_err(|error| error.in_file(file));
            opened.map(drop)
        }
        _ => read::solid(file).map(drop),
    }
}

/// What may be missing at the end of a file that is still read.
#[derive(Clone, Copy)]
enum Spare {
    /// So many bytes: white space, or what a format has behind its last number.
    Bytes(usize),
    /// The last word and what is behind it: a shorter number is a number too.
    LastWord,
    /// Whole lines: the format has no counts.
    Lines,
}

fn is_spare(content: &[u8], end: usize, spare: Spare) -> bool {
    let rest = &content[end..];
    match spare {
        Spare::Bytes(number) => rest.len() <= number,
        Spare::LastWord => !rest.trim_ascii_end().contains(&b' '),
        Spare::Lines => true,
    }
}

#[test]
fn every_beginning_of_every_file() {
    let folder = Folder::new();
    folder.write("with-ele.node", NODE);
    folder.write("with-node.ele", ELE);
    let text = |text: &str| text.as_bytes().to_vec();
    let sample = sound::sample;
    let files: Vec<(&str, Vec<u8>, Read, Spare)> = vec![
        (
            "2-ascii.msh",
            text(TWO_TETRAHEDRA_2),
            solid,
            Spare::Bytes(1),
        ),
        (
            "4-ascii.msh",
            text(TWO_TETRAHEDRA_4),
            solid,
            Spare::Bytes(1),
        ),
        (
            "2-binary.msh",
            sample("gmsh-22-binary.msh"),
            solid,
            Spare::Bytes(1),
        ),
        (
            "4-binary.msh",
            sample("gmsh-41-binary.msh"),
            solid,
            Spare::Bytes(1),
        ),
        (
            "ascii.vtu",
            text(&sound::written("vtu")),
            solid,
            Spare::Bytes(1),
        ),
        (
            "inline.vtu",
            sample("inline-zlib-64-big.vtu"),
            solid,
            Spare::Bytes(1),
        ),
        (
            "raw.vtu",
            sample("raw-plain-64-little.vtu"),
            solid,
            Spare::Bytes(1),
        ),
        (
            "base64.vtu",
            sample("base64-zlib-64-little.vtu"),
            solid,
            Spare::Bytes(1),
        ),
        // Behind the types there are labels and channels, which a file may do without.
        (
            "3-ascii.vtk",
            types_last(&sound::written("vtk")),
            solid,
            Spare::LastWord,
        ),
        (
            "5-ascii.vtk",
            sample("legacy-51-ascii.vtk"),
            solid,
            Spare::LastWord,
        ),
        (
            "5-binary.vtk",
            sample("legacy-51-binary.vtk"),
            solid,
            Spare::Bytes(1),
        ),
        (
            "2-binary.vtk",
            sample("legacy-42-binary.vtk"),
            solid,
            Spare::Bytes(1),
        ),
        ("cage.mesh", text(MEDIT), solid, Spare::Bytes(1)),
        ("with-node.node", text(NODE), solid, Spare::LastWord),
        ("with-ele.ele", text(ELE), solid, Spare::LastWord),
        ("skin.obj", text(OBJ), model, Spare::Lines),
        ("cup.obj", text(CUP), control_mesh, Spare::Lines),
        ("ascii.ply", text(PLY), model, Spare::LastWord),
        ("binary.ply", sound::binary_ply(), model, Spare::Bytes(0)),
        ("ascii.stl", text(STL), model, Spare::Bytes(1)),
        ("binary.stl", sound::binary_stl(), model, Spare::Bytes(0)),
        ("skin.off", text(OFF), model, Spare::LastWord),
        (
            "sound.oct",
            sound::files()["sound.oct"].clone(),
            bundle,
            Spare::Bytes(0),
        ),
    ];
    // Files are slower than bytes: one beginning in so many is read from one.
    const FROM_FILE: usize = 97;
    for (name, content, read, spare) in files {
        let file = folder.write(name, &content);
        from_file(&file).unwrap_or_else(|error| panic!("{name} is sound: {error}"));
        for end in 0..content.len() {
            let bytes = &content[..end];
            if read(&file, bytes).is_ok() {
                assert!(is_spare(&content, end, spare), "{name} of {end} bytes");
            } else if end % FROM_FILE == 0 {
                std::fs::write(&file, bytes).unwrap();
                let error = from_file(&file).unwrap_err();
                assert_eq!(error.file(), Some(file.as_path()), "{name}: {error}");
            }
        }
    }
}

/// A legacy VTK file without data, and without the end of its last line.
fn types_last(text: &str) -> Vec<u8> {
    let end = text.find("CELL_DATA").unwrap_or(text.len());
    text.as_bytes()[..end].to_vec()
}
