//! The validated view of a bundle's bytes.

use core::mem::size_of;

use zerocopy::FromBytes;

use super::error::BundleError;
use super::header::{
    BOUNDARY_FIXED, BOUNDARY_LOOP, Header, MAGIC, NormalsRecord, RIM_FIXED, RIM_SPLINE,
    SCHEME_LOOP, SCHEME_MIXED, SCHEME_TET_OCT, SCHEME_TRI_QUAD, SECTION_ACTUATION, SECTION_CELLS,
    SECTION_CENTROID_MODES, SECTION_INVERSE, SECTION_LIMITS, SECTION_MODEL_POINTS, SECTION_NORMALS,
    SECTION_REST_CAGE, SECTION_RIG, SECTION_SPRINGS, SECTION_VOLUME, SECTION_VOLUME_MODES, Section,
    VERSION,
};
use super::layout::{ALIGNMENT, Sections, checksum, size};
use super::stage::{Body, StageParts, cast};
use crate::control::actuation::Actuation;
use crate::control::health::Health;
use crate::control::inverse::Inverse;
use crate::control::project::Limits;
use crate::control::rig::Rig;
use crate::control::springs::Springs;
use crate::coord::Coordinate;
use crate::deform::{CompactTable, Normals, Table};
use crate::enclosed::{CentroidModes, VolumeForm, VolumeModes};

/// A bundle that has been proved sound, still where it lay.
#[derive(Clone, Copy, Debug)]
pub struct Bundle<'a> {
    header: &'a Header,
    rest_cage: &'a [[i32; 3]],
    /// The rows over the control points, and the rows over the points that these give.
    first: StageParts<'a>,
    second: Option<StageParts<'a>>,
    model_points: ModelPoints<'a>,
    sections: Sections<'a>,
}

