//! What shaders read of the poses of a frame.

use drypoint_mesh::Viewpoint;
use drypoint_mesh::rig::Pose;
use glam::{DAffine3, DMat3, DVec3, Vec4};

use super::layout::{CarrierTransform, RigLayout, count};
use crate::{Frame, Placement, Transform};

/// A rig as it stands in a scene once.
#[derive(Clone, Copy, Debug)]
pub struct RigInstance<'a> {
    /// Where its carriers are in the space of the rig.
    pub pose: &'a Pose,
    /// Where that space is in the scene, and from where it is seen.
    pub placement: Placement,
}

/// Why a frame's poses cannot be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseError {
    /// The placement of this instance has no inverse.
    Singular(u32),
    /// The pose of this instance is of another rig: it has other numbers of carriers or of weights.
    Other(u32),
    /// Something in the pose of this instance is not finite.
    Infinite(u32),
}

/// What shaders read of a frame.
#[derive(Clone, Debug, Default)]
pub struct RigInput {
    /// Instances that there is room for.
    pub most_instances: u32,
    /// The viewpoint of each placement, in the frame of its shape or pose.
    pub viewpoints: Vec<Vec4>,
    /// Of each placement.
    pub transforms: Vec<Transform>,
    /// Carriers, instance by instance, from their frames to that of the pose.
    pub carriers: Vec<CarrierTransform>,
    /// Of morph targets, instance by instance.
    pub weights: Vec<f32>,
    /// The frame in which each instance is posed.
    pub frames: Vec<Frame>,
}

impl RigInput {
    /// Nothing, in the memory of what there was.
    pub fn clear(&mut self) {
        self.viewpoints.clear();
        self.transforms.clear();
        self.carriers.clear();
        self.weights.clear();
        self.frames.clear();
    }
}

impl RigLayout {
    /// Writes to `input`, in place of what it held, what shaders read of `instances`, with room for
    /// `most_instances`: some 50 ns for each part and each carrier.
    ///
    /// A part that its carrier flattens is no error: its shape is seen along the direction that is lost.
    ///
    /// # Errors
    /// What is wrong with the first instance of which something is. Nothing is in `input` then.
    ///
    /// # Panics
    /// If there are more instances than room.
    pub fn place(
        &self,
        instances: &[RigInstance<'_>],
        most_instances: u32,
        input: &mut RigInput,
    ) -> Result<(), PoseError> {
        assert!(instances.len() <= most_instances as usize, "there is room for the instances");
        input.clear();
        input.most_instances = most_instances;
        let placements = most_instances as usize * (self.parts.len() + 1);
        input.viewpoints.resize(placements, Vec4::ZERO);
        input.transforms.resize(placements, Transform::from(DAffine3::IDENTITY));
        let placed = (0..)
            .zip(instances)
            .try_for_each(|(index, instance)| self.place_instance(index, instance, input));
        if placed.is_err() {
            input.clear();
        }
        placed
    }

    fn place_instance(
        &self,
        index: u32,
        instance: &RigInstance<'_>,
        input: &mut RigInput,
    ) -> Result<(), PoseError> {
        let RigInstance { pose, placement } = instance;
        let viewpoint = placement.viewpoint_of_part().ok_or(PoseError::Singular(index))?;
        let counts = [pose.to_scene.len(), pose.weights.len()];
        if counts != [self.counts.carrier_count as usize, self.counts.morph_count as usize] {
            return Err(PoseError::Other(index));
        }
        let are_finite = pose.to_scene.iter().all(|to_scene| to_scene.is_finite())
            && pose.weights.iter().all(|weight| weight.is_finite());
        if !are_finite {
            return Err(PoseError::Infinite(index));
        }
        for (part, place) in (0..).zip(&self.parts) {
            let to_rig = &pose.to_scene[place.carrier as usize];
            let at = self.placement(part, index, input.most_instances) as usize;
            input.viewpoints[at] = carried(viewpoint, to_rig, &place.frame);
            input.transforms[at] = Transform::from(placement.to_scene * *to_rig);
        }
        let frame = self.frame_of_pose(pose);
        let at = (count(self.parts.len()) * input.most_instances + index) as usize;
        input.viewpoints[at] = frame.viewpoint(viewpoint);
        let from_frame = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(1.0 / frame.scale)),
            translation: frame.center,
        };
        input.transforms[at] = Transform::from(placement.to_scene * from_frame);
        for (carrier, to_rig) in self.carriers.iter().zip(&pose.to_scene) {
            input.carriers.push(between_frames(&carrier.frame, to_rig, &frame));
        }
        #[expect(clippy::cast_possible_truncation, reason = "rounded for shaders")]
        input.weights.extend(pose.weights.iter().map(|&weight| weight as f32));
        input.frames.push(frame);
        Ok(())
    }

    /// A frame that holds all vertices that are posed, if morph targets weigh no more than 1: each is between
    /// places where single carriers would have it.
    pub(super) fn frame_of_pose(&self, pose: &Pose) -> Frame {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (carrier, to_rig) in self.carriers.iter().zip(&pose.to_scene) {
            if carrier.half_sides.min_element() >= 0.0 {
                let center = to_rig.transform_point3(carrier.frame.center);
                let columns = to_rig.matrix3.to_cols_array_2d().map(|c| DVec3::from_array(c).abs());
                let [x, y, z] = carrier.half_sides.to_array();
                let half_sides = columns[0] * x + columns[1] * y + columns[2] * z;
                low = low.min(center - half_sides);
                high = high.max(center + half_sides);
            }
        }
        Frame::of_box(low, high)
    }
}

