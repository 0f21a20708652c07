//! Four rings of tests around the one claim that counts: nothing that holds a contour edge is
//! culled. Each aims closer to the edge of that claim than the one before, the last at its reverse.
//! `docs/mutants.md` shows which ring notices which broken bound: viewpoints drawn at random do not
//! see a radius 3 % too small.

mod draw;
mod support;

use std::sync::LazyLock;

use draw::cases;
use draw::{direction, magnitude};
use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_mesh::Viewpoint;
use glam::DVec3;
use proptest::prelude::*;
use support::{Patch, SPATIALIZED, Subject, subjects};

static SUBJECTS: LazyLock<Vec<Subject>> = LazyLock::new(subjects);

/// A patch of any mesh.
fn patch() -> impl Strategy<Value = (&'static Subject, &'static Patch)> {
    (0..SUBJECTS.len(), any::<prop::sample::Index>()).prop_map(|(subject, patch)| {
        let subject = &SUBJECTS[subject];
        (subject, patch.get(&subject.patches))
    })
}

fn sign() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), Just(-1.0)]
}

proptest! {
    #![proptest_config(cases(100_000))]

    /// Ring 1. Any patch from anywhere: from inside it to 10⁴ times its size away, and at infinity.
    #[test]
    fn ring_1_anything(
        (subject, patch) in patch(), direction in direction(), distance in magnitude(-3.0, 4.0),
    ) {
        let center = patch.bounds[1].sphere.center;
        subject.check(patch, Viewpoint::at(center + distance * patch.size * direction))?;
        subject.check(patch, Viewpoint::from_direction(distance * direction))?;
    }

    /// Ring 2. From a hair above or below the plane of one of the patch's own faces, where it is
    /// about to turn; most often along the line of that plane that climbs along the axis, where the
    /// bound is as tight as it can be.
    #[test]
    fn ring_2_grazing(
        (subject, patch) in patch(), face in any::<prop::sample::Index>(),
        bound in 0..SPATIALIZED, distance in magnitude(-1.0, 4.0), turn in magnitude(-9.0, 0.5),
        hair in prop_oneof![3 => magnitude(-9.0, -1.0), 1 => Just(0.0)],
        side in sign(), way in sign(),
    ) {
        let (corners, normal) = *face.get(&patch.faces);
        let axis = patch.bounds[bound].cone.axis;
        let climb = axis - axis.dot(normal) * normal;
        let climb = climb.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let along = way * (turn.cos() * climb + turn.sin() * normal.cross(climb));
        let grazing = along + side * hair * normal;
        let foot = (corners[0] + corners[1] + corners[2]) / 3.0;
        subject.check(patch, Viewpoint::at(foot + distance * patch.size * grazing))?;
        subject.check(patch, Viewpoint::from_direction(grazing))?;
    }
}

/// A bound, and the plane that it barely admits: normal on the rim of the cone, touching the sphere
/// on the far side.
#[derive(Clone, Copy, Debug)]
struct Rim {
    bound: SpatializedNormalCone,
    normal: DVec3,
    /// In the plane, up the side of the double cone.
    climb: DVec3,
}

/// Rims of bounds from pin-prick to 79.9°, from a point to a large sphere, near the origin and far.
fn rim() -> impl Strategy<Value = Rim> {
    let half_angle = prop_oneof![magnitude(-8.0, 0.1), 0.02..1.39f64];
    let radius = prop_oneof![4 => magnitude(-6.0, 3.0), 1 => Just(0.0)];
    let center = (direction(), magnitude(-3.0, 5.0)).prop_map(|(d, distance)| distance * d);
    (direction(), 0.0..std::f64::consts::TAU, half_angle, center, radius).prop_map(
        |(axis, turn, half_angle, center, radius)| {
            let (sin, cos) = half_angle.sin_cos();
            let (right, up) = axis.any_orthonormal_pair();
            let sideways = turn.cos() * right + turn.sin() * up;
            Rim {
                bound: SpatializedNormalCone {
                    cone: NormalCone { axis, sin, cos },
                    sphere: Sphere { center, radius },
                },
                normal: cos * axis + sin * sideways,
                climb: sin * axis - cos * sideways,
            }
        },
    )
}

