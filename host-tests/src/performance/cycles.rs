//! Estimated cycles of the hot loops, by `llvm-mca`.

use std::io::Write as _;
use std::process::{Command, Stdio};

/// The source of core's kernels: what is estimated is their text itself.
const KERNELS: &str = include_str!("../../../core/src/deform/kernel/cortex_m.rs");

/// A piece of straight-line code and the taps that it takes.
pub struct Loop {
    /// Its name.
    pub name: &'static str,
    /// Assembly.
    pub code: String,
    /// Taps.
    pub taps: f64,
}

/// The loops of core's kernels.
///
/// # Errors
/// If the source does not have them where they are looked for.
pub fn kernels() -> Result<Vec<Loop>, String> {
    let wide = repeated("\".rept {most}\",")?;
    let narrow = repeated("\".rept {most} / 2 - 1\",")?;
    let load = |name: &str| {
        let call = KERNELS.split(&format!("wide_rows!({name}, \"")).nth(1);
        let load = call.and_then(|call| call.split('"').next());
        load.ok_or_else(|| format!("core's kernels have no {name}"))
    };
    let wide_with = |name| load(name).map(|load| wide.replace("$load,", load));
    Ok(vec![
        Loop {
            name: "q30",
            code: wide_with("wide_q30_rows")?,
            taps: 1.0,
        },
        Loop {
            name: "q14",
            code: wide_with("wide_q14_rows")?,
            taps: 1.0,
        },
        Loop {
            name: "compact",
            code: narrow,
            taps: 4.0,
        },
    ])
}

/// The lines that the assembler repeats behind a line of the source, without the marks of Rust strings.
fn repeated(start: &str) -> Result<String, String> {
    let missing = || format!("core's kernels have no line {start}");
    let (_, rest) = KERNELS.split_once(start).ok_or_else(missing)?;
    let (body, _) = rest.split_once("\".endr\"").ok_or_else(missing)?;
    let line = |line: &str| {
        let line = line.trim().trim_end_matches(',').trim_matches('"');
        match line {
            "$load" => "$load,".to_owned(),
            _ => line.replace("{{", "{").replace("}}", "}"),
        }
    };
    Ok(body.lines().map(line).collect::<Vec<_>>().join("\n"))
}

/// The innermost loop of a C function in the compiler's assembly: from the label that its last branch
/// goes back to.
///
/// # Errors
/// If there is no loop with a fused multiplication.
pub fn c_loop(assembly: &str, function: &str) -> Result<Loop, String> {
    let missing = || format!("the compiler's assembly has no loop in {function}");
    let (_, body) = assembly
        .split_once(&format!("\n{function}:"))
        .ok_or_else(missing)?;
    let lines: Vec<&str> = body.lines().map(str::trim).collect();
    let fused = lines
        .iter()
        .position(|line| line.starts_with("vfma"))
        .ok_or_else(missing)?;
    let end = lines[fused..]
        .iter()
        .position(|line| line.starts_with("bne"))
        .ok_or_else(missing)?;
    let target = lines[fused + end]
        .split_whitespace()
        .nth(1)
        .ok_or_else(missing)?;
    let label = format!("{target}:");
    let start = lines[..fused]
        .iter()
        .rposition(|line| *line == label)
        .ok_or_else(missing)?;
    let is_code =
        |line: &&&str| !line.ends_with(':') && !line.starts_with(['.', '@']) && !line.is_empty();
    let code: Vec<&str> = lines[start..=fused + end]
        .iter()
        .filter(is_code)
        .copied()
        .collect();
    // The branch needs its label.
    let code = format!("{label}\n{}", code.join("\n"));
    Ok(Loop {
        name: "float csr in C",
        code,
        taps: 1.0,
    })
}

