//! The tree that carriers hang from.

use glam::{DAffine3, DMat3, DQuat, DVec3};

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

    /// Translation, rotation and scale that make `matrix`, as nearly as they can: without its shear. Axes
    /// that it flattens have scale 0 and are turned with the others.
    pub(super) fn nearest_trs(matrix: DAffine3) -> Self {
        let DAffine3 { matrix3: axes, translation } = matrix;
        let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length);
        let mut unit = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize_or_zero);
        let is_flat = |axis: &DVec3| *axis == DVec3::ZERO;
        for axis in 0..3 {
            let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
            if is_flat(&unit[axis]) {
                let across = unit[next].cross(unit[last]).normalize_or_zero();
                // With another one flat, any direction across what is left.
                let left = if is_flat(&unit[next]) { unit[last] } else { unit[next] };
                unit[axis] = match () {
                    () if !is_flat(&across) => across,
                    () if !is_flat(&left) => left.any_orthonormal_vector(),
                    () => DVec3::X,
                };
            }
        }
        let mirror = DMat3::from_cols_array_2d(&unit.map(|axis| axis.to_array())).determinant();
        let sign = 1f64.copysign(mirror);
        let rotation = DQuat::from_mat3(&DMat3::from_cols(sign * unit[0], unit[1], unit[2]));
        let scale = DVec3::new(sign * lengths[0], lengths[1], lengths[2]);
        Self::Trs { translation, rotation, scale }
    }

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

    #[test]
    fn a_matrix_comes_apart_even_where_it_is_flat() {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
        for scale in [
            [2.0, 3.0, 0.5],
            [-2.0, 3.0, 0.5],
            [2.0, -3.0, -0.5],
            [0.0, 3.0, 0.5],
            [2.0, 0.0, 0.5],
            [2.0, 3.0, 0.0],
            [0.0, 0.0, 0.5],
            [0.0, 3.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0; 3],
        ] {
            let scale = DVec3::from_array(scale);
            let matrix = DAffine3::from_scale_rotation_translation(scale, turn, DVec3::ONE);
            let again = Local::nearest_trs(matrix).to_affine();
            assert!(again.abs_diff_eq(matrix, 1e-12), "{scale}: {again} for {matrix}");
        }
    }
}
