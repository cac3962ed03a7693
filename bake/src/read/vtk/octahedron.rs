//! Recognises an octahedron among VTK's polyhedra and puts its corners into order.

use crate::error::{Error, Result};
use crate::mesh::Vertex;
use octruss::mesh::OCTAHEDRON_FACES;

/// The six corners of a polyhedron with the faces of an octahedron, opposite pairs being (0,3),
/// (1,4), (2,5).
///
/// The order depends on what the file lists, never on positions, so that a cage and its poses
/// agree. If `corners` already stands in such an order and fits the sense of the faces, it is
/// kept; otherwise the first corner listed comes first, the next one that is not opposite to it
/// second, and the faces, taken as counter-clockwise from outside, decide the third.
pub fn recognise(corners: &[Vertex], faces: &[Vec<i64>]) -> Result<[Vertex; 6]> {
    let corners: [Vertex; 6] = corners
        .try_into()
        .map_err(|_| not_an_octahedron(corners.len(), faces.len()))?;
    let faces = triangles(&corners, faces)?;
    let opposite = opposites(&faces)?;
    let fits = |order: &[usize; 6]| {
        (0..3).all(|place| opposite[order[place]] == order[place + 3])
            && OCTAHEDRON_FACES
                .iter()
                .all(|face| faces.contains(&first_least(face.map(|place| order[place]))))
    };
    let listed = [0, 1, 2, 3, 4, 5];
    if fits(&listed) {
        return Ok(corners);
    }
    let second = if opposite[0] == 1 { 2 } else { 1 };
    let rest = (1..6).filter(|place| ![opposite[0], second, opposite[second]].contains(place));
    for third in rest {
        let order = [
            0,
            second,
            third,
            opposite[0],
            opposite[second],
            opposite[third],
        ];
        if fits(&order) {
            return Ok(order.map(|place| corners[place]));
        }
    }
    Err(
        Error::new("is an octahedron whose faces do not all turn the same way")
            .advise("list the corners of every face counter-clockwise as seen from outside"),
    )
}

fn not_an_octahedron(corners: usize, faces: usize) -> Error {
    Error::new(format!(
        "is a polyhedron with {corners} corners and {faces} faces; of polyhedra only octahedra (6 corners, 8 triangles) are read"
    ))
    .advise("a cage consists of tetrahedra (type 10), wedges (13), hexahedra (12), pyramids (14) and octahedra (polyhedra, type 42)")
}

/// The faces as places in `corners`, each with its least place first.
fn triangles(corners: &[Vertex; 6], faces: &[Vec<i64>]) -> Result<Vec<[usize; 3]>> {
    if faces.len() != OCTAHEDRON_FACES.len() {
        return Err(not_an_octahedron(corners.len(), faces.len()));
    }
    let mut triangles = Vec::new();
    for face in faces {
        let &[a, b, c] = face.as_slice() else {
            return Err(Error::new(format!(
                "has a face of {} corners; the faces of an octahedron are triangles",
                face.len()
            )));
        };
        let place = |vertex: i64| {
            corners
                .iter()
                .position(|corner| i64::from(*corner) == vertex)
        };
        let (Some(a), Some(b), Some(c)) = (place(a), place(b), place(c)) else {
            return Err(Error::new(
                "has faces with vertices that are not among its corners",
            ));
        };
        triangles.push(first_least([a, b, c]));
    }
    Ok(triangles)
}

/// The same turn, starting at the least corner.
fn first_least([a, b, c]: [usize; 3]) -> [usize; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// For each corner the one that shares no face with it.
fn opposites(faces: &[[usize; 3]]) -> Result<[usize; 6]> {
    let mut opposite = [0; 6];
    for (place, entry) in opposite.iter_mut().enumerate() {
        let touches = |other: usize| {
            faces
                .iter()
                .any(|face| face.contains(&place) && face.contains(&other))
        };
        let mut apart = (0..6).filter(|other| *other != place && !touches(*other));
        match (apart.next(), apart.next()) {
            (Some(other), None) => *entry = other,
            _ => {
                return Err(Error::new(
                    "has 6 corners and 8 triangles, but not as an octahedron has them: every corner shares triangles with all others but one",
                ));
            }
        }
    }
    Ok(opposite)
}
