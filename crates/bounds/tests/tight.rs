//! The tight bound at the edge of its claim, and beside the bounds that it replaces.

mod draw;

use draw::{cases, direction, magnitude};
use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
use drypoint_mesh::Viewpoint;
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// Planes that hold up a bound: normals all around the rim of the cone of half-angle `half_angle`,
/// and crossings with the axis line at its two apexes.
#[derive(Clone, Debug)]
struct Rim {
    axis: DVec3,
    center: DVec3,
    half_angle: f64,
    /// From the center to either apex.
    apex_distance: f64,
    planes: Vec<Plane>,
    /// Of the plane, in its order: up the side of the double cone.
    climbs: Vec<DVec3>,
}

/// Rims from pin-prick to 79.9°, from a point to a large patch, near the origin and far, with points
/// up to 1000 units away from where the planes cross the axis.
fn rim() -> impl Strategy<Value = Rim> {
    let half_angle = prop_oneof![magnitude(-8.0, 0.1), 0.02..1.39f64];
    let size = prop_oneof![4 => magnitude(-6.0, 3.0), 1 => Just(0.0)];
    let center = (direction(), magnitude(-3.0, 5.0)).prop_map(|(d, distance)| distance * d);
    let away = prop_oneof![Just(0.0), magnitude(-3.0, 3.0)];
    (direction(), 0.0..std::f64::consts::TAU, half_angle, size, center, away).prop_map(
        |(axis, turn, half_angle, apex_distance, center, away)| {
            let (sin, cos) = half_angle.sin_cos();
            let (right, up) = axis.any_orthonormal_pair();
            let (mut planes, mut climbs) = (Vec::new(), Vec::new());
            for i in 0..6u32 {
                let around =
                    DVec2::from_angle(turn + std::f64::consts::TAU * f64::from(i / 2) / 3.0);
                let sideways = around.x * right + around.y * up;
                let height = if i % 2 == 0 { apex_distance } else { -apex_distance };
                let (normal, climb) = (cos * axis + sin * sideways, sin * axis - cos * sideways);
                let along = if i < 3 { climb } else { normal.cross(climb) };
                planes.push(Plane { normal, point: center + height * axis + away * along });
                climbs.push(climb);
            }
            Rim { axis, center, half_angle, apex_distance, planes, climbs }
        },
    )
}

impl Rim {
    /// Whether `viewpoint` is certainly behind one of the planes and in front of another, in f64.
    fn is_between(&self, viewpoint: Viewpoint) -> bool {
        let side = |plane: &Plane| {
            let from_point = viewpoint.from_point(plane.point);
            let doubt = 1e-14 * from_point.length() + 1e-15 * viewpoint.w() * plane.point.length();
            let volume = plane.normal.dot(from_point);
            if volume.abs() > doubt { volume.signum() } else { 0.0 }
        };
        let sides = || self.planes.iter().map(side);
        sides().any(|side| side < 0.0) && sides().any(|side| side > 0.0)
    }

    /// Points a hair behind the planes that cross the axis at the upper apex, past it by `past_apex`
    /// on the line where plane and double cone meet, the same mirrored for the lower one, and both
    /// directions; those from which the planes are seen from different sides.
    fn viewpoints(&self, past_apex: f64, hair: f64) -> Vec<Viewpoint> {
        let mut viewpoints = Vec::new();
        for (i, (plane, climb)) in self.planes.iter().zip(&self.climbs).enumerate() {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let apex = self.center + side * self.apex_distance * self.axis;
            let towards = side * (climb - hair * plane.normal);
            viewpoints.push(Viewpoint::at(apex + past_apex * towards));
            viewpoints.push(Viewpoint::from_direction(towards));
        }
        viewpoints.retain(|&viewpoint| self.is_between(viewpoint));
        viewpoints
    }

    fn planes(&self) -> impl Iterator<Item = Plane> + Clone {
        self.planes.iter().copied()
    }
}

