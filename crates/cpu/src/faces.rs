//! Planes of faces in whole numbers, sixteen side by side.
//!
//! A plane with unit normal n through p has, as seen from a homogeneous viewpoint (v, w), the sign
//! of n · (v − w p). About a center c, and in units of R, half the diagonal of the mesh's box, that
//! is the sign of the product of two vectors of four numbers,
//!
//! g = (n, −n · (p − c) / R) · (v − w c, w R) / |(v − w c, w R)|.
//!
//! They are no longer than √2 and 1, in this order. Multiplied by s and t, S = 2¹⁵ − 1 at most, they are p
//! and q, and rounded to whole numbers P = p + δ and Q = q + ε. The product P · Q fits an i32, since
//! S² √2 < 2³¹ by far more than the rounding, and is exact: it depends on no order and on no processor.
//! Of each plane and of the viewpoint a length is chosen that rounds well ([`crate::whole`]): so no place
//! of δ is beyond ⅛, and those of ε are mostly less. The product is off from s t g by
//!
//! P · Q − p · q = δ · q + P · ε ≤ ⅛ Σ |q| + (S + 1) |ε₁₂₃| + S |ε₄|,
//!
//! as the normal in P is no longer than S + ⅛ √3, and its offset no more than S. That is some 0.3 S, at
//! most 1.62 S, and known once the viewpoint is; 181 = 2⁻²³ S² √2 more pays for the 1e-7 radians that
//! [`unit_normal`] may be off by. If the product is farther from 0 than that, its sign is the plane's:
//! else the exact predicate is asked. That is so where a plane passes the viewpoint within some 1e-5 of
//! its distance from c, or of R if that is more, as all planes do that are parallel to the direction of an
//! orthographic view. Few planes have to be much shorter than S to round well, and it is as much more for
//! them.

use drypoint_mesh::{Viewpoint, Wing, unit_normal};
use glam::{DVec3, DVec4, Vec3};

use crate::simd::{Lanes, Level};
use crate::whole::{SCALE, Whole};

/// Faces in a block, and patches.
pub(crate) const LANES: usize = 16;

/// What rounding changes a component of a plane by, at most: ⅛, and what f64 loses.
const LOSS: f64 = 0.125 + 1e-9;

/// Two components of sixteen planes: side by side, as one instruction multiplies and adds pairs.
pub(crate) type Pairs = [[i16; 2]; LANES];

/// Planes of sixteen faces: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct FaceBlock {
    /// x and y of the normals.
    xy: Pairs,
    /// z, and the offset.
    zd: Pairs,
}

/// The viewpoint in whole numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// x and y, then z and w.
    pairs: [[i16; 2]; 2],
    /// A product of more than that, or less than minus that, has the sign of the plane.
    pub(crate) margin: i32,
}

/// What a viewpoint sees of the faces of a block, a bit each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    /// Faces that look away, if they are not doubtful.
    pub(crate) back: u16,
    /// Faces of which the exact predicate must tell.
    pub(crate) doubtful: u16,
}

impl FaceBlock {
    /// Of the plane that `plane` gives for each lane.
    pub(crate) fn new(plane: impl Fn(usize) -> Plane) -> Self {
        let components = |first: usize| {
            std::array::from_fn(|lane| [plane(lane).0[first], plane(lane).0[first + 1]])
        };
        Self { xy: components(0), zd: components(2) }
    }

    #[inline(always)]
    pub(crate) fn sides<L: Lanes>(&self, lanes: L, view: View) -> Sides {
        let heights = self.heights(lanes, view);
        Sides { back: lanes.negative(heights), doubtful: lanes.within(heights, view.margin) }
    }

    /// P · Q.
    #[inline(always)]
    pub(crate) fn heights<L: Lanes>(&self, lanes: L, view: View) -> L::Wholes {
        lanes.dot([&self.xy, &self.zd], view.pairs)
    }
}

/// Normal and offset in whole numbers; zero if the face spans no plane that can be trusted, or none that
/// rounds well.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Plane([i16; 4]);

impl Plane {
    /// The same, seen from behind.
    pub(crate) fn turned(self, is_turned: bool) -> Self {
        // No component is below −S.
        if is_turned { Self(self.0.map(|component| -component)) } else { self }
    }
}

