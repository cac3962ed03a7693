//! A refined cage in which points are looked up.

use super::{Embedding, Locator};
use crate::check;
use crate::error::{Error, Result, count};
use crate::mesh::{Labels, Point, Shape, SolidMesh};
use crate::overlap;
use crate::progress::Progress;
use crate::refine::{BoundaryRule, DiagonalLists, Level, Refinement, Scheme};
use crate::table::Outside;

/// A cage at rest, refined, with what its cells inherit.
pub struct RefinedCage {
    level: Level,
    points: Vec<Point>,
    labels: Labels,
    /// Of each refined cell the cell of the cage that it is a part of, as a place in
    /// [`crate::mesh::Cells::corners`].
    ancestors: Vec<usize>,
}

/// Where a point lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Located {
    /// The refined cell, as a place in [`crate::mesh::Cells::corners`]; of a point outside the one
    /// behind the nearest place of the boundary.
    pub cell: usize,
    /// A weight for each corner of the cell, in its order. They sum to one.
    pub coordinates: Vec<f64>,
    /// How far outside the refined cage the point lies; 0 inside.
    pub distance: f64,
}

impl RefinedCage {
    /// Refines a cage.
    ///
    /// # Errors
    /// If it is no sound solid at rest, or there are too many levels.
    pub fn new(
        cage: &SolidMesh,
        scheme: Scheme,
        diagonals: Option<&DiagonalLists>,
        boundary: BoundaryRule,
        levels: u32,
    ) -> Result<Self> {
        check::require_sound_connectivity(cage)?;
        check::require_positive_volumes(cage)?;
        overlap::require_none(cage)?;
        let mut level = Level::of_scheme(cage, scheme, diagonals)?;
        level.require_levels(levels)?;
        let (mut points, mut labels) = (cage.points.clone(), cage.labels.clone());
        // The number of a cell goes the way of its label.
        let mut next = 0_i32..;
        let mut numbers = |shape| next.by_ref().take(cage.cells.count(shape)).collect();
        let mut ancestors = Labels {
            tetrahedra: numbers(Shape::Tetrahedron),
            octahedra: numbers(Shape::Octahedron),
            prisms: numbers(Shape::Prism),
            hexahedra: numbers(Shape::Hexahedron),
        };
        for _ in 0..levels {
            let mut step = Refinement::new(&level, boundary.to_core())?;
            points = step.points(&points)?;
            (labels, ancestors) = (labels.refined(), ancestors.refined());
            level = step.split()?;
        }
        Ok(Self {
            level,
            points,
            labels,
            ancestors: ancestors.iter().map(|number| number as usize).collect(),
        })
    }

    /// The refined cells.
    pub fn level(&self) -> &Level {
        &self.level
    }

    /// The cell of the cage that a refined cell is a part of.
    pub fn ancestor(&self, cell: usize) -> usize {
        self.ancestors[cell]
    }

    /// The label of each refined cell; none if the cage has none.
    pub fn labels(&self) -> Vec<i32> {
        self.labels.iter().collect()
    }

    /// Looks points up.
    ///
    /// # Errors
    /// If a point lies outside and that is to be an error.
    pub fn locate(
        &self,
        points: &[Point],
        outside: Outside,
        progress: &mut dyn Progress,
    ) -> Result<Vec<Located>> {
        let boundary = self.level.boundary_faces();
        let locator = Locator::new(&self.level.cells, &boundary, &self.points);
        progress.stage("locating points", points.len());
        let mut located = Vec::with_capacity(points.len());
        for (index, point) in points.iter().enumerate() {
            located.push(self.locate_one(&locator, index, *point, outside)?);
            progress.step();
        }
        progress.finish();
        let farthest = located
            .iter()
            .enumerate()
            .filter(|(_, point)| point.distance > 0.0)
            .max_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance));
        match farthest {
            Some((index, farthest)) if outside == Outside::Error => {
                let number = located.iter().filter(|point| point.distance > 0.0).count();
                Err(Error::new(format!(
                    "{number} of {} outside the refined cage; the farthest, point {index} (counted from 0), by {}",
                    count(points.len(), "point lies", "points lie"),
                    farthest.distance
                ))
                .advise("the smooth scheme pulls the boundary inward; leave --outside error out to learn where each point lies"))
            }
            _ => Ok(located),
        }
    }

    fn locate_one(
        &self,
        locator: &Locator<'_>,
        index: usize,
        point: Point,
        outside: Outside,
    ) -> Result<Located> {
        let lost = || Error::new(format!("point {index} (counted from 0) lies in no cell"));
        if let Some((cell, embedding)) = locator.find(point) {
            return Ok(self.located(cell, &embedding, 0.0));
        }
        let nearest = locator.nearest(point).ok_or_else(lost)?;
        let cell = locator.cell_behind(&nearest).ok_or_else(lost)?;
        let embedding = match outside {
            Outside::Extrapolate => locator.extrapolated(&nearest, point).ok_or_else(lost)?,
            Outside::Error | Outside::Nearest => locator.projected(&nearest),
        };
        // A distance that rounds to nothing is still one: the point was in no cell.
        let distance = nearest.distance.max(f64::MIN_POSITIVE);
        Ok(self.located(cell, &embedding, distance))
    }

    fn located(&self, cell: usize, embedding: &Embedding, distance: f64) -> Located {
        let corners = self.level.cells.corners_of(cell);
        let weight = |corner: &u32| {
            let found = embedding.iter().find(|(vertex, _)| vertex == corner);
            found.map_or(0.0, |(_, weight)| *weight)
        };
        Located {
            cell,
            coordinates: corners.iter().map(weight).collect(),
            distance,
        }
    }
}
