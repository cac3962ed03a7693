//! Random tables as bundles in every format, and what the reference says of them.
//!
//! The bundles are packed by the baker; the results that they are held to come from
//! [`reference`](crate::reference) and from the rows before they were packed.

use octruss::bundle::{BOUNDARY_LOOP, Header, SCHEME_TET_OCT};
use octruss_bake::pack::sections::{Source, Stage};
use octruss_bake::pack::writer::Section;
use octruss_bake::pack::{Layout, writer};

use crate::random_table::{ApplyCase, RowSum};
use crate::reference::{Applied, Table, apply_absolute, apply_displacement};

/// The layouts, by a number that draws one: 16-bit displacements with every shift that there is among them.
#[must_use]
pub fn layout(number: u64) -> Layout {
    const SHIFTS: [u32; 8] = [0, 1, 5, 11, 12, 14, 15, 16];
    match number % 4 {
        0 => Layout::Q30,
        1 => Layout::Q14,
        _ => Layout::Compact {
            shift: SHIFTS[(number / 4 % 8) as usize],
        },
    }
}

/// A random table in a format.
#[derive(Clone, Debug)]
pub struct BundleCase {
    /// The format.
    pub layout: Layout,
    /// Rows, pose and rest, with weights that the format holds.
    pub case: ApplyCase<3>,
    /// The bundle's bytes.
    pub bytes: Vec<u8>,
    /// The row of the case that each row of the bundle is.
    pub order: Vec<usize>,
}

impl BundleCase {
    /// The case of a seed with at most so many rows and control points.
    ///
    /// # Panics
    /// If the baker cannot pack it, which is a fault.
    #[must_use]
    pub fn new(seed: u64, rows: usize, points: u16, layout: Layout) -> Self {
        Self::of(ApplyCase::<3>::new(seed, rows, points, RowSum::One), layout)
    }

    /// A case in a format: weights and rest results become what the format holds.
    ///
    /// # Panics
    /// If the baker cannot pack it, which is a fault.
    #[must_use]
    pub fn of(mut case: ApplyCase<3>, layout: Layout) -> Self {
        let seed = case.seed;
        if layout.weight_bits() == 14 {
            coarsen(&mut case.table);
        }
        share(&mut case.table, seed);
        // Rest results near those of the rest pose, as a baker has them, but for formats that take any.
        if !matches!(layout, Layout::Compact { .. }) {
            let at_rest = apply_absolute(&case.table, &case.rest_pose).expect("a sound table");
            case.rest = at_rest.points;
            for (row, rest) in case.rest.iter_mut().enumerate() {
                let off = [0, 3, -1_000_000][(seed as usize + row) % 3];
                *rest = rest.map(|bits: i32| bits.saturating_add(off));
            }
        }
        let (bytes, order) = pack(&case, layout);
        Self {
            layout,
            case,
            bytes,
            order,
        }
    }

    /// What the displacement form gives, in the order of the case's rows; how many displacements were
    /// clamped comes with it.
    ///
    /// # Panics
    /// If the reference refuses the table, which is a fault.
    #[must_use]
    pub fn displaced(&self) -> (Applied<3>, u32) {
        let case = &self.case;
        let Layout::Compact { shift } = self.layout else {
            let applied = apply_displacement(&case.table, &case.pose, &case.rest_pose, &case.rest);
            return (applied.expect("a sound table"), 0);
        };
        // Displacements in whole units of 2^shift, exact in double precision, as a pose over a rest
        // pose of zeros.
        let mut clamped = 0;
        let unit = f64::from(1_u32 << shift);
        let points = case.pose.iter().zip(&case.rest_pose);
        let moved: Vec<[i32; 3]> = points
            .map(|(now, before)| {
                std::array::from_fn(|axis| {
                    let way = f64::from(now[axis]) - f64::from(before[axis]);
                    let rounded = (way / unit + 0.5).floor();
                    let kept = rounded.clamp(-32768.0, 32767.0);
                    clamped += u32::from(kept != rounded);
                    (kept * unit) as i32
                })
            })
            .collect();
        let zeros = vec![[0; 3]; moved.len()];
        let applied = apply_displacement(&case.table, &moved, &zeros, &case.rest);
        (applied.expect("a sound table"), clamped)
    }

