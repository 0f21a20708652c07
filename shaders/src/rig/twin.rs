//! Twins of what shaders of rigs do, operation by operation but for the order of sums.

use glam::Vec3;

use super::content::RigContent;
use super::input::RigInput;
use crate::edge::height;

impl RigContent {
    /// Twin of `posed` in rig/vertices.wgsl: where a vertex is, in the frame of the pose.
    pub fn posed(&self, input: &RigInput, instance: u32, vertex: u32) -> Vec3 {
        let weights = (instance * self.layout.counts.morph_count) as usize;
        let carriers = (instance * self.layout.counts.carrier_count) as usize;
        let first = self.first_influences[vertex as usize] as usize;
        let mut sum = Vec3::ZERO;
        for influence in &self.influences[first..] {
            let mut moved = influence.position;
            let offsets = influence.first_offset as usize..influence.offset_end as usize;
            for offset in &self.offsets[offsets] {
                moved += input.weights[weights + offset.morph as usize] * offset.by;
            }
            let carrier = &input.carriers[carriers + influence.carrier as usize];
            let p = moved.extend(1.0);
            sum +=
                influence.weight * Vec3::new(carrier.x.dot(p), carrier.y.dot(p), carrier.z.dot(p));
            if influence.is_last == 1 {
                break;
            }
        }
        sum
    }

    /// Twin of `find_sides` in rig/faces.wgsl: a bit each for whether a face is seen from the front, whether it
    /// would be if it were turned over, and whether it is mirrored.
    pub fn side(&self, input: &RigInput, instance: u32, face: u32) -> u32 {
        let is_mirrored = |carrier: u32| {
            let carriers = instance * self.layout.counts.carrier_count;
            input.carriers[(carriers + carrier) as usize].is_mirrored
        };
        let Some(bending) = self.bending_faces.get(face as usize) else {
            let face = &self.part_faces[(face - self.layout.counts.bending_count) as usize];
            let placement = face.placements_before * input.most_instances
                + instance * face.class_placements
                + face.place;
            let height = height(face.plane, input.viewpoints[placement as usize]);
            return bits(height, is_mirrored(face.carrier));
        };
        let loose = self.layout.part_count() * input.most_instances + instance;
        let viewpoint = input.viewpoints[loose as usize];
        let [a, b, c] = bending.corners.map(|corner| self.posed(input, instance, corner));
        let to_viewpoint = viewpoint.truncate() - viewpoint.w * a;
        let height = (b - a).cross(c - a).dot(to_viewpoint);
        let is_mirrored = is_mirrored(bending.carrier);
        bits(if is_mirrored == 1 { -height } else { height }, is_mirrored)
    }
}

fn bits(height: f32, is_mirrored: u32) -> u32 {
    u32::from(height >= 0.0) | u32::from(height <= 0.0) << 1 | is_mirrored << 2
}
