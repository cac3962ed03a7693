//! The volume as one form over the control points, and in the device's integers.

mod forms_support;

use forms_support::{Shape, cubes};
use octruss::enclosed::{EnclosedError, VolumeForm};
use octruss_bake::forms::solid::Enclosure;
use octruss_bake::forms::{ClosedMesh, ControlForm, DeviceForm, LimitSurface, Scheme};
use octruss_bake::mesh::Features;
use zerocopy::IntoBytes;

const BITS: u32 = 20;

fn shape(seed: u64) -> Shape {
    let cells = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    cubes(&cells).triangulated().scaled(1000).shaken(seed, 200)
}

fn surface(shape: &Shape) -> LimitSurface<f64> {
    let mesh = ClosedMesh::new(shape.points.len(), &shape.faces).unwrap();
    LimitSurface::new(Scheme::Loop, &mesh).unwrap()
}

/// Coordinates of some thousand units as raw bits.
fn bits(shape: &Shape) -> Vec<[i32; 3]> {
    let scale = (1_i64 << BITS) / 4096;
    let coordinate = |c: i64| i32::try_from(c * scale * 300).unwrap();
    shape
        .points
        .iter()
        .map(|point| point.map(coordinate))
        .collect()
}

fn real(bits: &[[i32; 3]]) -> Vec<[f64; 3]> {
    bits.iter().map(|point| point.map(f64::from)).collect()
}

/// One form over the control points gives what the facets' forms give.
#[test]
fn one_form_stands_for_all_facets() {
    let shape = shape(1);
    let surface = surface(&shape);
    let form = ControlForm::of_surface(&surface).unwrap();
    for seed in 2..6 {
        let pose = shape.shaken(seed, 400).real();
        let volume = surface.volume(&pose).unwrap();
        assert!((form.volume(&pose) / volume - 1.0).abs() < 1e-12);
        let gradient = surface.gradient(&pose).unwrap();
        let size = gradient
            .iter()
            .flatten()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        for (point, own) in form.points.iter().zip(form.gradient(&pose)) {
            for axis in 0..3 {
                assert!((own[axis] - gradient[*point][axis]).abs() < 1e-10 * size);
            }
        }
    }
}

/// The device's volume is within its bound, and its gradient within 2^-22 of the greatest.
#[test]
fn the_device_keeps_its_bound() {
    let shape = shape(1);
    let rest = bits(&shape);
    let form = ControlForm::of_surface(&surface(&shape)).unwrap();
    let device = DeviceForm::new(&form, &rest).unwrap();
    let view = VolumeForm::new_checked(device.parts(), rest.len()).unwrap();
    let mut workspace = vec![[0; 3]; view.workspace_length()];
    let mut gradient = vec![[0; 3]; view.points().len()];
    let mut worst: f64 = 0.0;
    for seed in 2..40 {
        let pose = bits(&shape.shaken(seed, 500));
        let got = view
            .volume_and_gradient(&pose, &mut workspace, &mut gradient)
            .unwrap();
        assert_eq!(got.saturated, 0);
        let want = form.volume(&real(&pose));
        #[expect(clippy::cast_precision_loss, reason = "about 56 bits")]
        let error = (got.volume as f64 * device.volume_unit() - want).abs();
        let bound = device.volume_bound(device.reach(&pose));
        assert!(error <= bound, "{error} {bound}");
        assert!(bound < 1e-4 * want);
        worst = worst.max(error / want);
        let slopes = form.gradient(&real(&pose));
        let size = slopes
            .iter()
            .flatten()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        for (name, own) in view.points().iter().zip(&gradient) {
            let place = form
                .points
                .iter()
                .position(|point| point == &usize::from(*name))
                .unwrap();
            for axis in 0..3 {
                #[expect(clippy::cast_precision_loss, reason = "48 bits")]
                let got = own[axis] as f64 * device.gradient_unit();
                let error = (got - slopes[place][axis]).abs() / size;
                assert!(error < 1.0 / f64::from(1 << 22), "{error}");
            }
        }
    }
    println!("greatest error of the volume, relative: {worst:e}");
}

/// A section gives the parts back, and is refused if a byte is missing, too many or misplaced.
#[test]
fn sections_are_read_in_place() {
    let shape = shape(1);
    let form = ControlForm::of_surface(&surface(&shape)).unwrap();
    let device = DeviceForm::new(&form, &bits(&shape)).unwrap();
    let section = device.section();
    assert_eq!(section.len(), device.bytes());
    let mut words = vec![0_u64; section.len().div_ceil(8) + 1];
    let bytes = words.as_mut_bytes();
    bytes[..section.len()].copy_from_slice(&section);
    let same = |form: VolumeForm<'_>| *form.parts() == device.parts();
    let open = |bytes: &[u8]| VolumeForm::from_section(bytes, shape.points.len()).map(same);
    assert_eq!(open(&bytes[..section.len()]), Ok(true));
    let layout = Err(EnclosedError::Layout { place: 0 });
    assert_eq!(open(&bytes[..section.len() - 1]), layout);
    assert_eq!(open(&bytes[..=section.len()]), layout);
    assert_eq!(open(&bytes[..31]), layout);
    bytes.copy_within(..section.len(), 1);
    assert_eq!(open(&bytes[1..=section.len()]), layout);
}

/// With creases the polyhedra of two levels are extrapolated. A cube whose edges are creases and
/// whose corners are corners is its own limit surface.
#[test]
fn creases_are_extrapolated() {
    let shape = cubes(&[[0, 0, 0]]).triangulated();
    let corners = Features {
        corners: (0..8).collect(),
        ..Features::default()
    };
    let mut all = corners.clone();
    for face in &cubes(&[[0, 0, 0]]).faces {
        all.creases.extend([
            [face[0], face[1]],
            [face[1], face[2]],
            [face[2], face[3]],
            [face[3], face[0]],
        ]);
    }
    all.normalise();
    let surface = Enclosure::new(&shape.faces, &all).unwrap();
    let [form, before] = surface.control_forms(Scheme::Loop).unwrap();
    // All edges are straight creases with fixed ends: the surface is the cube.
    assert!((form.volume(&shape.real()) - 1.0).abs() < 1e-12);
    assert!((before.volume(&shape.real()) - 1.0).abs() < 1e-12);
    assert!(surface.limit(Scheme::Loop).is_err());
}
