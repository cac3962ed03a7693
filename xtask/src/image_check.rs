//! Looks into a linked image: does it hold a panic, does it hold floating point?
//!
//! Of the image `apply`, which is nothing but the opening of a bundle and the apply path, neither
//! may be found. The same look at the image `bench`, which has both, must find them: a check that
//! finds nothing anywhere proves nothing.

use std::path::Path;

use crate::command::{Failure, Program};
use crate::workspace;

/// What was found in an image.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// Symbols of panics.
    pub panics: Vec<String>,
    /// Symbols of floating-point routines, and instructions of the floating point unit.
    pub floats: Vec<String>,
    /// How many instructions were looked at.
    pub instructions: usize,
    /// How many functions of the apply path there are.
    pub apply_functions: usize,
}

/// Checks the images of a directory.
pub fn run(images: &Path) -> Result<(), Failure> {
    let apply = look(&images.join("apply"))?;
    if !apply.panics.is_empty() || !apply.floats.is_empty() {
        return Err(format!(
            "the apply path is not free of panics and floating point:\n  panics: {:?}\n  floats: {:?}",
            apply.panics, apply.floats
        ));
    }
    if apply.apply_functions == 0 {
        return Err("the compiler has taken the apply path out of its own image".to_owned());
    }
    let bench = look(&images.join("bench"))?;
    if bench.panics.is_empty() || bench.floats.is_empty() {
        return Err(format!(
            "the check is blind: it finds too little in `bench`: {bench:?}"
        ));
    }
    println!(
        "The image with nothing but the apply path: {} functions of it, {} instructions in all, no \
         panic, no floating point.",
        apply.apply_functions, apply.instructions
    );
    println!(
        "The same check of the benchmark finds {} symbols of panics and {} of floating point.",
        bench.panics.len(),
        bench.floats.len()
    );
    Ok(())
}

fn look(image: &Path) -> Result<Findings, Failure> {
    let output = |tool: &str, arguments: &[&str]| {
        let program = Program::new(workspace::llvm_tool(tool)?)
            .args(arguments)
            .args([image]);
        let line = program.line();
        program.output().ok_or_else(|| format!("`{line}` failed"))
    };
    let symbols = output("llvm-nm", &["--demangle", "--format=just-symbols"])?;
    let code = output("llvm-objdump", &["--disassemble", "--no-show-raw-insn"])?;
    let findings = judge(&symbols, &code);
    if findings.instructions == 0 {
        return Err(format!("{} has no code", image.display()));
    }
    Ok(findings)
}

/// Judges the symbols, one a line, and the disassembly.
fn judge(symbols: &str, code: &str) -> Findings {
    let mut findings = Findings::default();
    for symbol in symbols.lines() {
        findings.apply_functions += usize::from(symbol.contains("octruss::deform"));
        if is_panic(symbol) {
            findings.panics.push(symbol.to_owned());
        }
        if is_float_routine(symbol) {
            findings.floats.push(symbol.to_owned());
        }
    }
    for mnemonic in code.lines().filter_map(mnemonic_of) {
        findings.instructions += 1;
        // On these processors every instruction of the floating point unit, and no other, starts
        // so; loads, stores and moves among them. The start-up code turns the unit on with
        // integer instructions alone.
        if mnemonic.starts_with('v') {
            findings.floats.push(mnemonic.to_owned());
        }
    }
    findings
}

/// The mnemonic in a line of a disassembly: address, colon, mnemonic, operands. Data between the
/// code (`.word`) is none.
fn mnemonic_of(line: &str) -> Option<&str> {
    let (address, rest) = line.split_once(':')?;
    let address = address.trim();
    if address.is_empty() || !address.chars().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let mnemonic = rest.split_whitespace().next()?;
    (!mnemonic.starts_with('.') && !mnemonic.starts_with('<')).then_some(mnemonic)
}

fn is_panic(symbol: &str) -> bool {
    let words = [
        "panic",
        "rust_begin_unwind",
        "unwrap_failed",
        "expect_failed",
        "index_fail",
    ];
    words.iter().any(|word| symbol.contains(word))
}

/// Routines that compute floating point in software, by the names of Arm's run-time interface and
/// of compilers.
fn is_float_routine(symbol: &str) -> bool {
    const ARM: [&str; 14] = [
        "fadd", "fsub", "frsub", "fmul", "fdiv", "fcmp", "f2", "dadd", "dsub", "drsub", "dmul",
        "ddiv", "dcmp", "d2",
    ];
    if let Some(name) = symbol.strip_prefix("__aeabi_") {
        let converts = name.ends_with("2f") || name.ends_with("2d") || name.starts_with("h2");
        let compares = name.starts_with("cfcmp")
            || name.starts_with("cdcmp")
            || name.starts_with("cfrcmp")
            || name.starts_with("cdrcmp");
        return converts || compares || ARM.iter().any(|start| name.starts_with(start));
    }
    // `__addsf3`, `__floatsidf`, `__fixdfsi`: a type of floating point is part of the name.
    symbol.starts_with("__") && ["sf", "df"].iter().any(|kind| symbol.contains(kind))
}

#[cfg(test)]
mod tests {
    use super::{is_float_routine, is_panic, judge, mnemonic_of};

    #[test]
    fn lines_of_the_tools_are_read() {
        assert_eq!(mnemonic_of("     400:      \tbl\t0x408 <main>"), Some("bl"));
        assert_eq!(mnemonic_of("     404:      \t.word\t0x20000000"), None);
        assert_eq!(mnemonic_of("00000400 <Reset>:"), None);
    }

    #[test]
    fn floats_and_panics_are_known_by_name() {
        for name in [
            "__aeabi_fadd",
            "__aeabi_dcmplt",
            "__aeabi_ui2d",
            "__adddf3",
            "__floatsisf",
        ] {
            assert!(is_float_routine(name), "{name}");
        }
        for name in [
            "__aeabi_ldivmod",
            "__aeabi_memcpy4",
            "__aeabi_uldivmod",
            "__sdata",
            "main",
        ] {
            assert!(!is_float_routine(name), "{name}");
        }
        assert!(is_panic("core::panicking::panic_bounds_check::h1234"));
        assert!(is_panic("core::slice::index::slice_index_fail"));
        assert!(!is_panic("octruss::deform::apply::row"));
    }

    #[test]
    fn an_image_with_both_is_found_out() {
        let symbols = "main\noctruss::deform::table::run\ncore::panicking::panic_fmt\n";
        let code = "00000400 <main>:\n     400:      \tvldr\ts0, [r0]\n     404:      \tbx\tlr\n";
        let findings = judge(symbols, code);
        assert_eq!(findings.panics, ["core::panicking::panic_fmt"]);
        assert_eq!(findings.floats, ["vldr"]);
        assert_eq!((findings.instructions, findings.apply_functions), (2, 1));
    }
}
