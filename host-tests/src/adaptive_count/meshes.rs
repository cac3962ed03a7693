//! Closed meshes of triangles to compare on.

use std::path::Path;

use octruss_bake::error::Result;
use octruss_bake::read;

use super::surface::Point;

/// A closed mesh of triangles.
#[derive(Clone, Debug)]
pub struct Closed {
    /// What it is called.
    pub name: &'static str,
    /// Where its vertices are.
    pub points: Vec<Point>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Closed {
    /// The greatest difference of two vertices along an axis.
    pub fn extent(&self) -> f64 {
        let along = |axis: usize| {
            let values = || self.points.iter().map(|point| point[axis]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        [0, 1, 2].map(along).into_iter().fold(0.0, f64::max)
    }
}

/// The meshes of the comparison: a star, a torus and the example glove.
///
/// # Errors
/// If the glove cannot be read.
pub fn all(models: &Path) -> Result<Vec<Closed>> {
    Ok(vec![star(), torus(), glove(models)?])
}

/// An icosahedron with its faces cut in four, of which the twelve first vertices stand out: valences 5 and 6.
pub fn star() -> Closed {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let (apex, ring) = (golden / 2.0, 1.0);
    let mut points = vec![[0.0, 0.0, 0.0]; 12];
    for (place, point) in points.iter_mut().enumerate() {
        let angle = std::f64::consts::TAU * (place % 5) as f64 / 5.0;
        let turn = std::f64::consts::PI / 5.0;
        *point = match place {
            0 => [0.0, 0.0, 5.0_f64.sqrt() * apex / golden],
            11 => [0.0, 0.0, -5.0_f64.sqrt() * apex / golden],
            1..=5 => {
                let angle = angle - std::f64::consts::TAU / 5.0;
                [ring * angle.cos(), ring * angle.sin(), 0.5]
            }
            _ => {
                let angle = angle - std::f64::consts::TAU / 5.0 + turn;
                [ring * angle.cos(), ring * angle.sin(), -0.5]
            }
        };
    }
    let upper = |i: u32| 1 + i % 5;
    let lower = |i: u32| 6 + i % 5;
    let faces = (0..5).flat_map(|i| {
        [
            [0, upper(i), upper(i + 1)],
            [upper(i), lower(i), upper(i + 1)],
            [upper(i + 1), lower(i), lower(i + 1)],
            [11, lower(i + 1), lower(i)],
        ]
    });
    let mut triangles = Vec::new();
    let mut middles = std::collections::BTreeMap::new();
    for [a, b, c] in faces {
        let mut middle = |one: u32, other: u32| {
            let next = 12 + middles.len() as u32;
            *middles
                .entry((one.min(other), one.max(other)))
                .or_insert(next)
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    points.resize(12 + middles.len(), [0.0; 3]);
    for ((one, other), place) in middles {
        let ends = [points[one as usize], points[other as usize]];
        points[place as usize] = [0, 1, 2].map(|axis| f64::midpoint(ends[0][axis], ends[1][axis]));
    }
    for point in &mut points[..12] {
        *point = point.map(|own| 2.0 * own);
    }
    Closed {
        name: "star",
        points,
        triangles,
    }
}

/// Twelve by six vertices round a torus whose tube is half as wide as its circle: valence 6 everywhere.
pub fn torus() -> Closed {
    const AROUND: u32 = 12;
    const ACROSS: u32 = 6;
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    let vertex = |i: u32, j: u32| i % AROUND * ACROSS + j % ACROSS;
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let [along, across] = [(i, AROUND), (j, ACROSS)]
                .map(|(place, count)| std::f64::consts::TAU * f64::from(place) / f64::from(count));
            let radius = 2.0 + across.cos();
            points.push([radius * along.cos(), radius * along.sin(), across.sin()]);
            let [a, b, c, d] = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Closed {
        name: "torus",
        points,
        triangles,
    }
}

/// The example glove, every quadrilateral cut from its first corner: valences 4 to 9.
///
/// # Errors
/// If the file cannot be read.
pub fn glove(models: &Path) -> Result<Closed> {
    let model = read::model(&models.join("glove.obj"))?;
    let cut = |face: &Vec<u32>| {
        let corners = face.clone();
        (2..corners.len()).map(move |k| [corners[0], corners[k - 1], corners[k]])
    };
    Ok(Closed {
        name: "glove",
        triangles: model.faces.iter().flat_map(cut).collect(),
        points: model.points,
    })
}
