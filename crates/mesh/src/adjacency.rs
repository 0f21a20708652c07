//! From triangles to edges.

use rayon::prelude::*;

use crate::classes::{interior_class, is_fold};
use crate::{EdgeClass, EdgeFilter, EdgeId, HalfEdge, Mesh, Wing, has_area, weld_by_position};

/// At an edge of very many faces each is paired with this many others, so that hostile input costs
/// linear memory. Up to 16 faces that is every pair.
const MAX_PAIRED: usize = 15;

/// Edges that a thread classifies at once.
const SHARE: usize = 1 << 14;

/// The edges of a mesh, each with the faces on both sides.
///
/// - Vertices at equal positions are welded, or those that the caller says.
/// - An edge of k ≥ 3 faces is one wing per pair of faces, k(k − 1)/2 in all, up to k = 16; above,
///   each face is paired with the 15 that follow.
/// - A *collapsed* triangle, two of whose corners are welded together, is no face: its neighbours
///   meet each other.
///
/// Wings are ordered by their left half-edge, then their right one, so that edges of one region of
/// the file stay together and the same mesh always gives the same ids.
#[derive(Clone, Debug, Default)]
pub struct MeshAdjacency {
    wings: Vec<Wing>,
    sides: Vec<[HalfEdge; 2]>,
    classes: Vec<EdgeClass>,
    /// The right face is wound the other way.
    turned: Vec<bool>,
    /// Kept by [`EdgeFilter::Convex`].
    drawable: Vec<bool>,
    representatives: Vec<u32>,
    without_area: Vec<bool>,
    report: TopologyReport,
}

/// What was found while pairing half-edges. Edges are counted once, however many wings they make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TopologyReport {
    /// Triangles.
    pub faces: usize,
    /// Vertices as stored.
    pub vertices: usize,
    /// Vertices at distinct positions.
    pub welded_vertices: usize,
    /// Edges of exactly two faces: convex, flat, concave and inconsistent ones.
    pub interior: usize,
    /// Edges of one face.
    pub boundary: usize,
    /// Edges of three faces or more.
    pub non_manifold: usize,
    /// Edges of two faces that disagree on which side is outside.
    pub inconsistent: usize,
    /// Triangles without area, collapsed ones among them.
    pub degenerate: usize,
    /// Triangles with two corners at one position.
    pub collapsed: usize,
    /// Edges of [`EdgeClass::Convex`].
    pub convex: usize,
    /// Edges of [`EdgeClass::Flat`].
    pub flat: usize,
    /// Edges of [`EdgeClass::Concave`].
    pub concave: usize,
}

impl MeshAdjacency {
    /// Pairs the half-edges of `mesh`. Linear but for one sort of the edges, on
    /// all threads but for some passes over the triangles.
    pub fn new(mesh: &Mesh) -> Self {
        Self::welded(mesh, weld_by_position(mesh.positions()))
    }

    /// As [`MeshAdjacency::new`], where somebody else knows which vertices are one: for each vertex
    /// the lowest index of those that it is one with. For meshes that move, whose vertices may meet
    /// for a moment.
    ///
    /// # Panics
    /// If there is not one representative for each vertex, or one of them does not stand for itself.
    pub fn welded(mesh: &Mesh, representatives: Vec<u32>) -> Self {
        assert_eq!(representatives.len(), mesh.positions().len(), "one for each vertex");
        assert!(
            representatives.iter().all(|&r| representatives.get(r as usize) == Some(&r)),
            "a representative stands for itself"
        );
        let without_area: Vec<bool> =
            mesh.triangles().par_iter().map(|t| !has_area(t.map(|v| mesh.position(v)))).collect();
        let welded = Welded { mesh, representatives: &representatives };
        let sides = welded.sides();
        let mut adjacency = Self {
            report: TopologyReport {
                faces: mesh.triangles().len(),
                vertices: mesh.positions().len(),
                welded_vertices: (0..)
                    .zip(&representatives)
                    .filter(|&(v, &w): &(u32, _)| v == w)
                    .count(),
                degenerate: without_area.iter().filter(|&&d| d).count(),
                collapsed: mesh.triangles().iter().filter(|t| welded.is_collapsed(t)).count(),
                ..Default::default()
            },
            wings: Vec::with_capacity(sides.len()),
            sides: Vec::with_capacity(sides.len()),
            classes: Vec::with_capacity(sides.len()),
            turned: Vec::with_capacity(sides.len()),
            drawable: Vec::with_capacity(sides.len()),
            ..Default::default()
        };
        let shares: Vec<Vec<Kept>> = sides
            .par_chunks(SHARE)
            .map(|sides| sides.iter().map(|side| welded.kept(side)).collect())
            .collect();
        for (side, kept) in sides.iter().zip(shares.iter().flatten()) {
            adjacency.report.count(kept.class, side.first_of_edge);
            adjacency.wings.push(kept.wing);
            adjacency.sides.push(side.half_edges);
            adjacency.classes.push(kept.class);
            adjacency.turned.push(kept.turned);
            adjacency.drawable.push(kept.drawable);
        }
        Self { representatives, without_area, ..adjacency }
    }

