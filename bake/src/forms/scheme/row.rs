//! Sparse rows: a new vertex as a weighted sum of old ones.

use crate::forms::exact::Field;

/// The weights of a new vertex, each with the old vertex that it multiplies, ascending by vertex.
pub type Row<F> = Vec<(usize, F)>;

/// Collects the weights of one row.
#[derive(Clone, Debug)]
pub(crate) struct RowBuilder<F> {
    entries: Row<F>,
}

impl<F: Field> RowBuilder<F> {
    pub(crate) fn new() -> Self {
        Self {
            entries: Vec::new(),
        }
    }

    /// Adds a weight to that of a vertex.
    pub(crate) fn add(&mut self, vertex: usize, weight: &F) {
        if weight.is_zero() {
            return;
        }
        match self.entries.binary_search_by_key(&vertex, |entry| entry.0) {
            Ok(place) => self.entries[place].1 = self.entries[place].1.plus(weight),
            Err(place) => self.entries.insert(place, (vertex, weight.clone())),
        }
    }

    /// The row, without weights that cancelled.
    pub(crate) fn finish(mut self) -> Row<F> {
        self.entries.retain(|(_, weight)| !weight.is_zero());
        self.entries
    }
}

/// Applies rows to values: one new value for each row.
pub(crate) fn apply<F: Field>(rows: &[Row<F>], points: &[[F; 3]]) -> Vec<[F; 3]> {
    let sum = |row: &Row<F>, axis: usize| {
        let mut total = F::zero();
        for (vertex, weight) in row {
            total.add_product(weight, &points[*vertex][axis]);
        }
        total
    };
    rows.iter()
        .map(|row| [0, 1, 2].map(|axis| sum(row, axis)))
        .collect()
}
