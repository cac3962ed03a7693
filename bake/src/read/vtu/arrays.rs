//! The arrays of a VTK XML file as numbers, whatever way they are stored.

use super::blocks::{Base64, Layout, Raw};
use super::line_number;
use crate::error::{Error, Result};
use crate::read::vtk::data::Values;
use crate::read::words::shown;
use roxmltree::{Document, Node};
use std::fmt::Display;

/// An open file: its XML, its appended data and how its binary blocks are laid out.
pub struct File<'a, 'input> {
    document: &'a Document<'input>,
    appended: Option<&'a [u8]>,
    layout: Layout,
}

/// The numbers an array may hold.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NumberType {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

impl NumberType {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::Signed(1),
            "Int16" => Self::Signed(2),
            "Int32" => Self::Signed(4),
            "Int64" => Self::Signed(8),
            "UInt8" => Self::Unsigned(1),
            "UInt16" => Self::Unsigned(2),
            "UInt32" => Self::Unsigned(4),
            "UInt64" => Self::Unsigned(8),
            "Float32" => Self::Float(4),
            "Float64" => Self::Float(8),
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Self::Signed(bytes) | Self::Unsigned(bytes) | Self::Float(bytes) => bytes,
        }
    }
}

impl<'a, 'input> File<'a, 'input> {
    /// Reads the attributes of the root element.
    pub fn new(document: &'a Document<'input>, appended: Option<&'a [u8]>) -> Result<Self> {
        let root = document.root_element();
        let mut file = Self {
            document,
            appended,
            layout: Layout::default(),
        };
        if !root.has_tag_name("VTKFile") {
            return Err(file.error(
                root,
                format!(
                    "expected the element VTKFile, found {}",
                    root.tag_name().name()
                ),
            ));
        }
        match root.attribute("type") {
            Some("UnstructuredGrid") => {}
            other => {
                return Err(file
                    .error(
                        root,
                        format!(
                            "expected type=\"UnstructuredGrid\", found \"{}\"",
                            other.unwrap_or("")
                        ),
                    )
                    .advise("save the mesh as an unstructured grid (.vtu)"));
            }
        }
        file.layout = file.read_layout()?;
        Ok(file)
    }

    /// How binary arrays are laid out, as the root element says.
    fn read_layout(&self) -> Result<Layout> {
        let root = self.root();
        let big_endian = match root.attribute("byte_order") {
            Some("BigEndian") => true,
            Some("LittleEndian") | None => false,
            Some(other) => {
                return Err(self.error(
                    root,
                    format!(
                        "expected byte_order LittleEndian or BigEndian, found \"{}\"",
                        shown(other)
                    ),
                ));
            }
        };
        let wide_header = match root.attribute("header_type") {
            Some("UInt64") => true,
            Some("UInt32") | None => false,
            Some(other) => {
                return Err(self.error(
                    root,
                    format!(
                        "expected header_type UInt32 or UInt64, found \"{}\"",
                        shown(other)
                    ),
                ));
            }
        };
        let compressed = match root.attribute("compressor") {
            Some("vtkZLibDataCompressor") => true,
            Some("") | None => false,
            Some(other) => {
                return Err(self
                    .error(
                        root,
                        format!("the compressor \"{}\" is not read", shown(other)),
                    )
                    .advise("save the file with zlib compression or with none"));
            }
        };
        Ok(Layout {
            big_endian,
            wide_header,
            compressed,
        })
    }

    /// The element VTKFile.
    pub fn root(&self) -> Node<'a, 'input> {
        self.document.root_element()
    }

    /// An error at an element.
    pub fn error(&self, node: Node<'_, '_>, message: impl Into<String>) -> Error {
        let place = self.document.text_pos_at(node.range().start);
        Error::new(message).at_line(line_number(place.row))
    }

    /// The first child element of that name, or an error.
    pub fn child(&self, parent: Node<'a, 'input>, name: &str) -> Result<Node<'a, 'input>> {
        parent
            .children()
            .find(|node| node.has_tag_name(name))
            .ok_or_else(|| {
                let parent_name = parent.tag_name().name();
                self.error(
                    parent,
                    format!("expected an element {name} in {parent_name}, found none"),
                )
            })
    }

    /// The array of that name among the children of `parent`.
    pub fn array(&self, parent: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
        let is_wanted = |node: &Node<'_, '_>| {
            node.has_tag_name("DataArray") && node.attribute("Name") == Some(name)
        };
        parent.children().find(is_wanted)
    }

    /// An attribute that is a count.
    pub fn count(&self, node: Node<'_, '_>, attribute: &str) -> Result<usize> {
        let value = node.attribute(attribute).unwrap_or("");
        value.trim().parse().map_err(|_| {
            self.error(
                node,
                format!(
                    "expected a count in {attribute}, found \"{}\"",
                    shown(value)
                ),
            )
        })
    }

    /// The array's numbers, integers or not.
    pub fn values(&self, node: Node<'_, '_>) -> Result<Values> {
        match self.number_type(node)? {
            NumberType::Float(_) => self.floats(node).map(Values::Reals),
            _ => self.integers(node).map(Values::Integers),
        }
    }

