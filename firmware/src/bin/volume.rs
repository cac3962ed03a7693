//! Instructions of the enclosed volume: the form over all control points, and the polynomial of modes, each
//! without and with its derivatives.
//!
//! The bundle `volume.oct` comes from the host into the board's large memory (16 MiB that only the emulated
//! boards have). Figures are those of whole calls, counted by `octruss_firmware::instructions`, exactly.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::slice;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// What is used of it.
const LENGTH: usize = 4 << 20;
/// Control points at most.
const CONTROL_POINTS: usize = 256;
/// Modes at most.
const MODES: usize = 32;
/// A tenth, with 30 fraction bits.
const TENTH: i32 = 107_374_182;

#[entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let Ok(mut counter) = InstructionCounter::start(core.SYST) else {
        refuse("the clock does not follow the instructions: run with -icount shift=7")
    };
    figure("instruction error bound", counter.error_bound());
    // SAFETY: the boards that this image runs on have 16 MiB there, which nothing else uses.
    let memory = unsafe { slice::from_raw_parts_mut(LARGE_MEMORY as *mut u8, LENGTH) };
    let length = Input::open(c"volume.oct").read(memory);
    let Ok(bundle) = Bundle::new_checked(memory.get(..length).unwrap_or_default()) else {
        refuse("volume.oct does not open")
    };
    form(&mut counter, &bundle);
    modes(&mut counter, &bundle);
    exit::finish()
}

fn form(counter: &mut InstructionCounter, bundle: &Bundle<'_>) {
    let Ok(Some(form)) = bundle.volume_form::<i32>(0) else {
        refuse("volume.oct holds no form")
    };
    let (mut workspace, mut gradient) = ([[0; 3]; CONTROL_POINTS], [[0; 3]; CONTROL_POINTS]);
    let (Some(workspace), Some(gradient)) = (
        workspace.get_mut(..form.workspace_length()),
        gradient.get_mut(..form.points().len()),
    ) else {
        refuse("the region has more control points than this image holds")
    };
    let pose = black_box(bundle.rest_cage());
    let (volume, counted) = counter.count(|| form.volume(pose, workspace));
    figure("volume", counted);
    let (both, counted) = counter.count(|| form.volume_and_gradient(pose, workspace, gradient));
    figure("volume and gradient", counted);
    if volume != both {
        refuse("the two calls give two volumes")
    }
}

fn modes(counter: &mut InstructionCounter, bundle: &Bundle<'_>) {
    let Ok(Some(modes)) = bundle.volume_modes::<i32>(0) else {
        refuse("volume.oct holds no modes")
    };
    let (amplitudes, mut gradient) = ([TENTH; MODES], [0; MODES]);
    let (Some(amplitudes), Some(gradient)) = (
        amplitudes.get(..modes.modes()),
        gradient.get_mut(..modes.modes()),
    ) else {
        refuse("there are more modes than this image holds")
    };
    let amplitudes = black_box(amplitudes);
    let (volume, counted) = counter.count(|| modes.volume(amplitudes));
    figure("volume by modes", counted);
    let (both, counted) = counter.count(|| modes.volume_and_gradient(amplitudes, gradient));
    figure("volume and gradient by modes", counted);
    if volume != both {
        refuse("the two calls give two volumes")
    }
    let Ok(Some(centroid)) = bundle.centroid_modes::<i32>(0) else {
        refuse("volume.oct holds no centroid")
    };
    let volume = volume.unwrap_or_default();
    let (found, counted) = counter.count(|| centroid.offset(amplitudes, volume));
    figure("centroid by modes", counted);
    if found.is_err() {
        refuse("there is no centroid")
    }
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
