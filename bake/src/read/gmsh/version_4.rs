//! Entities, nodes and elements as MSH 4.1 lists them, in either mode.

use super::builder::Builder;
use super::elements::ElementType;
use super::numbers::Numbers;
use crate::error::Result;
use std::collections::HashMap;

/// The physical groups of each entity, by dimension and tag of the entity.
pub type EntityGroups = HashMap<(i64, i64), Vec<i64>>;

/// Reads the inside of `$Entities`.
pub fn entities(numbers: &mut Numbers<'_, '_>) -> Result<EntityGroups> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = numbers.size("the number of points, curves, surfaces or volumes")?;
    }
    let mut groups = EntityGroups::new();
    for (dimension, count) in (0..).zip(counts) {
        // A point has a position, the others a bounding box.
        let extent = if dimension == 0 { 3 } else { 6 };
        for _ in 0..count {
            let tag = numbers.int("the tag of an entity")?;
            for _ in 0..extent {
                numbers.real("a coordinate of an entity")?;
            }
            let physical = numbers.size("the number of an entity's physical groups")?;
            let mut own = Vec::new();
            for _ in 0..physical {
                own.push(numbers.int("a physical group of an entity")?);
            }
            if dimension > 0 {
                let bounding = numbers.size("the number of an entity's bounding entities")?;
                for _ in 0..bounding {
                    numbers.int("a bounding entity")?;
                }
            }
            groups.insert((dimension, tag), own);
        }
    }
    Ok(groups)
}

/// Reads the inside of `$Nodes`.
pub fn nodes(numbers: &mut Numbers<'_, '_>, builder: &mut Builder) -> Result<()> {
    let blocks = numbers.size("the number of node blocks")?;
    for what in [
        "the number of nodes",
        "the least node tag",
        "the greatest node tag",
    ] {
        numbers.size(what)?;
    }
    let mut tags: Vec<u64> = Vec::new();
    for _ in 0..blocks {
        let dimension: usize = numbers.count("the dimension of a node block's entity")?;
        let _entity = numbers.int("the tag of a node block's entity")?;
        let parametric: u8 = numbers.count("0 or 1 (parametric coordinates)")?;
        let number = numbers.size("the number of nodes in a block")?;
        tags.clear();
        for _ in 0..number {
            tags.push(numbers.size("the tag of a node")?);
        }
        // Nodes on a curve or surface may carry their parameters there.
        let parameters = if parametric == 0 { 0 } else { dimension.min(3) };
        for tag in &tags {
            let position = numbers.position()?;
            let place = numbers.place();
            for _ in 0..parameters {
                numbers.real("a parametric coordinate of a node")?;
            }
            builder.node(*tag, position, place)?;
        }
    }
    Ok(())
}

/// Reads the inside of `$Elements`.
pub fn elements(
    numbers: &mut Numbers<'_, '_>,
    builder: &mut Builder,
    entities: &EntityGroups,
) -> Result<()> {
    let blocks = numbers.size("the number of element blocks")?;
    for what in [
        "the number of elements",
        "the least element tag",
        "the greatest element tag",
    ] {
        numbers.size(what)?;
    }
    for _ in 0..blocks {
        let dimension = numbers.int("the dimension of an element block's entity")?;
        let entity = numbers.int("the tag of an element block's entity")?;
        let kind = numbers.count("the type of a block's elements")?;
        let kind = ElementType::from_number(kind, numbers.place())?;
        let number = numbers.size("the number of elements in a block")?;
        let groups = entities
            .get(&(dimension, entity))
            .map_or(&[][..], Vec::as_slice);
        for _ in 0..number {
            numbers.size("the tag of an element")?;
            let place = numbers.place();
            let mut nodes = [0; ElementType::MOST_NODES];
            let nodes = &mut nodes[..kind.node_count()];
            for node in nodes.iter_mut() {
                *node = numbers.size("the tag of an element's node")?;
            }
            builder.element(kind, groups, nodes, place)?;
        }
    }
    Ok(())
}
