//! Which side of a face the viewpoint is on, exactly.
//!
//! Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates,
//! Discrete & Computational Geometry 18(3), 1997, through the crate `robust`.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};
use num_rational::BigRational;
use robust::{Coord, Coord3D};

use crate::{Mesh, Viewpoint};

/// The side of the plane through `corners` on which `viewpoint` lies, exactly.
///
/// `Greater`: on the side of the normal, from which the corners run counter-clockwise. `Less`: on
/// the other. `Equal`: in the plane, or the corners are collinear and span none.
///
/// Permuting the corners evenly changes nothing and oddly reverses the answer, so any edge that
/// asks about a face gets the same one. Tens of nanoseconds; microseconds where coordinates of one triangle
/// differ by more than 2^28 in size and the direction of an orthographic view grazes it.
pub fn face_side(corners: [Vec3; 3], viewpoint: Viewpoint) -> Ordering {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    sure_side([a, b, c], viewpoint).unwrap_or_else(|| exact_side([a, b, c], viewpoint))
}

/// The same where f64 is sure of it.
///
/// Three differences, their products and sums are each off by 2⁻⁵³ of themselves at most, so that
/// the determinant is off by some 8 · 2⁻⁵³ times the sum of the sizes of its terms, and that is no
/// more than the product of the three sums of components. What it compares with is rounded as often:
/// twice as much is enough. Nothing over- or underflows, from f32 and where [`Viewpoint`] may be.
#[inline]
fn sure_side([a, b, c]: [DVec3; 3], viewpoint: Viewpoint) -> Option<Ordering> {
    let (u, v, to_viewpoint) = (b - a, c - a, viewpoint.from_point(a));
    let determinant = u.cross(v).dot(to_viewpoint);
    let size = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
    let doubt = 8.0 * f64::EPSILON * size(u) * size(v) * size(to_viewpoint);
    // Not if it is NaN.
    (determinant.abs() > doubt).then(|| determinant.total_cmp(&0.0))
}

#[cold]
fn exact_side([a, b, c]: [DVec3; 3], viewpoint: Viewpoint) -> Ordering {
    if viewpoint.is_point() {
        return orientation(a, b, c, viewpoint.xyz());
    }
    // The sign of det(b − a, c − a, d), which is the normal's product with the direction.
    let direction = viewpoint.xyz();
    if let Some(side) = side_by_components([a, b, c], direction) {
        return side;
    }
    // Differences of f32 are nearly always exact in f64.
    match (exact_difference(b, a), exact_difference(c, a)) {
        (Some(u), Some(v)) => orientation(u, v, direction, DVec3::ZERO).reverse(),
        _ => whole_determinant(a, b, c, direction),
    }
}

/// The same towards `direction` where all terms of the normal's product with it that are not 0 have one
/// sign, by a tenth of the work: so it is with every face in a view along an axis, and with faces along
/// axes in every view.
fn side_by_components(corners: [DVec3; 3], direction: DVec3) -> Option<Ordering> {
    let [mut is_front, mut is_back] = [false; 2];
    for plane @ [x, y] in PLANES {
        let along = direction[3 - x - y];
        if along != 0.0 {
            let term = shadow(corners, plane) * along.signum();
            is_front |= term > 0.0;
            is_back |= term < 0.0;
        }
    }
    match (is_front, is_back) {
        (false, false) => Some(Ordering::Equal),
        (true, false) => Some(Ordering::Greater),
        (false, true) => Some(Ordering::Less),
        (true, true) => None,
    }
}

/// The side of the plane through `corners` on which `point` lies, exactly. See [`face_side`].
pub fn volume_side(corners: [Vec3; 3], point: Vec3) -> Ordering {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    orientation(a, b, c, point.as_dvec3())
}

