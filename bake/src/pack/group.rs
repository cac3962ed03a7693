//! Finds rows that share, or nearly share, their points.
//!
//! Rows with the same points form a group. Two groups become one wherever that costs fewer instructions:
//! the points are gathered once instead of twice, and rows get zeros for the points that only the
//! others have.

use super::Taps;
use super::cost::Cost;
use std::collections::BTreeMap;

/// The most points of a group that the kernels gather.
pub const MOST_POINTS: usize = 64;

/// The most rows of a group.
const MOST_ROWS: usize = u16::MAX as usize;

/// Groups that are compared with one another; longer lists are cut into pieces of this many neighbours.
const PIECE: usize = 2_000;

/// Rows that share their points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The points, ascending.
    pub points: Vec<u32>,
    /// The rows, ascending.
    pub rows: Vec<usize>,
}

/// Groups the rows of a table; groups come in the order of their first rows.
pub fn group(rows: &[impl AsRef<Taps>], cost: &Cost) -> Vec<Group> {
    let mut by_points: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    for (row, taps) in rows.iter().enumerate() {
        let points = taps.as_ref().iter().map(|(point, _)| *point).collect();
        by_points.entry(points).or_default().push(row);
    }
    let mut groups: Vec<Group> = by_points
        .into_iter()
        .map(|(points, rows)| Group { points, rows })
        .collect();
    // Rows that are neighbours in the model are likely to share points.
    groups.sort_by_key(|group| group.rows[0]);
    let pieces = groups.chunks(PIECE);
    let mut groups: Vec<Group> = pieces
        .flat_map(|piece| merge(piece.to_vec(), cost))
        .collect();
    for group in &mut groups {
        group.rows.sort_unstable();
    }
    groups.sort_by_key(|group| group.rows[0]);
    groups
}

/// Merges the two groups that gain most, again and again, until none gains.
fn merge(groups: Vec<Group>, cost: &Cost) -> Vec<Group> {
    let mut groups: Vec<Option<Group>> = groups.into_iter().map(Some).collect();
    let mut best: Vec<Option<(f64, usize)>> = (0..groups.len())
        .map(|index| best_partner(&groups, index, cost))
        .collect();
    loop {
        let candidates = best
            .iter()
            .enumerate()
            .filter_map(|(index, best)| best.map(|(gain, partner)| (gain, index, partner)));
        let Some((_, index, partner)) =
            candidates.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
        else {
            return groups.into_iter().flatten().collect();
        };
        if let (Some(one), Some(other)) = (groups[index].take(), groups[partner].take()) {
            groups[index] = Some(joined(&one, &other));
        }
        best[partner] = None;
        best[index] = best_partner(&groups, index, cost);
        for other in 0..groups.len() {
            let stale = best[other].is_some_and(|(_, to)| to == index || to == partner);
            if other == index || groups[other].is_none() {
                continue;
            }
            if stale {
                best[other] = best_partner(&groups, other, cost);
            } else if let Some(gain) = gain(&groups, other, index, cost)
                && best[other].is_none_or(|(known, _)| gain > known)
            {
                best[other] = Some((gain, index));
            }
        }
    }
}

/// The partner with which a group gains most, if it gains with any.
fn best_partner(groups: &[Option<Group>], index: usize, cost: &Cost) -> Option<(f64, usize)> {
    let gains =
        (0..groups.len()).filter_map(|other| Some((gain(groups, index, other, cost)?, other)));
    gains.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
}

/// Instructions that one group of two saves, if it saves any and the kernels can take it.
fn gain(groups: &[Option<Group>], one: usize, other: usize, cost: &Cost) -> Option<f64> {
    let (Some(one), Some(other)) = (&groups[one], &groups[other]) else {
        return None;
    };
    let rows = one.rows.len() + other.rows.len();
    if std::ptr::eq(one, other) || rows > MOST_ROWS {
        return None;
    }
    let points = union_size(&one.points, &other.points);
    if points > MOST_POINTS {
        return None;
    }
    let apart = |group: &Group| cost.group(group.rows.len(), group.points.len());
    let gain = apart(one) + apart(other) - cost.group(rows, points);
    (gain > 0.0).then_some(gain)
}

fn union_size(a: &[u32], b: &[u32]) -> usize {
    let (mut i, mut j, mut size) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        let (x, y) = (a[i], b[j]);
        i += usize::from(x <= y);
        j += usize::from(y <= x);
        size += 1;
    }
    size + (a.len() - i) + (b.len() - j)
}

fn joined(one: &Group, other: &Group) -> Group {
    let mut points = [one.points.as_slice(), &other.points].concat();
    points.sort_unstable();
    points.dedup();
    Group {
        points,
        rows: [one.rows.as_slice(), &other.rows].concat(),
    }
}
