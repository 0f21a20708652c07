//! Edges as steps from face to face.
//!
//! Every edge lies between two faces, so edges are the links of a graph of faces, and can be walked
//! in trails: each once, as few trails as half the faces with an odd number of links. Written in the
//! order of the walk, an edge lies between a face and the one before it, and with a bit for each face
//! that looks away, b, the contour edges are b ^ (b << 1): one plane for each edge and trail, not two
//! for each edge.

use drypoint_mesh::Wing;
use glam::Vec3;

use crate::edges::{Blocks, Seen};
use crate::faces::{FaceBlock, Frame, LANES, Plane, View};
use crate::simd::Lanes;

/// What stands for "no link" and "no edge".
const NONE: u32 = u32::MAX;

/// Edges between faces that follow each other, in blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strips {
    faces: Vec<FaceBlock>,
    /// Of each block, a bit for each face that shares an edge with the one before.
    links: Vec<u16>,
    /// The place of that edge among all edges; of others, any.
    places: Vec<[u32; LANES]>,
}

impl Strips {
    fn finish(&mut self, block: &mut Block) {
        if !block.planes.is_empty() {
            let planes = &block.planes;
            self.faces.push(FaceBlock::new(|lane| planes[lane.min(planes.len() - 1)]));
            self.links.push(block.links);
            self.places.push(block.places);
            *block = Block::default();
        }
    }
}

impl Blocks for Strips {
    type LookedAt<'a> = (&'a [FaceBlock], &'a [u16]);

    /// Takes the time of sorting the faces.
    fn push(&mut self, frame: &Frame, positions: &[Vec3], wings: &[Wing], first_place: u32) {
        let graph = Graph::new(wings);
        let plane = |face: u32, is_turned: bool| {
            let corners = graph.faces[face as usize].map(|vertex| positions[vertex as usize]);
            frame.plane(corners).turned(is_turned)
        };
        let mut block = Block::default();
        // Whether the last face of the block is the one that the trail has reached.
        let mut is_open = false;
        let (mut reached, mut is_turned) = (0, false);
        for step in graph.trails() {
            if step.link == NONE {
                (is_open, is_turned) = (false, false);
            } else {
                if !is_open {
                    if block.planes.len() + 1 >= LANES {
                        self.finish(&mut block);
                    }
                    block.push(plane(reached, is_turned), None);
                }
                let link = &graph.links[step.link as usize];
                is_turned ^= link.is_turned;
                block.push(plane(step.face, is_turned), Some(first_place + link.wing));
                is_open = block.planes.len() < LANES;
                if !is_open {
                    self.finish(&mut block);
                }
            }
            reached = step.face;
        }
        self.finish(&mut block);
    }

    #[inline(always)]
    fn looked_at(&self) -> (&[FaceBlock], &[u16]) {
        (&self.faces, &self.links[..self.faces.len()])
    }

    #[inline(always)]
    fn look<L: Lanes>(
        (faces, links): (&[FaceBlock], &[u16]),
        lanes: L,
        block: u32,
        view: View,
    ) -> Seen {
        let sides = faces[block as usize].sides(lanes, view);
        let links = links[block as usize];
        Seen {
            contours: (sides.back ^ sides.back << 1) & links,
            doubtful: (sides.doubtful | sides.doubtful << 1) & links,
        }
    }

    fn place(&self, block: u32, lane: usize) -> Option<u32> {
        let is_link = self.links[block as usize] >> lane & 1 == 1;
        is_link.then(|| self.places[block as usize][lane])
    }

    #[expect(clippy::cast_possible_truncation, reason = "at most one for each edge id")]
    fn len(&self) -> u32 {
        self.faces.len() as u32
    }
}

/// A block in the making.
#[derive(Default)]
struct Block {
    planes: Vec<Plane>,
    links: u16,
    places: [u32; LANES],
}

impl Block {
    /// A face, and the place of the edge between it and the one before.
    fn push(&mut self, plane: Plane, place: Option<u32>) {
        if let Some(place) = place {
            self.links |= 1 << self.planes.len();
            self.places[self.planes.len()] = place;
        }
        self.planes.push(plane);
    }
}

/// Faces, by the edges between them.
struct Graph {
    /// Corners, sorted: two faces upon each other are one.
    faces: Vec<[u32; 3]>,
    links: Vec<Link>,
}

