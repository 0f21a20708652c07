//! A rig split into parts that keep their shape: Tsiapkolis and Bénard, Patch Decomposition for
//! Efficient Mesh Contours Extraction, CGF 43(4), 2024, §4.1.

use foldhash::HashMap;
use glam::Vec3;

use super::Rig;
use crate::{EdgeClass, EdgeFilter, EdgeId, Mesh, MeshAdjacency, MeshError};

/// What lies in no part.
const NONE: u32 = u32::MAX;

/// All that makes two shapes one: bits of positions, triangles, and edges that keep their shape.
type Content = (Vec<[u32; 3]>, Vec<[u32; 3]>, Vec<EdgeId>);

/// The surface of one part or more, in their own space.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Vertices in order of first use, triangles in that of the rig.
    pub mesh: Mesh,
    /// Of `mesh`.
    pub adjacency: MeshAdjacency,
    /// The edges that keep their shape, by id; others of `adjacency` go on in another part.
    edges: Vec<EdgeId>,
}

impl Shape {
    /// The edges to group into patches: those that keep their shape and that `filter` keeps, by id.
    pub fn edges(&self, filter: EdgeFilter) -> impl Iterator<Item = EdgeId> + '_ {
        self.edges.iter().copied().filter(move |&edge| self.adjacency.keeps(edge, filter))
    }
}

/// Faces that one carrier moves.
#[derive(Clone, Debug)]
pub struct RigidPart {
    /// What moves them.
    pub carrier: u32,
    /// Index of the shape that it has, maybe as others.
    pub shape: u32,
    /// For each edge of the shape's adjacency the same edge in the rig; `NONE` for those that are not
    /// among the shape's own.
    edges: Vec<u32>,
}

impl RigidPart {
    /// The edge of the rig that is `edge` in the shape.
    ///
    /// # Panics
    /// If it is not one that [`Shape::edges`] yields.
    pub fn edge_in_rig(&self, edge: EdgeId) -> EdgeId {
        let in_rig = self.edges[edge.index()];
        assert_ne!(in_rig, NONE, "an edge that keeps its shape");
        EdgeId(in_rig)
    }
}

/// A rig split into rigid parts, and what lies between them.
///
/// A **rigid** vertex follows one carrier and is displaced by no morph target; a face is rigid if its
/// vertices follow the same one, and an edge if both of its faces do. All others are loose. At an edge of
/// three faces or more, each pair of faces is an edge of its own, and a pair of a part in which no third
/// face meets it is loose too.
#[derive(Clone, Debug)]
pub struct Skin {
    adjacency: MeshAdjacency,
    shapes: Vec<Shape>,
    parts: Vec<RigidPart>,
    /// For each face its part, and its triangle in the part's shape.
    faces: Vec<[u32; 2]>,
    /// For each edge its part, and its id in the part's shape.
    edges: Vec<[u32; 2]>,
    loose: Vec<EdgeId>,
}

impl Skin {
    /// Splits `rig`. Linear but for sorts; about as long as [`MeshAdjacency::new`] twice.
    ///
    /// # Errors
    /// A vertex that is at no finite place at rest.
    pub fn new(rig: &Rig) -> Result<Self, MeshError> {
        let rest = rig.rest();
        let vertices = 0..u32::try_from(rig.vertex_count()).unwrap_or(u32::MAX);
        let positions = vertices.map(|vertex| rig.position(vertex, &rest).as_vec3()).collect();
        // Not turned over where a carrier mirrors, so that half-edges are those of the rig's triangles.
        let adjacency = rig.adjacency(&Mesh::new(positions, rig.triangles.clone())?);
        let mut skin = Self {
            faces: vec![[NONE; 2]; rig.triangles.len()],
            edges: vec![[NONE; 2]; adjacency.wings().len()],
            adjacency,
            shapes: Vec::new(),
            parts: Vec::new(),
            loose: Vec::new(),
        };
        let mut known = HashMap::default();
        for (carrier, faces) in (0..).zip(faces_of_carriers(rig)) {
            if !faces.is_empty() {
                skin.add_part(rig, carrier, &faces, &mut known);
            }
        }
        let is_loose = |&edge: &EdgeId| {
            skin.edges[edge.index()][0] == NONE && skin.adjacency.class(edge) != EdgeClass::Boundary
        };
        skin.loose = skin.adjacency.edge_ids().filter(is_loose).collect();
        Ok(skin)
    }

