//! Nodes and elements as MSH 2.2 lists them.

use super::builder::Builder;
use super::elements::ElementType;
use super::numbers::{Mode, Numbers};
use crate::error::Result;
use crate::read::words::Words;

/// Reads the inside of `$Nodes`. The count is a word in binary files too.
pub fn nodes(words: &mut Words<'_>, mode: Mode, builder: &mut Builder) -> Result<()> {
    let number: usize = words.number("the number of nodes")?;
    let mut numbers = Numbers::new(words, mode)?;
    for _ in 0..number {
        let tag = numbers.count("the tag of a node")?;
        let place = numbers.place();
        let position = numbers.position()?;
        builder.node(tag, position, place)?;
    }
    Ok(())
}

/// Reads the inside of `$Elements`. A binary file lists them in blocks of one type.
pub fn elements(words: &mut Words<'_>, mode: Mode, builder: &mut Builder) -> Result<()> {
    let number: usize = words.number("the number of elements")?;
    let mut numbers = Numbers::new(words, mode)?;
    if mode == Mode::Ascii {
        for _ in 0..number {
            let _tag = numbers.int("the tag of an element")?;
            let place = numbers.place();
            let kind = ElementType::from_number(numbers.count("the type of an element")?, place)?;
            let tags = numbers.count("the number of tags of an element")?;
            tags_and_nodes(&mut numbers, kind, tags, builder)?;
        }
        return Ok(());
    }
    let mut done = 0;
    while done < number {
        let kind = numbers.count("the type of a block's elements")?;
        let kind = ElementType::from_number(kind, numbers.place())?;
        let in_block: usize = numbers.count("the number of elements in a block")?;
        if in_block == 0 || in_block > number - done {
            return Err(numbers
                .error(format!(
                    "expected a block of 1 to {} elements, found {in_block}",
                    number - done
                ))
                .advise("the number of elements at the start of the section may be wrong"));
        }
        let tags = numbers.count("the number of tags of an element")?;
        for _ in 0..in_block {
            let _tag = numbers.int("the tag of an element")?;
            tags_and_nodes(&mut numbers, kind, tags, builder)?;
        }
        done += in_block;
    }
    Ok(())
}

/// The first tag is the physical group, 0 for none; the others are of no use here.
fn tags_and_nodes(
    numbers: &mut Numbers<'_, '_>,
    kind: ElementType,
    tags: usize,
    builder: &mut Builder,
) -> Result<()> {
    let place = numbers.place();
    let mut group = 0;
    for index in 0..tags {
        let tag = numbers.int("a tag of an element")?;
        if index == 0 {
            group = tag;
        }
    }
    let mut nodes = [0; ElementType::MOST_NODES];
    let nodes = &mut nodes[..kind.node_count()];
    for node in nodes.iter_mut() {
        *node = numbers.count("the tag of an element's node")?;
    }
    builder.element(kind, &[group], nodes, place)
}