/// An edge between two faces.
struct Link {
    faces: [u32; 2],
    /// Its number among the wings.
    wing: u32,
    /// Whether its wing reads one of the faces in the order of its corners, and the other against it.
    is_turned: bool,
}

/// A face that a trail comes to, and the link that leads to it from the last; [`NONE`] at its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Step {
    face: u32,
    link: u32,
}

impl Graph {
    #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
    fn new(wings: &[Wing]) -> Self {
        let inner = || wings.iter().zip(0..).filter(|(wing, _)| wing.right != Wing::NONE);
        let mut faces: Vec<[u32; 3]> = inner()
            .flat_map(|(wing, _)| [sorted(wing.left_face()).0, sorted(wing.right_face()).0])
            .collect();
        faces.sort_unstable();
        faces.dedup();
        let link = |(wing, number): (&Wing, u32)| {
            let [left, right] = [sorted(wing.left_face()), sorted(wing.right_face())];
            let number_of =
                |face: [u32; 3]| faces.binary_search(&face).expect("it was put there") as u32;
            Link {
                faces: [number_of(left.0), number_of(right.0)],
                wing: number,
                is_turned: left.1 != right.1,
            }
        };
        let links = inner().map(link).collect();
        Self { faces, links }
    }

    /// Walks every link once, in as few trails as there can be. Linear.
    ///
    /// Faces with an odd number of links are joined in pairs, which makes circuits possible (Hierholzer,
    /// Mathematische Annalen 6, 1873); where those use such a joint, a trail ends and the next begins.
    #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
    fn trails(&self) -> Vec<Step> {
        let mut degrees = vec![0u32; self.faces.len()];
        for face in self.links.iter().flat_map(|link| link.faces) {
            degrees[face as usize] += 1;
        }
        let odd: Vec<u32> =
            (0..degrees.len() as u32).filter(|&face| degrees[face as usize] % 2 == 1).collect();
        // Joints come first, so that a circuit from an odd face begins with one, and breaks there.
        let joints = odd.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let links: Vec<[u32; 2]> = joints.chain(self.links.iter().map(|link| link.faces)).collect();
        let mut circuits = Circuits::new(self.faces.len(), &links);
        let mut steps = Vec::with_capacity(links.len() + odd.len());
        for face in odd.iter().copied().chain(0..degrees.len() as u32) {
            circuits.walk(face, &mut steps);
        }
        let joint_count = (odd.len() / 2) as u32;
        for step in &mut steps {
            step.link = if step.link == NONE {
                NONE
            } else {
                step.link.checked_sub(joint_count).unwrap_or(NONE)
            };
        }
        steps
    }
}

/// Walks along links that were not walked yet.
struct Circuits<'a> {
    links: &'a [[u32; 2]],
    /// Of each face, where its links begin in `by_face`, and the next that was not looked at.
    next: Vec<usize>,
    starts: Vec<usize>,
    by_face: Vec<u32>,
    is_walked: Vec<bool>,
    stack: Vec<Step>,
}

impl<'a> Circuits<'a> {
    #[expect(clippy::cast_possible_truncation, reason = "an edge has a u32 as its id")]
    fn new(faces: usize, links: &'a [[u32; 2]]) -> Self {
        let mut starts = vec![0; faces + 1];
        for &face in links.iter().flatten() {
            starts[face as usize + 1] += 1;
        }
        for face in 0..faces {
            starts[face + 1] += starts[face];
        }
        let mut next = starts.clone();
        let mut by_face = vec![0; 2 * links.len()];
        for (link, ends) in links.iter().enumerate() {
            for &face in ends {
                by_face[next[face as usize]] = link as u32;
                next[face as usize] += 1;
            }
        }
        next.clone_from(&starts);
        Self {
            links,
            next,
            starts,
            by_face,
            is_walked: vec![false; links.len()],
            stack: Vec::new(),
        }
    }

    /// Appends the circuit of all links that can be reached from `face`, backwards; nothing, if there
    /// are none.
    fn walk(&mut self, face: u32, steps: &mut Vec<Step>) {
        let Some(link) = self.take(face) else { return };
        // The link of a step on the stack led to it; that of a step in the circuit leads on from the
        // step before, which is the next on the way back.
        let mut came_by = NONE;
        self.stack.push(Step { face, link: NONE });
        self.follow(face, link);
        while let Some(&Step { face, link: back }) = self.stack.last() {
            if let Some(link) = self.take(face) {
                self.follow(face, link);
            } else {
                self.stack.pop();
                steps.push(Step { face, link: came_by });
                came_by = back;
            }
        }
    }