impl Rim {
    /// A point behind the rim's plane by `hair` times its distance from the apex, which is
    /// `past_apex` along the line where double cone and plane meet.
    fn viewpoint(&self, past_apex: f64, hair: f64) -> DVec3 {
        let NormalCone { sin, cos, .. } = self.bound.cone;
        let Sphere { center, radius } = self.bound.sphere;
        let along = radius * sin / cos + past_apex;
        center + radius * self.normal + along * self.climb - hair * past_apex * self.normal
    }

    /// Whether `viewpoint` is certainly behind the rim's plane, in f64, and in front of another
    /// that the bound admits: the one across the axis, as far down as the sphere reaches.
    fn is_between(&self, viewpoint: Viewpoint) -> bool {
        let from_center = viewpoint.from_point(self.bound.sphere.center);
        let radius = viewpoint.w() * self.bound.sphere.radius;
        let doubt = 1e-14 * (from_center.length() + radius);
        self.normal.dot(from_center) < radius - doubt
            && self.bound.cone.axis.dot(from_center) > doubt - radius
    }

    /// Viewpoints from which the rim's plane is seen from another side than some other: a point, a
    /// direction, and both mirrored.
    fn viewpoints(&self, past_apex: f64, hair: f64) -> impl Iterator<Item = Viewpoint> {
        let (point, center) = (self.viewpoint(past_apex, hair), self.bound.sphere.center);
        let direction = self.climb - hair * self.normal;
        [
            [point, 2.0 * center - point].map(Viewpoint::at),
            [direction, -direction].map(Viewpoint::from_direction),
        ]
        .into_iter()
        .filter(|[viewpoint, _]| self.is_between(*viewpoint))
        .flatten()
    }
}

proptest! {
    #![proptest_config(cases(100_000))]

    /// Ring 3. The worst plane that a spatialized normal cone admits, built from the bound itself
    /// and seen from a hair behind, and from the mirrored point on the other side.
    #[test]
    fn ring_3_rim_of_the_spatialized_cone(
        rim in rim(), past_apex in magnitude(-6.0, 4.0), hair in magnitude(-9.0, -1.0),
    ) {
        for viewpoint in rim.viewpoints(past_apex, hair) {
            prop_assert!(rim.bound.may_hold_contour(viewpoint), "{viewpoint:?}");
        }
    }

    /// The same for the run-time form: what it was made from must survive in it, f32 or not.
    #[test]
    fn ring_3_rim_of_the_double_cone(
        rim in rim(), past_apex in magnitude(-6.0, 4.0), hair in magnitude(-9.0, -1.0),
    ) {
        let cone = DoubleCone::from(rim.bound);
        for viewpoint in rim.viewpoints(past_apex, hair) {
            prop_assert!(cone.may_hold_contour(viewpoint), "{viewpoint:?}");
        }
    }
}

proptest! {
    #![proptest_config(cases(100_000))]

    /// Viewpoints on the very surface of a run-time cone, solved for: f32 decides by noise, and
    /// what it culls must still hold no contour edge.
    #[test]
    fn ring_3_surface_of_the_double_cone(
        (subject, patch) in patch(), face in any::<prop::sample::Index>(), bound in 0..SPATIALIZED + 1,
        past_apex in magnitude(-6.0, 4.0), turn in magnitude(-9.0, 0.5), side in sign(),
    ) {
        let cone = patch.double_cones[bound];
        if cone == DoubleCone::ALWAYS {
            return Ok(());
        }
        let axis = cone.axis.as_dvec3().normalize();
        // Where the face's plane is steepest, the cone is nearest to it.
        let (_, normal) = *face.get(&patch.faces);
        let downhill = axis.dot(normal) * axis - normal;
        let downhill = downhill.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        let across = turn.cos() * downhill + turn.sin() * axis.cross(downhill);
        let reach = past_apex * patch.size;
        let height = f64::from(cone.apex_distance) + f64::from(cone.tan_squared).sqrt() * reach;
        let offset = side * (height * axis + reach * across);
        subject.check(patch, Viewpoint::at(cone.center.as_dvec3() + offset))?;
        let slope = f64::from(cone.tan_squared).sqrt() * axis + across;
        subject.check(patch, Viewpoint::from_direction(side * slope))?;
    }
}