/// The side of every face of `mesh` on which `viewpoint` lies: one exact sign per face.
/// Replaces what `sides` held.
pub fn face_sides(mesh: &Mesh, viewpoint: Viewpoint, sides: &mut Vec<Ordering>) {
    sides.clear();
    sides
        .extend(mesh.triangles().iter().map(|t| face_side(t.map(|v| mesh.position(v)), viewpoint)));
}

/// Sine of the smallest corner angle at which [`unit_normal`] trusts a face. Differences of f32 lose
/// at most 2⁻⁵³ of their size in f64.
const LEAST_SINE: f64 = 1e-8;

/// The unit normal of a face whose corners run counter-clockwise, off by less than 1e-7 radians.
///
/// `None` where that is not sure: at faces without area, and at those all of whose angles have a sine
/// below 1e-8. Some 20 multiplications.
pub fn unit_normal(corners: [Vec3; 3]) -> Option<DVec3> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    // A sliver's angle may be small at any one corner, as long as the normal is sure.
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().find_map(|[a, b, c]| {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        // |u × v| ≥ sin |u| |v|, without dividing by lengths that may be zero.
        let least_squared = LEAST_SINE * LEAST_SINE * u.length_squared() * v.length_squared();
        if normal.length_squared() > least_squared { normal.try_normalize() } else { None }
    })
}

/// Whether the corners span a plane: exactly, `false` if and only if they are collinear.
pub fn has_area(corners: [Vec3; 3]) -> bool {
    let corners = corners.map(|p| p.as_dvec3());
    PLANES.iter().any(|&plane| shadow(corners, plane) != 0.0)
}

/// Whether two triangles in one plane, exactly, have opposite normals, or one of them no area.
pub(crate) fn are_opposite([left, right]: [[Vec3; 3]; 2]) -> bool {
    let [left, right] = [left, right].map(|corners| corners.map(|p| p.as_dvec3()));
    // The normals are parallel, so any component of theirs that is not 0 will tell.
    PLANES.iter().all(|&plane| shadow(left, plane) * shadow(right, plane) <= 0.0)
}

/// The planes of the coordinates, by their axes.
const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Twice the area of a triangle's shadow on one of [`PLANES`], a component of its normal. Positive
/// if it runs counter-clockwise, negative if clockwise, 0 if collinear, exactly; rounded otherwise.
fn shadow(corners: [DVec3; 3], [x, y]: [usize; 2]) -> f64 {
    let [a, b, c] = corners.map(|p| Coord { x: p[x], y: p[y] });
    robust::orient2d(a, b, c)
}

/// `Greater` if a, b and c run counter-clockwise seen from d.
fn orientation(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
    let at = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    // Shewchuk's orient3d is positive if d is *below* the plane, hence the exchange.
    0.0.partial_cmp(&robust::orient3d(at(a), at(b), at(c), at(d))).unwrap_or(Ordering::Equal)
}

/// p − q if f64 holds every component of it exactly.
fn exact_difference(p: DVec3, q: DVec3) -> Option<DVec3> {
    let difference = p - q;
    // Knuth's two-sum: the rounding error of each difference.
    let q_seen = p - difference;
    let error = (p - (difference + q_seen)) + (q_seen - q);
    (error == DVec3::ZERO).then_some(difference)
}

/// 2¹⁴⁹: f32 are multiples of its inverse, so that times this they are whole.
const WHOLE_POSITION: f64 = f64::from_bits((1023 + 149) << 52);
/// 2²⁵²: the same of f64 that are 0 or at least 1e-60 in size.
const WHOLE_DIRECTION: f64 = f64::from_bits((1023 + 252) << 52);

