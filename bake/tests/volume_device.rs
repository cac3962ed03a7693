//! The volume as one form over the control points, and in the device's integers.

mod forms_support;

use forms_support::{Shape, cubes};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed as _, ToPrimitive as _, Zero as _};
use octruss::enclosed::{EnclosedError, VolumeForm, VolumeModes};
use octruss_bake::forms::solid::Enclosure;
use octruss_bake::forms::{
    ClosedMesh, ControlForm, DeviceForm, DeviceModes, LimitSurface, ModeVolume, Scheme,
};
use octruss_bake::mesh::Features;
use octruss_bake::surface::SurfaceScheme;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
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

/// The exact volume of a form at a pose: its coefficients are double-precision numbers, so everything is rational.
fn exact_volume(form: &ControlForm, pose: &[[i32; 3]]) -> BigRational {
    let at = |place: usize| pose[form.points[place]].map(BigInt::from);
    let count = form.points.len();
    let mut sum = BigRational::zero();
    for i in 0..count {
        for j in i + 1..count {
            for k in j + 1..count {
                let coefficient = form.form.get(i, j, k);
                if coefficient != 0.0 {
                    let [a, b, c] = [at(i), at(j), at(k)];
                    let minor = |p: usize, q: usize| &b[p] * &c[q] - &b[q] * &c[p];
                    let determinant =
                        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
                    let exact = BigRational::from_float(coefficient).unwrap();
                    sum += exact * BigRational::from(determinant);
                }
            }
        }
    }
    sum
}

/// The bound holds for poses of the whole range of coordinates, its ends included, against exact rational numbers.
#[test]
fn the_bound_holds_at_the_ends_of_the_range() {
    let shape = shape(1);
    // A rest pose that fills the range but for a tenth.
    let mut rest = bits(&shape);
    let greatest = rest
        .as_flattened()
        .iter()
        .map(|own| own.unsigned_abs())
        .max();
    let wider = i32::MAX.unsigned_abs() / 10 * 9 / greatest.unwrap();
    let wider = i32::try_from(wider).unwrap();
    rest.as_flattened_mut()
        .iter_mut()
        .for_each(|own| *own *= wider);
    let form = ControlForm::of_surface(&surface(&shape)).unwrap();
    let device = DeviceForm::new(&form, &rest).unwrap();
    let view = VolumeForm::new_checked(device.parts(), rest.len()).unwrap();
    let mut workspace = vec![[0; 3]; view.workspace_length()];
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let (mut clamped, mut worst) = (0, 0.0_f64);
    for number in 0..60 {
        // All at the ends; the rest pose, some of it pushed to the ends; anything.
        let mut pose = rest.clone();
        for coordinate in pose.as_flattened_mut() {
            *coordinate = match number % 3 {
                0 if rng.random() => i32::MIN,
                0 => i32::MAX,
                1 => coordinate.saturating_add(rng.random::<i32>() / 4),
                _ => rng.random(),
            };
        }
        let got = view.volume(&pose, &mut workspace).unwrap();
        if got.saturated != 0 {
            clamped += 1;
            continue;
        }
        let unit = BigRational::from_float(device.volume_unit()).unwrap();
        let own = BigRational::from(BigInt::from(got.volume)) * unit;
        let error = (own - exact_volume(&form, &pose)).abs();
        let bound = device.volume_bound(device.reach(&pose));
        let part = error.to_f64().unwrap() / bound;
        assert!(part <= 1.0, "pose {number}: {part} of the bound");
        worst = worst.max(part);
    }
    println!("{clamped} of 60 poses were clamped; at most {worst:.2} of the bound");
    assert!(clamped < 40);
}

