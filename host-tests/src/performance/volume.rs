//! The enclosed volume: the form over all control points, and the polynomial of sixteen modes; the centroid.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::read::motion;
use octruss_bake::table::{Input, Options, Region, VolumeReport, bake};

use super::input::Failure;

/// Modes that are baked: the frames of the motion after the first, which is the rest pose.
const MODES: usize = 16;

/// What the image `volume` reports, with the words of the table.
const LINES: [(&str, &str); 5] = [
    ("volume", "form: volume"),
    ("volume and gradient", "form: volume and gradient"),
    ("volume by modes", "modes: volume"),
    ("volume and gradient by modes", "modes: volume and gradient"),
    ("centroid by modes", "modes: centroid, given the volume"),
];

/// Bakes the cage's volume and writes `volume.oct` into the directory.
///
/// # Errors
/// If a file cannot be read or written, or the baker refuses the cage.
pub fn make(
    directory: &Path,
    cage_file: &Path,
    model_file: &Path,
    motion_file: &Path,
) -> Result<VolumeReport, Failure> {
    let cage = read::solid_with_features(cage_file, None)?;
    let model = read::model(model_file)?;
    let frames = motion::read(motion_file, cage.points.len(), &|_| Ok(()))?;
    let poses = frames.into_iter().skip(1).take(MODES);
    let options = Options {
        volumes: vec![Region::Whole],
        modes: poses.map(|frame| frame.points).collect(),
        centroid: true,
        random_poses: 0,
        ..Options::default()
    };
    let input = Input {
        cage: &cage,
        cage_file,
        model: &model.points,
        model_file,
    };
    let baked = bake(input, &options, &mut Silent)?;
    fs::write(directory.join("volume.oct"), &baked.bundle)?;
    let mut volumes = baked.report.volumes.into_iter();
    Ok(volumes.next().ok_or("no volume was baked")?)
}

/// The section of the page.
///
/// # Errors
/// If the image did not report a figure.
pub fn section(report: &VolumeReport, figures: &[(String, u64)]) -> Result<String, Failure> {
    let modes = report.modes.as_ref().ok_or("no modes were baked")?;
    let mut text = String::from(
        "\n## Enclosed volume\n\n\
         The volume inside the finger's smooth boundary, as a form over its control points and as a cubic\n\
         polynomial of sixteen modes, and its centroid as three quartic ones; instructions of whole calls on the emulated Cortex-M4. Errors are\n\
         bounds of what a device can be off by, as parts of the volume: of the form for poses as large as the cage at\n\
         rest, of the polynomial for amplitudes to one.\n\n\
         | call | terms | bytes | error at most | instructions |\n| --- | --- | --- | --- | --- |\n",
    );
    let centroid = modes.centroid.as_ref().ok_or("no centroid was baked")?;
    let volume = report.volume.abs();
    let part = |bound: f64| format!("{:.1e}", bound / volume);
    let form = (report.taps, report.bytes, part(report.error_bound));
    let polynomial = (modes.coefficients, modes.bytes, part(modes.error_bound));
    let moments = (
        centroid.coefficients,
        centroid.bytes,
        format!("{:.1e} mm at rest", centroid.error_bound),
    );
    let rows = [&form, &form, &polynomial, &polynomial, &moments];
    for ((name, words), (terms, bytes, bound)) in LINES.into_iter().zip(rows) {
        let (_, instructions) = figures
            .iter()
            .find(|(found, _)| found == name)
            .ok_or("the image `volume` does not report all figures")?;
        writeln!(
            text,
            "| {words} | {terms} | {bytes} | {bound} | {instructions} |"
        )?;
    }
    Ok(text)
}
