//! Entities, nodes and elements as MSH 4.1 lists them.

use super::builder::Builder;
use super::elements::ElementType;
use crate::error::Result;
use crate::read::words::Words;
use std::collections::HashMap;

/// The physical groups of each entity, by dimension and tag of the entity.
pub type EntityGroups = HashMap<(u8, i64), Vec<i64>>;

/// Reads the inside of `$Entities`.
pub fn entities(words: &mut Words<'_>) -> Result<EntityGroups> {
    let mut numbers = [0_usize; 4];
    for number in &mut numbers {
        *number = words.number("the number of points, curves, surfaces or volumes")?;
    }
    let mut groups = EntityGroups::new();
    for (dimension, number) in (0_u8..).zip(numbers) {
        // A point has a position, the others a bounding box.
        let extent = if dimension == 0 { 3 } else { 6 };
        for _ in 0..number {
            let tag: i64 = words.number("the tag of an entity")?;
            for _ in 0..extent {
                let _: f64 = words.number("a coordinate of an entity")?;
            }
            let physical: usize = words.number("the number of an entity's physical groups")?;
            let mut own = Vec::new();
            for _ in 0..physical {
                own.push(words.number("a physical group of an entity")?);
            }
            if dimension > 0 {
                let bounding: usize =
                    words.number("the number of an entity's bounding entities")?;
                for _ in 0..bounding {
                    let _: i64 = words.number("a bounding entity")?;
                }
            }
            groups.insert((dimension, tag), own);
        }
    }
    Ok(groups)
}

/// Reads the inside of `$Nodes`.
pub fn nodes(words: &mut Words<'_>, builder: &mut Builder) -> Result<()> {
    let blocks: usize = words.number("the number of node blocks")?;
    for what in [
        "the number of nodes",
        "the least node tag",
        "the greatest node tag",
    ] {
        let _: u64 = words.number(what)?;
    }
    let mut tags: Vec<u64> = Vec::new();
    for _ in 0..blocks {
        let dimension: usize = words.number("the dimension of a node block's entity")?;
        let _entity: i64 = words.number("the tag of a node block's entity")?;
        let parametric: u8 = words.number("0 or 1 (parametric coordinates)")?;
        let number: usize = words.number("the number of nodes in a block")?;
        tags.clear();
        for _ in 0..number {
            tags.push(words.number("the tag of a node")?);
        }
        // Nodes on a curve or surface may carry their parameters there.
        let parameters = if parametric == 0 { 0 } else { dimension.min(3) };
        for tag in &tags {
            let position = [
                words.coordinate("the x coordinate of a node")?,
                words.coordinate("the y coordinate of a node")?,
                words.coordinate("the z coordinate of a node")?,
            ];
            let line = words.word_line();
            for _ in 0..parameters {
                let _: f64 = words.number("a parametric coordinate of a node")?;
            }
            builder.node(*tag, position, line)?;
        }
    }
    Ok(())
}

/// Reads the inside of `$Elements`.
pub fn elements(
    words: &mut Words<'_>,
    builder: &mut Builder,
    entities: &EntityGroups,
) -> Result<()> {
    let blocks: usize = words.number("the number of element blocks")?;
    for what in [
        "the number of elements",
        "the least element tag",
        "the greatest element tag",
    ] {
        let _: u64 = words.number(what)?;
    }
    let mut nodes = Vec::new();
    for _ in 0..blocks {
        let dimension: u8 = words.number("the dimension of an element block's entity")?;
        let entity: i64 = words.number("the tag of an element block's entity")?;
        let kind = ElementType::from_number(
            words.number("the type of a block's elements")?,
            words.word_line(),
        )?;
        let number: usize = words.number("the number of elements in a block")?;
        let groups = entities
            .get(&(dimension, entity))
            .map_or(&[][..], Vec::as_slice);
        for _ in 0..number {
            let _tag: u64 = words.number("the tag of an element")?;
            let line = words.word_line();
            nodes.clear();
            for _ in 0..kind.node_count() {
                nodes.push(words.number("the tag of an element's node")?);
            }
            builder.element(kind, groups, &nodes, line)?;
        }
    }
    Ok(())
}
