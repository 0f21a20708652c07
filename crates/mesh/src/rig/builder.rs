//! From vertices with their joints to a rig.

use foldhash::HashMap;
use glam::{DAffine3, Vec3};

use super::nodes::parents_first;
use super::{Animation, Carrier, Channel, Local, Morph, Node, Pose, Property, Rig};

/// One carrier's part in a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// Index of the carrier.
    pub carrier: u32,
    /// Its share, above 0.
    pub weight: f64,
    /// Where the vertex is in the carrier's space: for a joint, inverse bind matrix times position.
    pub position: Vec3,
}

/// What a morph target adds to a vertex, in the space of one of its carriers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Index of the morph target.
    pub morph: u32,
    /// Which of the vertex's influences it is for.
    pub influence: u32,
    /// At weight 1, in the carrier's units.
    pub by: Vec3,
}

/// A [`Rig`] in the making: nodes and carriers first, then vertices and triangles.
#[derive(Debug, Default)]
pub struct RigBuilder {
    rig: Rig,
    carriers: HashMap<Carrier, u32>,
    /// For each node where it is in the scene at rest, once that was asked for.
    resting: Option<Vec<DAffine3>>,
    /// Vertices by all that decides where they are.
    vertices: HashMap<Box<[u32]>, u32>,
    key: Vec<u32>,
}

impl RigBuilder {
    /// Hangs carriers from these nodes. `None` if one is its own ancestor, or hangs from none that
    /// exists.
    pub fn new(nodes: Vec<Node>) -> Option<Self> {
        let mut builder = Self::default();
        builder.rig.order = parents_first(&nodes)?;
        builder.rig.nodes = nodes;
        Some(builder)
    }

    /// The carrier of a node's space, or of the scene's; of several places of one `mesh`, that of this
    /// one. The same for the same question.
    ///
    /// # Panics
    /// If there is no such node, or it does not move and so is no space of its own.
    pub fn carrier(&mut self, node: Option<u32>, mesh: Option<u32>) -> u32 {
        assert!(node.is_none_or(|node| self.rig.nodes[node as usize].moves), "a node that moves");
        let carrier = Carrier { node, mesh };
        *self.carriers.entry(carrier).or_insert_with(|| {
            self.rig.carriers.push(carrier);
            index(self.rig.carriers.len() - 1)
        })
    }

    /// A morph target of a node's mesh, after those that it has already.
    pub fn morph(&mut self, node: u32, rest: f64) -> u32 {
        self.rig.morphs.push(Morph { node, rest });
        index(self.rig.morphs.len() - 1)
    }

    /// An animation of the nodes. A node that is given by a matrix and that it moves becomes one of
    /// translation, rotation and scale, as nearly as that can be.
    pub fn animation(&mut self, animation: Animation) {
        let moves_node = |channel: &&Channel| channel.property != Property::Weights;
        for channel in animation.channels.iter().filter(moves_node) {
            let node = self.rig.nodes.get_mut(channel.node as usize);
            if let Some(rest @ &mut Local::Matrix(matrix)) = node.map(|node| &mut node.rest) {
                *rest = Local::nearest_trs(matrix);
            }
        }
        self.resting = None;
        self.rig.animations.push(animation);
    }

    /// The vertex that follows `influences`, displaced by `offsets`: one that is there already, if it
    /// would coincide with it in every pose. Offsets of nothing are left out.
    ///
    /// # Panics
    /// If there is no influence, or one of a carrier that does not exist.
    pub fn vertex(&mut self, influences: &[Influence], offsets: &[Offset]) -> u32 {
        assert!(!influences.is_empty(), "a vertex follows something");
        let rig = &mut self.rig;
        let count = rig.carriers.len();
        assert!(influences.iter().all(|i| (i.carrier as usize) < count), "a carrier that exists");
        // Adding 0 turns −0 into 0.
        let bits = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
        let offsets = || offsets.iter().filter(|offset| offset.by != Vec3::ZERO);
        self.key.clear();
        for influence in influences {
            let weight = influence.weight.to_bits();
            #[expect(clippy::cast_possible_truncation, reason = "the two halves of 64 bits")]
            self.key.extend([influence.carrier, weight as u32, (weight >> 32) as u32]);
            self.key.extend(bits(influence.position));
        }
        for offset in offsets() {
            self.key.extend([offset.morph, offset.influence]);
            self.key.extend(bits(offset.by));
        }
        if let Some(&known) = self.vertices.get(&self.key[..]) {
            return known;
        }
        rig.influences.extend(influences);
        rig.offsets.extend(offsets());
        rig.first_influence.push(index(rig.influences.len()));
        rig.first_offset.push(index(rig.offsets.len()));
        let vertex = index(rig.vertex_count() - 1);
        self.vertices.insert(self.key.as_slice().into(), vertex);
        vertex
    }

