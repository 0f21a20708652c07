//! From patch sets to what lies in buffers.

use std::ops::Range;

use drypoint_bounds::DoubleCone;
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeClass, EdgeFilter, EdgeId, Mesh, MeshAdjacency, Wing};
use glam::Vec3;

use crate::layout::Group;
use crate::{EdgeEnds, EdgePlanes, Frame};

/// Most edges in one entry of [`Content::patches`]: larger patches are several, with the same bound, so
/// that no workgroup is left with far more to do than others.
pub const MAX_PIECE: u32 = 256;

/// Most patches in one entry of [`Content::super_patches`]: larger super-patches are several, as patches
/// are of [`MAX_PIECE`].
pub const MAX_GROUP: u32 = 64;

/// An edge that a [`Content`] is to hold.
#[derive(Clone, Copy, Debug)]
pub struct ContentEdge<'a> {
    /// Its vertices and those of its two faces.
    pub wing: &'a Wing,
    /// Its id in the mesh's adjacency.
    pub id: EdgeId,
    /// Its class there.
    pub class: EdgeClass,
}

impl<'a> ContentEdge<'a> {
    /// An edge of two faces or more.
    pub fn new(adjacency: &'a MeshAdjacency, id: EdgeId) -> Self {
        Self { wing: &adjacency.wings()[id.index()], id, class: adjacency.class(id) }
    }
}

/// All that extraction reads of a model of one or several rigid parts, part by part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    /// The frame of each part.
    pub frames: Vec<Frame>,
    /// Edges of each part.
    pub parts: Vec<Range<u32>>,
    /// Planes of each edge, in the frame of its part.
    pub planes: Vec<EdgePlanes>,
    /// Vertices of each edge, numbered on from part to part, and its id in its part.
    pub ends: Vec<EdgeEnds>,
    /// Patches, and edges that no patch holds under bounds that never cull. They follow one another
    /// without a gap, and hold every edge. Empty without patches.
    pub patches: Vec<Group>,
    /// Super-patches, and patches that none holds under bounds that never cull. They follow one another
    /// without a gap. Empty unless a part has a second level.
    pub super_patches: Vec<Group>,
    /// Vertices, in model units, part by part.
    pub positions: Vec<Vec3>,
}

/// A piece of a [`Content`] that fits a binding. Indices count from its own beginning.
#[derive(Clone, Debug, PartialEq)]
pub struct Chunk {
    /// Edges of the content.
    pub edges: Range<u32>,
    /// What it holds of each part that is in it: the part, and edges of the chunk.
    pub parts: Vec<(u32, Range<u32>)>,
    /// As [`Content::patches`].
    pub patches: Vec<Group>,
    /// As [`Content::super_patches`].
    pub super_patches: Vec<Group>,
}

impl Content {
    /// Of one rigid part for each patch set. Linear; exact predicates and a normal for each edge.
    pub fn new(parts: &[&PatchSet]) -> Self {
        Self::in_frames(parts, |set| frame_of(set.positions(), set.wings().iter()))
    }

    /// The same in frames that hold all faces of each shape, those too that lie beside none of its edges.
    pub(crate) fn of_shapes(shapes: &[&PatchSet]) -> Self {
        Self::in_frames(shapes, |set| Frame::new(set.positions().iter().copied()))
    }

    fn in_frames(parts: &[&PatchSet], frame: impl Fn(&PatchSet) -> Frame) -> Self {
        let mut content = Self::default();
        let has_levels = parts.iter().any(|set| !set.super_patches().is_empty());
        for (part, &set) in (0..).zip(parts) {
            let first_edge = content.edge_count();
            let named = set.wings().iter().zip(set.edge_ids()).zip(set.classes());
            let edges = named.map(|((wing, &id), &class)| ContentEdge { wing, id, class });
            content.add_edges(set.positions(), frame(set), edges);
            content.add_patches(part, first_edge, set, has_levels);
        }
        content
    }

    /// Of a mesh without patches, for brute force.
    ///
    /// # Panics
    /// If `adjacency` is of another mesh, with more vertices.
    pub fn without_patches(mesh: &Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        let mut content = Self::default();
        let edges = adjacency.edges(filter).map(|edge| ContentEdge::new(adjacency, edge));
        let edges: Vec<_> = edges.collect();
        let frame = frame_of(mesh.positions(), edges.iter().map(|edge| edge.wing));
        content.add_edges(mesh.positions(), frame, edges.into_iter());
        content
    }