/// The sign of det(b − a, c − a, d) in whole numbers: fractions are reduced at every step, which takes
/// most of their time.
fn whole_determinant(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
    let whole = |p: DVec3, scale: f64| {
        p.to_array().map(|x| BigRational::from_float(x * scale).unwrap_or_default().to_integer())
    };
    let [a, b, c] = [a, b, c].map(|p| whole(p, WHOLE_POSITION));
    let d = whole(d, WHOLE_DIRECTION);
    let u: [_; 3] = std::array::from_fn(|i| &b[i] - &a[i]);
    let v: [_; 3] = std::array::from_fn(|i| &c[i] - &a[i]);
    let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    let determinant = minor(1, 2) * &d[0] + minor(2, 0) * &d[1] + minor(0, 1) * &d[2];
    determinant.cmp(&Default::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    #[test]
    fn counter_clockwise_is_front() {
        let seen_from = |z| face_side(CORNERS, Viewpoint::at(DVec3::new(0.3, 0.3, z)));
        assert_eq!(
            [seen_from(1.0), seen_from(0.0), seen_from(-1.0)],
            [Ordering::Greater, Ordering::Equal, Ordering::Less]
        );
        let seen_along = |z| face_side(CORNERS, Viewpoint::from_direction(DVec3::new(5.0, 3.0, z)));
        assert_eq!(
            [seen_along(1e-60), seen_along(0.0), seen_along(-1e-60)],
            [Ordering::Greater, Ordering::Equal, Ordering::Less]
        );
    }

    #[test]
    fn a_normal_is_trusted_where_one_corner_is_wide_enough() {
        assert_eq!(unit_normal(CORNERS), Some(DVec3::Z));
        assert_eq!(unit_normal([Vec3::ONE, Vec3::splat(2.0), Vec3::splat(-7.0)]), None);
        let sliver = |width: f32| [Vec3::ZERO, Vec3::X, Vec3::new(0.5, width, 0.0)];
        for turn in 0..3 {
            let turned = |width| std::array::from_fn(|i| sliver(width)[(i + turn) % 3]);
            assert_eq!(unit_normal(turned(1e-7)), Some(DVec3::Z));
            assert_eq!(unit_normal(turned(1e-9)), None);
        }
    }

    #[test]
    fn collinear_corners_have_no_area() {
        assert!(has_area(CORNERS));
        assert!(!has_area([Vec3::ONE, Vec3::splat(2.0), Vec3::splat(-7.0)]));
        assert!(has_area([Vec3::ONE, Vec3::splat(2.0), Vec3::new(-7.0, -7.0, -7.000_000_5)]));
        assert!(!has_area([Vec3::ONE, Vec3::ONE, Vec3::X]));
    }

    /// The sign of det(b − a, c − a, d) in rational arithmetic.
    fn rational_determinant(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
        let exact = |p: DVec3| p.to_array().map(|x| BigRational::from_float(x).unwrap_or_default());
        let [a, b, c, d] = [a, b, c, d].map(exact);
        let u: [_; 3] = std::array::from_fn(|i| &b[i] - &a[i]);
        let v: [_; 3] = std::array::from_fn(|i| &c[i] - &a[i]);
        let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
        let determinant = minor(1, 2) * &d[0] + minor(2, 0) * &d[1] + minor(0, 1) * &d[2];
        determinant.cmp(&BigRational::default())
    }

    /// f32 of very different sizes, so that differences do not fit an f64.
    fn wild() -> impl Strategy<Value = f32> {
        (-1.0f32..1.0, -40i32..40).prop_map(|(m, e)| m * 2f32.powi(e))
    }

    fn wild_point() -> impl Strategy<Value = Vec3> {
        [wild(), wild(), wild()].prop_map(Vec3::from_array)
    }

    fn extreme_point() -> impl Strategy<Value = Vec3> {
        let extreme = || (-1.0f32..1.0, -149i32..128).prop_map(|(m, e)| m * (e as f32).exp2());
        [extreme(), extreme(), extreme()].prop_map(Vec3::from_array)
    }

    proptest! {
        /// A direction built to lie in the plane up to the rounding of a few f64 operations: the
        /// sign there is noise unless it is exact.
        #[test]
        fn grazing_directions_agree_with_rational_arithmetic(
            a in wild_point(), b in wild_point(), c in wild_point(), s in -2.0f64..2.0, t in -2.0f64..2.0,
        ) {
            let [p, q, r] = [a, b, c].map(|p| p.as_dvec3());
            let direction = s * (q - p) + t * (r - p);
            let expected = rational_determinant(p, q, r, direction);
            prop_assert_eq!(face_side([a, b, c], Viewpoint::from_direction(direction)), expected);
            prop_assert_eq!(face_side([b, c, a], Viewpoint::from_direction(direction)), expected);
            prop_assert_eq!(face_side([b, a, c], Viewpoint::from_direction(direction)), expected.reverse());
        }

        /// Faces in planes of the coordinates, and directions along axes and in their planes.
        #[test]
        fn what_lies_along_axes_agrees_with_rational_arithmetic(
            corners in [wild_point(), wild_point(), wild_point()], direction in wild_point(),
            flat in [0u8..3, 0u8..3, 0u8..3], along in [0u8..3, 0u8..3, 0u8..3],
        ) {
            let [mut a, mut b, mut c] = corners;
            let mut direction = direction.as_dvec3();
            for axis in 0..3 {
                if flat[axis] == 0 {
                    (b[axis], c[axis]) = (a[axis], a[axis]);
                }
                if along[axis] > 0 {
                    direction[axis] = 0.0;
                }
                // Collinear, if it is so on every axis.
                if flat[axis] == 1 {
                    (a[axis], b[axis], c[axis]) = (a[axis], 0.0, -a[axis]);
                }
            }
            let [p, q, r] = [a, b, c].map(|p| p.as_dvec3());
            let expected = rational_determinant(p, q, r, direction);
            prop_assert_eq!(face_side([a, b, c], Viewpoint::from_direction(direction)), expected);
            prop_assert_eq!(face_side([b, a, c], Viewpoint::from_direction(direction)), expected.reverse());
        }

        /// From the least f32 to the largest, and as far as a viewpoint may be.
        #[test]
        fn whole_numbers_are_large_enough(
            corners in [extreme_point(), extreme_point(), extreme_point()],
            direction in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0], sizes in [-199i32..199, -199i32..199, -199i32..199],
        ) {
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let whole = |i: usize| (2f64.powi(52) * direction[i]).round() * 2f64.powi(sizes[i] - 52);
            let direction = DVec3::new(whole(0), whole(1), whole(2));
            prop_assert_eq!(whole_determinant(a, b, c, direction), rational_determinant(a, b, c, direction));
            // In the plane, and so near it that only the last digits tell.
            let along = f64::from(sizes[0]) * (b - a);
            prop_assert_eq!(whole_determinant(a, b, c, along), rational_determinant(a, b, c, along));
        }

        #[test]
        fn grazing_points_agree_with_rational_arithmetic(
            a in wild_point(), b in wild_point(), c in wild_point(), s in -2.0f64..2.0, t in -2.0f64..2.0,
        ) {
            let [p, q, r] = [a, b, c].map(|p| p.as_dvec3());
            let point = p + s * (q - p) + t * (r - p);
            let exact = |v: DVec3| v.to_array().map(|x| BigRational::from_float(x).unwrap());
            let ([p, q, r], at) = ([p, q, r].map(exact), exact(point));
            let u: [_; 3] = std::array::from_fn(|i| &q[i] - &p[i]);
            let v: [_; 3] = std::array::from_fn(|i| &r[i] - &p[i]);
            let d: [_; 3] = std::array::from_fn(|i| &at[i] - &p[i]);
            let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
            let determinant = minor(1, 2) * &d[0] + minor(2, 0) * &d[1] + minor(0, 1) * &d[2];
            let expected = determinant.cmp(&BigRational::default());
            prop_assert_eq!(face_side([a, b, c], Viewpoint::at(point)), expected);
            prop_assert_eq!(face_side([b, a, c], Viewpoint::at(point)), expected.reverse());
        }
    }
}
