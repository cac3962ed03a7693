//! Normals of points, from the faces: the definition of `docs/numerics.md` in integers of 128 bits, face by
//! face, without a word of core.

/// The unit vector of each point in 14 fraction bits, and how many are zero.
///
/// `faces` lists points counter-clockwise; `shift` is that of edges.
#[must_use]
pub fn normals(points: &[[i32; 3]], faces: &[Vec<u32>], shift: u32) -> (Vec<[i16; 3]>, u32) {
    let mut sums = vec![[0_i128; 3]; points.len()];
    for face in faces {
        let corners = face.len();
        for place in 0..corners {
            let point = |at: usize| face[at % corners] as usize;
            let (at, next, before) = (point(place), point(place + 1), point(place + corners - 1));
            let [a, b] = [next, before].map(|to| edge(points[at], points[to], shift));
            for (axis, sum) in sums[at].iter_mut().enumerate() {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                *sum += a[u] * b[v] - a[v] * b[u];
            }
        }
    }
    let vectors: Vec<[i16; 3]> = sums.into_iter().map(unit).collect();
    let zeros = vectors.iter().filter(|vector| **vector == [0; 3]).count();
    (vectors, zeros as u32)
}

fn edge(from: [i32; 3], to: [i32; 3], shift: u32) -> [i128; 3] {
    std::array::from_fn(|axis| {
        let way = i128::from(to[axis]) - i128::from(from[axis]);
        rounded_quotient(way, 1 << shift).clamp(-(1 << 26), (1 << 26) - 1)
    })
}

/// The unit vector along a sum in 14 fraction bits, zero for zero.
pub fn unit(sum: [i128; 3]) -> [i16; 3] {
    let greatest = sum.iter().map(|c| c.abs()).max().unwrap_or(0);
    if greatest == 0 {
        return [0; 3];
    }
    let bits = (128 - greatest.leading_zeros()) as i32;
    let short = sum.map(|coordinate| match bits - 16 {
        excess @ 1.. => rounded_quotient(coordinate, 1 << excess),
        lack => coordinate << -lack,
    });
    let square: i128 = short.iter().map(|c| c * c).sum();
    let length = rounded_root(square);
    short.map(|coordinate| {
        let scaled = rounded_quotient(coordinate << 14, length);
        i16::try_from(scaled).expect("at most one")
    })
}

/// `floor(numerator / denominator + 1/2)`.
fn rounded_quotient(numerator: i128, denominator: i128) -> i128 {
    (2 * numerator + denominator).div_euclid(2 * denominator)
}

/// `floor(sqrt(square) + 1/2)`: the greatest root with `(2 root - 1)^2 <= 4 square`.
fn rounded_root(square: i128) -> i128 {
    let (mut low, mut high) = (0_i128, 1_i128 << 40);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if (2 * middle - 1).pow(2) <= 4 * square {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::normals;

    /// A right-angled triangle in a plane through the axes: `(1, 1, 1) / sqrt(3)` is 9459.3 / 2^14.
    #[test]
    fn a_triangle_by_hand() {
        let points = [[1000, 0, 0], [0, 1000, 0], [0, 0, 1000], [5, 5, 5]];
        let (vectors, zeros) = normals(&points, &[vec![0, 1, 2]], 0);
        assert_eq!(vectors, [[9459; 3], [9459; 3], [9459; 3], [0; 3]]);
        assert_eq!(zeros, 1);
    }
}
