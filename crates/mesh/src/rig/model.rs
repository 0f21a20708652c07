//! A mesh whose vertices are carried.

use glam::{DAffine3, DVec3, Vec3};

use super::builder::{Influence, Offset};
use super::{Animation, Local, Node, Property};
use crate::{Mesh, MeshError};

/// A space that moves as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Carrier {
    /// The node whose space it is; `None` for that of the scene, or for one that only a [`Pose`] moves.
    pub node: Option<u32>,
    /// Of several places of one mesh, which mesh: its vertices are apart from all others.
    pub mesh: Option<u32>,
}

impl Carrier {
    /// From its space to that of the scene, in which the nodes are there.
    pub(super) fn in_scene(&self, nodes: &[DAffine3]) -> DAffine3 {
        self.node.map_or(DAffine3::IDENTITY, |node| nodes[node as usize])
    }
}

/// A morph target of a node's mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morph {
    /// The node whose weight it is.
    pub node: u32,
    /// Its weight at rest.
    pub rest: f64,
}

/// Where a rig is at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// For each carrier from its space to that of the scene.
    pub to_scene: Vec<DAffine3>,
    /// For each morph target how much of it is added.
    pub weights: Vec<f64>,
}

/// A mesh whose vertices are carried. Made by [`RigBuilder`](super::RigBuilder), or read from glTF.
///
/// Vertices that coincide in every pose are one. Triangles are counter-clockwise seen from outside
/// where no carrier mirrors; [`Rig::mesh`] turns those that one mirrors.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    pub(super) nodes: Vec<Node>,
    /// Indices of the nodes, parents first.
    pub(super) order: Vec<u32>,
    pub(super) carriers: Vec<Carrier>,
    pub(super) morphs: Vec<Morph>,
    pub(super) animations: Vec<Animation>,
    pub(super) influences: Vec<Influence>,
    /// Where the influences of each vertex begin, and of one past the last.
    pub(super) first_influence: Vec<u32>,
    pub(super) offsets: Vec<Offset>,
    /// As `first_influence`.
    pub(super) first_offset: Vec<u32>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Default for Rig {
    /// Nothing: no vertex, and no carrier but those to come.
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            order: Vec::new(),
            carriers: Vec::new(),
            morphs: Vec::new(),
            animations: Vec::new(),
            influences: Vec::new(),
            first_influence: vec![0],
            offsets: Vec::new(),
            first_offset: vec![0],
            triangles: Vec::new(),
        }
    }
}

impl Rig {
    /// The tree that carriers hang from.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// What carries vertices.
    pub fn carriers(&self) -> &[Carrier] {
        &self.carriers
    }

    /// Morph targets, those of one node together.
    pub fn morphs(&self) -> &[Morph] {
        &self.morphs
    }

    /// In the order of the file.
    pub fn animations(&self) -> &[Animation] {
        &self.animations
    }