    /// Makes a part of `faces`, all of one carrier. `known` has the shapes there are, by their content.
    fn add_part(
        &mut self,
        rig: &Rig,
        carrier: u32,
        faces: &[u32],
        known: &mut HashMap<Content, u32>,
    ) {
        let part = length(self.parts.len());
        let mesh = shape_of(rig, faces);
        for (local, &face) in (0..).zip(faces) {
            self.faces[face as usize] = [part, local];
        }
        let adjacency = MeshAdjacency::new(&mesh);
        let mut edges = vec![NONE; adjacency.wings().len()];
        let mut rigid = Vec::new();
        for local in adjacency.edge_ids() {
            let Some(edge) = self.edge_of_part(&adjacency, local, faces) else { continue };
            edges[local.index()] = edge.0;
            self.edges[edge.index()] = [part, local.0];
            rigid.push(local);
        }
        let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
        let content =
            (mesh.positions().iter().map(bits).collect(), mesh.triangles().to_vec(), rigid);
        let shape = match known.get(&content) {
            Some(&shape) => shape,
            None => {
                self.shapes.push(Shape { mesh, adjacency, edges: content.2.clone() });
                known.insert(content, length(self.shapes.len() - 1));
                length(self.shapes.len() - 1)
            }
        };
        self.parts.push(RigidPart { carrier, shape, edges });
    }

    /// The rig's own edge for an edge of a part, if that has two faces, the same two, and is of the same
    /// kind: an edge at which other parts meet too is not.
    fn edge_of_part(&self, part: &MeshAdjacency, local: EdgeId, faces: &[u32]) -> Option<EdgeId> {
        if part.class(local) == EdgeClass::Boundary {
            return None;
        }
        let [left, right] = part.sides(local).map(|side| {
            let (face, corner) = (faces[side.triangle() as usize], side.0 % 3);
            crate::HalfEdge(3 * face + corner)
        });
        let edge = self.adjacency.edge_between(left, right)?;
        let is_many = |class| class == EdgeClass::NonManifold;
        let is_same = is_many(self.adjacency.class(edge)) == is_many(part.class(local));
        is_same.then_some(edge)
    }

    /// The edges of the whole rig, and their classes at rest. Wings name vertices of the rig; faces are
    /// not turned over where a carrier mirrors.
    pub fn adjacency(&self) -> &MeshAdjacency {
        &self.adjacency
    }

    /// What parts look like, each in its own space.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// Rigid parts, by carrier.
    pub fn parts(&self) -> &[RigidPart] {
        &self.parts
    }

    /// The edges of no part that may be contour edges, by id.
    pub fn loose(&self) -> &[EdgeId] {
        &self.loose
    }

    /// The part of a face, and its triangle in the part's shape; `None` if it bends.
    pub fn part_of_face(&self, face: u32) -> Option<(u32, u32)> {
        let [part, local] = self.faces[face as usize];
        (part != NONE).then_some((part, local))
    }

    /// The part of an edge, and its id in the part's shape; `None` if it is loose or a boundary.
    pub fn part_of_edge(&self, edge: EdgeId) -> Option<(u32, EdgeId)> {
        let [part, local] = self.edges[edge.index()];
        (part != NONE).then_some((part, EdgeId(local)))
    }

    /// Whether an edge can be a contour that `filter` lets pass. A loose edge bends, so it always can.
    pub fn keeps(&self, edge: EdgeId, filter: EdgeFilter) -> bool {
        match self.part_of_edge(edge) {
            Some((part, local)) => {
                let shape = self.parts[part as usize].shape;
                self.shapes[shape as usize].adjacency.keeps(local, filter)
            }
            None => self.adjacency.class(edge) != EdgeClass::Boundary,
        }
    }

    /// The edges that `filter` keeps, by id.
    pub fn edges(&self, filter: EdgeFilter) -> impl Iterator<Item = EdgeId> + '_ {
        self.adjacency.edge_ids().filter(move |&edge| self.keeps(edge, filter))
    }

    /// How much of the edges of two faces or more is rigid, 0 to 1; 1 if there are none. (TB24, Table 2.)
    pub fn rigid_share(&self) -> f64 {
        let rigid = self.edges.iter().filter(|[part, _]| *part != NONE).count();
        match rigid + self.loose.len() {
            0 => 1.0,
            all => rigid as f64 / all as f64,
        }
    }
}

/// For each carrier the faces that it alone moves, in order.
fn faces_of_carriers(rig: &Rig) -> Vec<Vec<u32>> {
    let mut faces = vec![Vec::new(); rig.carriers.len()];
    for (face, corners) in (0..).zip(&rig.triangles) {
        let [a, b, c] = corners.map(|vertex| rig.rigid_carrier(vertex));
        if let Some(carrier) = a.filter(|_| a == b && b == c) {
            faces[carrier as usize].push(face);
        }
    }
    faces
}

/// The mesh of `faces` in the space of the carrier that moves all of them.
fn shape_of(rig: &Rig, faces: &[u32]) -> Mesh {
    let mut vertices = HashMap::default();
    let mut positions = Vec::new();
    let mut vertex = |vertex: u32| {
        *vertices.entry(vertex).or_insert_with(|| {
            positions.push(rig.influences(vertex)[0].position);
            length(positions.len() - 1)
        })
    };
    let triangles =
        faces.iter().map(|&face| rig.triangles[face as usize].map(&mut vertex)).collect();
    Mesh::new(positions, triangles).expect("a rig's positions are finite")
}

fn length(length: usize) -> u32 {
    u32::try_from(length).expect("there are no more than vertices and faces, which fit a u32")
}
