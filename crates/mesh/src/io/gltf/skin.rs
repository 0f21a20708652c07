//! Which joints a vertex follows.

use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked::Valid;
use glam::{DAffine3, DMat4};

use super::accessor::Elements;
use super::document::{Document, object};
use crate::io::error::{Fault, Place, ReadError};

/// Joints of a skin and what a primitive says of them.
pub(super) struct Skinning<'a> {
    /// For each joint its node, and its inverse bind matrix.
    pub(super) joints: Vec<(usize, DAffine3)>,
    /// Joints and weights, four to a vertex in each set.
    sets: Vec<[Elements<'a>; 2]>,
}

impl<'a> Skinning<'a> {
    /// How `node` skins `primitive`. `None` if it has no skin, or the primitive no weights: that moves
    /// with its node.
    pub(super) fn new(
        document: &'a Document<'_>,
        node: usize,
        primitive: &Primitive,
    ) -> Result<Option<Self>, ReadError> {
        let root = &document.root;
        let Some(skin) = root.nodes[node].skin.map(|skin| skin.value()) else {
            return Ok(None);
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
            return Ok(None);
        }
        let binds = match json.inverse_bind_matrices {
            Some(accessor) => Some(Elements::matrices(document, accessor.value(), &place)?),
            None => None,
        };
        // A matrix, a node and a carrier.
        let joint_count = json.joints.len() as u64;
        document.spend(64 * joint_count).map_err(|fault| fault.at(place.clone()))?;
        let mut joints = Vec::with_capacity(json.joints.len());
        for (joint, node) in json.joints.iter().enumerate() {
            object(&root.nodes, node.value(), "nodes", &place)?;
            let bind = match &binds {
                Some(binds) if joint < binds.count() => {
                    DAffine3::from_mat4(DMat4::from_cols_array(&std::array::from_fn(|i| {
                        binds.real(joint, i)
                    })))
                }
                Some(binds) => {
                    let (needed, available) = (json.joints.len() as u64, binds.count() as u64);
                    return Err(Fault::TooFewMatrices { needed, available }.at(place));
                }
                None => DAffine3::IDENTITY,
            };
            joints.push((node.value(), bind));
        }
        Ok(Some(Self { joints, sets }))
    }

    /// Replaces `influences` by the joints that a vertex follows, each once, by index, with weights that
    /// add up to 1. None if all its weights are 0; a weight that is no number is that of them all.
    pub(super) fn influences(
        &self,
        vertex: usize,
        influences: &mut Vec<(usize, f64)>,
    ) -> Result<(), Fault> {
        influences.clear();
        for [joints, weights] in &self.sets {
            if vertex < joints.count().min(weights.count()) {
                let pairs = (0..4).map(|i| (joints.integer(vertex, i), weights.real(vertex, i)));
                let weighty = pairs.filter(|&(_, weight)| weight != 0.0);
                influences.extend(weighty.map(|(joint, weight)| (joint as usize, weight)));
            }
        }
        if let Some(&(joint, _)) = influences.iter().find(|i| i.0 >= self.joints.len()) {
            return Err(Fault::JointOutOfRange {
                vertex: vertex as u64,
                joint: joint as u64,
                joint_count: self.joints.len() as u64,
            });
        }
        // In one order, so that vertices that are split along a seam stay together.
        influences.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        influences.dedup_by(|next, first| {
            let is_same = next.0 == first.0;
            first.1 += if is_same { next.1 } else { 0.0 };
            is_same
        });
        // Weights are rounded, so they add up to 1 only nearly.
        let sum: f64 = influences.iter().map(|(_, weight)| weight).sum();
        // What is NaN stays so: the vertex is nowhere.
        if sum > 0.0 || sum.is_nan() {
            influences.iter_mut().for_each(|(_, weight)| *weight /= sum);
        } else {
            influences.clear();
        }
        Ok(())
    }
}
