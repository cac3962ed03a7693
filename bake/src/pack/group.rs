//! Finds rows that share, or nearly share, their points.
//!
//! Rows with the same points form a group. Two groups become one wherever that costs fewer instructions:
//! the points are gathered once instead of twice, and rows get zeros for the points that only the
//! others have.

use super::Taps;
use super::cost::Cost;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The most points of a group that the kernels gather.
pub const MOST_POINTS: usize = 64;

/// The most rows of a group.
const MOST_ROWS: usize = u16::MAX as usize;

/// Groups that are compared with one another: lists are cut into pieces of so many neighbours, because the
/// time grows with the square of a piece.
const PIECE: usize = 2_000;

/// Up to so many groups the pieces are large; beyond, time counts for more than the last few merges.
const FEW: usize = 2 * PIECE;

/// The size of a piece where there are many groups.
const PIECE_OF_MANY: usize = 400;

/// Where groups name so many points together that their sets take more words than this, lists of them are
/// compared instead.
const FEW_WORDS: usize = 32;

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
    let piece = match groups.len() {
        0..=FEW => PIECE,
        _ => PIECE_OF_MANY,
    };
    let pieces = groups.par_chunks(piece);
    let mut groups: Vec<Group> = pieces
        .flat_map_iter(|piece| merge(piece.to_vec(), cost))
        .collect();
    for group in &mut groups {
        group.rows.sort_unstable();
    }
    groups.sort_by_key(|group| group.rows[0]);
    groups
}

/// Merges the two groups that gain most, again and again, until none gains.
fn merge(groups: Vec<Group>, cost: &Cost) -> Vec<Group> {
    let mut groups = Candidates::new(groups, cost);
    let mut best: Vec<Option<Best>> = (0..groups.len())
        .map(|index| groups.best_partner(index))
        .collect();
    while let Some((index, found)) = greatest(&best) {
        let Some(partner) = found.partner else {
            // Nothing is known to be greater than this group's bound, so it is worth a search.
            best[index] = groups.best_partner(index);
            continue;
        };
        groups.join(index, partner);
        best[partner] = None;
        best[index] = groups.best_partner(index);
        for (other, known) in best.iter_mut().enumerate() {
            if other == index || groups.is_gone(other) {
                continue;
            }
            if let Some(known) = known
                && (known.partner == Some(index) || known.partner == Some(partner))
            {
                // What is left for it gains no more than what it has lost.
                known.partner = None;
            }
            if let Some(gain) = groups.gain(other, index)
                && known.is_none_or(|known| gain > known.gain)
            {
                *known = Some(Best {
                    gain,
                    partner: Some(index),
                });
            }
        }
    }
    groups.into_groups()
}

/// The partner with which a group gains most; without a partner, a bound of that gain.
#[derive(Clone, Copy, Debug)]
struct Best {
    gain: f64,
    partner: Option<usize>,
}

/// The group with the greatest gain or bound, the first of several.
fn greatest(best: &[Option<Best>]) -> Option<(usize, Best)> {
    let known = best.iter().enumerate();
    known
        .filter_map(|(index, best)| Some((index, (*best)?)))
        .max_by(|a, b| a.1.gain.total_cmp(&b.1.gain).then(b.0.cmp(&a.0)))
}

/// Groups that may be merged, with their points as sets of bits: the sizes of unions are what takes the
/// time.
struct Candidates<'a> {
    /// `None` once it is part of another.
    groups: Vec<Option<Group>>,
    /// A bit for each point that any group names, the same for all groups.
    bits: Vec<u64>,
    words: usize,
    /// What each group costs alone.
    alone: Vec<f64>,
    cost: &'a Cost,
}

impl<'a> Candidates<'a> {
    fn new(groups: Vec<Group>, cost: &'a Cost) -> Self {
        let mut named: Vec<u32> = groups
            .iter()
            .flat_map(|group| &group.points)
            .copied()
            .collect();
        named.sort_unstable();
        named.dedup();
        let words = named.len().div_ceil(64);
        let mut bits = vec![0; words * groups.len()];
        for (group, bits) in groups.iter().zip(bits.chunks_exact_mut(words.max(1))) {
            let mut place = 0;
            for point in &group.points {
                // Both lists ascend.
                place += named[place..].partition_point(|other| other < point);
                bits[place / 64] |= 1 << (place % 64);
            }
        }
        let alone = |group: &Group| cost.group(group.rows.len(), group.points.len());
        Self {
            alone: groups.iter().map(alone).collect(),
            groups: groups.into_iter().map(Some).collect(),
            bits,
            words,
            cost,
        }
    }

    fn len(&self) -> usize {
        self.groups.len()
    }

    fn is_gone(&self, index: usize) -> bool {
        self.groups[index].is_none()
    }

    fn into_groups(self) -> Vec<Group> {
        self.groups.into_iter().flatten().collect()
    }

    fn bits(&self, index: usize) -> &[u64] {
        &self.bits[index * self.words..][..self.words]
    }

    /// Makes the second group part of the first.
    fn join(&mut self, index: usize, partner: usize) {
        let (Some(one), Some(other)) = (self.groups[index].take(), self.groups[partner].take())
        else {
            return;
        };
        let group = joined(&one, &other);
        self.alone[index] = self.cost.group(group.rows.len(), group.points.len());
        self.groups[index] = Some(group);
        for word in 0..self.words {
            self.bits[index * self.words + word] |= self.bits[partner * self.words + word];
        }
    }

    /// The partner with which a group gains most, if it gains with any.
    fn best_partner(&self, index: usize) -> Option<Best> {
        let gains = (0..self.len()).filter_map(|other| Some((self.gain(index, other)?, other)));
        let (gain, partner) = gains.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
        Some(Best {
            gain,
            partner: Some(partner),
        })
    }

    /// Instructions that one group of two saves, if it saves any and the kernels can take it.
    fn gain(&self, index: usize, partner: usize) -> Option<f64> {
        let (Some(one), Some(other)) = (&self.groups[index], &self.groups[partner]) else {
            return None;
        };
        let rows = one.rows.len() + other.rows.len();
        if index == partner || rows > MOST_ROWS {
            return None;
        }
        let apart = self.alone[index] + self.alone[partner];
        // More points cost more: if nothing is gained even where the one holds all of the other's, the
        // union need not be counted.
        let most = one.points.len().max(other.points.len());
        if most > MOST_POINTS || apart <= self.cost.group(rows, most) {
            return None;
        }
        let points = match self.words {
            0..=FEW_WORDS => {
                let both = self.bits(index).iter().zip(self.bits(partner));
                both.map(|(one, other)| (one | other).count_ones() as usize)
                    .sum()
            }
            _ => union_size(&one.points, &other.points),
        };
        if points > MOST_POINTS {
            return None;
        }
        let gain = apart - self.cost.group(rows, points);
        (gain > 0.0).then_some(gain)
    }
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
