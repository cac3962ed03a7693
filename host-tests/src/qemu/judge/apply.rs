//! Tables in bundles.

use octruss_bake::pack::Layout;
use octruss_firmware::cases::{APPLY, SECTION_ROWS};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_bundle::{BundleCase, layout};
use crate::random_table::ApplyCase;
use crate::reference::Table;

/// Forms of the apply as the case says them.
const DISPLACEMENT: u32 = 0;
const ABSOLUTE: u32 = 1;
const COMPACT: u32 = 2;

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    const ROWS: usize = 16;
    const POINTS: u16 = 48;
    let layout = layout(u64::from(seed / 10));
    let bundle = BundleCase::new(u64::from(seed), ROWS, POINTS, layout);
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let start = rng.random_range(0..=bundle.order.len());
    let end = rng.random_range(start..=bundle.order.len());
    let form = match layout {
        Layout::Compact { .. } => COMPACT,
        _ if rng.random() => ABSOLUTE,
        _ => DISPLACEMENT,
    };
    let pose = &bundle.case.pose;
    let numbers = [start, end, end - start, pose.len(), bundle.bytes.len()];
    let mut words = vec![form];
    words.extend(numbers.map(word));
    words.extend(bundle_words(&bundle.bytes));
    words.extend(bits(pose));
    let judged = Judged::sound(APPLY, seed, words, applied(&bundle, start, end, form));
    if seed.is_multiple_of(10) {
        judged.damaged(&mut rng)
    } else {
        judged
    }
}

/// A bundle's bytes as a case tells them.
pub(super) fn bundle_words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.chunks(4).map(|chunk| {
        let mut bytes = [0; 4];
        bytes[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(bytes)
    })
}

/// These rows alone, for only they may count what saturates.
fn applied(bundle: &BundleCase, start: usize, end: usize, form: u32) -> Expected {
    let part = rows_of(bundle, start, end);
    let (applied, clamped) = match form {
        ABSOLUTE => (part.absolute(), 0),
        _ => part.displaced(),
    };
    let mut words = vec![word(applied.saturated), clamped];
    words.extend(bits(&applied.points));
    Expected {
        sections: vec![Section {
            tag: SECTION_ROWS,
            words,
        }],
        coordinates: 3 * applied.points.len(),
        saturated: applied.saturated,
        ..Expected::default()
    }
}

/// A range of a bundle's rows as a case of its own, in the bundle's order.
pub(super) fn rows_of(bundle: &BundleCase, start: usize, end: usize) -> BundleCase {
    let whole = &bundle.case;
    let mut table = Table {
        offsets: vec![0],
        ..Table::default()
    };
    let rows = &bundle.order[start..end];
    for &row in rows {
        for (point, weight) in whole.table.row(row) {
            table.indices.push(point);
            table.weights.push(weight);
        }
        table.offsets.push(word(table.indices.len()));
    }
    BundleCase {
        layout: bundle.layout,
        case: ApplyCase {
            seed: whole.seed,
            table,
            pose: whole.pose.clone(),
            rest_pose: whole.rest_pose.clone(),
            rest: rows.iter().map(|&row| whole.rest[row]).collect(),
        },
        bytes: Vec::new(),
        order: (0..rows.len()).collect(),
    }
}
