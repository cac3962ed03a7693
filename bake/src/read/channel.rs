//! Files of values at vertices: one number for each vertex, in file order.
//!
//! Numbers are separated by white space; everything after `#` is skipped.

use super::words::shown;
use crate::error::{Error, Result};

/// Reads the values of so many vertices.
pub fn read(bytes: &[u8], vertices: usize) -> Result<Vec<f64>> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Error::new("found bytes that are not text").at_byte(error.valid_up_to())
    })?;
    let mut values = Vec::with_capacity(vertices);
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or("");
        for word in content.split_ascii_whitespace() {
            let value: Option<f64> = word.parse().ok().filter(|value: &f64| value.is_finite());
            let value = value.ok_or_else(|| {
                Error::new(format!(
                    "expected a finite number, found \"{}\"",
                    shown(word)
                ))
                .at_line(index + 1)
            })?;
            values.push(value);
        }
    }
    if values.len() != vertices {
        return Err(Error::new(format!(
            "expected a value for each of {vertices} vertices, found {}",
            values.len()
        ))
        .advise("give one number for each vertex, in the order of the mesh file"));
    }
    Ok(values)
}