/// From one frame to another.
fn between_frames(from: &Frame, map: &DAffine3, to: &Frame) -> CarrierTransform {
    let matrix3 = map.matrix3 * (1.0 / from.scale) * to.scale;
    let translation = to.point(map.transform_point3(from.center));
    let Transform { x, y, z } = Transform::from(DAffine3 { matrix3, translation });
    let is_mirrored = u32::from(map.matrix3.determinant() < 0.0);
    CarrierTransform { x, y, z, is_mirrored, padding: [0; 3] }
}

/// The viewpoint as a part sees it that `to_rig` places, in the frame of its shape.
pub(super) fn carried(viewpoint: Viewpoint, to_rig: &DAffine3, frame: &Frame) -> Vec4 {
    match viewpoint.carried_into(to_rig) {
        Some(viewpoint) => frame.viewpoint(viewpoint),
        None => {
            let (xyz, w) = carried_into_flat(viewpoint, to_rig);
            frame.homogeneous(xyz, w)
        }
    }
}

/// The viewpoint in a space that may be flattened: homogeneous, w at least 0 and of any size.
///
/// A face with edges u and v at a point a is placed with edges Mu and Mv at Ma + t. With r the vector from t to
/// the viewpoint, the sign of det(Mu, Mv, r − w M a) is that of (u × v) · (adj(M) r − det(M) w a), since
/// Mu × Mv = adj(M)ᵀ (u × v). So it is seen as from adj(M) r with det(M) w, which where M flattens to a plane is
/// a direction; where that plane is seen edge-on, or M flattens to a line or a point, it is none, and every face
/// is edge-on.
fn carried_into_flat(viewpoint: Viewpoint, to_rig: &DAffine3) -> (DVec3, f64) {
    let largest = to_rig.matrix3.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if largest == 0.0 {
        return (DVec3::ZERO, 0.0);
    }
    // Of a size that products do not lose; adj(M) is then off by its square, and det(M) by its cube.
    let matrix = DMat3::from_cols(
        to_rig.matrix3.x_axis / largest,
        to_rig.matrix3.y_axis / largest,
        to_rig.matrix3.z_axis / largest,
    );
    let relative = viewpoint.from_point(to_rig.translation);
    let [a, b, c] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let xyz =
        DVec3::new(b.cross(c).dot(relative), c.cross(a).dot(relative), a.cross(b).dot(relative));
    let w = largest * matrix.determinant() * viewpoint.w();
    if matrix.determinant() < 0.0 { (-xyz, -w) } else { (xyz, w) }
}
