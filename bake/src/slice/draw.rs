//! The picture: density, lines of equal value, and a plot along a line, side by side.

use super::isolines::isoline;
use super::{Checkerboard, Cut, Plane, Window};
use crate::error::{Error, Result};
use epaint_default_fonts::UBUNTU_LIGHT;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;
use tiny_skia::{IntSize, Pixmap};

/// What is drawn.
pub struct Picture<'a> {
    /// The panels, row by row from the upper left.
    pub panels: Vec<Panel<'a>>,
    /// Width and height of a panel in pixels.
    pub size: u32,
}

/// One part of a picture.
pub enum Panel<'a> {
    /// Values on a plane as colours, with a title.
    Density(String, &'a Cut),
    /// So many lines of equal value on a plane.
    Isolines(usize, &'a Cut),
    /// Values along a line.
    Plot(Profile),
    /// The colours that a deformed solid's places came from, with a title.
    Checkerboard(String, &'a Checkerboard),
}

/// Panels side by side before the next row begins.
const MOST_COLUMNS: usize = 3;

/// Values along a segment.
pub struct Profile {
    /// Length of the segment.
    pub length: f64,
    /// Of the refined solid.
    pub refined: Vec<Option<f64>>,
    /// Interpolated linearly in the cells of the cage.
    pub linear: Vec<Option<f64>>,
    /// The derivative of the first along the segment, if it is to be drawn; scaled to the same
    /// greatest magnitude.
    pub derivative: Option<Vec<Option<f64>>>,
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// Makes the built-in font that of all text: no font of the system is looked for.
///
/// # Errors
/// If it cannot be read.
pub fn register_font() -> Result<()> {
    plotters::style::register_font("sans-serif", FontStyle::Normal, UBUNTU_LIGHT)
        .map_err(|_| Error::new("the built-in font cannot be used"))
}

/// Draws a picture as PNG.
///
/// # Errors
/// If no point of the cut lies inside the solid, or the drawing fails.
pub fn draw(picture: &Picture<'_>) -> Result<Vec<u8>> {
    let range = range(&picture.panels)?;
    register_font()?;
    let columns = picture.panels.len().clamp(1, MOST_COLUMNS);
    let rows = picture.panels.len().div_ceil(columns);
    let [width, height] = [columns, rows].map(|panels| picture.size * panels as u32);
    let mut pixels = vec![255; width as usize * height as usize * 3];
    paint(
        picture,
        range,
        [rows, columns],
        &mut pixels,
        (width, height),
    )
    .map_err(|error| Error::new(format!("cannot be drawn: {error}")))?;
    let opaque: Vec<u8> = pixels
        .chunks_exact(3)
        .flat_map(|rgb| [rgb[0], rgb[1], rgb[2], u8::MAX])
        .collect();
    let size = IntSize::from_wh(width, height).ok_or_else(|| Error::new("the picture is empty"))?;
    Pixmap::from_vec(opaque, size)
        .ok_or_else(|| Error::new("the picture does not fit its size"))?
        .encode_png()
        .map_err(|error| Error::new(format!("cannot be encoded as PNG: {error}")))
}

/// The least and the greatest value on all planes.
fn range(panels: &[Panel<'_>]) -> Result<[f64; 2]> {
    let ranges = panels.iter().filter_map(|panel| match panel {
        Panel::Density(_, cut) | Panel::Isolines(_, cut) => cut.range(),
        Panel::Checkerboard(_, board) => (board.inside() > 0).then_some([0.0, 1.0]),
        Panel::Plot(_) => None,
    });
    let both = |[low, high]: [f64; 2], [a, b]: [f64; 2]| [low.min(a), high.max(b)];
    ranges.reduce(both).ok_or_else(|| {
        Error::new("the plane touches the refined solid, but no grid point lies inside")
            .advise("move the plane into the solid")
    })
}

type Drawn = std::result::Result<(), Box<dyn std::error::Error>>;

fn paint(
    picture: &Picture<'_>,
    range: [f64; 2],
    [rows, columns]: [usize; 2],
    pixels: &mut [u8],
    size: (u32, u32),
) -> Drawn {
    let root = BitMapBackend::with_buffer(pixels, size).into_drawing_area();
    root.fill(&WHITE)?;
    let parts = root.split_evenly((rows, columns));
    for (panel, part) in picture.panels.iter().zip(&parts) {
        match panel {
            Panel::Density(title, cut) => density(title, cut, range, part)?,
            Panel::Isolines(count, cut) => isolines(*count, cut, range, part)?,
            Panel::Plot(profile) => plot(profile, part)?,
            Panel::Checkerboard(title, board) => checkerboard(title, board, part)?,
        }
    }
    root.present()?;
    Ok(())
}

/// A value's place between the least and the greatest.
fn fraction(value: f64, [low, high]: [f64; 2]) -> f64 {
    if high > low {
        (value - low) / (high - low)
    } else {
        0.5
    }
}

fn caption(title: &str, [low, high]: [f64; 2]) -> String {
    format!("{title}{low:.4} (dark) to {high:.4} (bright)")
}

fn density(title: &str, cut: &Cut, range: [f64; 2], area: &Area<'_>) -> Drawn {
    let window = Window {
        start: cut.start,
        side: cut.side,
    };
    let title = caption(title, range);
    let mut chart = raster(&title, cut.plane, window, cut.size, area, |place| {
        let value = cut.values[place]?;
        Some(ViridisRGB.get_color(fraction(value, range)))
    })?;
    for segment in cut.sheets() {
        let colour = ViridisRGB.get_color(fraction(segment.value, range));
        chart.draw_series(std::iter::once(path(segment.ends, colour.stroke_width(5))))?;
    }
    Ok(())
}

fn checkerboard(title: &str, board: &Checkerboard, area: &Area<'_>) -> Drawn {
    raster(
        title,
        board.plane,
        board.window,
        board.size,
        area,
        |place| {
            Some(match board.dark[place]? {
                true => RGBColor(36, 62, 99),
                false => RGBColor(240, 206, 160),
            })
        },
    )?;
    Ok(())
}

type Chart<'a> = ChartContext<
    'a,
    BitMapBackend<'a>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

/// A chart of a square part of a plane, each pixel in the colour of the nearest of `size` by `size`
/// places, which are numbered row by row from below.
fn raster<'a>(
    title: &str,
    plane: Plane,
    window: Window,
    size: usize,
    area: &Area<'a>,
    colour: impl Fn(usize) -> Option<RGBColor>,
) -> std::result::Result<Chart<'a>, Box<dyn std::error::Error>> {
    let ([u, v], side) = (window.start, window.side);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(u..u + side, v..v + side)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc(plane.names[0])
        .y_desc(plane.names[1])
        .draw()?;
    let plotting = chart.plotting_area().strip_coord_spec();
    let (width, height) = plotting.dim_in_pixel();
    for down in 0..height {
        for along in 0..width {
            let nearest = |place: u32, of: u32| {
                (place as usize * (size - 1) + of as usize / 2) / (of as usize - 1).max(1)
            };
            let row = size - 1 - nearest(down, height).min(size - 1);
            let column = nearest(along, width).min(size - 1);
            if let Some(colour) = colour(row * size + column) {
                plotting.draw_pixel((along as i32, down as i32), &colour)?;
            }
        }
    }
    Ok(chart)
}

/// A line from one place of the plane to another.
fn path([from, to]: [[f64; 2]; 2], style: ShapeStyle) -> PathElement<(f64, f64)> {
    PathElement::new([(from[0], from[1]), (to[0], to[1])], style)
}

fn isolines(count: usize, cut: &Cut, range: [f64; 2], area: &Area<'_>) -> Drawn {
    let [u, v] = cut.start;
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{count} lines of equal value"), ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(u..u + cut.side, v..v + cut.side)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc(cut.plane.names[0])
        .y_desc(cut.plane.names[1])
        .draw()?;
    for line in 1..=count {
        let part = line as f64 / (count + 1) as f64;
        let level = range[0] + part * (range[1] - range[0]);
        let colour = ViridisRGB.get_color(part * 0.9);
        for ends in isoline(cut, level) {
            chart.draw_series(std::iter::once(path(ends, colour.stroke_width(2))))?;
        }
    }
    for segment in cut.sheets() {
        chart.draw_series(std::iter::once(path(segment.ends, BLACK.stroke_width(2))))?;
    }
    Ok(())
}

/// Runs of samples without gaps, with their places along the segment.
fn runs(samples: &[Option<f64>], length: f64) -> Vec<Vec<(f64, f64)>> {
    let mut runs = vec![Vec::new()];
    let last = (samples.len() - 1) as f64;
    for (place, sample) in samples.iter().enumerate() {
        match (sample, runs.last_mut()) {
            (Some(value), Some(run)) => run.push((place as f64 / last * length, *value)),
            _ => runs.push(Vec::new()),
        }
    }
    runs
}

fn plot(profile: &Profile, area: &Area<'_>) -> Drawn {
    let derivative = profile.derivative.as_deref().map(|samples| {
        let greatest = |samples: &[Option<f64>]| {
            samples
                .iter()
                .flatten()
                .fold(0.0_f64, |most, value| most.max(value.abs()))
        };
        let most = greatest(samples);
        let scale = if most > 0.0 {
            greatest(&profile.refined) / most
        } else {
            1.0
        };
        let scaled = samples
            .iter()
            .map(|sample| sample.map(|value| value * scale));
        scaled.collect::<Vec<_>>()
    });
    let lines = [
        Some(&profile.refined),
        Some(&profile.linear),
        derivative.as_ref(),
    ];
    let all = || {
        lines
            .iter()
            .flatten()
            .flat_map(|samples| samples.iter().flatten())
    };
    let low = all().copied().fold(f64::INFINITY, f64::min);
    let high = all().copied().fold(f64::NEG_INFINITY, f64::max);
    let (low, high) = if low < high {
        (low, high)
    } else {
        (low - 1.0, low + 1.0)
    };
    let room = (high - low) * 0.05;
    let mut chart = ChartBuilder::on(area)
        .caption("value along the line", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..profile.length, low - room..high + room)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("from the line's start")
        .draw()?;
    let drawn = [
        (
            "linear in the cage",
            Some(&profile.linear),
            BLACK.stroke_width(1),
        ),
        (
            "refined",
            Some(&profile.refined),
            RGBColor(68, 1, 84).stroke_width(3),
        ),
        (
            "its derivative, to another scale",
            derivative.as_ref(),
            RGBColor(200, 80, 20).stroke_width(2),
        ),
    ];
    for (name, samples, style) in drawn {
        let Some(samples) = samples else { continue };
        for (place, run) in runs(samples, profile.length).into_iter().enumerate() {
            let series = chart.draw_series(LineSeries::new(run, style))?;
            if place == 0 {
                series
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
            }
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(("sans-serif", 15))
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    Ok(())
}
