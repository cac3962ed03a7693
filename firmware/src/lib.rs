#![no_std]
//! octruss
