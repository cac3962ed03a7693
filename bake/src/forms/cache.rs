//! Forms that were made once are kept for the life of the process.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::error::FormError;
use super::exact::{Field, Quadratic};
use super::form::TrilinearForm;
use super::make;
use super::scheme::Scheme;

type Shelf<F> = Mutex<BTreeMap<(Scheme, usize), Arc<TrilinearForm<F>>>>;

static REAL: Shelf<f64> = Mutex::new(BTreeMap::new());
static EXACT: Shelf<Quadratic> = Mutex::new(BTreeMap::new());

/// A field whose forms are made on demand and kept.
pub trait FormField: Field {
    /// The form of a facet of this valence.
    ///
    /// # Errors
    ///
    /// [`FormError::NotExact`] if the weights do not lie in the field, [`FormError::Valence`] if
    /// there is no such facet.
    fn form(scheme: Scheme, valence: usize) -> Result<Arc<TrilinearForm<Self>>, FormError>;

    /// Makes sure that the weights of all these valences lie in one field.
    ///
    /// # Errors
    ///
    /// [`FormError::NotExact`] if they do not.
    fn require(scheme: Scheme, valences: &[usize]) -> Result<(), FormError>;
}

impl FormField for f64 {
    fn form(scheme: Scheme, valence: usize) -> Result<Arc<TrilinearForm<Self>>, FormError> {
        keep(&REAL, scheme, valence, make::real_form)
    }

    fn require(_: Scheme, _: &[usize]) -> Result<(), FormError> {
        Ok(())
    }
}

impl FormField for Quadratic {
    fn form(scheme: Scheme, valence: usize) -> Result<Arc<TrilinearForm<Self>>, FormError> {
        keep(&EXACT, scheme, valence, make::exact_form)
    }

    fn require(scheme: Scheme, valences: &[usize]) -> Result<(), FormError> {
        scheme.exact_radicand(valences).map(|_| ())
    }
}

fn keep<F: Field>(
    shelf: &Shelf<F>,
    scheme: Scheme,
    valence: usize,
    make: impl Fn(Scheme, usize) -> Result<TrilinearForm<F>, FormError>,
) -> Result<Arc<TrilinearForm<F>>, FormError> {
    // A form is put on the shelf whole, so a shelf is sound even after a panic elsewhere.
    let lock = || shelf.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(form) = lock().get(&(scheme, valence)) {
        return Ok(Arc::clone(form));
    }
    let form = Arc::new(make(scheme, valence)?);
    Ok(Arc::clone(lock().entry((scheme, valence)).or_insert(form)))
}