/// Planes of a patch of a bumpy ball or a saddle: normals and points are functions of a place.
fn patch() -> impl Strategy<Value = Vec<Plane>> {
    let place = (-1.0..1.0f64, -1.0..1.0f64);
    let curvatures = [-1.0..1.0f64, -1.0..1.0, -1.0..1.0];
    let places = proptest::collection::vec((place, direction()), 1..40);
    let placed = (direction(), direction(), magnitude(-3.0, 3.0));
    (places, curvatures, magnitude(-6.0, 0.5), magnitude(-6.0, -1.0), placed).prop_map(
        |(places, [xx, xy, yy], bent, rough, (axis, offset, distance))| {
            let (right, up) = axis.any_orthonormal_pair();
            let plane = |((x, y), noise): ((f64, f64), DVec3)| {
                let height = 0.5 * bent * (xx * x * x + 2.0 * xy * x * y + yy * y * y);
                let slope = bent * DVec2::new(xx * x + xy * y, xy * x + yy * y);
                let normal = axis - slope.x * right - slope.y * up + bent * rough * noise;
                let point = x * right + y * up + height * axis;
                Plane { normal: normal.normalize(), point: point + distance * offset }
            };
            places.into_iter().map(plane).collect()
        },
    )
}

proptest! {
    #![proptest_config(cases(100_000))]

    /// The worst planes that a tight bound admits, handed to it, and seen from a hair behind.
    #[test]
    fn ring_3_rim_of_the_tight_cone(
        rim in rim(), past_apex in magnitude(-6.0, 4.0), hair in magnitude(-9.0, -1.0),
    ) {
        let cones =
            [DoubleCone::tight(rim.planes()), DoubleCone::about(rim.axis, rim.center, rim.planes())];
        for viewpoint in rim.viewpoints(past_apex, hair) {
            for cone in &cones {
                prop_assert!(cone.may_hold_contour(viewpoint), "{viewpoint:?}: {cone:?}");
            }
        }
    }

    /// The same, with normals that are off by as much as normals of slivers are.
    #[test]
    fn ring_3_rim_of_the_tight_cone_of_slivers(
        rim in rim(), errors in [direction(), direction(), direction()],
        past_apex in magnitude(-6.0, 4.0), hair in magnitude(-9.0, -1.0),
    ) {
        let error = |(i, plane): (usize, Plane)| {
            let normal = (plane.normal + 1e-7 * errors[i % 3]).normalize();
            Plane { normal, ..plane }
        };
        let cone = DoubleCone::tight(rim.planes().enumerate().map(error));
        for viewpoint in rim.viewpoints(past_apex, hair) {
            prop_assert!(cone.may_hold_contour(viewpoint), "{viewpoint:?}: {cone:?}");
        }
    }

    /// The bound of the rim is the rim: neither t nor α is larger than it must be.
    #[test]
    fn ring_4_the_tight_cone_is_tight(rim in rim()) {
        let tight = DoubleCone::tight(rim.planes());
        let about = DoubleCone::about(rim.axis, rim.center, rim.planes());
        // With points away from there, the tight bound is about another line.
        let is_about_center = rim.planes().all(|p| p.point.distance(rim.center) <= rim.apex_distance);
        for cone in if is_about_center { vec![tight, about] } else { vec![about] } {
            prop_assert!(cone != DoubleCone::ALWAYS);
            let half_angle = f64::from(cone.tan_squared).sqrt().atan();
            prop_assert!(half_angle <= rim.half_angle + 1e-6, "{half_angle}");
            let reach = rim.planes().map(|p| p.point.distance(rim.center)).fold(0.0, f64::max);
            let size = reach + rim.center.length();
            let most = rim.apex_distance + 2e-6 * size / rim.half_angle.cos();
            prop_assert!(f64::from(cone.apex_distance) <= most, "{} > {most}", cone.apex_distance);
        }
    }
}

