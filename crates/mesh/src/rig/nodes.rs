//! The tree that carriers hang from.

use glam::{DAffine3, DQuat, DVec3};

/// A node: a space within that of its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// As the file names it; empty if it does not.
    pub name: String,
    /// Index of the node that it hangs from.
    pub parent: Option<u32>,
    /// Where it is at rest, in its parent's space.
    pub rest: Local,
    /// Whether a pose may move it: it is a joint, an animation moves it, or it is one of several places
    /// of one mesh. What hangs from a node that does not move was placed when the rig was made.
    pub moves: bool,
}

/// From the space of a node to that of its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// Any affine transform. No animation moves it.
    Matrix(DAffine3),
    /// First scaled, then turned, then moved.
    Trs {
        /// In the parent's units.
        translation: DVec3,
        /// Of any length above 0.
        rotation: DQuat,
        /// Along the node's own axes; negative where it mirrors, 0 where it flattens.
        scale: DVec3,
    },
}

impl Local {
    /// The parent's own space.
    pub const IDENTITY: Self =
        Self::Trs { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// The same as a transform. A rotation without length is none.
    pub fn to_affine(self) -> DAffine3 {
        match self {
            Self::Matrix(matrix) => matrix,
            Self::Trs { translation, rotation, scale } => {
                let length = rotation.length();
                // Stored in f32, and interpolated, so of unit length only nearly.
                let unit = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
                DAffine3::from_scale_rotation_translation(scale, unit, translation)
            }
        }
    }
}

/// The nodes by index, each after its parent. `None` if one is its own ancestor, or hangs from none
/// that exists.
pub(super) fn parents_first(nodes: &[Node]) -> Option<Vec<u32>> {
    let mut children = vec![Vec::new(); nodes.len()];
    let mut order = Vec::with_capacity(nodes.len());
    for (index, node) in (0..).zip(nodes) {
        match node.parent {
            None => order.push(index),
            Some(parent) => children.get_mut(parent as usize)?.push(index),
        }
    }
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        order.append(&mut children[node as usize]);
        next += 1;
    }
    (order.len() == nodes.len()).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(parent: Option<u32>) -> Node {
        Node { name: String::new(), parent, rest: Local::IDENTITY, moves: false }
    }

    #[test]
    fn parents_come_before_children() {
        let nodes = [node(Some(2)), node(None), node(Some(1)), node(Some(0))];
        assert_eq!(parents_first(&nodes), Some(vec![1, 2, 0, 3]));
        assert_eq!(parents_first(&[node(Some(1)), node(Some(0))]), None);
        assert_eq!(parents_first(&[node(Some(7))]), None);
    }

    #[test]
    fn a_rotation_of_any_length_turns_alike() {
        let turned = |length: f64| {
            let rotation = DQuat::from_rotation_z(1.0) * length;
            let local =
                Local::Trs { translation: DVec3::Y, rotation, scale: DVec3::new(1.0, -2.0, 3.0) };
            local.to_affine().transform_point3(DVec3::ONE)
        };
        assert!(turned(1.0).distance(turned(0.25)) < 1e-15);
        assert_eq!(turned(0.0), DVec3::new(1.0, -1.0, 3.0));
    }
}
