//! The planes of a mesh, and the edges between them.

use drypoint_mesh::EdgeId;
use glam::Vec3;
use rayon::prelude::*;

use super::model::Model;
use crate::geometry::Frame;

/// The points x with normal · x = offset, in the frame of the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// Unit length, up to rounding.
    pub(crate) normal: Vec3,
    pub(crate) offset: f32,
}

/// An edge, by numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// Of its faces, in [`Table::planes`].
    pub(crate) planes: [u32; 2],
    /// Vertices at its ends, lower first; equal numbers are equal places.
    pub(crate) ends: [u32; 2],
    pub(crate) midpoint: Vec3,
}

/// All that is known of the edges to be grouped: 28 bytes each, and 16 for each face.
pub(crate) struct Table {
    /// By triangle; behind them the same turned over, if any edge needs them so.
    pub(crate) planes: Vec<Plane>,
    pub(crate) items: Vec<Item>,
}

impl Table {
    /// `edges` all have a shape. The number of an edge is its place among them.
    pub(crate) fn new(frame: &Frame, edges: &[EdgeId]) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "three half-edges each have a u32")]
        let turned_over = frame.mesh.triangles().len() as u32;
        let plane = |triangle: u32| {
            let (normal, offset) = (frame.normal(triangle), frame.offset(triangle));
            #[expect(clippy::cast_possible_truncation, reason = "it only guides the search")]
            Plane { normal: normal.as_vec3(), offset: offset as f32 }
        };
        let mut planes: Vec<Plane> = (0..turned_over).into_par_iter().map(plane).collect();
        if edges.par_iter().any(|&edge| frame.triangles(edge).1) {
            planes.extend_from_within(..);
            planes[turned_over as usize..].iter_mut().for_each(Plane::turn_over);
        }
        let item = |&edge: &EdgeId| {
            let ([left, right], is_turned) = frame.triangles(edge);
            let right = if is_turned { turned_over + right } else { right };
            let midpoint = frame.midpoint(edge).as_vec3();
            Item { planes: [left, right], ends: frame.ends(edge), midpoint }
        };
        Self { planes, items: edges.par_iter().map(item).collect() }
    }

    /// [`Model::place`] of an edge.
    pub(crate) fn place_of_item(&self, item: &Item, model: &Model) -> [f32; 4] {
        let [a, b] = item.planes.map(|plane| self.plane(plane).normal);
        model.place((a + b).normalize_or_zero(), item.midpoint)
    }

    pub(crate) fn plane(&self, number: u32) -> Plane {
        self.planes[number as usize]
    }

    pub(crate) fn item(&self, number: u32) -> &Item {
        &self.items[number as usize]
    }
}

impl Plane {
    pub(crate) fn to_array(self) -> [f32; 4] {
        let [x, y, z] = self.normal.to_array();
        [x, y, z, self.offset]
    }

    fn turn_over(&mut self) {
        (self.normal, self.offset) = (-self.normal, -self.offset);
    }
}
