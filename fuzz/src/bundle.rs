//! Bytes as a bundle, as they are and with the outermost seals mended.

use octruss::bundle::{Bundle, Header, MAGIC, VERSION, checksum};
use octruss::deform::{CompactTable, Displacement, Table};
use zerocopy::{FromBytes, IntoBytes};

/// Opens the bytes as they are; then with the magic, the version, the length and the checksum that
/// they ought to have, without which hardly any would get past the first check. Whatever opens is
/// applied in every way that there is.
pub fn bundle(bytes: &[u8]) {
    let mut words = vec![0_u64; bytes.len().div_ceil(size_of::<u64>())];
    words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
    open(&words.as_bytes()[..bytes.len()]);
    let length = bytes.len();
    let bytes = &mut words.as_mut_bytes()[..length];
    if let Ok((header, _)) = Header::mut_from_prefix(bytes) {
        header.magic = MAGIC;
        header.version = VERSION.into();
        header.total_bytes = u32::try_from(length).unwrap_or(0).into();
    }
    let sum = checksum(bytes);
    if let Ok((header, _)) = Header::mut_from_prefix(bytes) {
        header.checksum = sum.into();
    }
    open(bytes);
}

fn open(bytes: &[u8]) {
    let bundle = match Bundle::new_checked(bytes) {
        Ok(bundle) => bundle,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    let seed = checksum(bytes);
    let _ = bundle.unit();
    let rows = usize::try_from(bundle.header().rows.get()).expect("a count of what is there");
    assert!(bundle.model_points().iter().all(|point| point < rows));
    let pose = pose(bundle.rest_cage(), seed);
    if let Ok(table) = bundle.table::<i32>() {
        wide(&table, &pose, seed);
    }
    if let Ok([first, second]) = bundle.factored_table::<i32>() {
        let points = wide(&first, &pose, seed);
        wide(&second, &points, seed);
    }
    if let Ok(table) = bundle.compact_table::<i32>() {
        compact(&table, &pose, seed);
    }
    if let Ok([first, second]) = bundle.compact_factored_table::<i32>() {
        let points = compact(&first, &pose, seed);
        compact(&second, &points, seed);
    }
    for region in 0..2 {
        let _ = bundle.volume_form::<i32>(region);
    }
}

/// Positions that look random and reach the ends of the range.
fn pose(rest: &[[i32; 3]], seed: u32) -> Vec<[i32; 3]> {
    let mut state = seed | 1;
    let mut bits = |rest: i32| {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        match state % 4 {
            0 => rest,
            1 => i32::MAX,
            2 => i32::MIN,
            _ => state.cast_signed(),
        }
    };
    rest.iter().map(|point| point.map(&mut bits)).collect()
}

/// Marks of moved control points.
fn marks(count: usize, seed: u32) -> Vec<bool> {
    (0..count).map(|point| seed >> (point % 32) & 1 == 1).collect()
}

fn wide(table: &Table<'_, i32>, pose: &[[i32; 3]], seed: u32) -> Vec<[i32; 3]> {
    let rows = table.rows();
    let mut out = vec![[0; 3]; rows];
    let _ = table.apply(0..rows, pose, &mut out);
    table
        .apply_absolute(0..rows, pose, &mut out)
        .expect("fitting lengths");
    let mut one = vec![[0; 3]; rows];
    table
        .apply_scalars(0..rows, pose, &mut one)
        .expect("fitting lengths");
    assert_eq!(one, out, "three channels are what positions are");
    let _ = table.apply_moved(&marks(pose.len(), seed), pose, &mut out);
    let middle = rows / 3;
    let _ = table.apply(middle..rows, pose, &mut one[middle..]);
    for row in 0..rows {
        let _ = table.start(row);
        let taps = table.row(row).expect("a row of the table");
        assert!(taps.map(|(point, _)| point).all(|point| point < pose.len()));
    }
    out
}

fn compact(table: &CompactTable<'_, i32>, pose: &[[i32; 3]], seed: u32) -> Vec<[i32; 3]> {
    let rows = table.rows();
    let mut out = vec![[0; 3]; rows];
    let mut memory = vec![Displacement::default(); pose.len()];
    let displacements = table
        .displacements(pose, &mut memory)
        .expect("fitting lengths");
    table
        .apply(0..rows, &displacements, &mut out)
        .expect("fitting lengths");
    table
        .apply_moved(&marks(pose.len(), seed), &displacements, &mut out)
        .expect("fitting lengths");
    let mut values = vec![[0; 2]; rows];
    let inputs: Vec<[i32; 2]> = pose.iter().map(|[x, y, _]| [*x, *y]).collect();
    table
        .apply_scalars(0..rows, &inputs, &mut values)
        .expect("fitting lengths");
    let middle = rows / 3;
    table
        .apply(middle..rows, &displacements, &mut out[middle..])
        .expect("fitting lengths");
    out
}