    /// Appends to `pose`, which is the rest so far and of this builder, the carriers and the morph targets
    /// that came since: so a model of many carriers costs no more than each of them once. Animations must
    /// have come before.
    pub fn extend_rest(&mut self, pose: &mut Pose) {
        let rig = &self.rig;
        let nodes = self.resting.get_or_insert_with(|| rig.nodes_in_scene(&rig.resting_locals()));
        let carriers = rig.carriers.iter().skip(pose.to_scene.len());
        pose.to_scene.extend(carriers.map(|carrier| carrier.in_scene(nodes)));
        let morphs = rig.morphs.iter().skip(pose.weights.len());
        pose.weights.extend(morphs.map(|morph| morph.rest));
    }

    /// Adds a triangle.
    ///
    /// # Panics
    /// If a corner does not exist.
    pub fn triangle(&mut self, corners: [u32; 3]) {
        let count = self.rig.vertex_count();
        assert!(corners.iter().all(|&v| (v as usize) < count), "vertices that exist");
        self.rig.triangles.push(corners);
    }

    /// The rig.
    pub fn finish(self) -> Rig {
        self.rig
    }
}

/// A length or an index; there are never more of anything than three to a triangle times its joints.
fn index(index: usize) -> u32 {
    u32::try_from(index).expect("counts fit a u32")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn influence(carrier: u32, weight: f64) -> Influence {
        Influence { carrier, weight, position: Vec3::ONE }
    }

    #[test]
    fn vertices_that_always_coincide_are_one() {
        let mut builder = RigBuilder::default();
        let a = builder.carrier(None, None);
        let b = builder.carrier(None, Some(3));
        assert_eq!((a, b, builder.carrier(None, None)), (0, 1, 0));
        let morph = builder.morph(0, 0.0);
        let nothing = Offset { morph, influence: 0, by: Vec3::ZERO };
        let something = Offset { by: Vec3::X, ..nothing };
        let minus_zero = Influence { position: Vec3::new(-0.0, 1.0, 1.0), ..influence(a, 1.0) };
        let zero = Influence { position: Vec3::new(0.0, 1.0, 1.0), ..minus_zero };
        let found = [
            builder.vertex(&[influence(a, 1.0)], &[]),
            builder.vertex(&[influence(a, 1.0)], &[nothing]),
            builder.vertex(&[influence(b, 1.0)], &[]),
            builder.vertex(&[influence(a, 1.0)], &[something]),
            builder.vertex(&[influence(a, 0.5), influence(b, 0.5)], &[]),
            builder.vertex(&[influence(a, 0.25), influence(b, 0.75)], &[]),
            builder.vertex(&[minus_zero], &[]),
            builder.vertex(&[zero], &[]),
            builder.vertex(&[influence(a, 0.5), influence(b, 0.5)], &[]),
        ];
        assert_eq!(found, [0, 0, 1, 2, 3, 4, 5, 5, 3]);
        let rig = builder.finish();
        assert_eq!(rig.vertex_count(), 6);
        let rigid: Vec<_> = (0..6).map(|vertex| rig.rigid_carrier(vertex)).collect();
        assert_eq!(rigid, [Some(a), Some(b), None, None, None, Some(a)]);
        assert_eq!((rig.leading_carrier(3), rig.leading_carrier(4)), (a, b));
    }

    #[test]
    fn vertices_are_blended_and_displaced() {
        let mut builder = RigBuilder::default();
        let [a, b] = [None, Some(0)].map(|mesh| builder.carrier(None, mesh));
        let morph = builder.morph(0, 0.5);
        let offset = |influence, by| Offset { morph, influence, by };
        let vertex = builder.vertex(
            &[influence(a, 0.25), influence(b, 0.75)],
            &[offset(0, 2.0 * Vec3::X), offset(1, 4.0 * Vec3::Y)],
        );
        let rig = builder.finish();
        let mut pose = rig.rest();
        pose.to_scene[b as usize] = DAffine3::from_scale(DVec3::new(1.0, 1.0, -3.0));
        assert_eq!(rig.mirrored(&pose), [false, true]);
        // A quarter of (1 + 2 · 0.5, 1, 1) and three of (1, 1 + 4 · 0.5, −3).
        let expected = 0.25 * DVec3::new(2.0, 1.0, 1.0) + 0.75 * DVec3::new(1.0, 3.0, -3.0);
        assert_eq!(rig.position(vertex, &pose), expected);
    }

    #[test]
    fn a_rest_that_grows_is_the_rest() {
        let node = |parent, x| Node {
            name: String::new(),
            parent,
            rest: Local::Matrix(DAffine3::from_translation(DVec3::new(x, 0.0, 0.0))),
            moves: true,
        };
        let mut builder = RigBuilder::new(vec![node(None, 1.0), node(Some(0), 4.0)]).unwrap();
        let mut pose = Pose::default();
        builder.carrier(Some(1), None);
        builder.extend_rest(&mut pose);
        builder.morph(0, 0.5);
        builder.carrier(None, None);
        builder.carrier(Some(0), None);
        builder.extend_rest(&mut pose);
        assert_eq!(pose.to_scene[0].translation, DVec3::new(5.0, 0.0, 0.0));
        assert_eq!(pose, builder.finish().rest());
    }
}
