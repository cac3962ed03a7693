//! The faces round every point of a model, in the order in which core forms normals from them.

use super::writer::Section;
use crate::error::{Error, Result};
use octruss::bundle::{NormalsRecord, SECTION_NORMALS};
use octruss::deform::{MOST_CORNERS, MOST_EDGE_SHIFT};
use std::collections::BTreeMap;
use zerocopy::IntoBytes;

/// Says that another fan of the same point follows.
const MORE: u16 = 1 << 15;

/// What there is to say about baked normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct NormalsReport {
    /// Corners of faces.
    pub corners: usize,
    /// Edges are in units of 2^shift units in the last place.
    pub shift: u32,
    /// Bytes of the section.
    pub bytes: usize,
}

/// The section for a table whose rows are the points `order` of a model with these faces. `rest` holds the
/// model's points at rest in their own order.
///
/// # Errors
/// If a face names a point that does not exist, or there are more than 65 536 points or more than 512
/// corners at a point.
pub fn section(
    faces: &[Vec<u32>],
    order: &[usize],
    rest: &[[i32; 3]],
) -> Result<(Section, NormalsReport)> {
    if order.len() > 1 << 16 {
        return Err(Error::new(format!(
            "the model has {} points; normals are for at most 65536",
            order.len()
        )));
    }
    let mut row_of = vec![None; rest.len()];
    for (row, &point) in order.iter().enumerate() {
        row_of[point] = Some(row);
    }
    let mut corners: Vec<Vec<[u16; 2]>> = vec![Vec::new(); order.len()];
    for face in faces {
        for (place, &at) in face.iter().enumerate() {
            let behind = face[(place + 1) % face.len()];
            let before = face[(place + face.len() - 1) % face.len()];
            let row = |point: u32| {
                let row = row_of.get(point as usize).copied().flatten();
                row.ok_or_else(|| {
                    Error::new(format!("a face names point {point}, which is not there"))
                })
            };
            let narrow = |row: usize| row as u16;
            corners[row(at)?].push([narrow(row(behind)?), narrow(row(before)?)]);
        }
    }
    let shift = edge_shift(faces, rest);
    let count = corners.iter().map(Vec::len).sum();
    let mut words = Vec::new();
    for (row, corners) in corners.into_iter().enumerate() {
        if corners.len() > MOST_CORNERS {
            return Err(Error::new(format!(
                "{} faces meet at point {}; normals are for at most {MOST_CORNERS}",
                corners.len(),
                order[row]
            )));
        }
        push_fans(&mut words, chains(corners));
    }
    let record = NormalsRecord {
        rows: (order.len() as u32).into(),
        shift: shift.into(),
        words: (words.len() as u32).into(),
        reserved: [0; 4],
    };
    let bytes = [record.as_bytes(), words.as_bytes()].concat();
    let report = NormalsReport {
        corners: count,
        shift,
        bytes: bytes.len(),
    };
    let section = Section {
        kind: SECTION_NORMALS,
        stage: 0,
        bytes,
    };
    Ok((section, report))
}

/// The least shift with which edges four times as long as the longest at rest are not clamped.
fn edge_shift(faces: &[Vec<u32>], rest: &[[i32; 3]]) -> u32 {
    let mut longest = 0;
    for face in faces {
        for (place, &from) in face.iter().enumerate() {
            let to = face[(place + 1) % face.len()];
            let ends = rest[from as usize].iter().zip(&rest[to as usize]);
            longest = ends.fold(longest, |longest, (a, b)| longest.max(a.abs_diff(*b)));
        }
    }
    let fits = |shift: &u32| 4 * (u64::from(longest) >> shift) < 1 << 26;
    (0..MOST_EDGE_SHIFT).find(fits).unwrap_or(MOST_EDGE_SHIFT)
}

/// Corners put one behind the other wherever one ends where another starts; a closed ring names its first
/// neighbour again at its end.
fn chains(corners: Vec<[u16; 2]>) -> Vec<Vec<u16>> {
    let mut by_start: BTreeMap<u16, Vec<u16>> = BTreeMap::new();
    let mut ends: BTreeMap<u16, usize> = BTreeMap::new();
    for [start, end] in corners {
        by_start.entry(start).or_default().push(end);
        *ends.entry(end).or_default() += 1;
    }
    let mut chains = Vec::new();
    loop {
        // Open chains first, from a neighbour at which none ends; then rings from anywhere.
        let left = || by_start.iter().filter(|(_, to)| !to.is_empty());
        let open = left().find(|(start, to)| to.len() > ends.get(start).copied().unwrap_or(0));
        let Some((&start, _)) = open.or_else(|| left().next()) else {
            return chains;
        };
        let mut chain = vec![start];
        let mut at = start;
        while let Some(next) = by_start.get_mut(&at).and_then(Vec::pop) {
            if let Some(count) = ends.get_mut(&next) {
                *count -= 1;
            }
            chain.push(next);
            at = next;
        }
        chains.push(chain);
    }
}

fn push_fans(words: &mut Vec<u16>, chains: Vec<Vec<u16>>) {
    let count = chains.len();
    if count == 0 {
        words.push(0);
    }
    for (place, chain) in chains.into_iter().enumerate() {
        let more = if place + 1 < count { MORE } else { 0 };
        // At most 512 corners, and one neighbour more.
        words.push(chain.len() as u16 | more);
        words.extend(chain);
    }
}

#[cfg(test)]
mod tests {
    use super::{chains, section};

    #[test]
    fn a_ring_closes_and_a_fan_stays_open() {
        assert_eq!(chains(vec![[1, 2], [3, 1], [2, 3]]), [vec![1, 2, 3, 1]]);
        assert_eq!(chains(vec![[5, 6], [4, 5]]), [vec![4, 5, 6]]);
        // Two fans that touch only at the point.
        assert_eq!(chains(vec![[1, 2], [7, 8]]), [vec![1, 2], vec![7, 8]]);
        assert!(chains(Vec::new()).is_empty());
    }

    #[test]
    fn rows_are_in_the_order_of_the_table() {
        // One triangle; rows are the points 2, 0, 1, and point 3 is on no face.
        let rest = [[0; 3], [1 << 24, 0, 0], [0, 1, 0], [0; 3]];
        let (section, report) = section(&[vec![0, 1, 2]], &[2, 0, 1, 3], &rest).unwrap();
        let words: Vec<u16> = section.bytes[16..]
            .chunks(2)
            .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
            .collect();
        // Point 2 lies between 0 and 1 (rows 1 and 2), point 0 between 1 and 2, point 1 between 2 and 0.
        assert_eq!(words, [2, 1, 2, 2, 2, 0, 2, 0, 1, 0]);
        // Four times 2^24 is 2^26, just too much for no shift.
        assert_eq!((report.corners, report.shift, report.bytes), (3, 1, 36));
    }

    #[test]
    fn a_face_that_names_nothing_is_refused() {
        let error = section(&[vec![0, 1, 9]], &[0, 1], &[[0; 3]; 2]).unwrap_err();
        assert_eq!(error.message(), "a face names point 9, which is not there");
    }
}
