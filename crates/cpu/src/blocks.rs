//! Planes in whole numbers, eight edges side by side.
//!
//! A plane with unit normal n through p has, as seen from a homogeneous viewpoint (v, w), the sign
//! of n · (v − w p). About a center c, and in units of R, half the diagonal of the mesh's box, that
//! is the sign of the product of two vectors of four numbers,
//!
//! g = (n, −n · (p − c) / R) · (v − w c, w R) / |(v − w c, w R)|.
//!
//! Both have a length of at most √2 and 1. Times S = 2¹⁵ − 1 and rounded to whole numbers, they are
//! off by ½ in each place, and by what the normal is off by (below). The product of the whole
//! numbers fits an i32, since S² √2 < 2³¹ by far more than the rounding, and is exact: it depends
//! on no order and on no processor. It is off from S² g by at most
//!
//! Σ ½ |plane| + ½ |view| + ¼ ≤ ½ S (√3 + 1) + ½ S · 2 + 1,
//!
//! as no unit normal has a sum of components above √3, and no vector of four numbers of length 1
//! one above 2. If it is farther from 0 than that, its sign is the plane's: else the exact predicate
//! is asked: where a plane is seen under an angle below 1e-4 radians, as all those are that are parallel
//! to the direction of an orthographic view.

use drypoint_mesh::{Viewpoint, Wing, unit_normal};
use glam::{DVec3, Vec3};
use wide::i16x8;

/// Edges in a block.
pub(crate) const LANES: usize = 8;

/// S.
const SCALE: f64 = 32_767.0;

/// Beyond this, the product has the sign of the plane: ½ S (√3 + 3) + 1 = 77,527, and 2⁻²³ S² √2 =
/// 181 for the 1e-7 radians that [`unit_normal`] may be off by, rounded up.
pub(crate) const MARGIN: i32 = 78_000;

/// Planes of eight faces, four at a time: components x and y of each, side by side, so that one
/// instruction multiplies and adds pairs; then z and the offset.
pub(crate) type Planes = [[i16x8; 2]; 2];

/// Both faces' planes of eight edges: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct EdgeBlock {
    pub(crate) left: Planes,
    pub(crate) right: Planes,
}

/// The viewpoint in whole numbers, four times: x and y, then z and w.
pub(crate) type View = [i16x8; 2];

/// What planes and viewpoints are measured from, and in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    center: DVec3,
    /// R; above 0.
    radius: f64,
}

impl Frame {
    /// Around the corners of the faces beside `wings`: other vertices may be anywhere.
    pub(crate) fn new(positions: &[Vec3], wings: &[Wing]) -> Self {
        let corners = wings.iter().flat_map(|wing| [wing.tail, wing.head, wing.left, wing.right]);
        let used = corners.filter(|&corner| corner != Wing::NONE);
        let (least, most) = used
            .map(|vertex| positions[vertex as usize].as_dvec3())
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, most), position| {
                (least.min(position), most.max(position))
            });
        let radius = 0.5 * (most - least).length();
        if radius > 0.0 && radius.is_finite() {
            Self { center: 0.5 * (least + most), radius }
        } else {
            // A point, or nothing: it has no plane either.
            Self { center: DVec3::ZERO, radius: 1.0 }
        }
    }

    /// Zero from where nothing is sure: from the zero direction, or if a number is not finite.
    pub(crate) fn view(&self, viewpoint: Viewpoint) -> View {
        let (direction, w) = (viewpoint.from_point(self.center), viewpoint.w() * self.radius);
        let size = direction.length().hypot(w);
        // Smaller, and the squares do not fit an f64.
        if size < 1e-100 {
            return [i16x8::splat(0); 2];
        }
        let [x, y, z, w] =
            [direction.x, direction.y, direction.z, w].map(|number| rounded(number / size));
        [[x, y], [z, w]].map(|[a, b]| i16x8::from([a, b, a, b, a, b, a, b]))
    }

    /// Of the face with these corners; zero if it spans no plane that can be trusted.
    fn plane(&self, corners: [Vec3; 3]) -> [i16; 4] {
        let Some(normal) = unit_normal(corners) else { return [0; 4] };
        let offset = -normal.dot(corners[0].as_dvec3() - self.center) / self.radius;
        [normal.x, normal.y, normal.z, offset].map(rounded)
    }

    /// Up to eight edges; others are as if both their faces were one, and so are those that have but one.
    pub(crate) fn block(&self, positions: &[Vec3], wings: &[Wing]) -> EdgeBlock {
        let plane = |face: [u32; 3]| self.plane(face.map(|vertex| positions[vertex as usize]));
        let planes: [[[i16; 4]; 2]; LANES] = std::array::from_fn(|lane| {
            let wing = wings[lane.min(wings.len() - 1)];
            let left = plane(wing.left_face());
            let is_edge = lane < wings.len() && wing.right != Wing::NONE;
            [left, if is_edge { plane(wing.right_face()) } else { left }]
        });
        let of_side = |side: usize| {
            let pairs = |lane: usize, first: usize| {
                i16x8::from(std::array::from_fn(|i| planes[lane + i / 2][side][first + i % 2]))
            };
            [[pairs(0, 0), pairs(0, 2)], [pairs(4, 0), pairs(4, 2)]]
        };
        EdgeBlock { left: of_side(0), right: of_side(1) }
    }
}

