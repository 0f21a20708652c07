//! Viewpoints where culling is about to be wrong: on the cull boundaries themselves.
//!
//! Viewpoints at random do not see a bound half as large as it must be. So for each patch they are
//! placed on the surface that divides what it culls from what it does not, |h| = t + tan α |p| of the
//! stored floats, and a few roundings to either side; half of them in the direction where one of the
//! patch's own planes reaches farthest towards it. From where the patch is culled, no edge of it may be a contour
//! edge, by exact predicates.

use std::ops::Range;

use drypoint_bounds::{DoubleCone, MIN_CLEARANCE};
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeId, Viewpoint, is_contour};
use fastrand::Rng;
use glam::DVec3;
use rayon::prelude::*;

/// Fewest viewpoints for each patch and each super-patch.
pub const LEAST: usize = 16;

/// Heights at each place of the boundary, in units of what one rounding moves them by, towards the
/// culled side.
const STEPS: Range<i32> = -2..6;

/// What was looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Looked {
    /// Viewpoints on boundaries.
    pub viewpoints: u64,
    /// Those that were culled, and so had every edge tested exactly.
    pub culled: u64,
}

impl std::ops::AddAssign for Looked {
    fn add_assign(&mut self, other: Self) {
        self.viewpoints += other.viewpoints;
        self.culled += other.culled;
    }
}

/// A contour edge that was culled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostEdge {
    /// Whether a super-patch culled it, rather than a patch.
    pub is_super: bool,
    /// Index of the patch or super-patch.
    pub patch: usize,
    /// The edge.
    pub edge: EdgeId,
    /// From where.
    pub viewpoint: Viewpoint,
}

/// Looks at each patch and super-patch from its own cull boundary, `viewpoints` times over all of
/// them together, but [`LEAST`] times each. The same viewpoints each time; on all threads.
///
/// # Errors
/// The lost edge of the lowest patch.
pub fn look(set: &PatchSet, viewpoints: usize) -> Result<Looked, LostEdge> {
    let patches = set.patches().iter().map(|patch| (patch.bound, patch.edges()));
    let groups = set.super_patches().iter().map(|group| {
        let patches = group.patches();
        let (first, last) = (patches.start as usize, patches.end as usize - 1);
        let edges = set.patches()[first].first_edge..set.patches()[last].edges().end;
        (group.bound, edges)
    });
    let bounds: Vec<(DoubleCone, Range<u32>)> = patches.chain(groups).collect();
    let each = (viewpoints / bounds.len().max(1)).max(LEAST);
    let looks: Vec<Result<Looked, LostEdge>> = bounds
        .par_iter()
        .enumerate()
        .map(|(index, (bound, edges))| {
            let own = Boundary { set, bound, edges: edges.clone() };
            own.look(each, &mut Rng::with_seed(index as u64)).map_err(|(edge, viewpoint)| {
                let count = set.patches().len();
                let is_super = index >= count;
                let patch = if is_super { index - count } else { index };
                LostEdge { is_super, patch, edge, viewpoint }
            })
        })
        .collect();
    let mut total = Looked::default();
    for looked in looks {
        total += looked?;
    }
    Ok(total)
}

/// What one bound culls.
struct Boundary<'a> {
    set: &'a PatchSet,
    bound: &'a DoubleCone,
    /// Places of the edges that are culled with it.
    edges: Range<u32>,
}

impl Boundary<'_> {
    fn look(&self, viewpoints: usize, rng: &mut Rng) -> Result<Looked, (EdgeId, Viewpoint)> {
        let mut looked = Looked::default();
        for _ in 0..viewpoints.div_ceil(STEPS.len()) {
            for viewpoint in self.place(rng) {
                looked.viewpoints += 1;
                if !self.bound.may_hold_contour(viewpoint) {
                    looked.culled += 1;
                    self.check(viewpoint)?;
                }
            }
        }
        Ok(looked)
    }

    /// Viewpoints that differ in height alone, around a place of the boundary.
    fn place(&self, rng: &mut Rng) -> impl Iterator<Item = Viewpoint> {
        let bound = self.bound;
        let (center, axis) = (bound.center.as_dvec3(), bound.axis.as_dvec3());
        let (apex, tan) = (f64::from(bound.apex_distance), f64::from(bound.tan_squared).sqrt());
        let side = if rng.bool() { 1.0 } else { -1.0 };
        let is_orthographic = rng.u8(..16) == 0;
        // On an apex, or anywhere from a billionth of the mesh to ten thousand times its size.
        let distance = match rng.u8(..16) {
            0 => 0.0,
            _ => self.set.provenance().unit * 10f64.powf(13.0 * rng.f64() - 9.0),
        };
        let w = if is_orthographic { 0.0 } else { 1.0 };
        let across = if rng.bool() { self.hardest(side, distance, w) } else { direction(rng) };
        let across = (across - axis.dot(across) * axis).normalize_or_zero();
        let height = if is_orthographic {
            tan * distance
        } else {
            apex + (tan * distance).max(f64::from(MIN_CLEARANCE))
        };
        let rounding = (height + distance) / f64::from(1u32 << 24);
        STEPS.map(move |step| {
            let height = side * (height + f64::from(step) * rounding);
            let offset = height * axis + distance * across;
            if is_orthographic {
                Viewpoint::from_direction(offset)
            } else {
                Viewpoint::at(center + offset)
            }
        })
    }

    /// Where a plane of the edges reaches farthest into the cone of that side: the normal of that
    /// plane, towards where it is met. At `distance` from the axis, plane j is on its own side of
    /// viewpoints whose height is at least (w n·(p − o) + distance sin θ) / cos θ.
    fn hardest(&self, side: f64, distance: f64, w: f64) -> DVec3 {
        let (center, axis) = (self.bound.center.as_dvec3(), self.bound.axis.as_dvec3());
        let reach = |face: [u32; 3]| {
            let [a, b, c] = face.map(|vertex| self.set.positions()[vertex as usize].as_dvec3());
            let normal = (b - a).normalize_or_zero().cross((c - a).normalize_or_zero());
            let normal = normal.normalize_or_zero();
            let (cos, sin) = (normal.dot(axis), normal.cross(axis).length());
            let height = side * w * normal.dot(a - center) + distance * sin;
            (height / cos, -side * normal)
        };
        let wings = self.edges.clone().map(|place| self.set.wings()[place as usize]);
        let faces = wings.flat_map(|wing| [wing.left_face(), wing.right_face()]);
        let farthest = faces.map(reach).max_by(|a, b| a.0.total_cmp(&b.0));
        farthest.map_or(DVec3::ZERO, |(_, towards)| towards)
    }

    /// Whether what is culled from `viewpoint` is no contour there.
    fn check(&self, viewpoint: Viewpoint) -> Result<(), (EdgeId, Viewpoint)> {
        let set = self.set;
        let is_lost = |&place: &usize| is_contour(set.positions(), &set.wings()[place], viewpoint);
        match (self.edges.start as usize..self.edges.end as usize).find(is_lost) {
            Some(place) => Err((set.edge_ids()[place], viewpoint)),
            None => Ok(()),
        }
    }
}

/// Any direction, and of any length up to √3.
fn direction(rng: &mut Rng) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| 2.0 * rng.f64() - 1.0))
}
