//! All kinds that descend from some, and the points that each depends on.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

use super::patch::{Neighbourhood, Patch};
use super::solve::solve;
use super::step::Step;
use crate::forms::error::FormError;
use crate::forms::form::TrilinearForm;
use crate::forms::scheme::Row;
use crate::surface::SurfaceScheme;

/// The form of a kind of facet.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalForm {
    /// The patch's vertices that the form is over, ascending: those that the facet depends on.
    pub places: Vec<usize>,
    /// The form over them, in this order.
    pub form: Arc<TrilinearForm<f64>>,
    /// By how much no more than this, relative to the greatest coefficient, a coefficient differs from
    /// what the children's forms make of it.
    pub residual: f64,
}

/// A kind and its children.
pub(super) struct Kind {
    pub patch: Patch,
    pub children: Vec<Child>,
    /// The patch's vertices that the facet depends on.
    pub support: BTreeSet<usize>,
    /// The form, once it is known.
    pub form: Option<Arc<LocalForm>>,
}

/// A child of a kind.
pub(super) struct Child {
    /// Its own kind.
    pub kind: usize,
    /// Its vertices over the parent's.
    pub rows: Vec<Row<f64>>,
}

type Shelf = Mutex<BTreeMap<(u32, Patch), Arc<LocalForm>>>;

/// Forms that were made once are kept for the life of the process.
static SHELF: Shelf = Mutex::new(BTreeMap::new());

/// The forms of some kinds of facets, in their order.
///
/// # Errors
///
/// [`FormError::Refused`] if core refuses a patch.
pub fn forms(scheme: SurfaceScheme, patches: &[Patch]) -> Result<Vec<Arc<LocalForm>>, FormError> {
    let mut family = Family {
        scheme,
        kinds: Vec::new(),
        names: HashMap::new(),
    };
    let wanted = patches.iter().map(|patch| family.find(patch.clone()));
    let wanted = wanted.collect::<Vec<_>>();
    let mut place = 0;
    while place < family.kinds.len() {
        family.beget(place)?;
        place += 1;
    }
    spread(&mut family.kinds);
    solve(&mut family.kinds);
    // A form is put on the shelf whole, so the shelf is sound even after a panic elsewhere.
    let mut shelf = SHELF.lock().unwrap_or_else(PoisonError::into_inner);
    for kind in &family.kinds {
        if let Some(form) = &kind.form {
            shelf
                .entry((scheme.code(), kind.patch.clone()))
                .or_insert_with(|| Arc::clone(form));
        }
    }
    let form = |kind: usize| family.kinds[kind].form.clone();
    let found = wanted.into_iter().map(form);
    Ok(found
        .map(|form| form.expect("every kind is solved"))
        .collect())
}

/// Kinds as they are found.
struct Family {
    scheme: SurfaceScheme,
    kinds: Vec<Kind>,
    names: HashMap<Patch, usize>,
}

impl Family {
    /// The number of a kind, a new one if need be.
    fn find(&mut self, patch: Patch) -> usize {
        if let Some(&known) = self.names.get(&patch) {
            return known;
        }
        let shelf = SHELF.lock().unwrap_or_else(PoisonError::into_inner);
        let form = shelf.get(&(self.scheme.code(), patch.clone())).cloned();
        let support = match &form {
            Some(form) => form.places.iter().copied().collect(),
            // The polyhedron's form, which the iteration begins with, is over the corners.
            None => (0..patch.corners()).collect(),
        };
        self.names.insert(patch.clone(), self.kinds.len());
        self.kinds.push(Kind {
            patch,
            children: Vec::new(),
            support,
            form,
        });
        self.kinds.len() - 1
    }

    /// Finds the children of a kind whose form is not known.
    fn beget(&mut self, kind: usize) -> Result<(), FormError> {
        if self.kinds[kind].form.is_some() {
            return Ok(());
        }
        let (vertices, faces) = self.kinds[kind].patch.closed();
        let step = Step::new(self.scheme, vertices, &faces)?;
        let children = step.children(0).into_iter().map(|face| {
            let own = Neighbourhood::new(self.scheme, &step.mesh, face);
            let rows = own.points.iter().map(|&vertex| step.rows[vertex].clone());
            Child {
                rows: rows.collect(),
                kind: self.find(own.patch),
            }
        });
        self.kinds[kind].children = children.collect();
        Ok(())
    }
}

/// Lets every kind depend on what its children depend on, until nothing is new.
fn spread(kinds: &mut [Kind]) {
    let mut is_settled = false;
    while !is_settled {
        is_settled = true;
        for kind in (0..kinds.len()).rev() {
            let mut support = std::mem::take(&mut kinds[kind].support);
            let before = support.len();
            for child in &kinds[kind].children {
                // A kind's support was taken out above; its own children add what it has.
                let own = match child.kind == kind {
                    true => support.clone(),
                    false => kinds[child.kind].support.clone(),
                };
                let rows = own.iter().flat_map(|&place| &child.rows[place]);
                support.extend(rows.map(|(column, _)| *column));
            }
            is_settled &= support.len() == before;
            kinds[kind].support = support;
        }
    }
    for kind in kinds {
        let reached = kind.support.last().copied().unwrap_or_default();
        assert!(
            reached < kind.patch.vertices,
            "a facet depends on its patch alone"
        );
    }
}