proptest! {
    #![proptest_config(cases(10_000))]

    /// About the same line, no sphere does better, whichever line it is.
    #[test]
    fn tight_is_never_looser_than_a_sphere(planes in patch(), aside in direction(), far in 0.0..2.0f64) {
        let tight = DoubleCone::tight(planes.iter().copied());
        let cone = NormalCone::minimal(planes.iter().map(|plane| plane.normal));
        // A plane that holds a line meets what the line meets; here only the planes count.
        let meeting = |center: DVec3| {
            let distances = planes.iter().map(|p| p.normal.dot(p.point - center).abs());
            Sphere { center, radius: distances.fold(0.0, f64::max) }
        };
        let half_angle = |cone: DoubleCone| f64::from(cone.tan_squared).sqrt().atan();
        let is_no_looser = |tight: DoubleCone, center: DVec3| {
            let cone = DoubleCone::from(SpatializedNormalCone { cone, sphere: meeting(center) });
            let reach = planes.iter().map(|p| p.point.distance(center)).fold(0.0, f64::max);
            let apex_distance = f64::from(cone.apex_distance) + 1e-6 * reach;
            cone == DoubleCone::ALWAYS
                || (f64::from(tight.apex_distance) <= apex_distance
                    && half_angle(tight) <= half_angle(cone) + 2e-7)
        };
        prop_assert!(is_no_looser(tight, tight.center.as_dvec3()));
        let center = planes[0].point + far * aside;
        let about = DoubleCone::about(cone.axis, center, planes.iter().copied());
        prop_assert!(is_no_looser(about, center));
        // Nor than about the mean of the points, where the search starts.
        let mean = planes.iter().map(|p| p.point).sum::<DVec3>() / planes.len() as f64;
        prop_assert!(is_no_looser(tight, mean));
        let farthest = planes.iter().map(|p| p.point.distance(mean)).fold(0.0, f64::max);
        let across = (tight.center.as_dvec3() - mean).cross(tight.axis.as_dvec3()).length();
        prop_assert!(across <= farthest * (1.0 + 1e-6) + 1e-6 * mean.length(), "{across}, {farthest}");
    }
}

/// A cap of a ball: t is R α² / 4, and not R α.
#[test]
fn the_planes_of_a_ball_cross_close_together() {
    let plane = |i: u32| {
        let turn = std::f64::consts::TAU * f64::from(i % 16) / 16.0;
        let (sin, cos) = (0.2 * f64::from(i / 16) / 8.0).sin_cos();
        let normal = DVec3::new(sin * turn.cos(), sin * turn.sin(), cos);
        Plane { normal, point: 5.0 * normal }
    };
    // However many of them there are on one side.
    let planes = (0..144).chain([140; 300]).map(plane);
    let tight = DoubleCone::tight(planes);
    let expected = 5.0 * 0.2f64.powi(2) / 4.0;
    assert!((f64::from(tight.apex_distance) - expected).abs() < 0.02 * expected, "{tight:?}");
    let up = tight.center.as_dvec3() - DVec3::new(0.0, 0.0, 5.0 + expected);
    assert!(up.length() < 0.02 * expected, "{up}");
}

#[test]
fn what_has_no_tight_bound_gets_always() {
    let plane = |normal: DVec3, point: DVec3| Plane { normal, point };
    let tilted = |angle: f64| DVec3::new(angle.sin(), 0.0, angle.cos());
    let good = plane(DVec3::Z, DVec3::X);
    let always: [&[Plane]; 9] = [
        &[],
        &[good, plane(DVec3::NEG_Z, DVec3::X)],
        &[plane(tilted(1.4), DVec3::X), plane(tilted(-1.4), DVec3::X)],
        &[good, plane(DVec3::ZERO, DVec3::X)],
        &[plane(DVec3::NAN, DVec3::X), good],
        &[good, plane(DVec3::Z, DVec3::NAN), good],
        &[good, plane(DVec3::Z, DVec3::new(0.0, 0.0, f64::INFINITY))],
        &[good, plane(tilted(0.1), 1e39 * DVec3::Z)],
        &[plane(DVec3::Z, 1e39 * DVec3::Z)],
    ];
    for planes in always {
        assert_eq!(DoubleCone::tight(planes.iter().copied()), DoubleCone::ALWAYS, "{planes:?}");
    }
    let about = |axis, point| DoubleCone::about(axis, point, [good].into_iter());
    assert_ne!(about(DVec3::Z, DVec3::X), DoubleCone::ALWAYS);
    for axis in [DVec3::ZERO, 2.0 * DVec3::Z, DVec3::NAN, DVec3::X, DVec3::NEG_Z] {
        assert_eq!(about(axis, DVec3::X), DoubleCone::ALWAYS, "{axis}");
    }
    assert_eq!(about(DVec3::Z, DVec3::NAN), DoubleCone::ALWAYS);
    assert_eq!(about(DVec3::Z, DVec3::splat(1e300)), DoubleCone::ALWAYS);
}
