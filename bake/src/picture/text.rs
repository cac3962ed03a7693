//! Captions.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use tiny_skia::{Pixmap, PremultipliedColorU8};

const HEIGHT: RasterHeight = RasterHeight::Size16;
const WEIGHT: FontWeight = FontWeight::Regular;
const COLOUR: [u8; 3] = [70, 72, 80];

/// Writes a line whose middle lies at `x` and whose top at `y`, in pixels. What does not fit the
/// picture is cut off.
pub fn centred(picture: &mut Pixmap, text: &str, x: u32, y: u32) {
    let advance = get_raster_width(WEIGHT, HEIGHT);
    let width = text.chars().count() * advance;
    let start = i64::from(x) - width as i64 / 2;
    for (index, character) in text.chars().enumerate() {
        let Some(glyph) =
            get_raster(character, WEIGHT, HEIGHT).or_else(|| get_raster('?', WEIGHT, HEIGHT))
        else {
            continue;
        };
        for (row, pixels) in (i64::from(y)..).zip(glyph.rows()) {
            let columns = start + (index * advance) as i64..;
            for (column, coverage) in columns.zip(pixels) {
                blend(picture, column, row, *coverage);
            }
        }
    }
}

fn blend(picture: &mut Pixmap, x: i64, y: i64, coverage: u8) {
    let (width, height) = (i64::from(picture.width()), i64::from(picture.height()));
    if coverage == 0 || !(0..width).contains(&x) || !(0..height).contains(&y) {
        return;
    }
    let pixel = &mut picture.pixels_mut()[(y * width + x) as usize];
    let mixed = |ink: u8, paper: u8| {
        let (ink, paper, coverage) = (u32::from(ink), u32::from(paper), u32::from(coverage));
        ((ink * coverage + paper * (255 - coverage) + 127) / 255) as u8
    };
    let [r, g, b] = COLOUR;
    let colour = PremultipliedColorU8::from_rgba(
        mixed(r, pixel.red()),
        mixed(g, pixel.green()),
        mixed(b, pixel.blue()),
        255,
    );
    *pixel = colour.unwrap_or(*pixel);
}