    fn follow(&mut self, face: u32, link: u32) {
        let [a, b] = self.links[link as usize];
        self.stack.push(Step { face: if a == face { b } else { a }, link });
    }

    /// A link of `face` that was not walked.
    fn take(&mut self, face: u32) -> Option<u32> {
        let end = self.starts[face as usize + 1];
        let next = &mut self.next[face as usize];
        while *next < end {
            let link = self.by_face[*next];
            *next += 1;
            if !std::mem::replace(&mut self.is_walked[link as usize], true) {
                return Some(link);
            }
        }
        None
    }
}

/// The corners in ascending order, and whether that takes an odd number of swaps.
fn sorted([a, b, c]: [u32; 3]) -> ([u32; 3], bool) {
    let mut face = [a, b, c];
    face.sort_unstable();
    let is_odd = (a > b) ^ (a > c) ^ (b > c);
    (face, is_odd)
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, shapes};

    use super::*;

    fn wings(mesh: &Mesh, filter: EdgeFilter) -> Vec<Wing> {
        let adjacency = MeshAdjacency::new(mesh);
        adjacency.edges(filter).map(|edge| adjacency.wing(edge)).collect()
    }

    /// Every link once, from the face that the trail has reached; as few trails as odd faces allow, or
    /// one for each closed walk.
    #[track_caller]
    fn check_trails(wings: &[Wing]) {
        let graph = Graph::new(wings);
        let mut degrees = vec![0; graph.faces.len()];
        for face in graph.links.iter().flat_map(|link| link.faces) {
            degrees[face as usize] += 1;
        }
        let odd = degrees.iter().filter(|&degree| degree % 2 == 1).count();
        let steps = graph.trails();
        let mut walked = vec![false; graph.links.len()];
        let (mut trails, mut closed) = (0, 0);
        let mut start = 0;
        for (number, step) in steps.iter().enumerate() {
            if step.link == NONE {
                start = number;
                continue;
            }
            let before = steps[number - 1].face;
            let [a, b] = graph.links[step.link as usize].faces;
            assert!([(a, b), (b, a)].contains(&(before, step.face)), "{step:?} from {before}");
            assert!(!std::mem::replace(&mut walked[step.link as usize], true), "{step:?} again");
            if steps.get(number + 1).is_none_or(|next| next.link == NONE) {
                trails += 1;
                closed += usize::from(steps[start].face == step.face);
            }
        }
        assert!(walked.into_iter().all(|is_walked| is_walked));
        assert!(trails - closed <= odd / 2, "{trails} trails, {closed} closed, {odd} odd faces");
    }

    #[test]
    fn walks_go_along_every_link_once() {
        for mesh in [
            shapes::cube(),
            shapes::cubes_sharing_an_edge(),
            shapes::folded_sheet(),
            shapes::one_triangle(),
            shapes::empty(),
            shapes::torus_knot(3_000),
            shapes::bumpy_sphere(3_000),
        ] {
            for filter in [EdgeFilter::All, EdgeFilter::Convex] {
                check_trails(&wings(&mesh, filter));
            }
        }
    }

    /// A block holds each edge at most once, at a lane that is not the first, and all blocks together
    /// hold all edges.
    #[test]
    fn blocks_hold_every_edge_once() {
        let mesh = shapes::bumpy_sphere(3_000);
        let wings = wings(&mesh, EdgeFilter::Convex);
        let mut strips = Strips::default();
        strips.push(&Frame::new(mesh.positions(), &wings), mesh.positions(), &wings, 7);
        let places = (0..strips.len())
            .flat_map(|block| (0..LANES).map(move |lane| (block, lane)))
            .filter_map(|(block, lane)| strips.place(block, lane));
        let mut places: Vec<u32> = places.collect();
        places.sort_unstable();
        assert!(places.into_iter().eq((7..).take(wings.len())));
        assert!(strips.links.iter().all(|links| links & 1 == 0));
        // Two planes an edge would be twice as many as there are.
        let slots = LANES * strips.faces.len();
        assert!(slots < 3 * wings.len() / 2, "{slots} planes for {} edges", wings.len());
    }
}
