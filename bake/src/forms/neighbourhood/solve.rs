//! The forms of kinds that descend from one another.
//!
//! Kinds are solved children first. Those that descend from themselves, by way of one another, are solved
//! together: from the forms of their own faces, cones over a triangle or over the fan of a
//! quadrilateral, `w = sum of P' w' P` is repeated. After `k` times a kind's form is the volume of the
//! polyhedron that `k` steps make of the facet, so the iteration converges as those do: by 4 a step (9
//! in two steps of square-root-3) in regular surroundings, by the product of the scheme's two greatest
//! eigenvalues below one at an extraordinary vertex. A regular facet's own form is the one
//! alternating form that its iteration keeps, of eigenvalue one, and the polyhedra's give it its size;
//! every other eigenvalue is smaller in magnitude.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::kinds::{Kind, LocalForm};
use crate::forms::control::fan;
use crate::forms::form::TrilinearForm;
use crate::forms::scheme::Row;

/// Steps that are made at most. The slowest kinds gain a factor of 2 in each.
const MOST_STEPS: usize = 400;

/// Gives every kind its form.
pub(super) fn solve(kinds: &mut [Kind]) {
    for group in groups(kinds) {
        solve_group(kinds, &group);
    }
}

/// The kinds whose forms are not known, children first; those that descend from one another stand together
/// (Tarjan's strongly connected components, without recursion).
fn groups(kinds: &[Kind]) -> Vec<Vec<usize>> {
    let none = usize::MAX;
    let (mut number, mut low) = (vec![none; kinds.len()], vec![none; kinds.len()]);
    let (mut open, mut is_open) = (Vec::new(), vec![false; kinds.len()]);
    let (mut groups, mut next) = (Vec::new(), 0);
    for root in 0..kinds.len() {
        if number[root] != none || kinds[root].form.is_some() {
            continue;
        }
        // A kind and how many of its children were visited.
        let mut path = vec![(root, 0)];
        while let Some((kind, visited)) = path.pop() {
            if visited == 0 {
                (number[kind], low[kind]) = (next, next);
                next += 1;
                open.push(kind);
                is_open[kind] = true;
            }
            let children = &kinds[kind].children;
            if visited > 0 {
                low[kind] = low[kind].min(low[children[visited - 1].kind]);
            }
            if let Some(child) = children.get(visited) {
                path.push((kind, visited + 1));
                let is_new = number[child.kind] == none && kinds[child.kind].form.is_none();
                if is_new {
                    path.push((child.kind, 0));
                } else if !is_open[child.kind] {
                    // Solved before: it leads nowhere back.
                    low[child.kind] = none;
                }
            } else if low[kind] == number[kind] {
                let start = open.iter().rposition(|own| *own == kind);
                let group = open.split_off(start.unwrap_or_default());
                for &own in &group {
                    is_open[own] = false;
                }
                groups.push(group);
            }
        }
    }
    groups
}

/// A child whose form changes with its parent's.
struct Link {
    parent: usize,
    child: usize,
    rows: Vec<Row<f64>>,
}

/// Solves kinds that descend from one another; all others that they have as children are solved.
fn solve_group(kinds: &mut [Kind], group: &[usize]) {
    let (mut known, mut links) = (Vec::new(), Vec::new());
    let mut forms = Vec::new();
    for (parent, &own) in group.iter().enumerate() {
        let kind = &kinds[own];
        let mut sum = TrilinearForm::zero(kind.support.len());
        for child in &kind.children {
            let rows = |places: &mut dyn Iterator<Item = &usize>| {
                let rows = places.map(|&place| local(&child.rows[place], &kind.support));
                rows.collect::<Vec<_>>()
            };
            if let Some(child) = group.iter().position(|other| *other == child.kind) {
                let rows = rows(&mut kinds[group[child]].support.iter());
                links.push(Link {
                    parent,
                    child,
                    rows,
                });
            } else if let Some(form) = &kinds[child.kind].form {
                let rows = rows(&mut form.places.iter());
                sum = sum.plus(&form.form.pull_back(&rows, kind.support.len()));
            }
        }
        known.push(sum);
        forms.push(polyhedral(kind));
    }
    let residuals = iterate(&known, &links, &mut forms);
    for ((&own, form), residual) in group.iter().zip(forms).zip(residuals) {
        kinds[own].form = Some(Arc::new(LocalForm {
            places: kinds[own].support.iter().copied().collect(),
            form: Arc::new(form),
            residual,
        }));
    }
}

/// A row over the patch as one over the vertices that the facet depends on.
fn local(row: &Row<f64>, support: &BTreeSet<usize>) -> Row<f64> {
    let place = |column: &usize| support.range(..column).count();
    let entries = row.iter();
    entries
        .map(|(column, weight)| (place(column), *weight))
        .collect()
}

/// The cone over the facet's own face, over what the facet depends on; its corners are the first.
fn polyhedral(kind: &Kind) -> TrilinearForm<f64> {
    let corners = (0..kind.patch.corners()).map(|corner| vec![(corner, 1.0)]);
    let corners = corners.collect::<Vec<_>>();
    fan(corners.len()).pull_back(&corners, kind.support.len())
}

/// Repeats `w = known + sum of P' w' P` until nothing changes but by rounding; returns the last relative
/// changes.
fn iterate(
    known: &[TrilinearForm<f64>],
    links: &[Link],
    forms: &mut Vec<TrilinearForm<f64>>,
) -> Vec<f64> {
    let mut changes = vec![0.0; forms.len()];
    let mut before = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let mut next = known.to_vec();
        for link in links {
            let size = next[link.parent].size();
            let pulled = forms[link.child].pull_back(&link.rows, size);
            next[link.parent] = next[link.parent].plus(&pulled);
        }
        for ((change, old), new) in changes.iter_mut().zip(&*forms).zip(&next) {
            let pairs = old.coefficients().iter().zip(new.coefficients());
            let most = magnitude(pairs.map(|(old, new)| new - old));
            *change = most / magnitude(new.coefficients().iter().copied());
        }
        *forms = next;
        let change = magnitude(changes.iter().copied());
        // Below this the changes are roundings, which do not fall any more.
        let is_rounding = change < 1e-14 && change > before * 0.7;
        if change <= f64::EPSILON / 256.0 || is_rounding {
            break;
        }
        before = change;
    }
    changes
}

fn magnitude(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |greatest: f64, value| greatest.max(value.abs()))
}
