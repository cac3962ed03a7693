//! Bundles as source code, for firmware that cannot include a file.

use octruss_bake::error::{Error, Result};
use std::io::Write;
use std::path::Path;

const BYTES_A_LINE: usize = 16;

/// Rust source with a function `bundle()` that gives the aligned bytes.
pub fn rust(bundle: &[u8], name: &Path, out: &mut dyn Write) -> Result<()> {
    let start = format!(
        "// The bundle {}, written by `octruss bake`. Do not edit.\n\n\
         /// Bytes at the alignment that `octruss::bundle::Bundle::new_checked` asks for.\n\
         #[repr(C, align(8))]\n\
         struct Aligned([u8; {length}]);\n\n\
         /// The bundle's bytes.\n\
         pub fn bundle() -> &'static [u8] {{\n    &BUNDLE.0\n}}\n\n\
         #[rustfmt::skip]\n\
         static BUNDLE: Aligned = Aligned([\n",
        shown(name),
        length = bundle.len()
    );
    text(out, &start)?;
    lines(bundle, out)?;
    text(out, "]);\n")
}

/// C source (C11) with an array `octruss_bundle` and its length `octruss_bundle_length`.
pub fn c(bundle: &[u8], name: &Path, out: &mut dyn Write) -> Result<()> {
    let start = format!(
        "/* The bundle {}, written by `octruss bake`. Do not edit. */\n\n\
         #include <stdalign.h>\n#include <stddef.h>\n#include <stdint.h>\n\n\
         extern const uint8_t octruss_bundle[{length}];\n\
         extern const size_t octruss_bundle_length;\n\n\
         const size_t octruss_bundle_length = {length};\n\
         alignas(8) const uint8_t octruss_bundle[{length}] = {{\n",
        shown(name).replace("*/", "* /"),
        length = bundle.len()
    );
    text(out, &start)?;
    lines(bundle, out)?;
    text(out, "};\n")
}

/// The file's name without its folders, on one line.
fn shown(name: &Path) -> String {
    let name = name.file_name().unwrap_or_default().to_string_lossy();
    name.chars()
        .map(|character| {
            if character.is_control() {
                ' '
            } else {
                character
            }
        })
        .collect()
}

fn lines(bundle: &[u8], out: &mut dyn Write) -> Result<()> {
    for line in bundle.chunks(BYTES_A_LINE) {
        let bytes: Vec<String> = line.iter().map(|byte| format!("{byte:#04x}")).collect();
        text(out, &format!("    {},\n", bytes.join(", ")))?;
    }
    Ok(())
}

fn text(out: &mut dyn Write, text: &str) -> Result<()> {
    out.write_all(text.as_bytes())
        .map_err(|error| Error::new(format!("cannot be written: {error}")))
}