    /// Of a mesh whose edges somebody else has grouped: `edges` in the order of the groups, and for each
    /// group in turn a bound of its edges' planes, in model units, and how many edges it has. Those that
    /// are left over are always tested.
    ///
    /// # Panics
    /// If groups have more edges than there are.
    pub fn with_groups<'a>(
        positions: &[Vec3],
        edges: impl Iterator<Item = ContentEdge<'a>> + Clone,
        groups: impl IntoIterator<Item = (DoubleCone, u32)>,
    ) -> Self {
        let mut content = Self::default();
        let frame = frame_of(positions, edges.clone().map(|edge| edge.wing));
        content.add_edges(positions, frame, edges);
        let (mut first, all) = (0, content.edge_count());
        for (bound, edge_count) in groups {
            assert!(edge_count <= all - first, "groups have more edges than there are");
            let edges = first..first + edge_count;
            let whole = group(frame.bound(&bound), 0, edges, 1);
            push_pieces(&mut content.patches, whole, MAX_PIECE);
            first += edge_count;
        }
        let rest = group(DoubleCone::ALWAYS, 0, first..all, 0);
        push_pieces(&mut content.patches, rest, MAX_PIECE);
        content
    }

    /// Whether all that it refers to is there: what shaders that check no index rely on.
    ///
    /// # Errors
    /// What is not there. That of [`Content::new`] and the other ways to make one always is.
    pub fn check(&self) -> Result<(), &'static str> {
        let is_within = |first: u32, count: u32, length: usize| {
            u64::from(first) + u64::from(count) <= length as u64
        };
        let follow = |groups: &[Group], length: usize| {
            let ends = groups.iter().map(|group| group.first.saturating_add(group.count));
            let starts = groups.iter().skip(1).map(|group| group.first);
            let is_gapless = ends.zip(starts).all(|(end, start)| end == start);
            is_gapless && groups.iter().all(|group| is_within(group.first, group.count, length))
        };
        let vertices = self.positions.len();
        let is_vertex = |vertex: u32| (vertex as usize) < vertices;
        let is_part = |group: &Group| (group.part as usize) < self.frames.len();
        let fits_piece = |group: &Group| (1..=MAX_PIECE).contains(&group.count);
        let fits_group = |group: &Group| (1..=MAX_GROUP).contains(&group.count);
        let has_vertices =
            |ends: &EdgeEnds| is_vertex(ends.from_vertex) && is_vertex(ends.to_vertex);
        let checks = [
            (self.ends.len() == self.planes.len(), "planes or ends of edges"),
            (self.ends.iter().all(has_vertices), "vertices"),
            (self.parts.len() == self.frames.len(), "parts"),
            (self.parts.iter().all(|p| is_within(0, p.end, self.planes.len())), "edges"),
            (self.patches.iter().all(fits_piece), "pieces of patches"),
            (follow(&self.patches, self.planes.len()), "edges of patches"),
            (self.super_patches.iter().all(fits_group), "pieces of super-patches"),
            (follow(&self.super_patches, self.patches.len()), "patches of super-patches"),
            (self.patches.iter().chain(&self.super_patches).all(is_part), "parts of patches"),
        ];
        checks.into_iter().find(|(is_there, _)| !is_there).map_or(Ok(()), |(_, what)| Err(what))
    }

    /// Number of edges of all parts.
    pub fn edge_count(&self) -> u32 {
        count(self.planes.len())
    }

    fn add_edges<'a>(
        &mut self,
        positions: &[Vec3],
        frame: Frame,
        edges: impl Iterator<Item = ContentEdge<'a>>,
    ) {
        let first_vertex = count(self.positions.len());
        let first_edge = self.edge_count();
        for ContentEdge { wing, id: edge, class } in edges {
            let [from_vertex, to_vertex] = wing.ends().map(|vertex| first_vertex + vertex);
            self.planes.push(EdgePlanes::new(positions, wing, &frame));
            let edge_class = class as u32;
            self.ends.push(EdgeEnds { from_vertex, to_vertex, edge, edge_class });
        }
        self.positions.extend_from_slice(positions);
        self.frames.push(frame);
        self.parts.push(first_edge..self.edge_count());
    }

    fn add_patches(&mut self, part: u32, first_edge: u32, set: &PatchSet, has_levels: bool) {
        let frame = *self.frames.last().expect("edges of the part are there");
        let first_piece = self.patches.len();
        // Where the pieces of each patch begin.
        let mut starts = Vec::new();
        for patch in set.patches() {
            starts.push(self.patches.len());
            let edges = patch.edges().start + first_edge..patch.edges().end + first_edge;
            let whole = group(frame.bound(&patch.bound), part, edges, 1);
            push_pieces(&mut self.patches, whole, MAX_PIECE);
        }
        starts.push(self.patches.len());
        let always = set.always_tested();
        let edges = always.start + first_edge..always.end + first_edge;
        let rest = group(DoubleCone::ALWAYS, part, edges, 0);
        push_pieces(&mut self.patches, rest, MAX_PIECE);
        if !has_levels {
            return;
        }
        let mut grouped = first_piece;
        for super_patch in set.super_patches() {
            let [first, end] = [super_patch.patches().start, super_patch.patches().end];
            let pieces = starts[first as usize]..starts[end as usize];
            grouped = pieces.end;
            let pieces = count(pieces.start)..count(pieces.end);
            let whole = group(frame.bound(&super_patch.bound), part, pieces, 1);
            push_pieces(&mut self.super_patches, whole, MAX_GROUP);
        }
        let rest = count(grouped)..count(self.patches.len());
        let rest = group(DoubleCone::ALWAYS, part, rest, 0);
        push_pieces(&mut self.super_patches, rest, MAX_GROUP);
    }

    /// Pieces of at most `max_edges` edges and `max_groups` patches each, both at least [`MAX_PIECE`].
    /// Patches that are longer are in several; super-patches too.
    pub fn chunks(&self, max_edges: u32, max_groups: u32) -> Vec<Chunk> {
        if self.patches.is_empty() {
            let cuts = (0..self.edge_count()).step_by(max_edges.max(1) as usize);
            let end = |first: u32| first.saturating_add(max_edges).min(self.edge_count());
            return cuts.map(|first| self.chunk(first..end(first), 0..0)).collect();
        }
        let mut chunks = Vec::new();
        let mut first = 0;
        while first < self.patches.len() {
            let start = self.patches[first].first;
            let fits = |group: &&Group| group.first + group.count - start <= max_edges;
            let most = max_groups.max(1) as usize;
            let taken = self.patches[first..].iter().take(most).take_while(fits).count().max(1);
            let last = &self.patches[first + taken - 1];
            chunks.push(self.chunk(start..last.first + last.count, first..first + taken));
            first += taken;
        }
        chunks
    }

    fn chunk(&self, edges: Range<u32>, patches: Range<usize>) -> Chunk {
        let parts = (0..).zip(&self.parts).filter_map(|(part, of_part)| {
            let shared = edges.start.max(of_part.start)..edges.end.min(of_part.end);
            let local =
                shared.start.saturating_sub(edges.start)..shared.end.saturating_sub(edges.start);
            (shared.start < shared.end).then_some((part, local))
        });
        let moved = |group: &Group| Group { first: group.first - edges.start, ..*group };
        let here = count(patches.start)..count(patches.end);
        let super_patches = self.super_patches.iter().filter_map(|group| {
            let first = group.first.max(here.start);
            let end = (group.first + group.count).min(here.end);
            let weight = if group.first < here.start { 0 } else { group.weight };
            let shared = (first < end).then(|| end - first)?;
            Some(Group { first: first - here.start, count: shared, weight, ..*group })
        });
        Chunk {
            parts: parts.collect(),
            patches: self.patches[patches].iter().map(moved).collect(),
            super_patches: super_patches.collect(),
            edges,
        }
    }
}

