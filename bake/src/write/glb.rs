//! Animations as binary glTF 2.0 (`.glb`), for viewers and modelling programs.
//!
//! The mesh is the model at rest, its polygons cut into triangles. Every frame is a morph target: the
//! way of each vertex from rest, and the change of its normal. A track of weights shows one target
//! after the other and blends between neighbours in a straight line.
//!
//! # Precision
//!
//! The format has single precision. The position at rest is rounded to it, and the target is what is
//! then missing, rounded too: at a frame's time `rest + target` differs from the frame's position by
//! at most `2^-24` of the target's magnitude, before the viewer adds the two up in its own precision.

use super::failed;
use crate::animation::Animation;
use crate::error::{Error, Result};
use crate::geometry::{add_scaled, cross, dot, length, normalised, subtract};
use crate::mesh::Point;
use serde_json::{Value, json};
use std::io::Write;

/// A vertex's position or normal as the format has it.
type Single = [f32; 3];

/// Numbers of the format: element types and what buffers are for.
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;

/// Writes the animation. A single frame makes a mesh that stands still.
///
/// # Errors
/// If it would be longer than 4 GiB, two frames come at the same time in single precision, or writing
/// fails.
pub fn write(animation: &Animation<'_>, out: &mut dyn Write) -> Result<()> {
    let mut data = Data::default();
    let mesh = mesh(animation, &mut data);
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "octruss" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{
            "name": animation.name,
            "mesh": 0,
            "rotation": rotation(animation.up),
            "scale": vec![metres(animation.unit); 3],
        }],
        "meshes": [mesh],
        "materials": [{
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.8, 0.55, 0.4, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.7,
            },
            "doubleSided": true,
        }],
    });
    if animation.frames.len() > 1 {
        document["animations"] = json!([track(animation, &mut data)?]);
    }
    document["accessors"] = Value::Array(data.accessors);
    document["bufferViews"] = Value::Array(data.views);
    document["buffers"] = json!([{ "byteLength": data.bytes.len() }]);
    container(&document.to_string(), &data.bytes, out)
}

/// The mesh at rest with a target for each frame.
fn mesh(animation: &Animation<'_>, data: &mut Data) -> Value {
    let triangles = triangles(animation.faces);
    let normals = |points: &[Point]| vertex_normals(&triangles, points);
    let rest = rounded(animation.rest);
    let rest_normals = rounded(&normals(animation.rest));
    let mut primitive = json!({
        "mode": if triangles.is_empty() { POINTS } else { TRIANGLES },
        "material": 0,
        "attributes": { "POSITION": data.vectors(&rest) },
    });
    if !triangles.is_empty() {
        primitive["indices"] = data.indices(triangles.as_flattened()).into();
        primitive["attributes"]["NORMAL"] = data.vectors(&rest_normals).into();
    }
    let targets = animation.frames.iter().map(|frame| {
        let mut target = json!({ "POSITION": data.vectors(&ways(&rest, frame.points)) });
        if !triangles.is_empty() {
            let changes = ways(&rest_normals, &normals(frame.points));
            target["NORMAL"] = data.vectors(&changes).into();
        }
        target
    });
    primitive["targets"] = targets.collect();
    // The first frame, for who shows no animation.
    let weights: Vec<u8> = (0..animation.frames.len())
        .map(|frame| u8::from(frame == 0))
        .collect();
    let names = animation
        .frames
        .iter()
        .map(|frame| format!("frame {}", frame.number));
    json!({
        "name": animation.name,
        "primitives": [primitive],
        "weights": weights,
        "extras": { "targetNames": names.collect::<Vec<_>>() },
    })
}

