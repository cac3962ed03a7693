//! The tables.

use std::fmt::Write as _;

use super::input::Inputs;

/// A measured loop: its name, instructions for all rows, and estimated cycles a tap on M4 and M7.
pub struct Line {
    /// Its name.
    pub name: String,
    /// Instructions for all rows.
    pub instructions: u64,
    /// Estimated cycles a tap of the hot loop, Cortex-M4 and Cortex-M7.
    pub cycles: [Option<f64>; 2],
    /// Cycles a tap by the Cortex-M4's manual.
    pub by_manual: Option<f64>,
}

/// What was measured.
pub struct Measured<'a> {
    /// The table.
    pub inputs: &'a Inputs,
    /// The rival first.
    pub lines: Vec<Line>,
    /// Rows a second on this host, by name.
    pub host: Vec<(String, f64)>,
    /// Every figure of the images, by name.
    pub others: Vec<(String, u64)>,
    /// Whether two runs gave the same counts.
    pub is_repeatable: bool,
}

/// The page in Markdown.
#[must_use]
pub fn page(measured: &Measured<'_>) -> String {
    let inputs = measured.inputs;
    let mut text = String::from(
        "# Performance\n\n\
         Made by `cargo xtask bench`; do not edit. One table, one input: the finger of `models/`, refined\n\
         twice. Ratios are to the float loop in C, compressed sparse rows, `arm-none-eabi-gcc -O3` with the\n\
         floating-point unit and fused multiply-add. Instructions are counted on the emulated Cortex-M4,\n\
         exactly, over whole calls with all overheads; they are not cycles. Cycles are those that\n\
         `llvm-mca` estimates for the hot loop alone; its Cortex-M4 model is little more than a count.\n\n",
    );
    let _ = writeln!(
        text,
        "{} rows over {} control points, {} taps ({:.1} a row).\n",
        inputs.rows,
        inputs.control_points,
        inputs.taps,
        inputs.taps as f64 / inputs.rows.max(1) as f64
    );
    bytes(&mut text, inputs);
    instructions(&mut text, measured);
    normals(&mut text, measured);
    refine(&mut text, measured);
    host(&mut text, measured);
    text
}

fn bytes(text: &mut String, inputs: &Inputs) {
    text.push_str(
        "## Formats\n\n\
         Bytes a tap are those of weights, indices and groups; the table's bytes have start values or rest\n\
         positions too. Errors are in units in the last place of a coordinate, for control points that move\n\
         by at most the cage's largest extent. Instructions here are the baker's estimate, which it chooses\n\
         by. A factored table computes refined points first.\n\n\
         | format | bytes a tap | bytes of the table | estimated instructions a tap | refined points | error proved | error measured |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let _ = writeln!(
        text,
        "| float compressed sparse rows | {:.2} | {:.0} | | | | |",
        inputs.csr_bytes_a_tap,
        inputs.csr_bytes_a_tap * inputs.taps as f64
    );
    for format in &inputs.formats {
        let name = format.format.name();
        let _ = writeln!(
            text,
            "| {name} | {:.2} | {} | {:.2} | {} | {:.1} | {:.1} |",
            format.bytes_a_tap,
            format.bytes,
            format.instructions / inputs.taps.max(1) as f64,
            format.refined_points,
            format.proved,
            format.measured
        );
    }
    text.push('\n');
}

