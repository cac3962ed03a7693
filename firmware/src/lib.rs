//! What the Cortex-M images of octruss share.
//!
//! ```text
//!   images   controller   demo       conformance   bench   faults    (apply stands alone)
//!              |            |            |          |        |
//!   shared   controller   frame        cases        |        |       also built for the host
//!            link, actuators           |            |        |
//!              |            |            |          |        |
//!   device   start, exit, fault, stack, sections, instructions       Cortex-M only
//!              |
//!   board    board::mps2                                             one file a board
//! ```
//!
//! - Built for the host too, because both ends of a wire must agree: the framing of deformed
//!   frames on the serial port ([`frame`], which the [`player`] sends), the format of the case files ([`cases`]), and what an
//!   image says when it ends ([`exit`]).
//! - Built for Cortex-M only: the start of an image (`start`), its panic and fault handlers
//!   (`fault`), the stack's high-water mark (`stack`), the sizes of its sections (`sections`) and
//!   the instruction counter (`instructions`).
//! - A board is one file behind one feature; everything above it is generic over the traits of
//!   `embedded-hal` and `embedded-io`, so the same images run on another board by adding a file
//!   there and choosing its feature.
#![no_std]

pub mod actuators;
pub mod cases;
pub mod checksum;
pub mod controller;
mod example;
pub mod exit;
pub mod frame;
pub mod link;
pub mod palm;
pub mod player;
pub mod tick;

#[cfg(target_os = "none")]
pub mod board;
#[cfg(target_os = "none")]
mod fault;
#[cfg(target_os = "none")]
pub mod files;
#[cfg(target_os = "none")]
pub mod instructions;
#[cfg(target_os = "none")]
pub mod sections;
#[cfg(target_os = "none")]
pub mod stack;

// The logger that `defmt` writes to: semihosting, which QEMU and debuggers understand alike.
#[cfg(target_os = "none")]
use defmt_semihosting as _;
