//! A value type that makes the crate hand out its masks: rows of numbers over the control points.

use std::collections::BTreeMap;

use num_traits::{FromPrimitive, Num};
use octruss::blend::{Blend, NeighbourWeight, WEIGHT_BITS};

/// Weights by control point.
pub type Row<T> = BTreeMap<u32, T>;

/// Rows of exact fractions or of real numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rows<T> {
    /// Takes the real number of an irrational weight instead of the device's multiple of 2^-30.
    pub real: Option<fn(f64) -> T>,
}

/// The control points themselves.
pub fn identity<T: Num + Clone>(count: u32) -> Vec<Row<T>> {
    (0..count)
        .map(|vertex| Row::from([(vertex, T::one())]))
        .collect()
}

fn whole<T: Num + FromPrimitive>(number: i64) -> T {
    match T::from_i64(number) {
        Some(value) => value,
        None => T::zero(),
    }
}

fn add<T: Num + Clone>(sum: &mut Row<T>, weight: &T, other: &Row<T>) {
    for (vertex, value) in other {
        let entry = sum.entry(*vertex).or_insert_with(T::zero);
        *entry = entry.clone() + weight.clone() * value.clone();
    }
}

impl<T: Num + Clone + FromPrimitive> Blend for Rows<T> {
    type Point = Row<T>;
    type Sum = Row<T>;

    fn zero(&self) -> Row<T> {
        Row::new()
    }

    fn add(&self, sum: &mut Row<T>, weight: i64, point: &Row<T>) {
        add(sum, &whole(weight), point);
    }

    fn add_sum(&self, sum: &mut Row<T>, weight: i64, other: &Row<T>) {
        add(sum, &whole(weight), other);
    }

    fn divide(&mut self, sum: &Row<T>, denominator: i64) -> Row<T> {
        let denominator: T = whole(denominator);
        sum.iter()
            .filter(|(_, weight)| !weight.is_zero())
            .map(|(vertex, weight)| (*vertex, weight.clone() / denominator.clone()))
            .collect()
    }

    fn umbrella(
        &mut self,
        own: &Row<T>,
        ring: &Row<T>,
        valence: i64,
        weight: NeighbourWeight,
    ) -> Row<T> {
        let weight = match (weight, self.real) {
            (NeighbourWeight::Irrational { real, .. }, Some(convert)) => convert(real),
            (NeighbourWeight::Irrational { bits, .. }, None) => {
                whole::<T>(bits) / whole(1 << WEIGHT_BITS)
            }
            (
                NeighbourWeight::Exact {
                    numerator,
                    denominator,
                },
                _,
            ) => whole::<T>(numerator) / whole(denominator),
        };
        let mut result = Row::new();
        let own_weight = T::one() - whole::<T>(valence) * weight.clone();
        add(&mut result, &own_weight, own);
        add(&mut result, &weight, ring);
        result
    }
}
