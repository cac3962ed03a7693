//! A stage of a table in the order in which the kernels read it.

use super::cost::Cost;
use super::group::{Group, group};
use super::writer::Section;
use super::{Layout, Taps};
use octruss::bundle;
use zerocopy::IntoBytes;

/// A packed stage.
#[derive(Clone, Debug)]
pub struct Stage {
    layout: Layout,
    inputs: usize,
    /// The row of the caller that each packed row is.
    pub order: Vec<usize>,
    groups: Vec<[u16; 2]>,
    indices: Vec<u16>,
    weights: Vec<i32>,
    starts: Starts,
    /// Instructions that applying it takes, estimated.
    pub instructions: f64,
}

/// What the sums of rows start from.
#[derive(Clone, Debug)]
enum Starts {
    None,
    Narrow(Vec<[i32; 3]>),
    Wide(Vec<[i64; 3]>),
    Rest(Vec<[i32; 3]>),
}

/// What a stage is packed from.
pub struct Source<'a, Row> {
    /// Rows of integer weights.
    pub rows: &'a [Row],
    /// Bits of the inputs at rest.
    pub rest_inputs: &'a [[i32; 3]],
    /// Bits of the rows' points at rest; `None` for a table of the absolute form alone.
    pub rest: Option<&'a [[i32; 3]]>,
    /// Keep the order of the rows: only neighbours then share a group.
    pub keep_order: bool,
}

impl Stage {
    /// Packs rows. `None` if a number does not fit: more than 65 536 inputs, rows of more than
    /// 65 535 taps, or a rest position too far from where the inputs put it.
    pub fn new<Row: AsRef<Taps>>(source: &Source<'_, Row>, layout: Layout) -> Option<Self> {
        let cost = Cost::of(layout);
        let groups = if source.keep_order {
            neighbours(source.rows)
        } else {
            group(source.rows, &cost)
        };
        let order: Vec<usize> = groups
            .iter()
            .flat_map(|group| &group.rows)
            .copied()
            .collect();
        let mut stage = Self {
            layout,
            inputs: source.rest_inputs.len(),
            groups: Vec::with_capacity(groups.len()),
            indices: Vec::new(),
            weights: Vec::new(),
            starts: starts(source, layout, &order)?,
            order,
            instructions: 0.0,
        };
        for group in &groups {
            stage.push(group, source.rows, &cost)?;
            stage.instructions += cost.group(group.rows.len(), group.points.len());
        }
        Some(stage)
    }

    fn push(&mut self, group: &Group, rows: &[impl AsRef<Taps>], cost: &Cost) -> Option<()> {
        let taps = cost.taps(group.points.len());
        let [count, taps_16] = [group.rows.len(), taps].map(u16::try_from);
        self.groups.push([count.ok()?, taps_16.ok()?]);
        // A tap that only fills up names the last point again, with weight zero.
        let last = group.points.last().copied();
        let filling = std::iter::repeat_n(last?, taps - group.points.len());
        for point in group.points.iter().copied().chain(filling) {
            self.indices.push(u16::try_from(point).ok()?);
        }
        let dense = group.rows.iter().map(|&row| {
            let mut dense = vec![0; taps];
            let mut place = 0;
            for &(point, weight) in rows[row].as_ref() {
                place += group.points[place..]
                    .iter()
                    .position(|&other| other == point)?;
                dense[place] = weight;
            }
            Some(dense)
        });
        let dense: Vec<Vec<i32>> = dense.collect::<Option<_>>()?;
        match self.layout {
            Layout::Q30 | Layout::Q14 => self.weights.extend(dense.into_iter().flatten()),
            Layout::Compact { .. } => {
                for rows in dense.chunks(2) {
                    for tap in (0..taps).step_by(2) {
                        let both = rows.iter().flat_map(|row| &row[tap..tap + 2]);
                        self.weights.extend(both);
                    }
                }
            }
        }
        Some(())
    }

    /// Weights stored, those included that only fill a group.
    pub fn stored_taps(&self) -> usize {
        self.weights.len()
    }

    /// Groups of rows.
    pub fn group_count(&self) -> usize {
        self.groups.len()
    }

    /// Bytes of groups, indices and weights.
    pub fn tap_bytes(&self) -> usize {
        4 * self.groups.len()
            + 2 * self.indices.len()
            + self.layout.weight_bytes() * self.weights.len()
    }

