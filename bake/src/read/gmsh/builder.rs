//! Turns Gmsh's nodes, elements and physical groups into a solid mesh.

use super::elements::{ElementType, ORDER_ADVICE};
use crate::error::{Error, Place, Result, listed};
use crate::mesh::{Point, SolidMesh, Vertex};
use crate::read::pyramids::{self, Pyramid};
use std::collections::{BTreeMap, HashMap};

/// A physical group's dimension and number.
type Group = (u8, i64);

/// Collects what the sections of a file say, in file order.
#[derive(Default)]
pub struct Builder {
    mesh: SolidMesh,
    vertex_of_tag: HashMap<u64, Vertex>,
    group_names: HashMap<Group, String>,
    ignored: BTreeMap<ElementType, usize>,
    /// Elements that a cage cannot hold: how many, and where the first stands.
    foreign: BTreeMap<ElementType, (usize, Place)>,
    pyramids: Vec<Pyramid>,
}

impl Builder {
    /// Records the name of a physical group.
    pub fn name_group(&mut self, dimension: u8, number: i64, name: &str) {
        self.group_names
            .insert((dimension, number.abs()), name.to_ascii_lowercase());
    }

    /// Records a node under its tag.
    pub fn node(&mut self, tag: u64, position: Point, place: Place) -> Result<()> {
        let vertex = Vertex::try_from(self.mesh.points.len())
            .map_err(|_| Error::new("there are more than 2^32 nodes").at(place))?;
        if self.vertex_of_tag.insert(tag, vertex).is_some() {
            return Err(Error::new(format!("node {tag} is listed twice"))
                .at(place)
                .advise("give every node a tag of its own"));
        }
        self.mesh.points.push(position);
        Ok(())
    }

    /// Records an element that belongs to the physical groups with these numbers.
    pub fn element(
        &mut self,
        kind: ElementType,
        groups: &[i64],
        nodes: &[u64],
        place: Place,
    ) -> Result<()> {
        match (kind, nodes) {
            (ElementType::Tetrahedron, &[a, b, c, d]) => {
                let corners = [
                    self.vertex(a, place)?,
                    self.vertex(b, place)?,
                    self.vertex(c, place)?,
                    self.vertex(d, place)?,
                ];
                self.mesh.cells.tetrahedra.push(corners);
                self.mesh.labels.tetrahedra.push(label(groups, place)?);
            }
            (ElementType::Prism, nodes) => {
                let corners = self.vertices(nodes, place)?;
                self.mesh.cells.prisms.push(corners);
                self.mesh.labels.prisms.push(label(groups, place)?);
            }
            (ElementType::Hexahedron, nodes) => {
                let corners = self.vertices(nodes, place)?;
                self.mesh.cells.hexahedra.push(corners);
                self.mesh.labels.hexahedra.push(label(groups, place)?);
            }
            (ElementType::Pyramid, nodes) => {
                let corners = self.vertices(nodes, place)?;
                let label = label(groups, place)?;
                self.pyramids.push(Pyramid { corners, label });
            }
            (ElementType::Line, &[a, b]) if self.in_group(1, groups, "crease") => {
                let edge = [self.vertex(a, place)?, self.vertex(b, place)?];
                self.mesh.features.creases.push(edge);
            }
            (ElementType::Point, &[a]) if self.in_group(0, groups, "corner") => {
                let corner = self.vertex(a, place)?;
                self.mesh.features.corners.push(corner);
            }
            (ElementType::Triangle, &[a, b, c]) if self.in_group(2, groups, "crease") => {
                let face = [
                    self.vertex(a, place)?,
                    self.vertex(b, place)?,
                    self.vertex(c, place)?,
                ];
                self.mesh.features.faces.push(face);
            }
            (ElementType::Triangle, &[a, b, c]) if self.in_group(2, groups, "sheet") => {
                let triangle = [
                    self.vertex(a, place)?,
                    self.vertex(b, place)?,
                    self.vertex(c, place)?,
                ];
                self.mesh.features.sheets.push(triangle);
            }
            (ElementType::Quadrangle, nodes) if self.in_group(2, groups, "crease") => {
                let face = self.vertices(nodes, place)?;
                self.mesh.features.quads.push(face);
            }
            (ElementType::Quadrangle, _) if self.in_group(2, groups, "sheet") => {
                return Err(Error::new(
                    "a physical surface whose name starts with \"sheet\" holds this quadrangle; sheets consist of triangles",
                )
                .at(place)
                .advise("mesh the surface with triangles, or rename the group"));
            }
            _ if kind.is_foreign() => self.foreign.entry(kind).or_insert((0, place)).0 += 1,
            _ => *self.ignored.entry(kind).or_default() += 1,
        }
        Ok(())
    }

    fn vertices<const N: usize>(&self, tags: &[u64], place: Place) -> Result<[Vertex; N]> {
        let mut vertices = [0; N];
        for (vertex, tag) in vertices.iter_mut().zip(tags) {
            *vertex = self.vertex(*tag, place)?;
        }
        Ok(vertices)
    }

    fn vertex(&self, tag: u64, place: Place) -> Result<Vertex> {
        self.vertex_of_tag.get(&tag).copied().ok_or_else(|| {
            Error::new(format!(
                "an element names node {tag}, which the file does not list"
            ))
            .at(place)
            .advise("the mesh is incomplete; write it again")
        })
    }

    fn in_group(&self, dimension: u8, groups: &[i64], prefix: &str) -> bool {
        groups.iter().any(|number| {
            let name = self.group_names.get(&(dimension, number.abs()));
            name.is_some_and(|name| name.starts_with(prefix))
        })
    }

    /// The mesh, with notes on what was left out.
    pub fn finish(mut self) -> Result<SolidMesh> {
        if let Some((_, (_, place))) = self.foreign.iter().min_by_key(|(_, (_, place))| *place) {
            let counted: Vec<String> = self
                .foreign
                .iter()
                .map(|(kind, (number, _))| kind.counted(*number))
                .collect();
            let is_curved = |kind: &ElementType| matches!(kind, ElementType::Curved(_));
            let advice = match self.foreign.keys().any(is_curved) {
                true => ORDER_ADVICE,
                false => "mesh the volume with tetrahedra, prisms, pyramids and hexahedra",
            };
            return Err(Error::new(format!(
                "the mesh has {}; a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges",
                listed(&counted)
            ))
            .at(*place)
            .advise(advice));
        }
        pyramids::add(&self.pyramids, true, &mut self.mesh);
        if self.mesh.cells.is_empty() {
            return Err(Error::new("the mesh has no tetrahedra").advise(
                "mesh in three dimensions (`gmsh -3`), and if there are physical groups, put the volume into one: Gmsh then saves only what is in a group",
            ));
        }
        let ignored: Vec<String> = self
            .ignored
            .iter()
            .map(|(kind, number)| kind.counted(*number))
            .collect();
        if !ignored.is_empty() {
            self.mesh.notes.push(format!(
                "left out: {} (in no physical group whose name starts with \"crease\" for curves and surfaces, \"sheet\" for surfaces or \"corner\" for points)",
                ignored.join(", ")
            ));
        }
        self.mesh.features.normalise();
        self.mesh.labels.drop_if_zero();
        Ok(self.mesh)
    }
}

/// A cell's label: its first physical group, 0 for none.
fn label(groups: &[i64], place: Place) -> Result<i32> {
    let group = groups.first().copied().unwrap_or(0);
    i32::try_from(group)
        .map_err(|_| Error::new(format!("the physical group {group} exceeds 32 bits")).at(place))
}
