//! Subdivision matrices of a neighbourhood: what a scheme does around one point, level by level.
//!
//! Vertices are named by where the linear split puts them: integer barycentric coordinates over
//! the base mesh's vertices, scaled by 2^level. Relative to a centre that is a vertex, the same
//! offset at one level and the next is the same place in the mesh seen at half the size. So a
//! set of offsets that depends on nothing but itself has a square subdivision matrix.

use std::collections::{BTreeMap, BTreeSet};

use crate::rational::{BigRational, Row};
use crate::reference::{Boundary, Solid, split};
use crate::subject::Scheme;

/// Integer barycentric coordinates, or the difference of two of them.
pub type Offset = Vec<i32>;

/// A solid with the places of its vertices over a base mesh.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Connectivity.
    pub solid: Solid,
    /// Barycentric coordinates of each vertex, times 2^level.
    pub places: Vec<Offset>,
}

impl Placed {
    /// A base mesh of tetrahedra: every vertex is its own base vertex.
    pub fn base(solid: Solid) -> Self {
        let count = solid.vertex_count;
        let unit = |vertex| (0..count).map(move |other| i32::from(other == vertex));
        let places = (0..solid.vertex_count)
            .map(|vertex| unit(vertex).collect())
            .collect();
        Self { solid, places }
    }

    /// The next level.
    ///
    /// A base mesh of tetrahedra leaves the centroids of octahedra on the integer grid: six
    /// times a centroid is the sum of its corners, and twice a centroid a third of that.
    pub fn split(&self) -> Self {
        let linear = split(&self.solid);
        let sum = |parents: &[u32]| -> Offset {
            let base = 0..self.places.first().map_or(0, Vec::len);
            let at = |i: usize| {
                parents
                    .iter()
                    .map(|parent| self.places[*parent as usize][i])
                    .sum()
            };
            base.map(at).collect()
        };
        let mut places: Vec<Offset> = (0..)
            .take(self.places.len())
            .map(|v| sum(&[v, v]))
            .collect();
        places.extend(linear.edges.iter().map(|ends| sum(ends)));
        places.extend(linear.octahedra.iter().map(|(corners, _)| {
            let sum = sum(corners);
            assert!(
                sum.iter().all(|coordinate| coordinate % 3 == 0),
                "not on the grid"
            );
            sum.into_iter().map(|coordinate| coordinate / 3).collect()
        }));
        Self {
            solid: linear.solid,
            places,
        }
    }

    /// The level reached after `levels` splits.
    pub fn at_level(&self, levels: usize) -> Self {
        (0..levels).fold(self.clone(), |level, _| level.split())
    }

    /// The cells all of whose corners lie within `radius` of `centre`, renumbered.
    pub fn near(&self, centre: &Offset, radius: i32) -> Self {
        let is_near: Vec<bool> = self
            .places
            .iter()
            .map(|place| size(&difference(place, centre)) <= radius)
            .collect();
        let mut names = BTreeMap::new();
        let mut near = Self {
            solid: Solid::default(),
            places: Vec::new(),
        };
        let mut rename = |corner: u32| {
            *names.entry(corner).or_insert_with(|| {
                near.places.push(self.places[corner as usize].clone());
                near.places.len() as u32 - 1
            })
        };
        for cell in &self.solid.tetrahedra {
            if cell.iter().all(|corner| is_near[*corner as usize]) {
                near.solid.tetrahedra.push(cell.map(&mut rename));
            }
        }
        for cell in &self.solid.octahedra {
            if cell.iter().all(|corner| is_near[*corner as usize]) {
                near.solid.octahedra.push(cell.map(&mut rename));
            }
        }
        near.solid.vertex_count = near.places.len();
        near
    }
}

/// The difference of two places.
pub fn difference(one: &Offset, other: &Offset) -> Offset {
    one.iter().zip(other).map(|(a, b)| a - b).collect()
}

fn sum(one: &Offset, other: &Offset) -> Offset {
    one.iter().zip(other).map(|(a, b)| a + b).collect()
}

/// The greatest magnitude of a coordinate.
fn size(offset: &Offset) -> i32 {
    offset
        .iter()
        .map(|coordinate| coordinate.abs())
        .max()
        .unwrap_or(0)
}

/// What a scheme does around a vertex.
#[derive(Clone, Debug)]
pub struct Neighbourhood {
    radius: i32,
    /// For each new vertex, by its offset from the centre in units of its level, the weights
    /// of the old vertices, by theirs.
    rows: BTreeMap<Offset, BTreeMap<Offset, BigRational>>,
}

impl Neighbourhood {
    /// The masks around `centre`, a place at the level of `placed`. Only the cells within
    /// `radius` are looked at.
    pub fn new(scheme: &dyn Scheme, placed: &Placed, centre: &Offset, radius: i32) -> Self {
        let near = placed.near(centre, radius);
        let twice_centre: Offset = centre.iter().map(|coordinate| 2 * coordinate).collect();
        let (solid, masks) = scheme.masks(&near.solid, Boundary::Interior);
        let refined = near.split();
        assert_eq!(
            solid,
            refined.solid,
            "the connectivity of {}",
            scheme.name()
        );
        let by_offset = |row: &Row| {
            let entries = row.iter();
            let offset = |vertex: &u32| difference(&near.places[*vertex as usize], centre);
            entries
                .map(|(vertex, weight)| (offset(vertex), weight.clone()))
                .collect()
        };
        let places = refined
            .places
            .iter()
            .map(|place| difference(place, &twice_centre));
        let rows = places.zip(masks.iter().map(by_offset)).collect();
        Self { radius, rows }
    }

    /// The weights of the new vertex at an offset.
    ///
    /// # Panics
    /// If there is no such vertex, or it lies so far out that cells around it were left out.
    pub fn row(&self, offset: &Offset) -> &BTreeMap<Offset, BigRational> {
        // Cells around it reach one old unit, two new ones, farther.
        assert!(
            size(offset) + 2 <= 2 * self.radius,
            "{offset:?} is too far out"
        );
        self.rows.get(offset).expect("an offset of a vertex")
    }

    /// The smallest set that contains `seeds` and, for every shift, all that the vertices at the
    /// shift plus an offset of the set depend on; in ascending order.
    pub fn closure(&self, seeds: &[Offset], shifts: &[Offset]) -> Vec<Offset> {
        let mut set = BTreeSet::new();
        let mut left = seeds.to_vec();
        while let Some(offset) = left.pop() {
            if set.insert(offset.clone()) {
                for shift in shifts {
                    left.extend(self.row(&sum(shift, &offset)).keys().cloned());
                }
            }
        }
        set.into_iter().collect()
    }

    /// The matrix that maps a set of offsets to the set of the next level shifted by `shift`.
    pub fn matrix(&self, set: &[Offset], shift: &Offset) -> Vec<Vec<BigRational>> {
        let zero = crate::rational::ratio(0, 1);
        let entries = |offset: &Offset| {
            let row = self.row(&sum(shift, offset));
            assert!(
                row.keys().all(|other| set.contains(other)),
                "the set is not closed"
            );
            set.iter()
                .map(|other| row.get(other).unwrap_or(&zero).clone())
                .collect()
        };
        set.iter().map(entries).collect()
    }
}