    /// What the absolute form gives, in the order of the case's rows.
    ///
    /// # Panics
    /// If the reference refuses the table, which is a fault.
    #[must_use]
    pub fn absolute(&self) -> Applied<3> {
        apply_absolute(&self.case.table, &self.case.pose).expect("a sound table")
    }
}

/// Makes weights multiples of 2^-14 with the same sum and no greater magnitudes: each loses its
/// fraction, and the greatest makes up for it.
fn coarsen(table: &mut Table) {
    for row in 0..table.row_count() {
        let taps = table.offsets[row] as usize..table.offsets[row + 1] as usize;
        let weights = &mut table.weights[taps];
        for weight in weights.iter_mut() {
            *weight = (*weight / (1 << 16)) << 16;
        }
        let sum: i64 = weights.iter().map(|&weight| i64::from(weight)).sum();
        if let Some(greatest) = weights.iter_mut().max() {
            *greatest += i32::try_from((1 << 30) - sum).expect("a small remainder");
        }
    }
}

/// Gives some rows the control points of the row before, so that rows share them.
fn share(table: &mut Table, seed: u64) {
    for row in 1..table.row_count() {
        let taps = |row: usize| table.offsets[row] as usize..table.offsets[row + 1] as usize;
        let (before, here) = (taps(row - 1), taps(row));
        if before.len() == here.len() || (seed + row as u64).is_multiple_of(3) {
            let shared = before.len().min(here.len());
            let points: Vec<u16> = table.indices[before][..shared].to_vec();
            if shared == here.len() {
                table.indices[here].copy_from_slice(&points);
            }
        }
    }
}

/// The rows as the baker packs them.
pub(crate) fn stage_of(case: &ApplyCase<3>, layout: Layout) -> Stage {
    let shift = 30 - layout.weight_bits();
    let taps = |row: usize| {
        let taps = case
            .table
            .row(row)
            .map(|(point, weight)| (point.into(), weight >> shift));
        taps.filter(|(_, weight)| *weight != 0).collect()
    };
    let rows: Vec<Vec<(u32, i32)>> = (0..case.table.row_count()).map(taps).collect();
    let source = Source {
        rows: &rows,
        rest_inputs: &case.rest_pose,
        rest: Some(&case.rest),
        keep_order: case.seed.is_multiple_of(5),
    };
    Stage::new(&source, layout).expect("a table that fits its format")
}

fn pack(case: &ApplyCase<3>, layout: Layout) -> (Vec<u8>, Vec<usize>) {
    let stage = stage_of(case, layout);
    let mut sections = vec![writer::rest_cage(&case.rest_pose)];
    sections.extend(stage.sections(0));
    sections.extend(writer::model_points(&stage.order));
    let bytes = bundle_of(&sections, case.pose.len(), case.table.row_count());
    (bytes, stage.order)
}

/// The bundle of some sections.
pub(crate) fn bundle_of(sections: &[Section], control_points: usize, rows: usize) -> Vec<u8> {
    let header = Header {
        magic: [0; 8],
        version: 0.into(),
        total_bytes: 0.into(),
        checksum: 0.into(),
        fraction_bits: 16.into(),
        unit: [0; 16],
        scheme: SCHEME_TET_OCT.into(),
        boundary: BOUNDARY_LOOP.into(),
        levels: 1.into(),
        control_points: (control_points as u32).into(),
        rows: (rows as u32).into(),
        sections: 0.into(),
        cage_checksum: 0.into(),
        model_checksum: 0.into(),
        reserved: [0; 56],
    };
    writer::bundle(header, sections).expect("a small bundle")
}