impl<'a> Bundle<'a> {
    /// Opens a bundle in place and proves that
    ///
    /// * it is aligned, complete, of a known version, and its checksum is right;
    /// * every section lies within the bytes, and the padding is zero;
    /// * groups, indices, weights and start values of a stage fit one another without a gap;
    /// * every tap names a point that exists;
    /// * the weights of every row add up to exactly one and their magnitudes to at most two;
    /// * no start value is larger than [`START_LIMIT`](super::START_LIMIT);
    /// * every row names a point of the model.
    ///
    /// Sections of a kind that this version does not know are skipped. The time is proportional to the
    /// bundle's bytes.
    ///
    /// # Errors
    ///
    /// A [`BundleError`] that says which of these does not hold.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, BundleError> {
        if cfg!(target_endian = "big") {
            return Err(BundleError::ByteOrder);
        }
        if bytes.as_ptr().align_offset(ALIGNMENT) != 0 {
            return Err(BundleError::Unaligned);
        }
        let needed = size_of::<Header>();
        let truncated = |needed| BundleError::Truncated {
            needed,
            given: bytes.len(),
        };
        let (header, behind) = Header::ref_from_prefix(bytes).map_err(|_| truncated(needed))?;
        check_header(header, bytes)?;
        let count = size(header.sections.get()).ok_or(BundleError::Header)?;
        let (table, _) = <[Section]>::ref_from_prefix_with_elems(behind, count)
            .map_err(|_| BundleError::Header)?;
        let sections = Sections::new(bytes, table)?;
        let rest_cage = sections.find(SECTION_REST_CAGE, 0)?;
        let rest_cage: &[[i32; 3]] = cast(rest_cage.unwrap_or_default(), BundleError::Header)?;
        if size(header.control_points.get()) != Some(rest_cage.len()) {
            return Err(BundleError::Header);
        }
        let first = StageParts::new(&sections, 0, rest_cage.len())?;
        let first = first.ok_or(BundleError::Stage { stage: 0 })?;
        let second = StageParts::new(&sections, 1, first.rows)?;
        let rows = second.map_or(first.rows, |second| second.rows);
        if size(header.rows.get()) != Some(rows) {
            return Err(BundleError::Header);
        }
        let model_points = sections.find(SECTION_MODEL_POINTS, 0)?;
        Ok(Self {
            header,
            rest_cage,
            first,
            second,
            model_points: ModelPoints::new(model_points, rows)?,
            sections,
        })
    }

    /// The header.
    #[must_use]
    pub fn header(&self) -> &'a Header {
        self.header
    }

    /// The unit's name, such as "mm"; empty if none was given.
    #[must_use]
    pub fn unit(&self) -> &'a str {
        let end = self.header.unit.iter().position(|&byte| byte == 0);
        let name = match end {
            Some(end) => self.header.unit.get(..end).unwrap_or_default(),
            None => &self.header.unit,
        };
        core::str::from_utf8(name).unwrap_or_default()
    }

    /// The bits of the cage's control points at rest.
    #[must_use]
    pub fn rest_cage(&self) -> &'a [[i32; 3]] {
        self.rest_cage
    }

    /// Which point of the model each row is.
    #[must_use]
    pub fn model_points(&self) -> ModelPoints<'a> {
        self.model_points
    }

    /// The table, for coordinates of the type `C`.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::OtherTable`] if it holds a factored table or one for 16-bit displacements.
    pub fn table<C: Coordinate>(&self) -> Result<Table<'a, C>, BundleError> {
        self.check_format::<C>()?;
        match self.second {
            None => wide(&self.first),
            Some(_) => Err(BundleError::OtherTable),
        }
    }

    /// The two tables of a factored one: the first makes refined points of the control points; these are
    /// the pose of the second, which makes the model's points.
    ///
    /// # Errors
    ///
    /// Those of [`Bundle::table`]; [`BundleError::OtherTable`] if the table is not factored.
    pub fn factored_table<C: Coordinate>(&self) -> Result<[Table<'a, C>; 2], BundleError> {
        self.check_format::<C>()?;
        let second = self.second.as_ref().ok_or(BundleError::OtherTable)?;
        Ok([wide(&self.first)?, wide(second)?])
    }

    /// The table for 16-bit displacements.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::OtherTable`] if it holds a factored table or one for 32-bit coordinates.
    pub fn compact_table<C: Coordinate>(&self) -> Result<CompactTable<'a, C>, BundleError> {
        self.check_format::<C>()?;
        match self.second {
            None => compact(&self.first, self.rest_cage),
            Some(_) => Err(BundleError::OtherTable),
        }
    }

    /// The two tables of a factored one for 16-bit displacements, as in [`Bundle::factored_table`].
    ///
    /// # Errors
    ///
    /// Those of [`Bundle::compact_table`]; [`BundleError::OtherTable`] if the table is not factored.
    pub fn compact_factored_table<C: Coordinate>(
        &self,
    ) -> Result<[CompactTable<'a, C>; 2], BundleError> {
        self.check_format::<C>()?;
        let second = self.second.as_ref().ok_or(BundleError::OtherTable)?;
        let Body::Compact { rest, .. } = self.first.body else {
            return Err(BundleError::OtherTable);
        };
        Ok([
            compact(&self.first, self.rest_cage)?,
            compact(second, rest)?,
        ])
    }

    /// The form of the volume that a region encloses; `None` if none was baked. The region is 0 for
    /// the whole boundary, else the label of its cells, a negative one in two's complement. It is proved sound here, not when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::Volume`] if the form is not sound.
    pub fn volume_form<C: Coordinate>(
        &self,
        region: u32,
    ) -> Result<Option<VolumeForm<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_VOLUME, region)? else {
            return Ok(None);
        };
        VolumeForm::from_section(bytes, self.rest_cage.len())
            .map(Some)
            .map_err(BundleError::Volume)
    }

    /// The volume of a region, named as in [`Bundle::volume_form`], as a cubic polynomial of the modes
    /// that were baked; `None` if there are none. It is proved sound here.
    ///
    /// # Errors
    ///
    /// Those of [`Bundle::volume_form`].
    pub fn volume_modes<C: Coordinate>(
        &self,
        region: u32,
    ) -> Result<Option<VolumeModes<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_VOLUME_MODES, region)? else {
            return Ok(None);
        };
        VolumeModes::from_section(bytes)
            .map(Some)
            .map_err(BundleError::Volume)
    }

    /// What tells how far a pose is from folding over the cage's cells; `None` if the cells were not baked. They are proved
    /// sound here, not when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::Cells`] if the cells are not sound.
    pub fn health<C: Coordinate>(&self) -> Result<Option<Health<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_CELLS, 0)? else {
            return Ok(None);
        };
        Health::from_section(bytes, self.rest_cage)
            .map(Some)
            .map_err(BundleError::Cells)
    }

    /// The limits that a projection of poses keeps; `None` if none were baked. They are proved sound here, not when
    /// the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::Limits`] if the limits are not sound.
    pub fn limits<C: Coordinate>(&self) -> Result<Option<Limits<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_LIMITS, 0)? else {
            return Ok(None);
        };
        Limits::from_section(bytes, self.rest_cage.len())
            .map(Some)
            .map_err(BundleError::Limits)
    }

    /// The skeleton that carries the control points; `None` if none was baked. It is proved sound here, not
    /// when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::Rig`] if the rig is not sound.
    pub fn rig<C: Coordinate>(&self) -> Result<Option<Rig<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_RIG, 0)? else {
            return Ok(None);
        };
        Rig::from_section(bytes, self.rest_cage)
            .map(Some)
            .map_err(BundleError::Rig)
    }

    /// The springs between the control points; `None` if none were baked. They are proved sound here, not
    /// when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format,
    /// [`BundleError::Springs`] if the springs are not sound.
    pub fn springs<C: Coordinate>(&self) -> Result<Option<Springs<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_SPRINGS, 0)? else {
            return Ok(None);
        };
        Springs::from_section(bytes, self.rest_cage.len())
            .map(Some)
            .map_err(BundleError::Springs)
    }

    /// The centroid of a region, named as in [`Bundle::volume_form`], for combinations of the modes that
    /// were baked; `None` if there is none. It is proved sound here.
    ///
    /// # Errors
    ///
    /// Those of [`Bundle::volume_form`].
    pub fn centroid_modes<C: Coordinate>(
        &self,
        region: u32,
    ) -> Result<Option<CentroidModes<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_CENTROID_MODES, region)? else {
            return Ok(None);
        };
        CentroidModes::from_section(bytes, self.rest_cage.len())
            .map(Some)
            .map_err(BundleError::Volume)
    }

    /// The solver that brings effectors to their goals by the modes that were baked; `None` if there is none. It is
    /// proved sound here, not when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format, [`BundleError::Inverse`] if the
    /// solver is not sound.
    pub fn inverse<C: Coordinate>(&self) -> Result<Option<Inverse<'a>>, BundleError> {
        self.solver::<C>(0)
    }

    /// The solver that tells the amplitudes of the modes from measured points: its goals are what was measured;
    /// `None` if there is none.
    ///
    /// # Errors
    ///
    /// Those of [`Bundle::inverse`].
    pub fn sensors<C: Coordinate>(&self) -> Result<Option<Inverse<'a>>, BundleError> {
        self.solver::<C>(1)
    }

    fn solver<C: Coordinate>(&self, number: u32) -> Result<Option<Inverse<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_INVERSE, number)? else {
            return Ok(None);
        };
        Inverse::from_section(bytes)
            .map(Some)
            .map_err(BundleError::Inverse)
    }

    /// The pose that actuators make, and the rows of the effectors of [`Bundle::inverse`]; `None` if no actuators were
    /// baked. They are proved sound here, not when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format, [`BundleError::Actuation`] if the
    /// actuators are not sound.
    pub fn actuation<C: Coordinate>(&self) -> Result<Option<Actuation<'a>>, BundleError> {
        self.check_format::<C>()?;
        let Some(bytes) = self.sections.find(SECTION_ACTUATION, 0)? else {
            return Ok(None);
        };
        let rows = size(self.header.rows.get()).ok_or(BundleError::Header)?;
        Actuation::from_section(bytes, self.rest_cage, rows)
            .map(Some)
            .map_err(BundleError::Actuation)
    }

    /// The faces round the model's points, for their normals; `None` if they were not baked. They are proved
    /// sound here, not when the bundle is opened.
    ///
    /// # Errors
    ///
    /// [`BundleError::Normals`] if they are not sound.
    pub fn normals(&self) -> Result<Option<Normals<'a>>, BundleError> {
        let Some(bytes) = self.sections.find(SECTION_NORMALS, 0)? else {
            return Ok(None);
        };
        let rows = self.header.rows.get();
        let error = BundleError::Normals { row: rows };
        let (record, fans) = NormalsRecord::ref_from_prefix(bytes).map_err(|_| error)?;
        let fans: &[u16] = cast(fans, error)?;
        let fits = record.rows.get() == rows
            && size(record.words.get()) == Some(fans.len())
            && record.reserved == [0; 4];
        let rows = size(rows).filter(|_| fits).ok_or(error)?;
        Normals::new(rows, record.shift.get(), fans)
            .map(Some)
            .map_err(|row| BundleError::Normals {
                row: u32::try_from(row).unwrap_or(u32::MAX),
            })
    }

    fn check_format<C: Coordinate>(&self) -> Result<(), BundleError> {
        let bundle = self.header.fraction_bits.get();
        match C::FRACTION_BITS {
            Some(wanted) if wanted != bundle => Err(BundleError::FractionBits { bundle, wanted }),
            _ => Ok(()),
        }
    }
}