/// `number`, cut off at −1 and 1, in units of 1 / S; 0 if it is NaN.
#[expect(clippy::cast_possible_truncation, reason = "at most S")]
fn rounded(number: f64) -> i16 {
    (SCALE * number.clamp(-1.0, 1.0)).round() as i16
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use drypoint_mesh::face_side;
    use proptest::prelude::*;

    use super::*;
    use crate::simd::look;

    const WING: Wing = Wing { tail: 0, head: 1, left: 2, right: 3 };

    fn point() -> impl Strategy<Value = Vec3> {
        [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0].prop_map(Vec3::from_array)
    }

    /// A viewpoint so close to the plane of `corners` that the product is within a few margins of
    /// zero: `sine` is that of the angle under which the plane is seen.
    fn near_the_plane(corners: [Vec3; 3], turn: f64, away: f64, sine: f64) -> Option<DVec3> {
        let normal = unit_normal(corners)?;
        let along = normal.any_orthonormal_vector();
        let along = turn.cos() * along + turn.sin() * normal.cross(along);
        Some(corners[0].as_dvec3() + away * (along + sine * normal))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Whatever is not doubtful has the sign that exact arithmetic gives: of any size, far from
        /// the origin, and where the right face is a needle.
        #[test]
        fn what_is_not_doubtful_is_right(
            corners in [point(), point(), point()], apex in point(), needle in 0i32..30,
            scale in -30..30i32, offset in point(), is_far: bool,
            turn in 0.0..6.3f64, size in -2.0..3.0f64, sine in -4e-4..4e-4f64, is_point: bool,
        ) {
            let scale = 10f32.powi(scale);
            let offset = if is_far { 1e5 * offset } else { Vec3::ZERO };
            let middle = 0.5 * (corners[0] + corners[1]);
            let apex = middle + 2f32.powi(-needle) * (apex - middle);
            let positions =
                [corners[0], corners[1], corners[2], apex].map(|position| scale * (position + offset));
            let corners = [positions[0], positions[1], positions[2]];
            let away = f64::from(scale) * 10f64.powf(size);
            let near = near_the_plane(corners, turn, away, sine);
            prop_assume!(near.is_some());
            let near = near.unwrap();
            let viewpoint = if is_point {
                Viewpoint::at(near)
            } else {
                Viewpoint::from_direction(near - corners[0].as_dvec3())
            };
            let frame = Frame::new(&positions, &[WING]);
            let seen = look(&frame.block(&positions, &[WING]), frame.view(viewpoint));
            let is_front = |face: [u32; 3]| {
                face_side(face.map(|v| positions[v as usize]), viewpoint) != Ordering::Less
            };
            let is_contour = is_front(WING.left_face()) != is_front(WING.right_face());
            prop_assert!(seen.doubtful & 1 == 1 || (seen.contours & 1 == 1) == is_contour);
            // The other lanes are no edges.
            prop_assert_eq!(seen.contours & !seen.doubtful & !1, 0);
        }
    }

    /// How far the product of whole numbers is from S² g, for a plane and a viewpoint about the origin.
    fn error(frame: &Frame, [normal, at, eye]: [DVec3; 3]) -> f64 {
        let normal = normal.normalize();
        let offset = -normal.dot(at.clamp_length_max(frame.radius)) / frame.radius;
        let plane = [normal.x, normal.y, normal.z, offset].map(rounded).map(f64::from);
        let [xy, zw] = frame.view(Viewpoint::at(eye)).map(|pairs| pairs.to_array());
        let view = [xy[0], xy[1], zw[0], zw[1]].map(f64::from);
        let product: f64 = plane.iter().zip(view).map(|(a, b)| a * b).sum();
        let exact = normal.dot(eye) + offset * frame.radius;
        (product - SCALE * SCALE * exact / eye.length().hypot(frame.radius)).abs()
    }

    /// A margin that nothing came near would be no margin, and a test of it none. The worst is where
    /// all components are equal in size, all rounded the same way: climbed to from near there.
    #[test]
    fn products_come_close_to_the_margin() {
        let frame = Frame::new(
            &[Vec3::ONE, Vec3::NEG_ONE],
            &[Wing { tail: 0, head: 1, left: 1, right: 1 }],
        );
        let mut rng = 1u32;
        let mut number = || {
            rng = rng.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(rng >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut most = 0.0f64;
        for _ in 0..100 {
            let mut near = |size: f64| size * DVec3::new(number(), number(), number());
            let radius = frame.radius;
            let mut best = [
                DVec3::ONE + near(0.05),
                DVec3::NEG_ONE + near(0.02),
                radius * DVec3::ONE + near(0.05),
            ];
            let mut worst = error(&frame, best);
            for _ in 0..2000 {
                let next = best.map(|vector| vector + near(3e-5));
                if error(&frame, next) > worst {
                    (best, worst) = (next, error(&frame, next));
                }
            }
            most = most.max(worst);
        }
        let margin = f64::from(MARGIN);
        assert!((0.8 * margin..margin).contains(&most), "{most}");
    }

    #[test]
    fn faces_without_a_plane_are_doubtful() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::splat(0.5), Vec3::new(0.5, 0.0, 0.0)];
        let frame = Frame::new(&positions, &[WING]);
        let block = frame.block(&positions, &[WING]);
        let seen = |viewpoint| look(&block, frame.view(viewpoint)).doubtful & 1;
        assert_eq!(seen(Viewpoint::at(DVec3::new(9.0, 4.0, 1.0))), 1);
        // From where no sign is sure, every edge is doubtful.
        let folded = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let frame = Frame::new(&folded, &[WING]);
        let block = frame.block(&folded, &[WING]);
        let view = |viewpoint| look(&block, frame.view(viewpoint)).doubtful;
        assert_eq!(view(Viewpoint::from_direction(DVec3::ZERO)), 0xff);
        assert_eq!(view(Viewpoint::from_direction(DVec3::new(1e-200, 2e-200, 0.0))), 0xff);
        assert_eq!(view(Viewpoint::at(DVec3::new(5.0, 4.0, 3.0))), 0);
    }

    /// A frame around it would leave no sign sure.
    #[test]
    fn a_vertex_far_away_that_no_face_uses_changes_nothing() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(1e9)];
        let frame = Frame::new(&positions, &[WING]);
        let view = frame.view(Viewpoint::at(DVec3::new(5.0, 4.0, 3.0)));
        assert_eq!(look(&frame.block(&positions, &[WING]), view).doubtful, 0);
    }
}