/// Around the faces of edges.
fn frame_of<'a>(positions: &[Vec3], wings: impl Iterator<Item = &'a Wing>) -> Frame {
    let vertices = wings.flat_map(|w| [w.tail, w.head, w.left, w.right]);
    Frame::new(vertices.map(|vertex| positions[vertex as usize]))
}

impl Chunk {
    /// Where blocks of super-patches that follow one another begin, and where the last one ends: each has
    /// at most `most_patches`, but for one of a single super-patch. Empty without super-patches.
    pub fn blocks(&self, most_patches: u32) -> Vec<u32> {
        let mut blocks = Vec::new();
        let mut patches = 0;
        for (index, group) in (0..).zip(&self.super_patches) {
            patches += group.count;
            if index == 0 || patches > most_patches {
                blocks.push(index);
                patches = group.count;
            }
        }
        if !blocks.is_empty() {
            blocks.push(count(self.super_patches.len()));
        }
        blocks
    }
}

/// Adds `whole` in pieces of at most `most` edges or patches; the first has the weight of all.
fn push_pieces(groups: &mut Vec<Group>, whole: Group, most: u32) {
    let end = whole.first + whole.count;
    for first in (whole.first..end).step_by(most as usize) {
        let weight = if first == whole.first { whole.weight } else { 0 };
        groups.push(Group { first, count: most.min(end - first), weight, ..whole });
    }
}

fn group(bound: DoubleCone, part: u32, members: Range<u32>, weight: u32) -> Group {
    Group { bound, first: members.start, count: members.end - members.start, part, weight }
}

fn count(length: usize) -> u32 {
    u32::try_from(length).expect("edges and vertices have a u32 each, and patches an edge each")
}
