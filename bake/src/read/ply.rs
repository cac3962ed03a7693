//! Models as Stanford `.ply`: ASCII and binary of either byte order.
//!
//! The file comes back byte for byte with only the coordinates x, y and z of its vertices replaced;
//! normals, colours and every other property and element stay. So that no digit is lost, the
//! three coordinates are declared and written in double precision.

use super::models::{Content, Model};
use super::words::{Words, shown};
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::ops::Range;

/// How the numbers behind the header are held.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A type of numbers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NumberType {
    Signed(usize),
    Unsigned(usize),
    Real(usize),
}

/// A property of an element.
struct Property {
    name: String,
    kind: NumberType,
    /// The type of the list's length, if it is a list.
    length: Option<NumberType>,
    /// The bytes of the type's name in the header.
    declared: Range<usize>,
}

/// An element: a kind of things and how many there are.
struct Element {
    name: String,
    number: usize,
    properties: Vec<Property>,
}

/// Reads a model from the bytes of a `.ply` file.
pub fn read(bytes: &[u8]) -> Result<Model> {
    let mut words = Words::new(bytes);
    let (encoding, elements) = header(&mut words)?;
    let mut model = Model::new(bytes);
    declare_doubles(&elements, &mut model)?;
    let of_vertices = elements.iter().find(|element| element.name == "vertex");
    let vertices = of_vertices.map_or(0, |element| element.number);
    // However many there are of an element without properties, they take no bytes.
    let listed = elements
        .iter()
        .filter(|element| !element.properties.is_empty());
    for element in listed {
        for _ in 0..element.number {
            match element.name.as_str() {
                "vertex" => vertex(&mut words, encoding, element, &mut model)?,
                "face" => face(&mut words, encoding, element, vertices, &mut model)?,
                _ => {
                    for property in &element.properties {
                        values(&mut words, encoding, property)?;
                    }
                }
            }
        }
    }
    if model.points.is_empty() {
        return Err(Error::new("the model has no vertices"));
    }
    Ok(model)
}

fn header(words: &mut Words<'_>) -> Result<(Encoding, Vec<Element>)> {
    if words.line()? != "ply" {
        return Err(words
            .error("expected \"ply\" on the first line")
            .advise("this is no PLY file"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        match words.word("a line of the header")? {
            "comment" | "obj_info" => {
                words.rest_of_line()?;
            }
            "format" => {
                let name = words.word("the name of the encoding")?;
                encoding = Some(match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        return Err(words.error(format!(
                            "expected ascii, binary_little_endian or binary_big_endian, found \"{}\"",
                            shown(name)
                        )));
                    }
                });
                words.word("the version of the format")?;
            }
            "element" => elements.push(Element {
                name: words.word("the name of an element")?.to_owned(),
                number: words.number("the number of elements")?,
                properties: Vec::new(),
            }),
            "property" => {
                let property = property(words)?;
                let Some(element) = elements.last_mut() else {
                    return Err(words.error("a property comes before the first element"));
                };
                element.properties.push(property);
            }
            "end_header" => break,
            other => {
                return Err(words.error(format!(
                    "expected a line of the header, such as element or property, found \"{}\"",
                    shown(other)
                )));
            }
        }
    }
    let Some(encoding) = encoding else {
        return Err(words.error("the header names no format"));
    };
    if encoding != Encoding::Ascii {
        words.name_bytes();
        words.skip_line_end()?;
    }
    Ok((encoding, elements))
}

fn property(words: &mut Words<'_>) -> Result<Property> {
    let length = if words.is_next("list") {
        words.word("list")?;
        let length = number_type(words)?;
        if matches!(length, NumberType::Real(_)) {
            return Err(words.error("the length of a list is a real number"));
        }
        Some(length)
    } else {
        None
    };
    let kind = number_type(words)?;
    let declared = words.span();
    Ok(Property {
        name: words.word("the name of a property")?.to_owned(),
        kind,
        length,
        declared,
    })
}