    /// The sections of this stage.
    pub fn sections(&self, number: u32) -> Vec<Section> {
        let (format, shift) = match self.layout {
            Layout::Q30 => (bundle::FORMAT_Q30, 0),
            Layout::Q14 => (bundle::FORMAT_Q14, 0),
            Layout::Compact { shift } => (bundle::FORMAT_COMPACT, shift),
        };
        let (starts, start_bytes) = match &self.starts {
            Starts::None => (bundle::STARTS_NONE, Vec::new()),
            Starts::Narrow(starts) => (bundle::STARTS_NARROW, starts.as_bytes().to_vec()),
            Starts::Wide(starts) => (bundle::STARTS_WIDE, starts.as_bytes().to_vec()),
            Starts::Rest(rest) => (bundle::STARTS_REST, rest.as_bytes().to_vec()),
        };
        let record = bundle::Stage {
            inputs: (self.inputs as u32).into(),
            rows: (self.order.len() as u32).into(),
            format: format.into(),
            starts: starts.into(),
            displacement_shift: shift.into(),
            reserved: [0; 12],
        };
        let weights = match self.layout.weight_bytes() {
            4 => self.weights.as_bytes().to_vec(),
            // Magnitudes that add up to at most two and a sum of one leave at most 1.5.
            _ => self
                .weights
                .iter()
                .flat_map(|&weight| (weight as i16).to_le_bytes())
                .collect(),
        };
        let mut sections = vec![
            (bundle::SECTION_STAGE, record.as_bytes().to_vec()),
            (bundle::SECTION_GROUPS, self.groups.as_bytes().to_vec()),
            (bundle::SECTION_INDICES, self.indices.as_bytes().to_vec()),
            (bundle::SECTION_WEIGHTS, weights),
        ];
        if !matches!(self.starts, Starts::None) {
            sections.push((bundle::SECTION_STARTS, start_bytes));
        }
        let section = |(kind, bytes)| Section {
            kind,
            stage: number,
            bytes,
        };
        sections.into_iter().map(section).collect()
    }
}

/// Groups of neighbours with the same points.
fn neighbours(rows: &[impl AsRef<Taps>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (row, taps) in rows.iter().enumerate() {
        let points: Vec<u32> = taps.as_ref().iter().map(|(point, _)| *point).collect();
        match groups.last_mut() {
            Some(last) if last.points == points && last.rows.len() < usize::from(u16::MAX) => {
                last.rows.push(row);
            }
            _ => groups.push(Group {
                points,
                rows: vec![row],
            }),
        }
    }
    groups
}

/// What the rows start from, in the packed order; `None` if it does not fit.
fn starts<Row: AsRef<Taps>>(
    source: &Source<'_, Row>,
    layout: Layout,
    order: &[usize],
) -> Option<Starts> {
    let Some(rest) = source.rest else {
        let absolute = !matches!(layout, Layout::Compact { .. });
        return absolute.then_some(Starts::None);
    };
    if let Layout::Compact { .. } = layout {
        return Some(Starts::Rest(order.iter().map(|&row| rest[row]).collect()));
    }
    let bits = layout.weight_bits();
    let wide = order.iter().map(|&row| {
        let start = |axis: usize| {
            let weighted = source.rows[row].as_ref().iter().map(|&(point, weight)| {
                i128::from(weight) * i128::from(source.rest_inputs[point as usize][axis])
            });
            let residual = (i128::from(rest[row][axis]) << bits) - weighted.sum::<i128>();
            let start = i64::try_from(residual + (1 << (bits - 1))).ok()?;
            (start.unsigned_abs() <= bundle::START_LIMIT.unsigned_abs()).then_some(start)
        };
        Some([start(0)?, start(1)?, start(2)?])
    });
    let wide: Vec<[i64; 3]> = wide.collect::<Option<_>>()?;
    let narrow = wide.iter().map(|start| {
        let [x, y, z] = start.map(i32::try_from);
        Some([x.ok()?, y.ok()?, z.ok()?])
    });
    Some(match narrow.collect::<Option<Vec<[i32; 3]>>>() {
        Some(narrow) => Starts::Narrow(narrow),
        None => Starts::Wide(wide),
    })
}