fn instructions(text: &mut String, measured: &Measured<'_>) {
    text.push_str(
        "## Instructions and estimated cycles\n\n\
         | loop | instructions a frame | a tap | ratio | cycles a tap, Cortex-M4 | ratio | cycles a tap, Cortex-M7 | ratio | cycles a tap by the manual, Cortex-M4 | ratio |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let Some(rival) = measured.lines.first() else {
        return;
    };
    for line in &measured.lines {
        let a_tap = line.instructions as f64 / measured.inputs.taps.max(1) as f64;
        let ratio = line.instructions as f64 / rival.instructions.max(1) as f64;
        let _ = write!(
            text,
            "| {} | {} | {a_tap:.2} | {ratio:.2} ",
            line.name, line.instructions
        );
        for (own, others) in line.cycles.iter().zip(rival.cycles) {
            let _ = match (own, others) {
                (Some(own), Some(other)) => write!(text, "| {own:.2} | {:.2} ", own / other),
                _ => write!(text, "| | "),
            };
        }
        let _ = match (line.by_manual, rival.by_manual) {
            (Some(own), Some(other)) => write!(text, "| {own:.2} | {:.2} ", own / other),
            _ => write!(text, "| | "),
        };
        text.push_str("|\n");
    }
    text.push('\n');
    text.push_str(
        "By the manual a load takes two cycles, several registers one each and one more, a fused\n\
         multiplication three, a branch two, all else one: an upper bound, as loads are pipelined.\n\n",
    );
    if measured.is_repeatable {
        text.push_str("Two runs gave the same counts.\n");
    } else {
        text.push_str("**Two runs gave different counts.**\n");
    }
    if rival.cycles[0].is_none() {
        text.push_str("Cycles are missing: `llvm-mca` is not installed.\n");
    }
}

/// A figure by its name.
fn figure(measured: &Measured<'_>, name: &str) -> Option<u64> {
    let found = measured.others.iter().find(|(found, _)| found == name);
    found.map(|(_, value)| *value)
}

fn normals(text: &mut String, measured: &Measured<'_>) {
    let (Some(normals), Some(instructions)) =
        (measured.inputs.normals, figure(measured, "normals"))
    else {
        return;
    };
    let rows = measured.inputs.rows.max(1) as f64;
    let of_rows = |name: &str| 2.0 * figure(measured, name).unwrap_or(0) as f64 / rows;
    let bytes = 2.0 * 2.2 * measured.inputs.taps as f64 / rows;
    let _ = writeln!(
        text,
        "\n## Normals\n\n\
         From the faces: {:.0} instructions a point ({instructions} a frame, {} corners of faces), unit length\n\
         included, and {:.1} bytes a point. Two derivative rows a point would take as much as two more rows of\n\
         the table before their cross product and its length: {:.0} instructions in Q14, {:.0} in the compact\n\
         format, and some {bytes:.0} bytes.",
        instructions as f64 / rows,
        normals.corners,
        normals.bytes as f64 / rows,
        of_rows("q14"),
        of_rows("compact"),
    );
}

fn refine(text: &mut String, measured: &Measured<'_>) {
    let _ = writeln!(
        text,
        "\n## Refinement on the device\n\n\
         The finger's cage, {} tetrahedra, boundary by Loop's rule: numbering, cells and points of a level\n\
         from those of the level before. Bytes are those of the arenas that the level is lent, scratch\n\
         included. Above 5.2 million a count has some instructions of the counter's own interrupt in it.\n\n\
         | level | instructions | arena bytes |\n| --- | --- | --- |",
        measured.inputs.cells
    );
    for level in 1..=2 {
        let of = |what: &str| figure(measured, &format!("refine {level} {what}"));
        if let (Some(instructions), Some(bytes)) = (of("instructions"), of("bytes")) {
            let _ = writeln!(text, "| {level} | {instructions} | {bytes} |");
        }
    }
}

fn host(text: &mut String, measured: &Measured<'_>) {
    text.push_str(
        "\n## On the host\n\n\
         The same rows on the machine that made this page, one thread, the best of many runs. Other than\n\
         instructions these figures vary from run to run and from machine to machine.\n\n\
         | loop | million rows a second | ratio |\n| --- | --- | --- |\n",
    );
    let peer = measured.host.iter().find(|(name, _)| name == "opensubdiv");
    for (name, rows) in &measured.host {
        let _ = write!(text, "| {name} | {:.1} ", rows / 1e6);
        let _ = match peer {
            Some((_, other)) => writeln!(text, "| {:.2} |", rows / other),
            None => writeln!(text, "| |"),
        };
    }
    if peer.is_none() {
        text.push_str("\nOpenSubdiv was skipped: it is not installed (Debian: libosd-dev).\n");
    }
}
