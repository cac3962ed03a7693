//! Curves over time as a picture.

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
    let opaque = pixels
        .chunks_exact(3)
        .flat_map(|rgb| [rgb[0], rgb[1], rgb[2], u8::MAX])
        .collect();
    let size = IntSize::from_wh(SIZE.0, SIZE.1);
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
