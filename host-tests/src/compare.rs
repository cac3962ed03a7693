//! Exact comparison that says what differs.

use std::fmt::{Debug, Write as _};

/// How many differences a message lists.
const LISTED: usize = 10;

/// Compares two lists element by element with `!=`.
///
/// # Errors
/// A message with `what` was compared, both lengths if they differ, the first differing
/// elements as index, got and want, and how many differ.
pub fn compare<T: PartialEq + Debug>(what: &str, got: &[T], want: &[T]) -> Result<(), String> {
    let mut message = String::new();
    let mut count = 0;
    for (index, (got, want)) in got.iter().zip(want).enumerate() {
        if got != want {
            count += 1;
            if count <= LISTED {
                let _ = writeln!(message, "  [{index}] got {got:?}, want {want:?}");
            }
        }
    }
    if count == 0 && got.len() == want.len() {
        return Ok(());
    }
    let lengths = if got.len() == want.len() {
        String::new()
    } else {
        format!(", {} elements instead of {}", got.len(), want.len())
    };
    let compared = got.len().min(want.len());
    Err(format!(
        "{what}: {count} of {compared} differ{lengths}\n{message}"
    ))
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn differences_are_listed_and_counted() {
        assert_eq!(compare("points", &[1, 2, 3], &[1, 2, 3]), Ok(()));
        let message = compare("points", &[1, 5, 3], &[1, 2, 4]).expect_err("two differ");
        assert_eq!(
            message,
            "points: 2 of 3 differ\n  [1] got 5, want 2\n  [2] got 3, want 4\n"
        );
        let message = compare("points", &[1], &[1, 2]).expect_err("one is missing");
        assert_eq!(message, "points: 0 of 1 differ, 1 elements instead of 2\n");
    }
}