    /// All edges, boundary ones among them.
    pub fn wings(&self) -> &[Wing] {
        &self.wings
    }

    /// The four vertices of an edge.
    pub fn wing(&self, edge: EdgeId) -> Wing {
        self.wings[edge.index()]
    }

    /// The half-edges on the left and the right of an edge; the latter is [`HalfEdge::NONE`] on a
    /// boundary edge. They lead to the triangles and, through their corners, to the vertices as
    /// they were before welding.
    pub fn sides(&self, edge: EdgeId) -> [HalfEdge; 2] {
        self.sides[edge.index()]
    }

    /// The edge with these half-edges on its left and its right, if it is one. Logarithmic.
    pub fn edge_between(&self, left: HalfEdge, right: HalfEdge) -> Option<EdgeId> {
        let found = self.sides.binary_search(&[left, right]).ok()?;
        u32::try_from(found).ok().map(EdgeId)
    }

    /// What the edge is.
    pub fn class(&self, edge: EdgeId) -> EdgeClass {
        self.classes[edge.index()]
    }

    /// For each vertex the lowest index of a vertex at the same position.
    pub fn representatives(&self) -> &[u32] {
        &self.representatives
    }

    /// Whether a triangle has no area: it spans no plane that a bound could hold.
    pub fn is_without_area(&self, triangle: u32) -> bool {
        self.without_area[triangle as usize]
    }

    /// Whether a face of the edge has no area, so that no bound can hold its plane: the edge must
    /// be tested whatever the viewpoint.
    pub fn is_beside_face_without_area(&self, edge: EdgeId) -> bool {
        let [left, right] = self.sides(edge);
        self.is_without_area(left.triangle())
            || right != HalfEdge::NONE && self.is_without_area(right.triangle())
    }

    /// Whether the right face runs along the edge in the same direction as the left one, so that
    /// the wing reads it turned over. Never on a boundary edge.
    pub fn is_right_turned(&self, edge: EdgeId) -> bool {
        self.turned[edge.index()]
    }

    /// Whether an edge can be a contour that `filter` lets pass. Never on a boundary edge.
    pub fn keeps(&self, edge: EdgeId, filter: EdgeFilter) -> bool {
        match filter {
            EdgeFilter::All => self.class(edge) != EdgeClass::Boundary,
            EdgeFilter::Convex => self.drawable[edge.index()],
        }
    }

    /// The edges that `filter` keeps, by id.
    pub fn edges(&self, filter: EdgeFilter) -> impl Iterator<Item = EdgeId> + '_ {
        self.edge_ids().filter(move |&edge| self.keeps(edge, filter))
    }

    /// Every edge by id, boundary ones among them.
    pub fn edge_ids(&self) -> impl Iterator<Item = EdgeId> + use<> {
        (0..u32::try_from(self.wings.len()).expect("half-edges fit a u32")).map(EdgeId)
    }

    /// What was found: all counts of trouble 0 on a closed manifold.
    pub fn report(&self) -> &TopologyReport {
        &self.report
    }
}

impl TopologyReport {
    fn count(&mut self, class: EdgeClass, first_of_edge: bool) {
        match class {
            EdgeClass::Convex => self.convex += 1,
            EdgeClass::Flat => self.flat += 1,
            EdgeClass::Concave => self.concave += 1,
            EdgeClass::Inconsistent => self.inconsistent += 1,
            EdgeClass::Boundary => self.boundary += 1,
            EdgeClass::NonManifold => self.non_manifold += usize::from(first_of_edge),
        }
        self.interior = self.convex + self.flat + self.concave + self.inconsistent;
    }
}

/// A half-edge and the welded ends of its edge, lower first.
#[derive(Clone, Copy)]
struct Keyed {
    ends: [u32; 2],
    id: HalfEdge,
}

/// A wing before its vertices are looked up.
struct Side {
    half_edges: [HalfEdge; 2],
    face_count: usize,
    first_of_edge: bool,
}