/// Directions spread evenly over the sphere, opposite ones both: a Fibonacci spiral, mirrored.
fn even_directions(count: u32) -> impl Iterator<Item = DVec3> {
    let golden_turn = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).flat_map(move |i| {
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (golden_turn * f64::from(i)).sin_cos();
        let across = (1.0 - z * z).sqrt();
        let direction = DVec3::new(across * cos, across * sin, z);
        [direction, -direction]
    })
}

/// Shares of patches and viewpoints that are culled, seen from the front and from the back.
fn culled_shares(
    subject: &Subject,
    viewpoint: impl Fn(DVec3) -> Viewpoint,
    may_hold_contour: impl Fn(&Patch, Viewpoint) -> bool,
) -> [f64; 2] {
    let mut culled = [0.0; 2];
    let mut asked = 0.0;
    for direction in even_directions(500) {
        for patch in &subject.patches {
            asked += 1.0;
            if !may_hold_contour(patch, viewpoint(direction)) {
                culled[usize::from(patch.bounds[0].cone.axis.dot(direction) < 0.0)] += 1.0;
            }
        }
    }
    culled.map(|culled| culled / asked)
}

/// Ring 4. A smooth ball is mostly culled, from the front as from the back; or a bound that is
/// never wrong because it never culls would pass.
#[test]
fn ring_4_a_smooth_ball_is_mostly_culled() {
    let smooth = SUBJECTS.iter().find(|subject| subject.name == "smooth").unwrap();
    let far = |direction| Viewpoint::at(50.0 * direction);
    let check = |viewpoint: fn(DVec3) -> Viewpoint, kind: usize, is_double: bool| {
        let may_hold = |p: &Patch, v| {
            if is_double {
                p.double_cones[kind].may_hold_contour(v)
            } else {
                p.bounds[kind].may_hold_contour(v)
            }
        };
        let [front, back] = culled_shares(smooth, viewpoint, may_hold);
        assert!(front > 0.4 && back > 0.4, "bound {kind}: {front} and {back} culled");
    };
    for kind in 0..SPATIALIZED {
        check(far, kind, false);
        check(Viewpoint::from_direction, kind, false);
    }
    for kind in 0..=SPATIALIZED {
        check(far, kind, true);
        check(Viewpoint::from_direction, kind, true);
    }
}

/// What survives is as much as the cost model expects: neither form is wider than it says.
#[test]
fn ring_4_the_acceptance_comes_true() {
    let bound = SpatializedNormalCone {
        cone: NormalCone { axis: DVec3::X, sin: 0.3f64.sin(), cos: 0.3f64.cos() },
        sphere: Sphere { center: DVec3::new(0.5, 0.25, 2.0), radius: 0.7 },
    };
    let cone = DoubleCone::from(bound);
    for distance in [0.5, 0.8, 1.5, 10.0, f64::INFINITY] {
        let viewpoint = |direction: DVec3| {
            if distance.is_finite() {
                Viewpoint::at(bound.sphere.center + distance * direction)
            } else {
                Viewpoint::from_direction(direction)
            }
        };
        let share = |may_hold_contour: &dyn Fn(Viewpoint) -> bool| {
            let directions = even_directions(20_000);
            let survivors = directions.filter(|&d| may_hold_contour(viewpoint(d))).count();
            survivors as f64 / 40_000.0
        };
        let measured =
            [share(&|v| bound.may_hold_contour(v)), share(&|v| cone.may_hold_contour(v))];
        let expected = [bound.acceptance(distance), cone.acceptance(distance)];
        for (measured, expected) in measured.into_iter().zip(expected) {
            assert!((measured - expected).abs() < 1e-3, "{distance}: {measured}, not {expected}");
        }
    }
}