/// The track of weights: at each frame's time its own target alone.
fn track(animation: &Animation<'_>, data: &mut Data) -> Result<Value> {
    let frames = animation.frames;
    let times: Vec<f32> = frames
        .iter()
        .map(|frame| animation.seconds(frame) as f32)
        .collect();
    if let Some(place) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        let [one, other] = [place, place + 1].map(|place| frames[place].number);
        return Err(Error::new(format!(
            "frames {one} and {other} come at the same time in single precision"
        ))
        .advise("number the frames with smaller gaps, or take a lower --frame-rate"));
    }
    let count = frames.len();
    let weights =
        (0..count * count).map(|place| f32::from(u8::from(place / count == place % count)));
    Ok(json!({
        "name": animation.name,
        "samplers": [{
            "input": data.times(&times),
            "output": data.scalars(&weights.collect::<Vec<_>>()),
            "interpolation": "LINEAR",
        }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
    }))
}

/// The bytes of the buffer, and what they mean.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Data {
    /// Appends a view; all elements have four bytes, so every view starts on a multiple of four.
    fn view(&mut self, words: impl Iterator<Item = [u8; 4]>, target: Option<u32>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(words.flatten());
        let mut view = json!({
            "buffer": 0,
            "byteOffset": start,
            "byteLength": self.bytes.len() - start,
        });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        self.views.len() - 1
    }

    /// Appends an accessor of a view's elements, and gives its number.
    fn accessor(&mut self, view: usize, count: usize, kind: u32, shape: &str) -> usize {
        self.accessors.push(json!({
            "bufferView": view,
            "componentType": kind,
            "count": count,
            "type": shape,
        }));
        self.accessors.len() - 1
    }

    fn bounded(&mut self, accessor: usize, least: Value, greatest: Value) -> usize {
        self.accessors[accessor]["min"] = least;
        self.accessors[accessor]["max"] = greatest;
        accessor
    }

    fn vectors(&mut self, vectors: &[Single]) -> usize {
        let words = vectors
            .as_flattened()
            .iter()
            .map(|value| value.to_le_bytes());
        let view = self.view(words, Some(VERTICES));
        let accessor = self.accessor(view, vectors.len(), FLOAT, "VEC3");
        let bound = |start: f32, choose: fn(f32, f32) -> f32| -> Single {
            let along = |axis: usize| vectors.iter().map(move |vector| vector[axis]);
            std::array::from_fn(|axis| along(axis).fold(start, choose))
        };
        let least = bound(f32::INFINITY, f32::min);
        let greatest = bound(f32::NEG_INFINITY, f32::max);
        self.bounded(accessor, json!(least), json!(greatest))
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let words = indices.iter().map(|index| index.to_le_bytes());
        let view = self.view(words, Some(INDICES));
        self.accessor(view, indices.len(), UNSIGNED_INT, "SCALAR")
    }

    fn scalars(&mut self, values: &[f32]) -> usize {
        let view = self.view(values.iter().map(|value| value.to_le_bytes()), None);
        self.accessor(view, values.len(), FLOAT, "SCALAR")
    }

    /// Ascending times.
    fn times(&mut self, times: &[f32]) -> usize {
        let accessor = self.scalars(times);
        self.bounded(accessor, json!(times[..1]), json!(times[times.len() - 1..]))
    }
}

/// Every polygon as a fan of triangles.
fn triangles(faces: &[Vec<u32>]) -> Vec<[u32; 3]> {
    let fan = |face: &Vec<u32>| -> Vec<[u32; 3]> {
        let sides = face[1..].windows(2);
        sides.map(|side| [face[0], side[0], side[1]]).collect()
    };
    faces.iter().flat_map(fan).collect()
}

/// Unit normals of the vertices: the mean of those of the triangles there, by area. A vertex of no
/// triangle gets one all the same, which the format asks for.
fn vertex_normals(triangles: &[[u32; 3]], points: &[Point]) -> Vec<Point> {
    const ANY: Point = [0.0, 0.0, 1.0];
    let mut sums = vec![[0.0; 3]; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| points[vertex as usize]);
        let normal = cross(subtract(b, a), subtract(c, a));
        for vertex in triangle {
            let sum = &mut sums[*vertex as usize];
            *sum = add_scaled(*sum, 1.0, normal);
        }
    }
    let unit = |sum: Point| {
        let normal = normalised(sum);
        if length(normal) > 0.5 { normal } else { ANY }
    };
    sums.into_iter().map(unit).collect()
}