/// What is found out of a side.
struct Kept {
    wing: Wing,
    class: EdgeClass,
    turned: bool,
    drawable: bool,
}

/// Appends the wings of one edge, given its half-edges by id.
fn pair(edge: &[Keyed], sides: &mut Vec<Side>) {
    let face_count = edge.len();
    let mut push =
        |half_edges, first_of_edge| sides.push(Side { half_edges, face_count, first_of_edge });
    if let [only] = edge {
        push([only.id, HalfEdge::NONE], true);
    }
    for (i, left) in edge.iter().enumerate() {
        for (j, right) in edge.iter().enumerate().skip(i + 1).take(MAX_PAIRED) {
            push([left.id, right.id], (i, j) == (0, 1));
        }
    }
}

/// A mesh seen through its weld.
struct Welded<'a> {
    mesh: &'a Mesh,
    representatives: &'a [u32],
}

impl Welded<'_> {
    fn corners(&self, triangle: u32) -> [u32; 3] {
        self.mesh.triangles()[triangle as usize].map(|v| self.representatives[v as usize])
    }

    fn is_collapsed(&self, triangle: &[u32; 3]) -> bool {
        let [a, b, c] = triangle.map(|v| self.representatives[v as usize]);
        a == b || b == c || c == a
    }

    /// Half-edges of all faces, those of one edge together: bucketed by the lower end, then sorted
    /// in the bucket.
    fn half_edges_by_edge(&self) -> Vec<Keyed> {
        let triangles = self.mesh.triangles();
        let keyed = || {
            let faces = (0u32..).zip(triangles).filter(|(_, t)| !self.is_collapsed(t));
            faces.flat_map(|(triangle, _)| {
                let corners = self.corners(triangle);
                (0..3).map(move |i: u32| {
                    let (tail, head) = (corners[i as usize], corners[(i as usize + 1) % 3]);
                    Keyed { ends: [tail.min(head), tail.max(head)], id: HalfEdge(3 * triangle + i) }
                })
            })
        };
        let mut next = vec![0usize; self.mesh.positions().len() + 1];
        keyed().for_each(|half| next[half.ends[0] as usize + 1] += 1);
        for vertex in 1..next.len() {
            next[vertex] += next[vertex - 1];
        }
        let empty = Keyed { ends: [0; 2], id: HalfEdge::NONE };
        let mut buckets = vec![empty; next.last().copied().unwrap_or(0)];
        for half in keyed() {
            let slot = &mut next[half.ends[0] as usize];
            buckets[*slot] = half;
            *slot += 1;
        }
        buckets
            .par_chunk_by_mut(|a, b| a.ends[0] == b.ends[0])
            .for_each(|bucket| bucket.sort_unstable_by_key(|half| (half.ends[1], half.id)));
        buckets
    }

    /// The wings of all edges, in their order.
    fn sides(&self) -> Vec<Side> {
        let half_edges = self.half_edges_by_edge();
        let mut sides = Vec::with_capacity(half_edges.len() / 2);
        half_edges.chunk_by(|a, b| a.ends == b.ends).for_each(|edge| pair(edge, &mut sides));
        drop(half_edges);
        sides.par_sort_unstable_by_key(|side| side.half_edges);
        sides
    }

    fn kept(&self, side: &Side) -> Kept {
        let wing = self.wing(side.half_edges);
        let [left, right] = side.half_edges;
        let turned = right != HalfEdge::NONE && self.start(left) == self.start(right);
        let class = match side.face_count {
            1 => EdgeClass::Boundary,
            2 if turned => EdgeClass::Inconsistent,
            2 => interior_class(self.mesh, &wing),
            _ => EdgeClass::NonManifold,
        };
        let drawable = match class {
            EdgeClass::Boundary | EdgeClass::Concave => false,
            EdgeClass::Convex | EdgeClass::NonManifold | EdgeClass::Inconsistent => true,
            EdgeClass::Flat => is_fold(self.mesh, &wing),
        };
        Kept { wing, class, turned, drawable }
    }

    fn wing(&self, [left, right]: [HalfEdge; 2]) -> Wing {
        let around = |half: HalfEdge| {
            let corners = self.corners(half.triangle());
            [0, 1, 2].map(|i| corners[(half.corner() + i) % 3])
        };
        let [tail, head, opposite] = around(left);
        let right = if right == HalfEdge::NONE { Wing::NONE } else { around(right)[2] };
        Wing { tail, head, left: opposite, right }
    }

    fn start(&self, half: HalfEdge) -> u32 {
        self.corners(half.triangle())[half.corner()]
    }
}