    /// Vertices of each triangle, none of them turned.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.first_influence.len() - 1
    }

    /// What a vertex follows, with weights that add up to 1; at least one.
    ///
    /// # Panics
    /// If there is no such vertex; so do the others.
    pub fn influences(&self, vertex: u32) -> &[Influence] {
        let vertex = vertex as usize;
        &self.influences
            [self.first_influence[vertex] as usize..self.first_influence[vertex + 1] as usize]
    }

    /// What morph targets add to a vertex; empty for most.
    pub fn offsets(&self, vertex: u32) -> &[Offset] {
        let vertex = vertex as usize;
        &self.offsets[self.first_offset[vertex] as usize..self.first_offset[vertex + 1] as usize]
    }

    /// The carrier that alone moves a vertex, if there is one.
    pub fn rigid_carrier(&self, vertex: u32) -> Option<u32> {
        match self.influences(vertex) {
            [only] if self.offsets(vertex).is_empty() => Some(only.carrier),
            _ => None,
        }
    }

    /// The carrier that weighs most at a vertex, the first of equals: with it a face is turned over.
    pub fn leading_carrier(&self, vertex: u32) -> u32 {
        let influences = self.influences(vertex);
        let heaviest = influences.iter().reduce(|a, b| if b.weight > a.weight { b } else { a });
        heaviest.map_or(0, |influence| influence.carrier)
    }

    /// Where a vertex is in a pose, in the scene: Σ weight · to_scene · (position + Σ morphs).
    pub fn position(&self, vertex: u32, pose: &Pose) -> DVec3 {
        posed_position(self.influences(vertex), self.offsets(vertex), pose)
    }

    /// Where it is when nothing is animated.
    pub fn rest(&self) -> Pose {
        self.pose(&self.resting_locals(), self.morphs.iter().map(|morph| morph.rest).collect())
    }

    /// Where it is at a time of an animation, in seconds: before its first key and after its last it
    /// stays. Linear in nodes and channels, and in morph targets for each channel of weights.
    ///
    /// # Panics
    /// If there is no such animation.
    pub fn pose_at(&self, animation: usize, seconds: f64) -> Pose {
        let mut locals = self.resting_locals();
        let mut weights: Vec<f64> = self.morphs.iter().map(|morph| morph.rest).collect();
        for channel in &self.animations[animation].channels {
            if channel.property == Property::Weights {
                let first = self.morphs.iter().position(|morph| morph.node == channel.node);
                let of_node = self.morphs.iter().filter(|morph| morph.node == channel.node).count();
                if let Some(first) = first {
                    channel.curve.sample(seconds, &mut weights[first..first + of_node]);
                }
            } else if let Some(local) = locals.get_mut(channel.node as usize) {
                channel.move_node(seconds, local);
            }
        }
        self.pose(&locals, weights)
    }

    /// The pose in which each node is at its local place, given for all of them. Those that do not
    /// move ([`Node::moves`]) are taken to be at rest.
    ///
    /// # Panics
    /// If there is not one local place for each node and one weight for each morph target.
    pub fn pose(&self, locals: &[Local], weights: Vec<f64>) -> Pose {
        assert_eq!(locals.len(), self.nodes.len(), "a local place for each node");
        assert_eq!(weights.len(), self.morphs.len(), "a weight for each morph target");
        let nodes = self.nodes_in_scene(locals);
        Pose { to_scene: self.carriers.iter().map(|c| c.in_scene(&nodes)).collect(), weights }
    }

    /// For each node where it is in its parent's space when nothing is animated.
    pub(super) fn resting_locals(&self) -> Vec<Local> {
        self.nodes.iter().map(|node| node.rest).collect()
    }

    /// For each node from its space to that of the scene.
    pub(super) fn nodes_in_scene(&self, locals: &[Local]) -> Vec<DAffine3> {
        let mut nodes = vec![DAffine3::IDENTITY; self.nodes.len()];
        for &index in &self.order {
            let node = &self.nodes[index as usize];
            let local = if node.moves { locals[index as usize] } else { node.rest };
            let parent = node.parent.map_or(DAffine3::IDENTITY, |parent| nodes[parent as usize]);
            nodes[index as usize] = parent * local.to_affine();
        }
        nodes
    }

    /// Which carriers mirror in a pose: there a triangle's corners run the other way.
    pub fn mirrored(&self, pose: &Pose) -> Vec<bool> {
        pose.to_scene.iter().map(|to_scene| to_scene.matrix3.determinant() < 0.0).collect()
    }

    /// The surface in a pose: the same vertices and triangles in each, those turned over that a carrier
    /// mirrors. For its edges [`Rig::adjacency`] knows which vertices are one.
    ///
    /// # Errors
    /// A vertex that is at no finite place, or at one beyond f32.
    pub fn mesh(&self, pose: &Pose) -> Result<Mesh, MeshError> {
        let vertices = 0..u32::try_from(self.vertex_count()).unwrap_or(u32::MAX);
        // Adding 0 turns −0 into 0.
        let at = |vertex| self.position(vertex, pose).as_vec3() + Vec3::ZERO;
        let mirrored = self.mirrored(pose);
        let turned = |&[a, b, c]: &[u32; 3]| {
            if mirrored[self.leading_carrier(a) as usize] { [a, c, b] } else { [a, b, c] }
        };
        Mesh::new(vertices.map(at).collect(), self.triangles.iter().map(turned).collect())
    }

    /// The edges of the surface in a pose, `mesh`. Vertices that meet only for a moment stay apart.
    pub fn adjacency(&self, mesh: &Mesh) -> crate::MeshAdjacency {
        let vertices = 0..u32::try_from(self.vertex_count()).unwrap_or(u32::MAX);
        crate::MeshAdjacency::welded(mesh, vertices.collect())
    }
}

/// [`Rig::position`], of a vertex that need be in no rig.
pub(crate) fn posed_position(influences: &[Influence], offsets: &[Offset], pose: &Pose) -> DVec3 {
    let carried = (0..).zip(influences).map(|(number, influence)| {
        let of_it = offsets.iter().filter(|offset| offset.influence == number);
        let moved = of_it.fold(influence.position.as_dvec3(), |sum, offset| {
            sum + pose.weights[offset.morph as usize] * offset.by.as_dvec3()
        });
        let at = pose.to_scene[influence.carrier as usize].transform_point3(moved);
        influence.weight * at
    });
    carried.sum()
}

impl super::Channel {
    /// Moves a node to where it is at a time. One that is given by a matrix stays.
    fn move_node(&self, seconds: f64, local: &mut Local) {
        let Local::Trs { translation, rotation, scale } = local else { return };
        let vector = || {
            let mut value = [0.0; 3];
            self.curve.sample(seconds, &mut value);
            DVec3::from_array(value)
        };
        match self.property {
            Property::Translation => *translation = vector(),
            Property::Scale => *scale = vector(),
            Property::Rotation => *rotation = self.curve.rotation(seconds),
            Property::Weights => {}
        }
    }
}