    /// The array's numbers as integers.
    pub fn integers(&self, node: Node<'_, '_>) -> Result<Vec<i64>> {
        let kind = self.number_type(node)?;
        if matches!(kind, NumberType::Float(_)) {
            return Err(self.error(
                node,
                "expected an array of integers, found floating point numbers",
            ));
        }
        if node.attribute("format") == Some("ascii") {
            return self.words(node);
        }
        let bytes = self.bytes(node)?;
        self.check_whole(node, &bytes, kind)?;
        let number = |word: &[u8]| -> Option<i64> {
            let mut wide = [0_u8; 8];
            for (place, byte) in word.iter().enumerate() {
                let from_low = if self.layout.big_endian {
                    word.len() - 1 - place
                } else {
                    place
                };
                wide[from_low] = *byte;
            }
            let value = u64::from_le_bytes(wide);
            let unused_bits = 64 - 8 * word.len();
            match kind {
                NumberType::Signed(_) => Some((value << unused_bits).cast_signed() >> unused_bits),
                _ => i64::try_from(value).ok(),
            }
        };
        bytes
            .chunks_exact(kind.bytes())
            .map(|word| number(word).ok_or_else(|| self.error(node, "a number exceeds 2^63 - 1")))
            .collect()
    }

    /// The array's numbers in double precision.
    pub fn floats(&self, node: Node<'_, '_>) -> Result<Vec<f64>> {
        let kind = self.number_type(node)?;
        if !matches!(kind, NumberType::Float(_)) {
            return Ok(self
                .integers(node)?
                .into_iter()
                .map(|value| value as f64)
                .collect());
        }
        if node.attribute("format") == Some("ascii") {
            return self.words(node);
        }
        let bytes = self.bytes(node)?;
        self.check_whole(node, &bytes, kind)?;
        let big = self.layout.big_endian;
        if kind.bytes() == 4 {
            let (words, _) = bytes.as_chunks::<4>();
            let number = |word: &[u8; 4]| {
                f64::from(if big {
                    f32::from_be_bytes(*word)
                } else {
                    f32::from_le_bytes(*word)
                })
            };
            return Ok(words.iter().map(number).collect());
        }
        let (words, _) = bytes.as_chunks::<8>();
        let number = |word: &[u8; 8]| {
            if big {
                f64::from_be_bytes(*word)
            } else {
                f64::from_le_bytes(*word)
            }
        };
        Ok(words.iter().map(number).collect())
    }

    fn number_type(&self, node: Node<'_, '_>) -> Result<NumberType> {
        let name = node.attribute("type").unwrap_or("");
        NumberType::from_name(name).ok_or_else(|| {
            self.error(
                node,
                format!(
                    "expected a number type such as Float64, found \"{}\"",
                    shown(name)
                ),
            )
        })
    }

    fn check_whole(&self, node: Node<'_, '_>, bytes: &[u8], kind: NumberType) -> Result<()> {
        if bytes.len().is_multiple_of(kind.bytes()) {
            return Ok(());
        }
        Err(self.error(
            node,
            format!(
                "the array's {} bytes are no multiple of {}",
                bytes.len(),
                kind.bytes()
            ),
        ))
    }

    fn words<T: std::str::FromStr>(&self, node: Node<'_, '_>) -> Result<Vec<T>>
    where
        T::Err: Display,
    {
        let number = |word: &str| {
            word.parse().map_err(|_| {
                self.error(
                    node,
                    format!("expected a number, found \"{}\"", shown(word)),
                )
            })
        };
        node.text()
            .unwrap_or("")
            .split_ascii_whitespace()
            .map(number)
            .collect()
    }

    /// The array's bytes in the file's byte order.
    fn bytes(&self, node: Node<'_, '_>) -> Result<Vec<u8>> {
        let located = |error: Error| match error.place() {
            crate::error::Place::Whole => self.error(node, error.message()),
            _ => error,
        };
        match node.attribute("format") {
            Some("binary") => {
                let text: String = node
                    .text()
                    .unwrap_or("")
                    .chars()
                    .filter(|c| !c.is_ascii_whitespace())
                    .collect();
                self.layout
                    .read(&mut Base64::new(text.as_bytes()))
                    .map_err(located)
            }
            Some("appended") => {
                let Some(data) = self.appended else {
                    return Err(self.error(
                        node,
                        "the array is appended, but the file has no appended data",
                    ));
                };
                let offset = self.count(node, "offset")?;
                let Some(data) = data.get(offset..) else {
                    return Err(
                        self.error(node, "the array's offset lies beyond the appended data")
                    );
                };
                let element = self.child(self.root(), "AppendedData")?;
                match element.attribute("encoding") {
                    Some("raw") => self.layout.read(&mut Raw::new(data)).map_err(located),
                    Some("base64") | None => {
                        self.layout.read(&mut Base64::new(data)).map_err(located)
                    }
                    Some(other) => Err(self.error(
                        element,
                        format!(
                            "expected encoding raw or base64, found \"{}\"",
                            shown(other)
                        ),
                    )),
                }
            }
            other => Err(self.error(
                node,
                format!(
                    "expected format ascii, binary or appended, found \"{}\"",
                    other.unwrap_or("")
                ),
            )),
        }
    }
}