fn rounded(points: &[Point]) -> Vec<Single> {
    points
        .iter()
        .map(|point| point.map(|coordinate| coordinate as f32))
        .collect()
}

/// What is missing from the rounded points to others.
fn ways(from: &[Single], to: &[Point]) -> Vec<Single> {
    let way = |(from, to): (&Single, &Point)| {
        std::array::from_fn(|axis| (to[axis] - f64::from(from[axis])) as f32)
    };
    from.iter().zip(to).map(way).collect()
}

/// The unit quaternion (x, y, z, w) that turns a direction to the format's upward direction, y.
fn rotation(up: Point) -> [f64; 4] {
    const Y: Point = [0.0, 1.0, 0.0];
    let up = normalised(up);
    let [x, y, z] = cross(up, Y);
    let w = 1.0 + dot(up, Y);
    let norm = (x * x + y * y + z * z + w * w).sqrt();
    if norm < 1e-6 {
        // Upside down: half a turn.
        return [1.0, 0.0, 0.0, 0.0];
    }
    [x, y, z, w].map(|part| part / norm)
}

/// A unit in the format's metres; a unit that is not known counts as one metre.
fn metres(unit: &str) -> f64 {
    match unit {
        "um" | "\u{b5}m" | "\u{3bc}m" => 1e-6,
        "mm" => 1e-3,
        "cm" => 1e-2,
        "in" => 0.0254,
        _ => 1.0,
    }
}

/// The header and the two chunks, each filled up to a multiple of four bytes.
fn container(document: &str, buffer: &[u8], out: &mut dyn Write) -> Result<()> {
    const HEADER: usize = 12;
    const CHUNK_HEADER: usize = 8;
    let document_length = document.len().next_multiple_of(4);
    let total = HEADER + 2 * CHUNK_HEADER + document_length + buffer.len();
    let size = |bytes: usize| {
        u32::try_from(bytes).map(u32::to_le_bytes).map_err(|_| {
            Error::new("the animation does not fit into the 4 GiB of a .glb file")
                .advise("take fewer frames, or write a .pvd")
        })
    };
    let padding = vec![b' '; document_length - document.len()];
    let parts: [&[u8]; 10] = [
        b"glTF",
        &2_u32.to_le_bytes(),
        &size(total)?,
        &size(document_length)?,
        b"JSON",
        document.as_bytes(),
        &padding,
        &size(buffer.len())?,
        b"BIN\0",
        buffer,
    ];
    parts
        .iter()
        .try_for_each(|part| out.write_all(part))
        .map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::{Point, metres, rotation};

    /// `q v q*` of a unit quaternion, by the formula `v + 2 u x (u x v + w v)`.
    fn turned([x, y, z, w]: [f64; 4], v: Point) -> Point {
        let u = [x, y, z];
        let inner = crate::geometry::add_scaled(crate::geometry::cross(u, v), w, v);
        crate::geometry::add_scaled(v, 2.0, crate::geometry::cross(u, inner))
    }

    #[test]
    fn every_direction_can_point_upward() {
        for up in [
            [0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [3.0, -2.0, 0.5],
        ] {
            let [x, y, z] = turned(rotation(up), crate::geometry::normalised(up));
            let off = x.abs() + (y - 1.0).abs() + z.abs();
            assert!(off < 1e-12, "{up:?} is turned to {:?}", [x, y, z]);
        }
    }

    #[test]
    fn units_become_metres() {
        assert_eq!(
            [metres("mm"), metres("in"), metres("")],
            [0.001, 0.0254, 1.0]
        );
    }
}
