//! Instructions of projecting poses to limits and a held volume, and of telling their health.
//!
//! The bundle `projection.oct` and the goals of all calls, `poses.bin` (first the motion's poses, then those that stray),
//! come from the host into the board's large memory (16 MiB that only the emulated boards have). Figures are those of
//! whole calls, counted by `octruss_firmware::instructions`, exactly.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::slice;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss::control::health::Health;
use octruss::control::project::{GaveUp, Limits, ProjectScratch, RegionGoal, ScratchLengths};
use octruss::enclosed::VolumeForm;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;
use zerocopy::FromBytes;

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// What is used of it for each file.
const LENGTH: usize = 4 << 20;
/// Control points that there is memory for.
const POINTS: usize = 128;

#[entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let Ok(mut counter) = InstructionCounter::start(core.SYST) else {
        refuse("the clock does not follow the instructions: run with -icount shift=7")
    };
    // SAFETY: the boards that this image runs on have 16 MiB there, which nothing else uses; the two parts do not
    // overlap.
    let (bundle, poses) = unsafe {
        (
            slice::from_raw_parts_mut(LARGE_MEMORY as *mut u8, LENGTH),
            slice::from_raw_parts_mut((LARGE_MEMORY + LENGTH) as *mut u8, LENGTH),
        )
    };
    let length = Input::open(c"projection.oct").read(bundle);
    let Ok(bundle) = Bundle::new_checked(bundle.get(..length).unwrap_or_default()) else {
        refuse("projection.oct does not open")
    };
    let (Ok(Some(limits)), Ok(Some(health)), Ok(Some(form))) = (
        bundle.limits::<i32>(),
        bundle.health::<i32>(),
        bundle.volume_form::<i32>(0),
    ) else {
        refuse("projection.oct holds no limits, no cells or no volume")
    };
    let length = Input::open(c"poses.bin").read(poses);
    let Ok(poses) = <[[i32; 3]]>::ref_from_bytes(poses.get(..length).unwrap_or_default()) else {
        refuse("poses.bin holds no poses")
    };
    let rest = bundle.rest_cage();
    if rest.len() > POINTS {
        refuse("the cage has more control points than there is memory for")
    }
    let mut bench = Bench {
        counter: &mut counter,
        limits: &limits,
        health: &health,
        form: &form,
        rest,
    };
    let (motion, strayed) = poses.split_at(poses.len() / 2);
    bench.run("motion", motion);
    bench.run("strayed", strayed);
    exit::finish()
}

struct Bench<'a, 'b> {
    counter: &'a mut InstructionCounter,
    limits: &'a Limits<'b>,
    health: &'a Health<'b>,
    form: &'a VolumeForm<'b>,
    rest: &'a [[i32; 3]],
}

/// What many calls took.
#[derive(Default)]
struct Spent {
    sum: u32,
    most: u32,
    calls: u32,
}

impl Spent {
    fn add(&mut self, counted: u32) {
        self.sum = self.sum.saturating_add(counted);
        self.most = self.most.max(counted);
        self.calls = self.calls.saturating_add(1);
    }

    fn log(&self, what: &str, goals: &str) {
        log(what, goals, "mean", self.sum / self.calls.max(1));
        log(what, goals, "most", self.most);
        log(what, goals, "calls", self.calls);
    }
}

impl Bench<'_, '_> {
    /// Projects all goals, each from the pose before, and logs what it took.
    fn run(&mut self, name: &str, goals: &[[i32; 3]]) {
        let count = self.rest.len();
        let mut memory = [[[0_i32; 3]; POINTS]; 7];
        let mut wide = [[[0_i64; 3]; POINTS]; 2];
        let [pose, lower, upper, current, candidate, gradients, workspace] = &mut memory;
        let [forces, form_gradient] = &mut wide;
        let pose = &mut pose[..count];
        pose.copy_from_slice(self.rest);
        let needed = self.form.workspace_length();
        let Some(Ok(rest)) = workspace
            .get_mut(..needed)
            .map(|own| self.form.volume(self.rest, own))
        else {
            refuse("the volume at rest cannot be told")
        };
        let region = [RegionGoal::hold(self.form, rest.volume)];
        let lengths = ScratchLengths::of(&region);
        let (mut projecting, mut telling) = (Spent::default(), Spent::default());
        let (mut steps, mut missed) = (0, 0);
        for goal in goals.chunks_exact(count) {
            let goal = black_box(goal);
            let scratch = ProjectScratch {
                lower: &mut lower[..count],
                upper: &mut upper[..count],
                current: &mut current[..count],
                candidate: &mut candidate[..count],
                gradients: &mut gradients[..lengths.gradients],
                form_workspace: &mut workspace[..lengths.form],
                forces: &mut forces[..count],
                form_gradient: &mut form_gradient[..lengths.form],
            };
            let limits = self.limits;
            let (report, counted) = self
                .counter
                .count(|| limits.project(goal, &region, scratch, pose));
            projecting.add(counted);
            let Ok(report) = report else {
                refuse("a projection is refused")
            };
            steps = report.steps.max(steps);
            missed += u32::from(report.gave_up.contains(GaveUp::VOLUME_MISSED));
            let health = self.health;
            let (told, counted) = self.counter.count(|| health.of(black_box(&*pose)));
            telling.add(counted);
            if told.is_err() {
                refuse("a pose's health cannot be told")
            }
        }
        projecting.log("projection", name);
        log("projection", name, "steps", steps);
        log("projection", name, "missed", missed);
        telling.log("health", name);
    }
}

fn log(what: &str, goals: &str, word: &str, number: u32) {
    let mut text = heapless::String::<64>::new();
    for part in [what, goals, word] {
        // Names are shorter than the text.
        let _ = text.push_str(part);
        let _ = text.push(' ');
    }
    figure(text.trim_end(), number);
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
