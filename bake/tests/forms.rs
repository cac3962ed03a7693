//! The forms of "Volume Enclosed by Subdivision Surfaces" against the figures printed there, and
//! against invariances that need no figure.

use num_rational::BigRational;
use octruss_bake::forms::exact::{Field, Quadratic};
use octruss_bake::forms::make::{FORM_ERROR, exact_form, real_form};
use octruss_bake::forms::{FormError, Scheme, TrilinearForm};

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
        assert_eq!(
            coefficient(&form, indices) * &half,
            rational(want),
            "{scheme}"
        );
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
        assert_eq!(
            coefficient(&form, indices) * factor,
            rational(want),
            "{scheme}"
        );
    }
}

/// Double precision against exact forms, every valence whose weights are exact and cheap.
#[test]
fn double_precision_keeps_its_stated_error() {
    for (scheme, valences) in [
        (Scheme::DooSabin, &[3, 4, 5, 6, 8][..]),
        (Scheme::CatmullClark, &[3, 4]),
        (Scheme::Loop, &[3, 4, 5, 6, 8]),
        (Scheme::LoopWarren, &[3, 4, 5, 6, 7]),
    ] {
        for &valence in valences {
            let exact = exact_form(scheme, valence).expect("an exact form");
            let real = real_form(scheme, valence).expect("a form");
            assert_eq!(exact.size(), scheme.control_point_count(valence));
            let pairs = exact.coefficients().iter().zip(real.coefficients());
            let error = pairs.fold(0.0_f64, |most, (want, got)| {
                most.max((want.to_f64() - got).abs())
            });
            let greatest = real
                .coefficients()
                .iter()
                .fold(0.0_f64, |most, c| most.max(c.abs()));
            assert!(
                error <= FORM_ERROR * greatest,
                "{scheme} {valence}: {error}"
            );
        }
    }
}

/// Mirror images have the opposite form: with the sign that an alternating form brings.
#[test]
fn forms_have_the_mirror_symmetry_of_their_facet() {
    // The paper's sigma at valence 5 for Loop: 3 2 1 7 6 5 4 10 9 8 11, counted from 1.
    let mirror = [3, 2, 1, 7, 6, 5, 4, 10, 9, 8, 11].map(|index: usize| index - 1);
    let form = exact_form(Scheme::Loop, 5).expect("an exact form");
    for i in 0..11 {
        for j in i + 1..11 {
            for k in j + 1..11 {
                let image = form.get(mirror[i], mirror[j], mirror[k]);
                assert_eq!(form.get(i, j, k), image.negated());
            }
        }
    }
}

/// Triples of control points that the irregular place does not touch have the regular
/// coefficients (the paper's second remark on each scheme).
#[test]
fn outer_coefficients_are_regular() {
    for scheme in [Scheme::DooSabin, Scheme::Loop] {
        let regular = exact_form(scheme, scheme.regular_valence()).expect("the regular form");
        let irregular = exact_form(scheme, 5).expect("an exact form");
        let outer = scheme.outer_control_points();
        for &i in outer {
            for &j in outer {
                for &k in outer {
                    assert_eq!(regular.get(i, j, k), irregular.get(i, j, k), "{scheme}");
                }
            }
        }
    }
}

#[test]
fn valences_up_to_64_have_a_form_and_others_are_refused() {
    for scheme in Scheme::ALL {
        assert_eq!(real_form(scheme, 2), Err(FormError::Valence { valence: 2 }));
        assert_eq!(
            real_form(scheme, 65),
            Err(FormError::Valence { valence: 65 })
        );
    }
    assert_eq!(real_form(Scheme::Loop, 64).map(|form| form.size()), Ok(70));
    assert_eq!(
        exact_form(Scheme::Loop, 7),
        Err(FormError::NotExact { valence: 7 })
    );
}