/// What planes and viewpoints are measured from, and in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    center: DVec3,
    /// R; above 0.
    radius: f64,
    /// What planes are rounded with.
    level: Level,
}

impl Frame {
    /// Around the corners of the faces beside `wings`: other vertices may be anywhere.
    pub(crate) fn new<'a>(positions: &[Vec3], wings: impl IntoIterator<Item = &'a Wing>) -> Self {
        let corners =
            wings.into_iter().flat_map(|wing| [wing.tail, wing.head, wing.left, wing.right]);
        let used = corners.filter(|&corner| corner != Wing::NONE);
        let (least, most) = used
            .map(|vertex| positions[vertex as usize].as_dvec3())
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, most), position| {
                (least.min(position), most.max(position))
            });
        let radius = 0.5 * (most - least).length();
        if radius > 0.0 && radius.is_finite() {
            Self { center: 0.5 * (least + most), radius, level: Level::newest() }
        } else {
            // A point, or nothing: it has no plane either.
            Self { center: DVec3::ZERO, radius: 1.0, level: Level::newest() }
        }
    }

    /// From the zero direction, and if a number is not finite, nothing is sure.
    pub(crate) fn view(&self, level: Level, viewpoint: Viewpoint) -> View {
        let (direction, w) = (viewpoint.from_point(self.center), viewpoint.w() * self.radius);
        let homogeneous = DVec4::from((direction, w));
        let size = homogeneous.length();
        // Smaller, and the squares do not fit an f64.
        if size < 1e-100 {
            return View { pairs: [[0; 2]; 2], margin: 0 };
        }
        let unit = (homogeneous / size).to_array();
        let whole = Whole::new(level, unit);
        let scaled = DVec4::from(unit) * whole.scale;
        let lost = DVec4::from(whole.losses(unit));
        let [x, y, z, w] = whole.numbers;
        let margin = LOSS * scaled.abs().element_sum()
            + (SCALE + 1.0) * lost.truncate().length()
            + SCALE * lost.w.abs();
        #[expect(clippy::cast_possible_truncation, reason = "at most 1.62 S")]
        let margin = (margin + 181.0).ceil() as i32;
        View { pairs: [[x, y], [z, w]], margin }
    }

    /// Of the face with these corners.
    pub(crate) fn plane(&self, corners: [Vec3; 3]) -> Plane {
        let Some(normal) = unit_normal(corners) else { return Plane::default() };
        let offset = -normal.dot(corners[0].as_dvec3() - self.center) / self.radius;
        let vector = [normal.x, normal.y, normal.z, offset.clamp(-1.0, 1.0)];
        Whole::within(self.level, vector, LOSS)
            .map_or(Plane::default(), |whole| Plane(whole.numbers))
    }
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use drypoint_mesh::face_side;
    use proptest::prelude::*;

    use super::*;
    use crate::edges::{Blocks, EdgePlanes, Seen};
    use crate::simd::{Instructions, Kernel};

    const WING: Wing = Wing { tail: 0, head: 1, left: 2, right: 3 };

    /// The first block, as every instruction set sees it.
    struct Look<'a>(&'a EdgePlanes, View);

    impl Kernel for Look<'_> {
        type Output = Seen;

        #[inline(always)]
        fn run<L: Lanes>(self, lanes: L) -> Seen {
            EdgePlanes::look(self.0.looked_at(), lanes, 0, self.1)
        }
    }

    #[track_caller]
    fn look(positions: &[Vec3], viewpoint: Viewpoint) -> Seen {
        let frame = Frame::new(positions, &[WING]);
        let mut blocks = EdgePlanes::default();
        blocks.push(&frame, positions, &[WING], 0);
        let levels = Instructions::ALL.into_iter().filter_map(Instructions::level);
        let mut seen = levels.map(|level| level.run(Look(&blocks, frame.view(level, viewpoint))));
        let first = seen.next().expect("one is always here");
        assert!(seen.all(|seen| seen == first), "other instructions see {first:?} otherwise");
        first
    }

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

    /// Numbers from −1 to 1, the same each time.
    fn fixed() -> impl FnMut() -> f64 {
        let mut state = 1u32;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        }
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
            let seen = look(&positions, viewpoint);
            let is_front = |face: [u32; 3]| {
                face_side(face.map(|v| positions[v as usize]), viewpoint) != Ordering::Less
            };
            let is_contour = is_front(WING.left_face()) != is_front(WING.right_face());
            prop_assert!(seen.doubtful & 1 == 1 || (seen.contours & 1 == 1) == is_contour);
            // The other lanes are no edges.
            prop_assert_eq!(seen.contours & !seen.doubtful & !1, 0);
        }
    }

    /// A margin that nothing came near would be no margin, and a test of it none. The worst is a plane
    /// that is rounded along the viewpoint as far as it may be, and lies along what the viewpoint loses.
    #[test]
    fn products_come_close_to_the_margin() {
        let frame = Frame::new(
            &[Vec3::ONE, Vec3::NEG_ONE],
            &[Wing { tail: 0, head: 1, left: 1, right: 1 }],
        );
        let mut rng = fixed();
        for _ in 0..1000 {
            let eye = 3.0 * DVec3::new(rng(), rng(), rng());
            let View { pairs: [[x, y], [z, w]], margin } =
                frame.view(frame.level, Viewpoint::at(eye));
            let unit = DVec4::from((eye, frame.radius)).normalize().to_array();
            let viewpoint = Whole::new(frame.level, unit);
            assert_eq!(viewpoint.numbers, [x, y, z, w]);
            let lost = DVec4::from(viewpoint.losses(unit));
            let [normal, offset] =
                [lost.truncate().normalize(), DVec3::new(lost.w.signum(), 0.0, 0.0)];
            let plane = DVec4::from((normal, offset.x)) * SCALE;
            let seen = DVec4::from(unit) * viewpoint.scale;
            let error = LOSS * seen.abs().element_sum() + plane.dot(lost);
            let share = error / f64::from(margin);
            assert!((0.95..1.0).contains(&share), "{share}");
        }
    }

    #[test]
    fn planes_lose_no_more_than_they_may() {
        let frame = Frame::new(
            &[Vec3::ONE, Vec3::NEG_ONE],
            &[Wing { tail: 0, head: 1, left: 1, right: 1 }],
        );
        let (mut rng, mut lengths) = (fixed(), 0.0);
        for number in 0..3000 {
            // Some nearly along an axis, where little is to choose from.
            let thin = 0.5f64.powi(number % 20);
            let mut corner = || DVec3::new(rng(), thin * rng(), rng()).as_vec3();
            let corners = [corner(), corner(), corner()];
            let normal = unit_normal(corners).unwrap();
            let offset = -normal.dot(corners[0].as_dvec3()) / frame.radius;
            let plane = DVec4::from(frame.plane(corners).0.map(f64::from));
            let exact = DVec4::from((normal, offset));
            let axis = exact.abs().max_position();
            let scale = plane[axis] / exact[axis];
            assert!((1.0..SCALE + 1e-3).contains(&scale), "{scale}");
            let lost = plane - scale * exact;
            assert!(lost.abs().max_element() <= LOSS, "{lost}");
            lengths += scale / SCALE / 3000.0;
        }
        assert!(lengths > 0.7, "{lengths}");
    }

    #[test]
    fn faces_without_a_plane_are_doubtful() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::splat(0.5), Vec3::new(0.5, 0.0, 0.0)];
        assert_eq!(look(&positions, Viewpoint::at(DVec3::new(9.0, 4.0, 1.0))).doubtful & 1, 1);
        // From where no sign is sure, every edge is doubtful.
        let folded = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let doubtful = |viewpoint| look(&folded, viewpoint).doubtful;
        assert_eq!(doubtful(Viewpoint::from_direction(DVec3::ZERO)), 0xffff);
        assert_eq!(doubtful(Viewpoint::from_direction(DVec3::new(1e-200, 2e-200, 0.0))), 0xffff);
        assert_eq!(doubtful(Viewpoint::at(DVec3::new(5.0, 4.0, 3.0))), 0);
    }

    /// A frame around it would leave no sign sure.
    #[test]
    fn a_vertex_far_away_that_no_face_uses_changes_nothing() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(1e9)];
        assert_eq!(look(&positions, Viewpoint::at(DVec3::new(5.0, 4.0, 3.0))).doubtful, 0);
    }
}
