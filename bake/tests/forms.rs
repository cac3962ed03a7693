//! The forms of "Volume Enclosed by Subdivision Surfaces" against the figures printed there, and
//! against invariances that need no figure.

use num_rational::BigRational;
use octruss_bake::forms::exact::{Field, Quadratic};
use octruss_bake::forms::make::{exact_form, real_form};
use octruss_bake::forms::{Scheme, TrilinearForm};

fn rational(text: &str) -> BigRational {
    text.parse().expect("a fraction")
}

/// The coefficient with the paper's indices, counted from 1.
fn coefficient(form: &TrilinearForm<Quadratic>, indices: [usize; 3]) -> BigRational {
    let [i, j, k] = indices.map(|index| index - 1);
    let value = form.get(i, j, k);
    assert_eq!(value.radicand(), 1);
    value.rational().clone()
}

/// The paper's A-hat is half of its Y-hat: an alternating form is twice its skew part.
#[test]
fn regular_coefficients_are_the_printed_ones() {
    let half = rational("1/2");
    for (scheme, indices, want) in [
        (Scheme::DooSabin, [8, 1, 2], "11/19200"),
        (Scheme::CatmullClark, [5, 1, 6], "61595/877879296"),
        (Scheme::Loop, [5, 1, 7], "1787/119750400"),
    ] {
        let form = exact_form(scheme, scheme.regular_valence()).expect("the regular form");
        assert_eq!(coefficient(&form, indices) * &half, rational(want), "{scheme}");
    }
}

/// The paper prints the Catmull-Clark one as Y-hat, but it is A-hat, its half.
#[test]
fn irregular_coefficients_are_the_printed_ones() {
    for (scheme, valence, indices, halved, want) in [
        (Scheme::DooSabin, 3, [8, 7, 2], false, "3324559/2891332800"),
        (
            Scheme::CatmullClark,
            5,
            [11, 5, 3],
            true,
            "17370080190337845057804377871061038705914533/\
             87765797398722937794631199843811365617667174400",
        ),
        (
            Scheme::Loop,
            4,
            [10, 8, 9],
            false,
            "22663731969915204014725535462759500947683/\
             18792363864674566857783671734314366207000000",
        ),
    ] {
        let form = exact_form(scheme, valence).expect("an exact form");
        let factor = rational(if halved { "1/2" } else { "1" });
        assert_eq!(coefficient(&form, indices) * factor, rational(want), "{scheme}");
    }
}

#[test]
fn t() {
    for scheme in Scheme::ALL {
        for valence in 3..=12 {
            let start = std::time::Instant::now();
            let exact = exact_form(scheme, valence);
            let t = start.elapsed();
            let start = std::time::Instant::now();
            let real = real_form(scheme, valence).unwrap();
            let u = start.elapsed();
            let Ok(exact) = exact else { continue };
            let big = real.coefficients().iter().fold(0.0f64, |g, v| g.max(v.abs()));
            let err = exact.coefficients().iter().zip(real.coefficients()).map(|(a, b)| (a.to_f64() - b).abs()).fold(0.0, f64::max);
            println!("{scheme} {valence} exact {t:?} real {u:?} relative error {:e}", err / big);
            if scheme == Scheme::CatmullClark && valence > 6 { break; }
        }
    }
}
