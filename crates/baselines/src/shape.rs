//! The planes and the line of an edge, and what bounds those of many.

use std::ops::Range;

use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_mesh::{Mesh, Wing, unit_normal};
use glam::{DVec3, Vec3};

use crate::edges::Edges;

/// What a bound needs to know of an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    /// Unit normals of the left face, and of the right one as the wing reads it.
    normals: [DVec3; 2],
    /// Where it starts and ends, in model units.
    ends: [DVec3; 2],
}

impl Shape {
    /// `None` if a face spans no plane that can be trusted: no bound holds such an edge.
    fn new(positions: &[Vec3], wing: &Wing) -> Option<Self> {
        let normal = |face: [u32; 3]| unit_normal(face.map(|v| positions[v as usize]));
        let normals = [normal(wing.left_face())?, normal(wing.right_face())?];
        let ends = [wing.tail, wing.head].map(|v| positions[v as usize].as_dvec3());
        Some(Self { normals, ends })
    }
}

/// Edges that can be bounded, with their shapes, and those that cannot.
#[derive(Debug)]
pub(crate) struct Shaped {
    /// Places of edges that have a shape, in order.
    pub(crate) places: Vec<u32>,
    /// Their shapes.
    pub(crate) shapes: Vec<Shape>,
    /// Places of the others, in order: always tested.
    pub(crate) shapeless: Vec<u32>,
}

impl Shaped {
    pub(crate) fn new(edges: &Edges<'_>) -> Self {
        let mut shaped = Self { places: Vec::new(), shapes: Vec::new(), shapeless: Vec::new() };
        for (place, wing) in (0..).zip(edges.wings()) {
            if let Some(shape) = Shape::new(edges.positions(), wing) {
                shaped.places.push(place);
                shaped.shapes.push(shape);
            } else {
                shaped.shapeless.push(place);
            }
        }
        shaped
    }

    /// The edges in this `order`, indices into [`Shaped::places`], each once; their shapes; and
    /// where those without a shape lie, behind them.
    pub(crate) fn arranged<'mesh>(
        self,
        edges: &Edges<'mesh>,
        order: &[u32],
    ) -> (Edges<'mesh>, Vec<Shape>, Range<u32>) {
        let shapes: Vec<Shape> = order.iter().map(|&index| self.shapes[index as usize]).collect();
        let mut places: Vec<u32> = order.iter().map(|&index| self.places[index as usize]).collect();
        let first = count(places.len());
        places.extend(self.shapeless);
        (edges.arranged(&places), shapes, first..count(places.len()))
    }
}

/// A number of edges, or of what holds one edge at least.
pub(crate) fn count(len: usize) -> u32 {
    u32::try_from(len).expect("half-edges fit a u32")
}

/// The narrowest cone around the normals of both faces of each edge, and the Reduced Sphere, which
/// meets the line through each: of what has been published, the bound that culls most. Linear.
///
/// [`DoubleCone::ALWAYS`] if there is no edge, or the normals spread too far.
pub(crate) fn bound(shapes: &[Shape]) -> DoubleCone {
    let cone = NormalCone::minimal(shapes.iter().flat_map(|shape| shape.normals));
    let sphere = Sphere::reduced(shapes.iter().map(|shape| shape.ends));
    DoubleCone::from(SpatializedNormalCone { cone, sphere })
}

/// The vertices with the mesh's box fitted into −1 ..= 1, so that areas fit an f32; those that no
/// triangle uses are moved into it. Rounded: for what only decides which edges lie together.
pub(crate) fn unit_positions(mesh: &Mesh) -> Vec<Vec3> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let unit = bounds.half_longest_side();
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let fitted = |p: &Vec3| {
        let p = (p.as_dvec3() - bounds.center()) / unit;
        p.clamp(DVec3::NEG_ONE, DVec3::ONE).as_vec3()
    };
    mesh.positions().iter().map(fitted).collect()
}
