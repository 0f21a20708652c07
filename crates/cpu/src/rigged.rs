//! Models that move: Tsiapkolis and Bénard, CGF 43(4), 2024, §4.1.

use std::cmp::Ordering;

use drypoint_fusion::PatchSet;
use drypoint_mesh::rig::{FaceSides, Pose, Rig, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Viewpoint};
use glam::Vec3;

use crate::{Contours, Extractor, Statistics};

/// Finds contour edges of a model that moves: those of rigid parts through patches, in the space of each
/// part, and loose ones on posed vertices.
///
/// The answer is that of [`Skin::contour_edges`] for the filter that the patches were made with.
#[derive(Clone, Debug)]
pub struct RigExtractor<'a> {
    rig: &'a Rig,
    skin: &'a Skin,
    filter: EdgeFilter,
    /// By shape.
    extractors: Vec<Extractor<'a>>,
    loose: Loose,
}

/// What is found of a model that moves, and memory for the next time.
#[derive(Clone, Debug, Default)]
pub struct RigContours {
    edges: Vec<EdgeId>,
    /// Of one part after the other.
    found: Contours<EdgeId>,
    /// Of the vertices of loose faces.
    positions: Vec<Vec3>,
    /// Of the faces beside loose edges.
    sides: Vec<Ordering>,
}

impl RigContours {
    /// What was found last: those of one part after the other, loose ones at the end.
    pub fn edges(&self) -> &[EdgeId] {
        &self.edges
    }
}

/// Loose edges and what they need.
#[derive(Clone, Debug, Default)]
struct Loose {
    /// Each edge with the places of its left and its right face in `faces`.
    edges: Vec<(EdgeId, [u32; 2])>,
    /// The faces beside them, and where the corners of those that bend are in `vertices`.
    faces: Vec<(u32, Option<[u32; 3]>)>,
    /// Vertices of the rig.
    vertices: Vec<u32>,
}

impl Loose {
    fn new(rig: &Rig, skin: &Skin) -> Self {
        let faces_of = |edge| skin.adjacency().sides(edge).map(|half_edge| half_edge.triangle());
        let faces = sorted(skin.loose().iter().flat_map(|&edge| faces_of(edge)).collect());
        let corners = |face: u32| rig.triangles()[face as usize];
        let bends = |face: u32| skin.part_of_face(face).is_none();
        let bending = faces.iter().copied().filter(|&face| bends(face));
        let vertices = sorted(bending.flat_map(corners).collect());
        let edges = skin.loose().iter();
        Self {
            edges: edges.map(|&edge| (edge, faces_of(edge).map(|f| place(&faces, f)))).collect(),
            faces: faces
                .iter()
                .map(|&face| {
                    let places = || corners(face).map(|vertex| place(&vertices, vertex));
                    (face, bends(face).then(places))
                })
                .collect(),
            vertices,
        }
    }
}

fn sorted(mut numbers: Vec<u32>) -> Vec<u32> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// The place of a number that is among those that are sorted.
fn place(sorted: &[u32], number: u32) -> u32 {
    u32::try_from(sorted.partition_point(|&other| other < number)).expect("a place of a u32")
}

impl<'a> RigExtractor<'a> {
    /// Lays out `patches`, one set for each of the skin's shapes
    /// ([`fuse_shapes`](drypoint_fusion::fuse_shapes)). Some 0.5 µs for each edge.
    ///
    /// # Panics
    /// If there is not one for each shape, or they are not all of one filter.
    pub fn new(rig: &'a Rig, skin: &'a Skin, patches: &'a [PatchSet]) -> Self {
        assert_eq!(patches.len(), skin.shapes().len(), "patches for each shape");
        let filter = patches.first().map_or(EdgeFilter::All, PatchSet::edge_filter);
        assert!(patches.iter().all(|set| set.edge_filter() == filter), "patches of one filter");
        let extractors = patches.iter().map(Extractor::new).collect();
        Self { rig, skin, filter, extractors, loose: Loose::new(rig, skin) }
    }

    /// Replaces what `contours` held by the contour edges seen from `viewpoint` in a pose, by id in
    /// [`Skin::adjacency`].
    ///
    /// Each part costs what [`Extractor::edges`] does and some 100 ns. Of loose edges, vertices are posed, some
    /// 20 ns for each joint that one follows, and faces and edges are tested, 10 ns each. Patches of a
    /// part that is flattened are passed over: its edges are tested as loose ones, with vertices posed one by one.
    ///
    /// # Panics
    /// If `pose` has not a place for each carrier.
    pub fn edges(
        &self,
        pose: &Pose,
        viewpoint: Viewpoint,
        contours: &mut RigContours,
    ) -> Statistics {
        self.extract(pose, viewpoint, contours, Extractor::edges)
    }

    /// The same as [`RigExtractor::edges`] with no patch skipped: for measuring what they gain.
    ///
    /// # Panics
    /// As [`RigExtractor::edges`].
    pub fn all_edges(
        &self,
        pose: &Pose,
        viewpoint: Viewpoint,
        contours: &mut RigContours,
    ) -> Statistics {
        self.extract(pose, viewpoint, contours, Extractor::all_edges)
    }

    fn extract(
        &self,
        pose: &Pose,
        viewpoint: Viewpoint,
        contours: &mut RigContours,
        of_part: impl Fn(&Extractor<'a>, Viewpoint, &mut Contours<EdgeId>) -> Statistics,
    ) -> Statistics {
        let faces = FaceSides::new(self.rig, self.skin, pose, viewpoint);
        let RigContours { edges, found, positions, sides } = contours;
        edges.clear();
        let mut statistics = Statistics::default();
        for (number, part) in (0..).zip(self.skin.parts()) {
            if let Some(carried) = faces.carried(number) {
                statistics += of_part(&self.extractors[part.shape as usize], carried, found);
                edges.extend(found.iter().map(|&edge| part.edge_in_rig(edge)));
            } else {
                let shape = &self.skin.shapes()[part.shape as usize];
                let kept = shape.edges(self.filter).map(|edge| part.edge_in_rig(edge));
                let counted = kept.inspect(|_| statistics.edges_tested += 1);
                edges.extend(counted.filter(|&edge| {
                    let of_edge = self.skin.adjacency().sides(edge);
                    faces.is_contour(edge, of_edge.map(|half| faces.side(half.triangle())))
                }));
            }
        }
        let loose = &self.loose;
        positions.clear();
        positions.extend(loose.vertices.iter().map(|&vertex| faces.posed(vertex)));
        sides.clear();
        sides.extend(loose.faces.iter().map(|&(face, corners)| match corners {
            Some(corners) => faces.side_with(face, |i| positions[corners[i] as usize]),
            None => faces.side(face),
        }));
        let side = |place: u32| sides[place as usize];
        let is_contour =
            |&&(edge, beside): &&(EdgeId, [u32; 2])| faces.is_contour(edge, beside.map(side));
        edges.extend(loose.edges.iter().filter(is_contour).map(|&(edge, _)| edge));
        statistics.edges_tested += self.skin.loose().len();
        statistics.contour_edges = edges.len();
        statistics
    }

    /// Number of edges that [`RigExtractor::edges`] may find: what brute force would test.
    pub fn edge_count(&self) -> usize {
        self.skin.edges(self.filter).count()
    }
}
