//! A goal for every control point, cut to what limits allow while a volume is held; then what that does to the cells.
//!
//! ```sh
//! octruss bake models/finger.msh --model models/finger.obj --unit mm --volume --limits finger.limits --health -o finger.oct
//! cargo run --release -p octruss --example projection_and_health finger.oct
//! ```
//!
//! `finger.limits` says what may move how far, such as `pin 0-3` and `speed 4-71 200` (`docs/files.md`).

#![allow(
    clippy::float_arithmetic,
    clippy::arithmetic_side_effects,
    reason = "an example that prints on a computer"
)]

use octruss::bundle::Bundle;
use octruss::control::health::RATIO_ONE;
use octruss::control::project::{ProjectScratch, RegionGoal, ScratchLengths};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("name a bundle")?;
    let bytes = std::fs::read(file)?;
    // A bundle lies on a multiple of 8; on a device `include_bundle!` sees to it.
    let mut words = vec![0_u64; bytes.len().div_ceil(8)];
    let aligned: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
    let aligned = aligned.get_mut(..bytes.len()).ok_or("no bytes")?;
    aligned.copy_from_slice(&bytes);
    let bundle = Bundle::new_checked(aligned)?;
    let limits = bundle.limits::<i32>()?.ok_or("bake with --limits")?;
    let form = bundle.volume_form::<i32>(0)?.ok_or("bake with --volume")?;
    let health = bundle.health::<i32>()?.ok_or("bake with --health")?;

    // The volume at rest is to be held.
    let rest = bundle.rest_cage();
    let workspace = &mut vec![[0; 3]; form.workspace_length()];
    let volume = form.volume(rest, workspace)?.volume;
    let regions = [RegionGoal::hold(&form, volume)];

    // What a call works in; on a device arrays of the same lengths, once for all calls.
    let (points, lengths) = (rest.len(), ScratchLengths::of(&regions));
    let mut of_points = [(); 4].map(|()| vec![[0; 3]; points]);
    let [lower, upper, current, candidate] = &mut of_points;
    let (mut forces, mut gradients) = (vec![[0; 3]; points], vec![[0; 3]; lengths.gradients]);
    let (mut form_workspace, mut form_gradient) =
        (vec![[0; 3]; lengths.form], vec![[0; 3]; lengths.form]);

    // Every control point is asked to go an eighth of a unit along x in every call.
    let unit = 1_i32.wrapping_shl(bundle.header().fraction_bits.get());
    let mut pose = rest.to_vec();
    for call in 1..=8 {
        let mut goal = pose.clone();
        for [x, _, _] in &mut goal {
            *x = x.saturating_add(unit / 8);
        }
        let scratch = ProjectScratch {
            lower,
            upper,
            current,
            candidate,
            forces: &mut forces,
            gradients: &mut gradients,
            form_workspace: &mut form_workspace,
            form_gradient: &mut form_gradient,
        };
        let report = limits.project(&goal, &regions, scratch, &mut pose)?;
        let cells = health.of(&pose)?;
        println!(
            "call {call}: {} steps, gave up {:#x}, volume off by {}, {} cells folded, least ratio {:.3}",
            report.steps,
            report.gave_up.bits(),
            report.volumes.first().copied().unwrap_or_default() - volume,
            cells.folded,
            f64::from(cells.least_ratio) / f64::from(RATIO_ONE)
        );
    }
    Ok(())
}
