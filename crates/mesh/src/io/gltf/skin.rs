//! Where the vertices of a primitive go: with their node, or with the joints of its skin.

use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked::Valid;
use glam::{DMat4, DVec3};

use super::accessor::Elements;
use super::document::{Document, object};
use super::scene::Nodes;
use crate::io::error::{Fault, Place, ReadError};

/// From stored positions to the scene.
pub(super) enum Placement<'a> {
    Rigid {
        transform: DMat4,
        mirrors: bool,
    },
    Skinned {
        /// For each joint, from the bind pose to the rest pose of the scene.
        matrices: Vec<DMat4>,
        /// Joints and weights, four to a vertex in each set.
        sets: Vec<[Elements<'a>; 2]>,
    },
}

impl<'a> Placement<'a> {
    /// How `node` places the vertices of `primitive`. A primitive without weights stays rigid.
    pub(super) fn new(
        document: &'a Document<'_>,
        nodes: &Nodes,
        node: usize,
        primitive: &Primitive,
    ) -> Result<Self, ReadError> {
        let root = &document.root;
        let transform = nodes.transform(node);
        let rigid = Self::Rigid { transform, mirrors: transform.determinant() < 0.0 };
        let Some(skin) = root.nodes[node].skin.map(|skin| skin.value()) else {
            return Ok(rigid);
        };
        let place = Place::Json(format!("nodes[{node}]"));
        let json = object(&root.skins, skin, "skins", &place)?;
        let place = Place::Json(format!("skins[{skin}]"));
        let mut sets = Vec::new();
        for set in 0.. {
            let attribute = |semantic| primitive.attributes.get(&Valid(semantic));
            let joints = attribute(Semantic::Joints(set));
            let Some((joints, weights)) = joints.zip(attribute(Semantic::Weights(set))) else {
                break;
            };
            sets.push([
                Elements::joints(document, joints.value(), &place)?,
                Elements::weights(document, weights.value(), &place)?,
            ]);
        }
        if sets.is_empty() {
            return Ok(rigid);
        }
        let binds = match json.inverse_bind_matrices {
            Some(accessor) => Some(Elements::matrices(document, accessor.value(), &place)?),
            None => None,
        };
        let mut matrices = Vec::with_capacity(json.joints.len());
        for (joint, node) in json.joints.iter().enumerate() {
            object(&root.nodes, node.value(), "nodes", &place)?;
            let bind = match &binds {
                Some(binds) if joint < binds.count() => {
                    DMat4::from_cols_array(&std::array::from_fn(|i| binds.real(joint, i)))
                }
                Some(binds) => {
                    let (needed, available) = (json.joints.len() as u64, binds.count() as u64);
                    return Err(Fault::TooFewMatrices { needed, available }.at(place));
                }
                None => DMat4::IDENTITY,
            };
            matrices.push(nodes.transform(node.value()) * bind);
        }
        Ok(Self::Skinned { matrices, sets })
    }

    /// The scene position of a vertex stored at `position`.
    pub(super) fn apply(&self, vertex: usize, position: DVec3) -> Result<DVec3, Fault> {
        Ok(self.matrix(vertex)?.transform_point3(position))
    }

    /// Whether what is outside near this vertex would come to lie inside.
    pub(super) fn mirrors(&self, vertex: usize) -> bool {
        match self {
            Self::Rigid { mirrors, .. } => *mirrors,
            Self::Skinned { .. } => {
                self.matrix(vertex).is_ok_and(|matrix| matrix.determinant() < 0.0)
            }
        }
    }

    fn matrix(&self, vertex: usize) -> Result<DMat4, Fault> {
        let (matrices, sets) = match self {
            Self::Rigid { transform, .. } => return Ok(*transform),
            Self::Skinned { matrices, sets } => (matrices, sets),
        };
        let mut influences = Vec::with_capacity(4 * sets.len());
        for [joints, weights] in sets {
            if vertex < joints.count().min(weights.count()) {
                let pairs = (0..4).map(|i| (joints.integer(vertex, i), weights.real(vertex, i)));
                influences.extend(pairs.filter(|&(_, weight)| weight != 0.0));
            }
        }
        // In one order, so that vertices that are split along a seam stay together.
        influences.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut sum = (DMat4::ZERO, 0.0);
        for (joint, weight) in influences {
            let matrix = matrices.get(joint as usize).ok_or(Fault::JointOutOfRange {
                vertex: vertex as u64,
                joint: joint.into(),
                joint_count: matrices.len() as u64,
            })?;
            sum = (sum.0 + *matrix * weight, sum.1 + weight);
        }
        // Weights are rounded, so they add up to 1 only nearly.
        Ok(if sum.1 > 0.0 { sum.0 * (1.0 / sum.1) } else { DMat4::IDENTITY })
    }
}