/// The bound of the gradient likewise. The volume is affine in every coordinate, so exact differences are derivatives.
#[test]
fn the_gradients_bound_holds_at_the_ends_of_the_range() {
    let shape = shape(1);
    let mut rest = bits(&shape);
    rest.as_flattened_mut().iter_mut().for_each(|own| *own *= 4);
    let form = ControlForm::of_surface(&surface(&shape)).unwrap();
    let device = DeviceForm::new(&form, &rest).unwrap();
    let view = VolumeForm::new_checked(device.parts(), rest.len()).unwrap();
    let mut workspace = vec![[0; 3]; view.workspace_length()];
    let mut gradient = vec![[0; 3]; view.points().len()];
    let unit = BigRational::from_float(device.gradient_unit()).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut worst = [0.0_f64; 2];
    for number in 0..6 {
        let mut pose = rest.clone();
        for coordinate in pose.as_flattened_mut() {
            *coordinate = match number % 3 {
                0 if rng.random() => i32::MIN,
                0 => i32::MAX - 1,
                1 => *coordinate,
                _ => rng.random::<i32>() / 2,
            };
        }
        let got = view
            .volume_and_gradient(&pose, &mut workspace, &mut gradient)
            .unwrap();
        let bound = device.gradient_bound(device.reach(&pose));
        let start = exact_volume(&form, &pose);
        for (place, (point, slope)) in view.points().iter().zip(&gradient).enumerate() {
            for (axis, own) in slope.iter().enumerate() {
                if own.unsigned_abs() >= (1 << 47) - 1 {
                    assert!(got.saturated > 0);
                    continue;
                }
                let mut moved = pose.clone();
                moved[usize::from(*point)][axis] += 1;
                let want = exact_volume(&form, &moved) - &start;
                let error = (BigRational::from(BigInt::from(*own)) * &unit - want).abs();
                let kind = usize::from(place == 0);
                if kind == 1 && got.saturated > 0 {
                    continue;
                }
                let part = error.to_f64().unwrap() / bound[kind];
                assert!(
                    part <= 1.0,
                    "pose {number}, point {point}: {part} of the bound"
                );
                worst[kind] = worst[kind].max(part);
            }
        }
    }
    println!("at most {worst:.2?} of the gradient's bounds");
    assert!(worst[0] > 1e-3, "the bound says something: {worst:?}");
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

/// A cube whose edges are creases and whose corners are corners is its own limit surface.
fn sharp_cube() -> (Shape, Enclosure) {
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
    (shape, surface)
}

/// With creases the polyhedra of two levels are extrapolated.
#[test]
fn creases_are_extrapolated() {
    let (shape, surface) = sharp_cube();
    let [form, before] = surface.control_forms(SurfaceScheme::Loop).unwrap();
    // All edges are straight creases with fixed ends: the surface is the cube.
    assert!((form.volume(&shape.real()) - 1.0).abs() < 1e-12);
    assert!((before.volume(&shape.real()) - 1.0).abs() < 1e-12);
    assert!(surface.limit(SurfaceScheme::Loop).is_err());
}

/// A cube that three modes stretch along the axes has the volume (1 + q_1)(1 + q_2)(1 + q_3): eight
/// of its twenty coefficients are one, the others zero.
#[test]
fn a_stretched_cube_is_a_product() {
    let (shape, surface) = sharp_cube();
    let [form, _] = surface.control_forms(SurfaceScheme::Loop).unwrap();
    let rest = shape.real();
    let stretched = |axis: usize| -> Vec<[f64; 3]> {
        let mut pose = rest.clone();
        pose.iter_mut().for_each(|point| point[axis] *= 2.0);
        pose
    };
    let volume = ModeVolume::new(&form, &rest, &[0, 1, 2].map(stretched));
    let mut indices = (0..4).flat_map(|a| (a..4).flat_map(move |b| (b..4).map(move |c| [a, b, c])));
    assert_eq!(volume.coefficients.len(), 20);
    for coefficient in &volume.coefficients {
        let [a, b, c] = indices.next().unwrap();
        let repeats = (a == b && a > 0) || (b == c && b > 0);
        let want = if repeats { 0.0 } else { 1.0 };
        assert!(
            (coefficient - want).abs() < 1e-12,
            "{a} {b} {c}: {coefficient}"
        );
    }
}

/// The polynomial of sixteen modes is the form of the combined pose, and the device's integers keep
/// their stated bound to it.
#[test]
fn modes_stand_for_their_poses() {
    let shape = shape(1);
    let form = ControlForm::of_surface(&surface(&shape)).unwrap();
    let rest = shape.real();
    let poses: Vec<Vec<[f64; 3]>> = (0..16)
        .map(|mode| shape.shaken(20 + mode, 100).real())
        .collect();
    let volume = ModeVolume::new(&form, &rest, &poses);
    assert_eq!(volume.coefficients.len(), 969);
    let device = DeviceModes::new(&volume, 10);
    let section = device.section();
    let mut words = vec![0_u64; section.len().div_ceil(8)];
    words.as_mut_bytes()[..section.len()].copy_from_slice(&section);
    let view = VolumeModes::from_section(&words.as_bytes()[..section.len()]).unwrap();
    let unit = 2.0_f64.powi(i32::try_from(view.volume_exponent() - 30).unwrap());
    let bound = device.volume_bound(1.0) * 2.0_f64.powi(-30);
    let mut greatest = 0.0_f64;
    for seed in 0..40_i64 {
        // Multiples of 2^-30 from -1 to 1, by a linear congruence.
        let amplitude =
            |mode: i64| (((seed * 16 + mode) * 1_103_515_245 + 12_345) % (1 << 31)) - (1 << 30);
        let bits: Vec<i32> = (0..16)
            .map(|mode| i32::try_from(amplitude(mode)).unwrap())
            .collect();
        let amplitudes: Vec<f64> = bits
            .iter()
            .map(|bits| f64::from(*bits) / 2.0_f64.powi(30))
            .collect();
        let mut pose = rest.clone();
        for (own, amplitude) in poses.iter().zip(&amplitudes) {
            for ((point, moved), at) in pose.iter_mut().zip(own).zip(&rest) {
                for axis in 0..3 {
                    point[axis] += amplitude * (moved[axis] - at[axis]);
                }
            }
        }
        let real = volume.volume(&amplitudes);
        assert!((form.volume(&pose) / real - 1.0).abs() < 1e-11);
        let got = view.volume(&bits).unwrap();
        let error = (got as f64 * unit - real).abs();
        assert!(error <= bound, "{error} {bound}");
        greatest = greatest.max(error);
    }
    // The bound is worth something.
    assert!(greatest * 1e4 > bound, "{greatest} {bound}");
}

#[test]
fn sections_of_modes_are_checked() {
    let modes = DeviceModes {
        modes: 1,
        coefficients: vec![5, 4, 3, 2],
        exponent: -7,
    };
    let section = modes.section();
    let open = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = section.clone();
        change(&mut bytes);
        let mut words = vec![0_u64; bytes.len().div_ceil(8)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(&bytes);
        let view = VolumeModes::from_section(&words.as_bytes()[..bytes.len()]);
        view.map(|view| {
            (
                view.modes(),
                view.volume_exponent(),
                view.gradient_exponent(),
            )
        })
    };
    let layout = Err(EnclosedError::Layout { place: 0 });
    assert_eq!(open(&|_| {}), Ok((1, -35, -36)));
    assert_eq!(open(&|bytes| bytes.truncate(15)), layout);
    assert_eq!(open(&|bytes| bytes.truncate(31)), layout);
    assert_eq!(open(&|bytes| bytes[12] = 1), layout);
    assert_eq!(open(&|bytes| bytes[2] = 1), layout);
    assert_eq!(
        open(&|bytes| bytes.truncate(28)),
        Err(EnclosedError::Length {
            needed: 4,
            given: 3
        })
    );
}
