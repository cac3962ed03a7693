//! Nodes and elements as MSH 2.2 lists them.

use super::builder::Builder;
use super::elements::ElementType;
use crate::error::Result;
use crate::read::words::Words;

/// Reads the inside of `$Nodes`.
pub fn nodes(words: &mut Words<'_>, builder: &mut Builder) -> Result<()> {
    let number: usize = words.number("the number of nodes")?;
    for _ in 0..number {
        let tag: u64 = words.number("the tag of a node")?;
        let line = words.word_line();
        let position = [
            words.coordinate("the x coordinate of a node")?,
            words.coordinate("the y coordinate of a node")?,
            words.coordinate("the z coordinate of a node")?,
        ];
        builder.node(tag, position, line)?;
    }
    Ok(())
}

/// Reads the inside of `$Elements`.
pub fn elements(words: &mut Words<'_>, builder: &mut Builder) -> Result<()> {
    let number: usize = words.number("the number of elements")?;
    let mut nodes = Vec::new();
    for _ in 0..number {
        let _tag: u64 = words.number("the tag of an element")?;
        let line = words.word_line();
        let kind = ElementType::from_number(words.number("the type of an element")?, line)?;
        let tags: usize = words.number("the number of tags of an element")?;
        // The first tag is the physical group, 0 for none; the others are of no use here.
        let mut group = 0_i64;
        for place in 0..tags {
            let tag: i64 = words.number("a tag of an element")?;
            if place == 0 {
                group = tag;
            }
        }
        nodes.clear();
        for _ in 0..kind.node_count() {
            nodes.push(words.number("the tag of an element's node")?);
        }
        builder.element(kind, &[group], &nodes, line)?;
    }
    Ok(())
}
