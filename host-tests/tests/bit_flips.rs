//! A bundle with any one bit flipped is refused: every bit of small bundles in every format, and of
//! the demo's.
//!
//! Every damaged bundle is really opened, with the device's own `Bundle::new_checked`.

use std::num::NonZero;
use std::ops::Range;
use std::path::Path;
use std::thread;

use octruss::bundle::{Bundle, Header, Section};
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Scheme};
use octruss_bake::table::{Input, Options, Region, Request, TableFormat, bake};
use octruss_host_tests::random_bundle::{BundleCase, layout};
use zerocopy::IntoBytes;

/// Bundle bytes at the alignment that core asks for.
#[derive(Clone)]
struct Aligned {
    words: Vec<u64>,
    length: usize,
}

impl Aligned {
    fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0_u64; bytes.len().div_ceil(8)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
        Self {
            words,
            length: bytes.len(),
        }
    }

    fn bits(&self) -> Range<usize> {
        0..8 * self.length
    }

    fn flip(&mut self, bit: usize) {
        self.words.as_mut_bytes()[bit / 8] ^= 1 << (bit % 8);
    }

    fn opens(&self) -> bool {
        Bundle::new_checked(&self.words.as_bytes()[..self.length]).is_ok()
    }
}

/// Flips each of these bits alone, on all processors, and gives those with which the bundle opens all
/// the same.
fn accepted(bundle: &Aligned, bits: Range<usize>) -> Vec<usize> {
    assert!(bundle.opens(), "the bundle itself opens");
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let part = bits.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> = bits
            .clone()
            .step_by(part)
            .map(|start| {
                let bits = start..bits.end.min(start + part);
                let mut own = bundle.clone();
                scope.spawn(move || {
                    bits.filter(|&bit| {
                        own.flip(bit);
                        let opens = own.opens();
                        own.flip(bit);
                        opens
                    })
                    .collect::<Vec<_>>()
                })
            })
            .collect();
        let joined = parts.into_iter().map(|part| part.join().expect("no panic"));
        joined.flatten().collect()
    })
}

/// The finger as `cargo xtask demo` bakes it.
fn demo() -> Aligned {
    let options = Options {
        scheme: Scheme::Mixed,
        boundary: BoundaryRule::TriQuad,
        levels: 2,
        ..Options::default()
    };
    finger("finger-mixed.msh", options, 1)
}

/// A small bundle of the finger of tetrahedra: some hundred points, refined once.
fn small(format: Option<TableFormat>, volumes: &[Region]) -> Aligned {
    let options = Options {
        levels: 1,
        volumes: volumes.to_vec(),
        request: Request {
            format,
            ..Request::default()
        },
        ..Options::default()
    };
    finger("finger.msh", options, 40)
}

/// A finger, with every so many-th point of its model.
fn finger(cage: &str, options: Options, step: usize) -> Aligned {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let (cage_file, model_file) = (models.join(cage), models.join("finger.obj"));
    let cage = read::solid(&cage_file).expect("the example's cage");
    let model = read::model(&model_file).expect("the example's model");
    let points: Vec<_> = model.points.into_iter().step_by(step).collect();
    let options = Options {
        unit: "mm".to_owned(),
        ..options
    };
    let input = Input {
        cage: &cage,
        cage_file: &cage_file,
        model: &points,
        model_file: &model_file,
    };
    let baked = bake(input, &options, &mut Silent).expect("the example can be baked");
    Aligned::new(&baked.bundle)
}

#[test]
fn every_bit_of_small_bundles_counts() {
    let mut bits = 0;
    for seed in 0..16 {
        let case = BundleCase::new(seed, 12, 12, layout(seed));
        let bundle = Aligned::new(&case.bytes);
        assert_eq!(
            accepted(&bundle, bundle.bits()),
            Vec::<usize>::new(),
            "seed {seed}"
        );
        bits += bundle.bits().len();
    }
    println!("{bits} bundles with one bit flipped, all refused");
}

/// Header and section table of baked bundles: factored tables and a volume among them.
#[test]
fn every_bit_of_header_and_section_table_counts() {
    let formats = [
        (Some(TableFormat::Q30), &[][..]),
        (Some(TableFormat::Q14), &[Region::Whole][..]),
        (Some(TableFormat::Q30Factored), &[]),
        (Some(TableFormat::CompactFactored), &[Region::Whole]),
    ];
    for (format, volumes) in formats {
        let bundle = small(format, volumes);
        let opened = Bundle::new_checked(&bundle.words.as_bytes()[..bundle.length]);
        let sections = opened.expect("a sound bundle").header().sections.get() as usize;
        let bytes = size_of::<Header>() + sections * size_of::<Section>();
        assert_eq!(
            accepted(&bundle, 0..8 * bytes),
            Vec::<usize>::new(),
            "{format:?}"
        );
    }
}

#[test]
#[ignore = "almost six million bundles of two thirds of a megabyte: part of cargo xtask verify"]
fn every_bit_of_the_demo_counts() {
    let bundle = demo();
    let bits = bundle.bits();
    let accepted = accepted(&bundle, bits.clone());
    println!(
        "{} bytes: {} bundles with one bit flipped, {} opened",
        bundle.length,
        bits.len(),
        accepted.len()
    );
    assert_eq!(accepted, Vec::<usize>::new());
}
