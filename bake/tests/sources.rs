//! Bundles as source code: compilers take it, and the program that holds it has the bundle's bytes,
//! aligned.

mod common;

use common::{Folder, TWO_TETRAHEDRA_2, octruss};
use octruss_bake::bundle::BundleBytes;
use std::path::Path;
use std::process::Command;

/// A baked bundle as `two.oct`, `two.rs` and `two.c`.
fn baked() -> Folder {
    let folder = Folder::new();
    let cage = folder.write("two.msh", TWO_TETRAHEDRA_2);
    let model = folder.write("two.obj", "v 0.5 0.5 0.25\nv 0.5 0.5 -0.25\nv 0.6 0.5 0\n");
    octruss()
        .args(["bake", "--levels", "1", "--outside", "nearest", "-o"])
        .arg(folder.path("two.oct"))
        .arg("--rust")
        .arg(folder.path("two.rs"))
        .arg("--c")
        .arg(folder.path("two.c"))
        .arg(&cage)
        .arg("--model")
        .arg(&model)
        .assert()
        .success();
    folder
}

/// Runs a compiler, which must not complain, and then what it made; the program writes the bundle.
fn compile_and_run(compiler: &mut Command, program: &Path) -> Vec<u8> {
    let compiled = compiler.arg("-o").arg(program).output().unwrap();
    let said = String::from_utf8_lossy(&compiled.stderr).into_owned();
    assert!(compiled.status.success(), "{said}");
    let run = Command::new(program).output().unwrap();
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    run.stdout
}

/// The bytes are those of the bundle, which opens.
fn check(folder: &Folder, bytes: &[u8]) {
    assert_eq!(bytes, folder.read("two.oct"));
    let bytes = BundleBytes::new(bytes);
    let bundle = bytes.open().unwrap();
    assert_eq!(bundle.header().version.get(), 1);
    assert_eq!(bundle.table::<i32>().unwrap().rows(), 3);
}

#[test]
fn rust_source_compiles_and_holds_the_bundle() {
    let folder = baked();
    let main = folder.write(
        "main.rs",
        "mod two;\n\
         use std::io::Write;\n\
         fn main() {\n\
             let bundle = two::bundle();\n\
             assert_eq!(bundle.as_ptr().align_offset(8), 0);\n\
             std::io::stdout().write_all(bundle).unwrap();\n\
         }\n",
    );
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let mut compiler = Command::new(rustc);
    compiler
        .args(["--edition", "2024", "-D", "warnings"])
        .arg(main);
    check(
        &folder,
        &compile_and_run(&mut compiler, &folder.path("rust-program")),
    );
}

/// On a device there is no standard library.
#[test]
fn rust_source_needs_no_standard_library() {
    let folder = baked();
    let library = folder.write("library.rs", "#![no_std]\npub mod two;\n");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let compiled = Command::new(rustc)
        .args([
            "--edition",
            "2024",
            "-D",
            "warnings",
            "--crate-type",
            "rlib",
        ])
        .args(["--emit", "metadata", "-o"])
        .arg(folder.path("library.rmeta"))
        .arg(library)
        .output()
        .unwrap();
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
}

#[test]
fn c_source_compiles_and_holds_the_bundle() {
    let folder = baked();
    let main = folder.write(
        "main.c",
        "#include <stddef.h>\n\
         #include <stdint.h>\n\
         #include <stdio.h>\n\
         extern const uint8_t octruss_bundle[];\n\
         extern const size_t octruss_bundle_length;\n\
         int main(void) {\n\
             if ((uintptr_t)octruss_bundle % 8 != 0) return 1;\n\
             size_t written = fwrite(octruss_bundle, 1, octruss_bundle_length, stdout);\n\
             return written == octruss_bundle_length ? 0 : 2;\n\
         }\n",
    );
    let mut compiler = Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()));
    compiler
        .args(["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
        .arg(main)
        .arg(folder.path("two.c"));
    check(
        &folder,
        &compile_and_run(&mut compiler, &folder.path("c-program")),
    );
}
