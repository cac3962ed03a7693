//! Lines of equal value on a grid (marching squares).

use super::Cut;

/// A piece of a line, in the coordinates of the plane.
pub type Segment = [[f64; 2]; 2];

/// The line of a value: the straight pieces in all squares of the grid that lie inside.
///
/// In a square with two corners above that face each other, the middle of the square decides
/// which of them are joined.
pub fn isoline(cut: &Cut, level: f64) -> Vec<Segment> {
    let mut segments = Vec::new();
    for row in 0..cut.size - 1 {
        for column in 0..cut.size - 1 {
            // Counter-clockwise from the lower left.
            let corners = [
                [column, row],
                [column + 1, row],
                [column + 1, row + 1],
                [column, row + 1],
            ];
            let values = corners.map(|[column, row]| cut.values[row * cut.size + column]);
            if let [Some(a), Some(b), Some(c), Some(d)] = values {
                let places = corners.map(|place| cut.place(place));
                square(places, [a, b, c, d], level, &mut segments);
            }
        }
    }
    segments
}

impl Cut {
    fn place(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        let step = self.side / (self.size - 1) as f64;
        [
            self.start[0] + column as f64 * step,
            self.start[1] + row as f64 * step,
        ]
    }
}

fn square(places: [[f64; 2]; 4], values: [f64; 4], level: f64, segments: &mut Vec<Segment>) {
    // Where the line crosses the sides, in order round the square.
    let mut crossings = Vec::new();
    for side in 0..4 {
        let next = (side + 1) % 4;
        let (from, to) = (values[side], values[next]);
        if (from >= level) != (to >= level) {
            let part = (level - from) / (to - from);
            let [p, q] = [places[side], places[next]];
            crossings.push([0, 1].map(|k| p[k] + part * (q[k] - p[k])));
        }
    }
    match crossings.as_slice() {
        [a, b] => segments.push([*a, *b]),
        [a, b, c, d] => {
            let middle = values.iter().sum::<f64>() / 4.0;
            // The first corner is cut off if it is not joined to the one that it faces.
            if (values[0] >= level) == (middle >= level) {
                segments.extend([[*a, *b], [*c, *d]]);
            } else {
                segments.extend([[*d, *a], [*b, *c]]);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::square;

    const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    /// Of the function x on the unit square, x = 1/4.
    #[test]
    fn a_line_lies_where_the_value_is() {
        let mut segments = Vec::new();
        square(PLACES, [0.0, 1.0, 1.0, 0.0], 0.25, &mut segments);
        assert_eq!(segments, [[[0.25, 0.0], [0.25, 1.0]]]);
    }

    /// Two corners above that face each other, first with the middle above, then below: the
    /// corners that are apart are cut off, a piece at each.
    #[test]
    fn saddles_are_decided_by_their_middle() {
        let mut joined = Vec::new();
        square(PLACES, [1.0, 0.0, 1.0, 0.0], 0.4, &mut joined);
        // Corner (1,0) lies below, alone.
        assert_eq!(joined[0], [[0.6, 0.0], [1.0, 0.4]]);
        let mut apart = Vec::new();
        square(PLACES, [1.0, 0.0, 1.0, 0.0], 0.75, &mut apart);
        // Corner (0,0) lies above, alone.
        assert_eq!(apart[0], [[0.0, 0.25], [0.25, 0.0]]);
    }
}
