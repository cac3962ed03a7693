//! Core on the host against the reference, case by case and bit by bit.

use std::collections::BTreeSet;

use crate::compare::compare;
use crate::distance::Distances;
use crate::random_mesh::{Limits, RefineCase};
use crate::reference::{
    BoundarySurface, RefinedReal, Solid, boundary_triangles, refine, refine_real, split,
    split_triangles, surface_triangles,
};
use crate::subject::{CoreSolid, refine_bits};

/// What a run over random cases has seen.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Cases.
    pub cases: usize,
    /// Levels of all cases.
    pub levels: usize,
    /// Coordinates compared.
    pub coordinates: usize,
    /// Coordinates that saturated.
    pub saturated: usize,
    /// Distances from the device's bits to the real-number answer.
    pub distances: Distances,
}

/// Refines `count` random cases, seeds from `first_seed` on, with core and with the reference,
/// and compares connectivity, points and counts of every level.
///
/// Core works between guard words. Each level's points are also held against the real-number
/// answer, whose proved bound is checked.
///
/// # Errors
/// The seed of the first case that differs, and what differs in it.
pub fn refine_cases(first_seed: u64, count: u64, limits: &Limits) -> Result<Report, String> {
    let mut report = Report::default();
    for seed in first_seed..first_seed + count {
        let case = RefineCase::new(seed, limits);
        refine_case(&case, &mut report).map_err(|fault| format!("seed {seed}: {fault}"))?;
        report.cases += 1;
    }
    Ok(report)
}

fn refine_case(case: &RefineCase, report: &mut Report) -> Result<(), String> {
    let mut solid = case.solid.clone();
    let mut points = case.points.clone();
    let mut core = CoreSolid::new(&solid).map_err(|error| error.to_string())?;
    compare(
        "surface at level 0",
        &core.surface,
        &surface_triangles(&solid),
    )?;
    let mut real = RefinedReal {
        solid: solid.clone(),
        points: points.iter().map(|point| point.map(f64::from)).collect(),
    };
    let mut distance = report.distances.of_case(&case.points);
    for level in 1..=case.levels {
        let valences = BoundarySurface::new(&surface_triangles(&solid)).valences();
        let refined = refine(&solid, &points, case.boundary).map_err(|error| error.to_string())?;
        let (next, core_points, saturated) =
            refine_bits(&core, case.boundary, &points).map_err(|error| error.to_string())?;
        compare(
            &format!("points at level {level}"),
            &core_points,
            &refined.points,
        )?;
        compare_solids(level, &next.solid, &refined.solid)?;
        compare_surfaces(level, &core, &next)?;
        compare("saturated", &[saturated], &[refined.saturated])?;

        real = refine_real(&real.solid, &real.points, case.boundary)
            .map_err(|error| error.to_string())?;
        distance.level(case.boundary, &valences, &refined.points, &real.points)?;
        report.levels += 1;
        report.coordinates += 3 * core_points.len();
        report.saturated += saturated;
        (solid, points, core) = (refined.solid, refined.points, next);
    }
    report.distances.add(&distance);
    Ok(())
}

fn compare_solids(level: u32, got: &Solid, want: &Solid) -> Result<(), String> {
    let name = |list: &str| format!("{list} at level {level}");
    compare(&name("vertices"), &[got.vertex_count], &[want.vertex_count])?;
    compare(&name("tetrahedra"), &got.tetrahedra, &want.tetrahedra)?;
    compare(&name("octahedra"), &got.octahedra, &want.octahedra)?;
    compare(&name("sheets"), &got.sheets, &want.sheets)?;
    compare(&name("creases"), &got.creases, &want.creases)?;
    compare(&name("corners"), &got.corners, &want.corners)
}

/// Core hands its surface on; the reference splits its triangles and finds the boundary anew.
fn compare_surfaces(level: u32, before: &CoreSolid, after: &CoreSolid) -> Result<(), String> {
    let linear = split(&before.solid);
    let inherited = split_triangles(&before.surface, |a, b| linear.midpoint(a, b));
    compare(
        &format!("surface at level {level}"),
        &after.surface,
        &inherited,
    )?;
    let boundary = &after.surface[..after.surface.len() - after.solid.sheets.len()];
    let least_first = |face: &[u32; 3]| {
        let [a, b, c] = *face;
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .min()
            .unwrap_or(*face)
    };
    let handed_on: BTreeSet<_> = boundary.iter().map(least_first).collect();
    let anew: BTreeSet<_> = boundary_triangles(&after.solid).into_iter().collect();
    if handed_on == anew && handed_on.len() == boundary.len() {
        Ok(())
    } else {
        Err(format!(
            "the boundary at level {level} is not the one that the faces give"
        ))
    }
}
