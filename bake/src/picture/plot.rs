//! Curves as a picture: over time, and over a quantity of several magnitudes.

use crate::error::{Error, Result};
use crate::slice::register_font;
use plotters::prelude::*;
use tiny_skia::{IntSize, Pixmap};

/// A curve with its name: a value for each frame.
pub type Curve<'a> = (&'a str, Vec<f64>);

/// Width and height in pixels.
const SIZE: (u32, u32) = (900, 420);

/// Draws curves over their frames as PNG; the vertical axis is symmetric about zero.
///
/// # Errors
/// If there is no value, or the drawing fails.
pub fn plot(title: &str, curves: &[Curve<'_>]) -> Result<Vec<u8>> {
    let values = curves.iter().flat_map(|(_, values)| values);
    let most = values.fold(0.0, |most: f64, value| most.max(value.abs()));
    let frames = curves.iter().map(|(_, values)| values.len()).max();
    let last = frames.unwrap_or_default().saturating_sub(1);
    if most == 0.0 || last == 0 {
        return Err(Error::new("there is nothing to plot"));
    }
    register_font()?;
    let mut pixels = vec![255; SIZE.0 as usize * SIZE.1 as usize * 3];
    paint(title, curves, (last as f64, 1.1 * most), &mut pixels)
        .map_err(|error| Error::new(format!("cannot be drawn: {error}")))?;
    encode(&pixels, SIZE)
}

fn encode(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>> {
    let opaque = pixels
        .chunks_exact(3)
        .flat_map(|rgb| [rgb[0], rgb[1], rgb[2], u8::MAX])
        .collect();
    let size = IntSize::from_wh(width, height);
    size.and_then(|size| Pixmap::from_vec(opaque, size))
        .ok_or_else(|| Error::new("the picture does not fit its size"))?
        .encode_png()
        .map_err(|error| Error::new(format!("cannot be encoded as PNG: {error}")))
}

fn paint(
    title: &str,
    curves: &[Curve<'_>],
    (last, most): (f64, f64),
    pixels: &mut [u8],
) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let root = BitMapBackend::with_buffer(pixels, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..last, -most..most)?;
    chart.configure_mesh().x_desc("frame").draw()?;
    for ((name, values), colour) in curves.iter().zip([BLUE, RED, BLACK]) {
        let line = values.iter().enumerate();
        let line = line.map(|(frame, value)| (frame as f64, *value));
        chart
            .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], colour));
    }
    let mut labels = chart.configure_series_labels();
    labels.position(SeriesLabelPosition::LowerLeft);
    labels.background_style(WHITE).border_style(BLACK).draw()?;
    root.present()?;
    Ok(())
}

/// A curve of positive numbers.
#[derive(Clone, Debug)]
pub struct LogCurve {
    /// Its name.
    pub name: String,
    /// Its points: across and upward.
    pub points: Vec<(f64, f64)>,
    /// The number of its colour; curves that belong together share one.
    pub colour: usize,
    /// A thin line with round points, where others are bold.
    pub is_thin: bool,
}

/// Curves over logarithmic axes.
#[derive(Clone, Copy, Debug)]
pub struct LogPlot<'a> {
    /// What stands above.
    pub title: &'a str,
    /// The name of the horizontal axis.
    pub across: &'a str,
    /// The name of the vertical axis.
    pub upward: &'a str,
    /// The curves.
    pub curves: &'a [LogCurve],
}

/// Width and height of a plot with logarithmic axes, in pixels.
const LOG_SIZE: (u32, u32) = (900, 600);

/// Draws curves over logarithmic axes as PNG.
///
/// # Errors
/// If there are no two different points, or one is not positive, or the drawing fails.
pub fn log_plot(plot: &LogPlot<'_>) -> Result<Vec<u8>> {
    let points = || plot.curves.iter().flat_map(|curve| &curve.points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let least = points().map(of).fold(f64::INFINITY, f64::min);
        (least, points().map(of).fold(0.0, f64::max))
    };
    let ranges = [range(|point| point.0), range(|point| point.1)];
    if ranges
        .iter()
        .any(|(least, most)| *least <= 0.0 || least >= most)
    {
        return Err(Error::new(
            "logarithmic axes need positive numbers, and two different ones along each",
        ));
    }
    register_font()?;
    let mut pixels = vec![255; LOG_SIZE.0 as usize * LOG_SIZE.1 as usize * 3];
    paint_log(plot, ranges, &mut pixels)
        .map_err(|error| Error::new(format!("cannot be drawn: {error}")))?;
    encode(&pixels, LOG_SIZE)
}

fn paint_log(
    plot: &LogPlot<'_>,
    [across, upward]: [(f64, f64); 2],
    pixels: &mut [u8],
) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let root = BitMapBackend::with_buffer(pixels, LOG_SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let wide = |(least, most): (f64, f64)| (least / 1.15..most * 1.15).log_scale();
    let mut chart = ChartBuilder::on(&root)
        .caption(plot.title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(wide(across), wide(upward))?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(plot.across).y_desc(plot.upward);
    mesh.x_label_formatter(&log_label)
        .y_label_formatter(&log_label);
    mesh.light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.1))
        .draw()?;
    let colours = [BLUE, RED, RGBColor(0, 128, 0), BLACK];
    for curve in plot.curves {
        let colour = colours[curve.colour % colours.len()];
        let style = colour.stroke_width(if curve.is_thin { 1 } else { 3 });
        let line = LineSeries::new(curve.points.iter().copied(), style);
        let size = if curve.is_thin { 3 } else { 0 };
        chart
            .draw_series(line.point_size(size))?
            .label(curve.name.as_str())
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], style));
    }
    let mut labels = chart.configure_series_labels();
    labels.position(SeriesLabelPosition::UpperRight);
    labels.background_style(WHITE).border_style(BLACK).draw()?;
    root.present()?;
    Ok(())
}

/// Only 1, 2 and 5 times a power of ten are labelled: more would touch one another.
fn log_label(value: &f64) -> String {
    let power = 10.0_f64.powf((value.log10() + 1e-6).floor());
    let leading = value / power;
    if [1.0, 2.0, 5.0]
        .iter()
        .any(|own| (leading - own).abs() < 1e-3)
    {
        format!("{}", (leading.round() * power * 1e9).round() / 1e9)
    } else {
        String::new()
    }
}