fn wide<'a, C: Coordinate>(stage: &StageParts<'a>) -> Result<Table<'a, C>, BundleError> {
    match stage.body {
        Body::Wide {
            weights,
            starts,
            greatest_start,
        } => Ok(Table::new(
            (stage.inputs, stage.rows),
            stage.groups,
            weights,
            starts,
            greatest_start,
        )),
        Body::Compact { .. } => Err(BundleError::OtherTable),
    }
}

fn compact<'a, C: Coordinate>(
    stage: &StageParts<'a>,
    rest_inputs: &'a [[i32; 3]],
) -> Result<CompactTable<'a, C>, BundleError> {
    match stage.body {
        Body::Compact {
            weights,
            rest,
            shift,
            greatest_rest,
        } => Ok(CompactTable::new(
            stage.groups,
            weights,
            rest,
            rest_inputs,
            shift,
            greatest_rest,
        )),
        Body::Wide { .. } => Err(BundleError::OtherTable),
    }
}

/// Which point of the model each row of a table is.
#[derive(Clone, Copy, Debug)]
pub struct ModelPoints<'a> {
    rows: usize,
    stored: Stored<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Stored<'a> {
    /// Rows are in the model's order.
    InOrder,
    /// Up to 65 536 rows.
    Narrow(&'a [u16]),
    /// More.
    Wide(&'a [u32]),
}

impl<'a> ModelPoints<'a> {
    fn new(section: Option<&'a [u8]>, rows: usize) -> Result<Self, BundleError> {
        let error = BundleError::ModelPoints;
        let stored = match section {
            None => Stored::InOrder,
            Some(bytes) if rows <= 1 << 16 => Stored::Narrow(cast(bytes, error)?),
            Some(bytes) => Stored::Wide(cast(bytes, error)?),
        };
        let points = Self { rows, stored };
        let length = match stored {
            Stored::InOrder => rows,
            Stored::Narrow(stored) => stored.len(),
            Stored::Wide(stored) => stored.len(),
        };
        let exist = (0..rows).all(|row| points.get(row).is_some_and(|point| point < rows));
        if length == rows && exist {
            Ok(points)
        } else {
            Err(error)
        }
    }

    /// The point of the model that a row is; `None` if there is no such row.
    #[must_use]
    pub fn get(&self, row: usize) -> Option<usize> {
        match self.stored {
            Stored::InOrder => Some(row).filter(|&row| row < self.rows),
            Stored::Narrow(stored) => stored.get(row).map(|&point| usize::from(point)),
            Stored::Wide(stored) => stored.get(row).and_then(|&point| size(point)),
        }
    }

    /// The points of the model, row by row.
    pub fn iter(self) -> impl Iterator<Item = usize> + use<'a> {
        (0..self.rows).filter_map(move |row| self.get(row))
    }
}

