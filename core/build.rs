//! Finds out whether the target has the instructions of `src/deform/kernel/cortex_m.rs`: stable Rust does
//! not tell programs about Arm's DSP extension.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(octruss_dsp)");
    let target = env::var("TARGET").unwrap_or_default();
    if target.starts_with("thumbv7em-") {
        println!("cargo::rustc-cfg=octruss_dsp");
    }
}
