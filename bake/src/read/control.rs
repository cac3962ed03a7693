//! Actuators and effectors: what a solver for goals is baked from, beside the poses of the modes.
//!
//! Both are `.csv` files whose first line names the columns, in any order, with others between them if one likes.
//! Of actuators: `actuator` (the mode's number, counted from 0 in the order of the modes), `lower` and `upper` (bounds
//! of its amplitude) and `rate` (how far it moves in a tick at most; `inf` for no limit), one line for each
//! mode. Of effectors: `point` (of the model, counted from 0) and `weight` (1 without the column).

use super::words::shown;
use crate::error::{Error, Result};
use crate::table::inverse::{Actuator, Effector};
use std::path::Path;

/// Reads the bounds and rates of `modes` actuators.
///
/// # Errors
/// If a line is no actuator's, an actuator is missing or listed twice, or its bounds are out of range.
pub fn actuators(path: &Path, modes: usize) -> Result<Vec<Actuator>> {
    let text = super::bytes(path)?;
    parse_actuators(&text, modes).map_err(|error| error.in_file(path))
}

/// Reads effectors among `points` points of a model.
///
/// # Errors
/// If a line is no effector's, a point does not exist or is listed twice, or a weight is not positive.
pub fn effectors(path: &Path, points: usize) -> Result<Vec<Effector>> {
    let text = super::bytes(path)?;
    parse_effectors(&text, points).map_err(|error| error.in_file(path))
}

fn parse_actuators(text: &[u8], modes: usize) -> Result<Vec<Actuator>> {
    let mut actuators = vec![None; modes];
    for_each_line(text, &["actuator", "lower", "upper", "rate"], 4, |fields| {
        let number = whole(fields, 0, "actuator")?;
        let [lower, upper] = [1, 2].map(|column| real(fields, column));
        let (lower, upper, rate) = (lower?, upper?, real(fields, 3)?);
        if !(-2.0 < lower && lower <= upper && upper < 2.0) {
            return Err(Error::new(format!(
                "the bounds {lower} and {upper} of actuator {number} are empty or not between -2 and 2"
            ))
            .advise("scale the mode so that amplitudes of about one suffice"));
        }
        if rate < 0.0 {
            return Err(
                Error::new(format!("the rate {rate} of actuator {number} is negative")).advise(
                    "a rate is the farthest that the amplitude moves in a tick, inf for no limit",
                ),
            );
        }
        let place = actuators.get_mut(number).ok_or_else(|| {
            Error::new(format!("there is no mode {number}; {modes} are given"))
                .advise("actuators are counted from 0 in the order of the modes")
        })?;
        let actuator = Actuator { lower, upper, rate };
        match place.replace(actuator) {
            None => Ok(()),
            Some(_) => Err(Error::new(format!("actuator {number} is listed twice"))),
        }
    })?;
    let missing = actuators.iter().position(Option::is_none);
    match missing {
        None => Ok(actuators.into_iter().flatten().collect()),
        Some(number) => Err(Error::new(format!("actuator {number} is missing"))
            .advise("list one line for each mode")),
    }
}

fn parse_effectors(text: &[u8], points: usize) -> Result<Vec<Effector>> {
    let mut effectors: Vec<Effector> = Vec::new();
    for_each_line(text, &["point", "weight"], 1, |fields| {
        let point = whole(fields, 0, "point")?;
        let weight = match fields.get(1) {
            Some(Some(_)) => real(fields, 1)?,
            _ => 1.0,
        };
        if point >= points {
            return Err(
                Error::new(format!("there is no point {point}; the model has {points}"))
                    .advise("points are counted from 0 in the order of the model's file"),
            );
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(Error::new(format!(
                "the weight {weight} of point {point} is not positive"
            ))
            .advise("leave out what has no weight"));
        }
        if effectors.iter().any(|effector| effector.point == point) {
            return Err(Error::new(format!("point {point} is listed twice")));
        }
        effectors.push(Effector { point, weight });
        Ok(())
    })?;
    if effectors.is_empty() {
        return Err(Error::new("no points are listed"));
    }
    Ok(effectors)
}

/// The fields of a line in the order of the names; those of columns that the file does not have are `None`.
type Fields<'a> = [Option<&'a str>];

/// Reads a file with named columns, of which the first `required` must be there.
fn for_each_line(
    text: &[u8],
    names: &[&str],
    required: usize,
    mut work: impl FnMut(&Fields<'_>) -> Result<()>,
) -> Result<()> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text);
    let header = reader
        .headers()
        .map_err(|error| Error::new(format!("the first line cannot be read: {error}")))?
        .clone();
    let find = |name: &&str| {
        header
            .iter()
            .position(|field| field.eq_ignore_ascii_case(name))
    };
    let columns: Vec<Option<usize>> = names.iter().map(find).collect();
    if let Some(missing) = columns[..required].iter().position(Option::is_none) {
        return Err(Error::new(format!(
            "the first line names no column \"{}\"",
            names[missing]
        ))
        .advise(format!("the columns are {}", names.join(", "))));
    }
    for record in reader.records() {
        let record =
            record.map_err(|error| Error::new(format!("a line cannot be read: {error}")))?;
        let line = record.position().map_or(1, csv::Position::line);
        let line = usize::try_from(line).unwrap_or(usize::MAX);
        let fields: Vec<Option<&str>> = columns
            .iter()
            .map(|column| column.and_then(|column| record.get(column)))
            .collect();
        work(&fields).map_err(|error| error.at_line(line))?;
    }
    Ok(())
}

fn whole(fields: &Fields<'_>, column: usize, name: &str) -> Result<usize> {
    let word = fields.get(column).copied().flatten().unwrap_or("");
    word.parse().map_err(|_| {
        Error::new(format!(
            "expected a number as {name}, found \"{}\"",
            shown(word)
        ))
    })
}

fn real(fields: &Fields<'_>, column: usize) -> Result<f64> {
    let word = fields.get(column).copied().flatten().unwrap_or("");
    let value: Option<f64> = word.parse().ok();
    value
        .filter(|value| !value.is_nan())
        .ok_or_else(|| Error::new(format!("expected a number, found \"{}\"", shown(word))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actuators_in_any_order() {
        let text = b"rate,actuator,lower,upper\ninf,1,-1,1\n# a note\n0.01,0,0,0.5\n";
        let actuators = parse_actuators(text, 2).unwrap();
        assert_eq!(actuators[0].upper, 0.5);
        assert_eq!(actuators[1].rate, f64::INFINITY);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let cases: [(&str, &str); 7] = [
            ("actuator,lower,upper\n", "column \"rate\""),
            ("actuator,lower,upper,rate\n0,1,0,1\n", "bounds 1 and 0"),
            ("actuator,lower,upper,rate\n0,-2,0,1\n", "-2 and 0"),
            ("actuator,lower,upper,rate\n0,0,1,-1\n", "rate -1"),
            ("actuator,lower,upper,rate\n0,0,1,x\n", "found \"x\""),
            ("actuator,lower,upper,rate\n3,0,1,1\n", "no mode 3"),
            ("actuator,lower,upper,rate\n", "actuator 0 is missing"),
        ];
        for (text, part) in cases {
            let error = parse_actuators(text.as_bytes(), 1).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        let cases: [(&str, &str); 5] = [
            ("weight\n1\n", "column \"point\""),
            ("point\n9\n", "no point 9"),
            ("point,weight\n1,0\n", "weight 0"),
            ("point\n1\n1\n", "twice"),
            ("point\n", "no points"),
        ];
        for (text, part) in cases {
            let error = parse_effectors(text.as_bytes(), 9).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
