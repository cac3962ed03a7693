//! Pictures: a contact sheet of a model in motion, shaded, with its cage drawn over it.
//!
//! A [`Scene`] says what is connected, a [`Frame`] where everything is; [`contact_sheet`] draws
//! one tile for each frame, all from the same side and at the same scale, and gives the bytes of a
//! PNG file. The projection is parallel. Triangles and pieces of cage edges are painted from far
//! to near, then all cage edges once more in a faint colour, so that the hidden parts show
//! through. The tiles are painted three times as large and averaged down.

mod paint;
mod plot;
mod text;
mod view;

pub use plot::{Curve, LogCurve, LogPlot, log_plot, plot};
pub use view::View;

use crate::error::{Error, Result};
use crate::mesh::{Faces, Point};
use paint::Painter;
use std::collections::BTreeSet;
use tiny_skia::{Color, Pixmap, PixmapPaint, Transform};
use view::Camera;

/// What is connected in all frames.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Triangles of the model, counter-clockwise from outside.
    pub triangles: &'a [[u32; 3]],
    /// Edges of the cage.
    pub cage_edges: &'a [[u32; 2]],
}

/// Where everything is at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// What is written below the tile; characters beyond ASCII show as "?".
    pub caption: String,
    /// Vertices of the model.
    pub model: Vec<Point>,
    /// Vertices of the cage.
    pub cage: Vec<Point>,
}

/// The look of a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// From which side things are seen.
    pub view: View,
    /// Width and height of a tile, in pixels, without its caption.
    pub tile: [u32; 2],
    /// Tiles side by side; by default as many as make the sheet about half as wide again as high.
    pub columns: Option<u32>,
}

impl Default for Sheet {
    fn default() -> Self {
        Self {
            view: View::default(),
            tile: [300, 360],
            columns: None,
        }
    }
}

/// Height of the strip for a caption, in pixels.
const CAPTION: u32 = 26;

/// Room round the whole sheet, in pixels.
const MARGIN: u32 = 12;

/// The edges of these triangles, each once. Of a cage, those of its boundary make the clearest
/// picture.
pub fn edges_of(faces: &Faces) -> Vec<[u32; 2]> {
    let sides = faces
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let of_quads = faces
        .quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    let sides = sides.chain(of_quads);
    let edges: BTreeSet<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.into_iter().collect()
}

/// Draws the frames and returns the bytes of a PNG file.
///
/// # Errors
/// If there is no frame, a frame lacks vertices that the scene names, or the sheet would have more
/// pixels than memory holds.
pub fn contact_sheet(scene: &Scene<'_>, frames: &[Frame], sheet: &Sheet) -> Result<Vec<u8>> {
    coloured_sheet(scene, &[], frames, sheet)
}

/// The same with a colour for each triangle: red, green, blue, from 0 to 1. Triangles beyond the
/// colours have the usual one.
///
/// # Errors
/// As [`contact_sheet`].
pub fn coloured_sheet(
    scene: &Scene<'_>,
    colours: &[[f64; 3]],
    frames: &[Frame],
    sheet: &Sheet,
) -> Result<Vec<u8>> {
    check(scene, frames)?;
    let camera = Camera::new(sheet.view, sheet.tile, frames);
    let columns = columns(sheet, frames.len());
    let rows = u32::try_from(frames.len())
        .unwrap_or(u32::MAX)
        .div_ceil(columns);
    let [tile_width, tile_height] = sheet.tile;
    let too_large = || {
        Error::new("the picture would be too large").advise("take fewer frames or smaller tiles")
    };
    let width = tile_width
        .checked_mul(columns)
        .and_then(|w| w.checked_add(2 * MARGIN));
    let height = (tile_height.checked_add(CAPTION))
        .and_then(|h| h.checked_mul(rows))
        .and_then(|h| h.checked_add(2 * MARGIN));
    let mut whole = Pixmap::new(width.ok_or_else(too_large)?, height.ok_or_else(too_large)?)
        .ok_or_else(too_large)?;
    let [r, g, b] = paint::BACKGROUND;
    whole.fill(Color::from_rgba8(r, g, b, 255));
    let mut painter = Painter::new(sheet.tile).ok_or_else(too_large)?;
    for (index, frame) in (0_u32..).zip(frames) {
        let left = MARGIN + index % columns * tile_width;
        let top = MARGIN + index / columns * (tile_height + CAPTION);
        let tile = painter
            .tile(scene, colours, frame, &camera)
            .ok_or_else(too_large)?;
        let place = (left.cast_signed(), top.cast_signed());
        whole.draw_pixmap(
            place.0,
            place.1,
            tile.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
        text::centred(
            &mut whole,
            &frame.caption,
            left + tile_width / 2,
            top + tile_height,
        );
    }
    whole
        .encode_png()
        .map_err(|error| Error::new(format!("the picture cannot be encoded: {error}")))
}

fn check(scene: &Scene<'_>, frames: &[Frame]) -> Result<()> {
    if frames.is_empty() {
        return Err(Error::new("there is no frame to draw"));
    }
    let needed = |indices: &mut dyn Iterator<Item = &u32>| {
        indices.max().map_or(0, |greatest| *greatest as usize + 1)
    };
    let model = needed(&mut scene.triangles.iter().flatten());
    let cage = needed(&mut scene.cage_edges.iter().flatten());
    for frame in frames {
        if frame.model.len() < model || frame.cage.len() < cage {
            return Err(Error::new(format!(
                "the frame \"{}\" has {} model and {} cage vertices; {model} and {cage} are needed",
                frame.caption,
                frame.model.len(),
                frame.cage.len()
            )));
        }
    }
    Ok(())
}

/// About half as wide again as high; of three numbers near that, the one that leaves the
/// fewest places empty.
fn columns(sheet: &Sheet, frames: usize) -> u32 {
    const ASPECT: f64 = 1.5;
    let most = u32::try_from(frames).unwrap_or(u32::MAX).max(1);
    if let Some(columns) = sheet.columns {
        return columns.clamp(1, most);
    }
    let [width, height] = sheet.tile.map(f64::from);
    let wanted = (frames as f64 * ASPECT * (height + f64::from(CAPTION)) / width)
        .sqrt()
        .round();
    let wanted = (wanted as u32).clamp(1, most);
    let empty = |columns: u32| most.next_multiple_of(columns) - most;
    let candidates = [
        wanted,
        wanted.saturating_sub(1).max(1),
        (wanted + 1).min(most),
    ];
    candidates
        .into_iter()
        .min_by_key(|columns| empty(*columns))
        .unwrap_or(wanted)
}
