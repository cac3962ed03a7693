//! Puts sections into a bundle.

use octruss::bundle::{self, ALIGNMENT, Header};
use zerocopy::IntoBytes;

/// A section before it has a place.
#[derive(Clone, Debug)]
pub struct Section {
    /// What it holds.
    pub kind: u32,
    /// The stage that it belongs to, or 0.
    pub stage: u32,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The model points of a table's rows as a section; `None` if the rows are in the model's order.
pub fn model_points(order: &[usize]) -> Option<Section> {
    let in_order = order.iter().enumerate().all(|(row, &point)| row == point);
    let bytes = if order.len() <= 1 << 16 {
        order
            .iter()
            .flat_map(|&point| (point as u16).to_le_bytes())
            .collect()
    } else {
        order
            .iter()
            .flat_map(|&point| (point as u32).to_le_bytes())
            .collect()
    };
    (!in_order).then_some(Section {
        kind: bundle::SECTION_MODEL_POINTS,
        stage: 0,
        bytes,
    })
}

/// The cage at rest as a section.
pub fn rest_cage(points: &[[i32; 3]]) -> Section {
    Section {
        kind: bundle::SECTION_REST_CAGE,
        stage: 0,
        bytes: points.as_bytes().to_vec(),
    }
}

/// The bytes of a bundle; fills in the header's length, number of sections and checksum. `None` if it
/// would be longer than 4 GiB.
pub fn bundle(mut header: Header, sections: &[Section]) -> Option<Vec<u8>> {
    let table_bytes = sections.len() * size_of::<bundle::Section>();
    let mut body = Vec::new();
    let mut table = Vec::new();
    let start = size_of::<Header>() + table_bytes;
    for section in sections {
        let end: usize = start + body.len();
        let offset = end.next_multiple_of(ALIGNMENT);
        body.resize(offset - start, 0);
        body.extend(&section.bytes);
        table.push(bundle::Section {
            kind: section.kind.into(),
            stage: section.stage.into(),
            offset: u32::try_from(offset).ok()?.into(),
            bytes: u32::try_from(section.bytes.len()).ok()?.into(),
        });
    }
    let total = (start + body.len()).next_multiple_of(ALIGNMENT);
    body.resize(total - start, 0);
    header.magic = bundle::MAGIC;
    header.version = bundle::VERSION.into();
    header.total_bytes = u32::try_from(total).ok()?.into();
    header.sections = (sections.len() as u32).into();
    header.checksum = 0.into();
    let mut bytes = [header.as_bytes(), table.as_bytes(), &body].concat();
    let checksum = bundle::checksum(&bytes).to_le_bytes();
    bytes[std::mem::offset_of!(Header, checksum)..][..checksum.len()].copy_from_slice(&checksum);
    Some(bytes)
}
