//! One table in every format, and the same rows in floating point.

use std::fs;
use std::path::Path;

use octruss_bake::bundle::BundleBytes;
use octruss_bake::mesh::Point;
use octruss_bake::pack::Layout;
use octruss_bake::pack::cost::Cost;
use octruss_bake::pack::group::group;
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::refine::rows::Row;
use octruss_bake::table::{FormatReport, Input, NormalsReport, Options, TableFormat, bake};

/// Why nothing can be measured.
pub type Failure = Box<dyn std::error::Error>;

/// The files, and what the baker says of them.
pub struct Inputs {
    /// Rows of the table.
    pub rows: usize,
    /// Taps of the rows, before anything is rounded or packed.
    pub taps: usize,
    /// Control points.
    pub control_points: usize,
    /// Cells of the cage.
    pub cells: usize,
    /// The faces for normals.
    pub normals: Option<NormalsReport>,
    /// Every format.
    pub formats: Vec<FormatReport>,
    /// Bytes of a tap in floating point with its index, row starts included.
    pub csr_bytes_a_tap: f64,
}

/// Bakes the finger in the formats that the image measures and writes the files into a directory.
///
/// # Errors
/// If a file cannot be read or written, or the baker refuses the cage.
pub fn make(directory: &Path, cage_file: &Path, model_file: &Path) -> Result<Inputs, Failure> {
    fs::create_dir_all(directory)?;
    let cage = read::solid_with_features(cage_file, None)?;
    let model = read::model(model_file)?;
    let input = Input {
        cage: &cage,
        cage_file,
        model: &model.points,
        model_file,
    };
    let mut made = None;
    for format in TableFormat::ALL {
        let mut options = Options::default();
        options.request.format = Some(format);
        options.request.survey = format == TableFormat::Q30;
        // One bundle has the faces too.
        options.faces = (format == TableFormat::Q30).then(|| model.faces.clone());
        let baked = bake(input, &options, &mut Silent)?;
        let name = format.name();
        fs::write(directory.join(format!("{name}.oct")), &baked.bundle)?;
        if format == TableFormat::Q30 {
            made = Some(baked);
        }
    }
    let baked = made.ok_or("no format was baked")?;
    let bytes = BundleBytes::new(&baked.bundle);
    let cage_bytes = cage_bytes(&cage.cells.tetrahedra, bytes.open()?.rest_cage());
    fs::write(directory.join("cage.bin"), cage_bytes)?;
    let rows: &[Vec<(u32, f64)>] = &baked.rows;
    let (bytes, csr_bytes_a_tap) = rivals(rows);
    fs::write(directory.join("rivals.bin"), bytes)?;
    let points: &[Point] = &cage.points;
    Ok(Inputs {
        rows: rows.len(),
        taps: rows.iter().map(Vec::len).sum(),
        control_points: points.len(),
        cells: cage.cells.len(),
        normals: baked.report.normals,
        formats: baked.report.formats,
        csr_bytes_a_tap,
    })
}

/// The cage as the image `refine` reads it.
fn cage_bytes(tetrahedra: &[[u32; 4]], points: &[[i32; 3]]) -> Vec<u8> {
    let counts = [points.len() as u32, tetrahedra.len() as u32];
    let words = counts.iter().chain(tetrahedra.as_flattened()).copied();
    let bits = points
        .as_flattened()
        .iter()
        .map(|bits| bits.cast_unsigned());
    words.chain(bits).flat_map(u32::to_le_bytes).collect()
}

/// The rows in floating point as the image `rivals` reads them, and the bytes of a tap as compressed sparse
/// rows.
fn rivals(rows: &[Row]) -> (Vec<u8>, f64) {
    let taps: usize = rows.iter().map(Vec::len).sum();
    // The grouping that the 16-bit weights of 32-bit coordinates have.
    let whole: Vec<Vec<(u32, i32)>> = rows
        .iter()
        .map(|row| row.iter().map(|(point, _)| (*point, 1)).collect())
        .collect();
    let groups = group(&whole, &Cost::of(Layout::Q14));
    let (mut weights, mut points, mut sizes) = (Vec::new(), Vec::new(), Vec::new());
    for group in &groups {
        sizes.extend([group.rows.len() as u16, group.points.len() as u16]);
        points.extend(group.points.iter().map(|&point| point as u16));
        for &row in &group.rows {
            let weight = |point: &u32| {
                let tap = rows[row].iter().find(|(other, _)| other == point);
                tap.map_or(0.0, |(_, weight)| *weight as f32)
            };
            weights.extend(group.points.iter().map(weight));
        }
    }
    let counts = [rows.len(), taps, groups.len(), weights.len(), points.len()];
    let mut bytes: Vec<u8> = counts
        .iter()
        .flat_map(|&count| (count as u32).to_le_bytes())
        .collect();
    let mut start = 0_u32;
    bytes.extend(start.to_le_bytes());
    for row in rows {
        start += row.len() as u32;
        bytes.extend(start.to_le_bytes());
    }
    let all = || rows.iter().flatten();
    bytes.extend(all().flat_map(|(_, weight)| (*weight as f32).to_le_bytes()));
    bytes.extend(weights.iter().flat_map(|weight| weight.to_le_bytes()));
    bytes.extend(sizes.iter().flat_map(|size| size.to_le_bytes()));
    bytes.extend(all().flat_map(|(point, _)| (*point as u16).to_le_bytes()));
    bytes.extend(points.iter().flat_map(|point| point.to_le_bytes()));
    let csr = (6 * taps + 4 * (rows.len() + 1)) as f64 / taps.max(1) as f64;
    (bytes, csr)
}
