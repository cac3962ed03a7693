//! Scalar channels of vertices, refined by the masks of the coordinates.
//!
//! Channels are taken three at a time in the place of x, y and z: a mask treats every axis alike.

use super::Refinement;
use crate::error::Result;
use crate::mesh::{Channel, Point};
use crate::table::format::Format;

const AXES: usize = 3;

/// The channels of one level.
pub struct Channels {
    names: Vec<String>,
    values: Values,
}

enum Values {
    Real(Vec<Vec<Point>>),
    Fixed {
        /// Of each channel, as many fraction bits as leave two bits of headroom.
        formats: Vec<Format>,
        bits: Vec<Vec<[i32; AXES]>>,
    },
}

impl Channels {
    /// In double precision.
    pub fn real(channels: &[Channel]) -> Self {
        let packed = |group: &[Channel]| {
            let vertices = group.first().map_or(0, |channel| channel.values.len());
            let value = |axis: usize, vertex: usize| {
                group
                    .get(axis)
                    .map_or(0.0, |channel| channel.values[vertex])
            };
            (0..vertices)
                .map(|vertex| std::array::from_fn(|axis| value(axis, vertex)))
                .collect()
        };
        Self {
            names: names(channels),
            values: Values::Real(channels.chunks(AXES).map(packed).collect()),
        }
    }

    /// In the device's fixed-point numbers, each channel in a format of its own.
    ///
    /// # Errors
    /// If a value fits no format.
    pub fn fixed(channels: &[Channel]) -> Result<Self> {
        let (mut formats, mut single) = (Vec::new(), Vec::new());
        for channel in channels {
            let values: Vec<Point> = channel.values.iter().map(|value| [*value; AXES]).collect();
            let format = Format::with_headroom(&values);
            single.push(format.bits_of(&values, "vertex")?);
            formats.push(format);
        }
        let packed = |group: &[Vec<[i32; AXES]>]| {
            let vertices = group.first().map_or(0, Vec::len);
            let value =
                |axis: usize, vertex: usize| group.get(axis).map_or(0, |bits| bits[vertex][0]);
            (0..vertices)
                .map(|vertex| std::array::from_fn(|axis| value(axis, vertex)))
                .collect()
        };
        Ok(Self {
            names: names(channels),
            values: Values::Fixed {
                formats,
                bits: single.chunks(AXES).map(packed).collect(),
            },
        })
    }

    /// Takes the channels to the next level; counts saturated values.
    ///
    /// # Errors
    /// If the mesh cannot be refined.
    pub fn refine(&mut self, step: &mut Refinement<'_>, saturated: &mut usize) -> Result<()> {
        match &mut self.values {
            Values::Real(groups) => {
                for group in groups {
                    *group = step.points(group)?;
                }
            }
            Values::Fixed { bits, .. } => {
                for group in bits {
                    *group = step.bits(group, saturated)?;
                }
            }
        }
        Ok(())
    }

    /// The channels with their values at this level.
    pub fn values(&self) -> Vec<Channel> {
        let values = |channel: usize| -> Vec<f64> {
            let (group, axis) = (channel / AXES, channel % AXES);
            match &self.values {
                Values::Real(groups) => groups[group].iter().map(|point| point[axis]).collect(),
                Values::Fixed { formats, bits } => formats[channel]
                    .points_of(&bits[group])
                    .iter()
                    .map(|point| point[axis])
                    .collect(),
            }
        };
        let channel = |(index, name): (usize, &String)| Channel {
            name: name.clone(),
            values: values(index),
        };
        self.names.iter().enumerate().map(channel).collect()
    }
}

fn names(channels: &[Channel]) -> Vec<String> {
    channels
        .iter()
        .map(|channel| channel.name.clone())
        .collect()
}