/// Checks the header against the bytes.
fn check_header(header: &Header, bytes: &[u8]) -> Result<(), BundleError> {
    if header.magic != MAGIC {
        return Err(BundleError::Magic);
    }
    let found = header.version.get();
    if found != VERSION {
        return Err(BundleError::Version { found });
    }
    let given = bytes.len();
    let needed = size(header.total_bytes.get()).ok_or(BundleError::Header)?;
    if given < needed {
        return Err(BundleError::Truncated { needed, given });
    }
    if given > needed {
        return Err(BundleError::TrailingBytes { needed, given });
    }
    let (stored, computed) = (header.checksum.get(), checksum(bytes));
    if stored != computed {
        return Err(BundleError::Checksum { stored, computed });
    }
    let (scheme, boundary) = (header.scheme.get(), header.boundary.get());
    let is_solid = (SCHEME_TET_OCT..=SCHEME_MIXED).contains(&scheme)
        && (BOUNDARY_LOOP..=BOUNDARY_FIXED).contains(&boundary);
    let is_surface = (SCHEME_LOOP..=SCHEME_TRI_QUAD).contains(&scheme)
        && (RIM_SPLINE..=RIM_FIXED).contains(&boundary);
    let known = (is_solid || is_surface)
        && header.fraction_bits.get() <= i32::BITS
        && header.reserved.iter().all(|&byte| byte == 0)
        && core::str::from_utf8(&header.unit).is_ok();
    if known {
        Ok(())
    } else {
        Err(BundleError::Header)
    }
}