fn number_type(words: &mut Words<'_>) -> Result<NumberType> {
    let name = words.word("a type of numbers, such as float")?;
    Ok(match name {
        "char" | "int8" => NumberType::Signed(1),
        "short" | "int16" => NumberType::Signed(2),
        "int" | "int32" => NumberType::Signed(4),
        "uchar" | "uint8" => NumberType::Unsigned(1),
        "ushort" | "uint16" => NumberType::Unsigned(2),
        "uint" | "uint32" => NumberType::Unsigned(4),
        "float" | "float32" => NumberType::Real(4),
        "double" | "float64" => NumberType::Real(8),
        _ => {
            return Err(words.error(format!(
                "expected a type of numbers, such as float, found \"{}\"",
                shown(name)
            )));
        }
    })
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Checks that there is one element of vertices, with coordinates, and declares these as doubles.
fn declare_doubles(elements: &[Element], model: &mut Model) -> Result<()> {
    let mut of_vertices = elements.iter().filter(|element| element.name == "vertex");
    let (Some(vertices), None) = (of_vertices.next(), of_vertices.next()) else {
        return Err(Error::new(
            "expected one element named vertex in the header",
        ));
    };
    for axis in AXES {
        let is_axis = |property: &&Property| property.name == axis && property.length.is_none();
        if vertices.properties.iter().filter(is_axis).count() != 1 {
            return Err(Error::new(format!(
                "expected one property named {axis} of the element vertex"
            )));
        }
    }
    for property in &vertices.properties {
        let is_axis = property.length.is_none() && AXES.contains(&property.name.as_str());
        if is_axis && property.kind != NumberType::Real(8) {
            model.add_slot(property.declared.clone(), Content::Text("double"));
        }
    }
    Ok(())
}

/// The numbers of one property; of a list without its length.
fn values(words: &mut Words<'_>, encoding: Encoding, property: &Property) -> Result<Vec<f64>> {
    let number = match property.length {
        None => 1,
        Some(length) => {
            let number = value(words, encoding, length, "the length of a list")?;
            if number < 0.0 || number.fract() != 0.0 {
                return Err(words.error(format!("expected the length of a list, found {number}")));
            }
            number as usize
        }
    };
    let mut values = Vec::new();
    for _ in 0..number {
        let expected = format!("a value of the property {}", shown(&property.name));
        values.push(value(words, encoding, property.kind, &expected)?);
    }
    Ok(values)
}

fn value(
    words: &mut Words<'_>,
    encoding: Encoding,
    kind: NumberType,
    expected: &str,
) -> Result<f64> {
    if encoding == Encoding::Ascii {
        return words.number(expected);
    }
    let (NumberType::Signed(bytes) | NumberType::Unsigned(bytes) | NumberType::Real(bytes)) = kind;
    let taken = words.take(bytes, expected)?;
    let mut wide = [0_u8; 8];
    for (place, byte) in taken.iter().enumerate() {
        let from_low = match encoding {
            Encoding::BigEndian => bytes - 1 - place,
            _ => place,
        };
        wide[from_low] = *byte;
    }
    let bits = u64::from_le_bytes(wide);
    let unused_bits = 64 - 8 * bytes;
    Ok(match kind {
        NumberType::Signed(_) => ((bits << unused_bits).cast_signed() >> unused_bits) as f64,
        NumberType::Unsigned(_) => bits as f64,
        NumberType::Real(4) => f64::from(f32::from_bits(bits as u32)),
        NumberType::Real(_) => f64::from_bits(bits),
    })
}

fn vertex(
    words: &mut Words<'_>,
    encoding: Encoding,
    element: &Element,
    model: &mut Model,
) -> Result<()> {
    let vertex = model.points.len();
    let mut point: Point = [0.0; 3];
    for property in &element.properties {
        let found = values(words, encoding, property)?;
        let axis = AXES.iter().position(|axis| property.name == *axis);
        let (Some(axis), None, [coordinate]) = (axis, property.length, found.as_slice()) else {
            continue;
        };
        if !coordinate.is_finite() {
            return Err(words.error(format!(
                "vertex {vertex} (counted from 0) has a coordinate that is no finite number"
            )));
        }
        point[axis] = *coordinate;
        let index = vertex as u32;
        let content = match encoding {
            Encoding::Ascii => Content::Word(index, axis),
            Encoding::LittleEndian => Content::LittleEndian(index, axis),
            Encoding::BigEndian => Content::BigEndian(index, axis),
        };
        model.add_slot(words.span(), content);
    }
    model.points.push(point);
    Ok(())
}

fn face(
    words: &mut Words<'_>,
    encoding: Encoding,
    element: &Element,
    vertices: usize,
    model: &mut Model,
) -> Result<()> {
    for property in &element.properties {
        let found = values(words, encoding, property)?;
        if !matches!(property.name.as_str(), "vertex_indices" | "vertex_index") {
            continue;
        }
        if found.len() < 3 {
            return Err(words.error(format!(
                "expected at least three corners of a face, found {}",
                found.len()
            )));
        }
        let corner = |value: &f64| {
            let is_index = *value >= 0.0 && *value < vertices as f64 && value.fract() == 0.0;
            if is_index {
                Ok(*value as u32)
            } else {
                Err(words.error(format!(
                    "expected a vertex of a face, 0 to {}, found {value}",
                    vertices.saturating_sub(1)
                )))
            }
        };
        let corners: Result<Vec<u32>> = found.iter().map(corner).collect();
        model.faces.push(corners?);
    }
    Ok(())
}