/// Estimated cycles a tap; `None` if `llvm-mca` is not installed or refuses the code.
#[must_use]
pub fn cycles_a_tap(code: &Loop, processor: &str) -> Option<f64> {
    const ITERATIONS: f64 = 100.0;
    let mut child = Command::new("llvm-mca")
        .args(["-mtriple=thumbv7em-none-eabihf", "-iterations=100"])
        .arg(format!("-mcpu={processor}"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let text = format!(".syntax unified\n.thumb\n{}\n", code.code);
    child.stdin.take()?.write_all(text.as_bytes()).ok()?;
    let output = child.wait_with_output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("Total Cycles:"))?;
    let cycles: f64 = line.trim().parse().ok()?;
    Some(cycles / ITERATIONS / code.taps)
}

/// Cycles a tap by the Cortex-M4 technical reference manual's table of instructions (Arm 100166), from memory
/// without wait states: a load or store takes 2, several registers one each and 1, a fused multiplication 3, a
/// branch 2, everything else 1. Loads that follow one another may be pipelined, so this is an upper bound.
#[must_use]
pub fn cycles_by_manual(code: &Loop) -> f64 {
    let registers = |operands: &str| {
        let list = operands.split_once('{').map_or("", |(_, list)| list);
        let list = list.trim_end_matches('}');
        let parts = list
            .split(',')
            .map(|part| match part.trim().split_once('-') {
                None => 1,
                Some((first, last)) => {
                    let number =
                        |name: &str| name.trim().get(1..).and_then(|n| n.parse::<u32>().ok());
                    let ends = number(first).zip(number(last));
                    ends.map_or(1, |(first, last)| last.saturating_sub(first) + 1)
                }
            });
        parts.sum::<u32>()
    };
    let cycles = |line: &str| {
        let (mnemonic, operands) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match mnemonic.trim_end_matches(".w") {
            name if name.starts_with("ldm") || name.starts_with("vldm") => 1 + registers(operands),
            name if name.starts_with("ldrd") => 3,
            name if name.starts_with("ldr") || name.starts_with("vldr") => 2,
            name if name.starts_with("vfma") => 3,
            name if name == "bne" || name == "b" => 2,
            _ => 1,
        }
    };
    let lines = code.code.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.ends_with(':'));
    f64::from(lines.map(cycles).sum::<u32>()) / code.taps
}

#[cfg(test)]
mod tests {
    use super::{Loop, c_loop, cycles_by_manual, kernels};

    /// By hand: three registers at once take four cycles, one takes two, three products one each.
    #[test]
    fn cycles_by_the_manual_are_added_up() {
        let code = "2:\nldm.w r11!, {r0-r2}\nldrsh r3, [r10], #2\nsmlal r4, r5, r0, r3\nbne 2b";
        let hot = Loop {
            name: "by hand",
            code: code.to_owned(),
            taps: 1.0,
        };
        assert_eq!(cycles_by_manual(&hot), 4.0 + 2.0 + 1.0 + 2.0);
    }

    /// The loops have their multiply-accumulate and touch no stack: three SMLAL a tap, and six SMLAD
    /// for four taps.
    #[test]
    fn kernels_multiply_and_accumulate_and_spill_nothing() {
        let loops = kernels().expect("the kernels' source");
        let instruction =
            |code: &str, name: &str| code.lines().filter(|line| line.starts_with(name)).count();
        for hot in &loops {
            assert!(!hot.code.contains("sp"), "{} touches the stack", hot.name);
            let instructions = hot.code.lines().filter(|line| !line.is_empty()).count();
            match hot.name {
                "compact" => assert_eq!((instruction(&hot.code, "smlad"), instructions), (6, 8)),
                _ => assert_eq!((instruction(&hot.code, "smlal"), instructions), (3, 5)),
            }
        }
        assert_eq!(loops.len(), 3);
    }

    #[test]
    fn the_innermost_loop_is_found() {
        let assembly = "\nrow:\n\tmov r0, r1\n.L3:\n\tnop\n.L4:\n\tldr r1, [r2]\n\tvfma.f32 s0, s1, s2\n\tbne .L4\n\tbne .L3\n";
        let found = c_loop(assembly, "row").expect("a loop");
        assert_eq!(
            found.code,
            ".L4:\nldr r1, [r2]\nvfma.f32 s0, s1, s2\nbne .L4"
        );
    }
}
