//! Cones around the normals of faces.

use glam::DVec3;

use crate::cap::smallest_cap;

/// What a computed sine or cosine may be off by: a cross product, a length and the normals' own
/// rounding make some 4 units of 2⁻⁵³.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// How far a normal's squared length may be from 1.
const UNIT_TOLERANCE: f64 = 1e-9;

/// An axis, and the largest angle between it and any of a set of face normals: the half-angle α.
///
/// Sine and cosine are kept, and not the angle: the test needs these, and of a narrow cone the sine
/// is measured as |n × axis|, because √(1 − cos²) loses it to cancellation.
///
/// A cone of half-angle 90° or more says nothing, and is [`NormalCone::OPEN`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalCone {
    /// Unit length, up to rounding.
    pub axis: DVec3,
    /// Sine of α, rounded up. 1 if open.
    pub sin: f64,
    /// Cosine of α, rounded down. 0 or less, or NaN, if open.
    pub cos: f64,
}

impl NormalCone {
    /// Holds every direction; what it bounds is never culled.
    pub const OPEN: Self = Self { axis: DVec3::Z, sin: 1.0, cos: 0.0 };

    /// The cone around the mean of unit `normals` (Tsiapkolis and Bénard, CGF 2024, §3): each
    /// counts once, whatever the area of its face. Two scans.
    ///
    /// Open if there are none, if they cancel, or as [`NormalCone::around`] says.
    pub fn mean(normals: impl Iterator<Item = DVec3> + Clone) -> Self {
        let sum: DVec3 = normals.clone().sum();
        sum.try_normalize().map_or(Self::OPEN, |axis| Self::around(axis, normals))
    }

    /// The narrowest cone around unit `normals` (Barequet and Elber, 2005), to within rounding: never
    /// wider than [`NormalCone::mean`], for some 3 to 7 scans instead of 2.
    ///
    /// Open if there are none, or as [`NormalCone::around`] says.
    pub fn minimal(normals: impl Iterator<Item = DVec3> + Clone) -> Self {
        smallest_cap(normals.clone()).map_or(Self::OPEN, |cap| Self::around(cap.axis, normals))
    }

    /// The narrowest cone with this unit `axis` around unit `normals`: one scan. This is how a
    /// union is measured again, whose axis is known from the sum of its parts' normals.
    ///
    /// Open if a normal is 90° or more from the axis, or is not of unit length to within 1e-9, as
    /// those of faces without area are not, being zero or NaN. Without any normal: the axis alone.
    pub fn around(axis: DVec3, normals: impl Iterator<Item = DVec3>) -> Self {
        if !is_unit(axis) {
            return Self::OPEN;
        }
        let (mut sin_squared, mut cos) = (0f64, 1f64);
        for normal in normals {
            let normal_cos = normal.dot(axis);
            // NaN is neither positive nor of unit length.
            let is_held = normal_cos > 0.0 && is_unit(normal);
            if !is_held {
                return Self::OPEN;
            }
            sin_squared = sin_squared.max(normal.cross(axis).length_squared());
            cos = cos.min(normal_cos);
        }
        Self { axis, sin: (sin_squared.sqrt() + ROUNDING).min(1.0), cos: cos - ROUNDING }
    }

    /// The narrowest cone around two cones: conservative for the union, in constant time. Wider
    /// than [`NormalCone::around`] would measure over its normals, as rims rarely hold a normal
    /// where it matters. Open if either is, or the union takes 90° or more.
    #[must_use]
    pub fn merged(&self, other: &Self) -> Self {
        if self.is_open() || other.is_open() {
            return Self::OPEN;
        }
        let between = angle(self.axis, other.axis);
        let (near, far) = (self.half_angle(), other.half_angle());
        // Of two cones about the same axis one holds the other for sure; else the angle may be off.
        let doubt = if self.axis == other.axis { 0.0 } else { ROUNDING };
        if between + far + doubt <= near {
            return *self;
        }
        if between + near + doubt <= far {
            return *other;
        }
        // Turned from our axis towards the other one until both rims are at the same angle.
        let turn = 0.5 * (far - near + between);
        // At right angles to our axis, even if the other one is almost opposite.
        let towards = self.axis.cross(other.axis).cross(self.axis);
        let axis = towards
            .try_normalize()
            .map_or(self.axis, |towards| turn.cos() * self.axis + turn.sin() * towards)
            .normalize();
        // Measured about the axis that came of it, so that its rounding does no harm.
        let half_angle = (angle(axis, self.axis) + near).max(angle(axis, other.axis) + far);
        let (sin, cos) = half_angle.sin_cos();
        let merged = Self { axis, sin: (sin + ROUNDING).min(1.0), cos: cos - ROUNDING };
        if merged.is_open() { Self::OPEN } else { merged }
    }

    /// Whether it holds a hemisphere or more, so that it says nothing.
    pub fn is_open(&self) -> bool {
        self.sin.is_nan() || self.cos.is_nan() || self.cos <= 0.0
    }

    /// α in radians, 0 ..= π/2.
    pub fn half_angle(&self) -> f64 {
        if self.is_open() { std::f64::consts::FRAC_PI_2 } else { self.sin.atan2(self.cos) }
    }
}

/// In radians, 0 ..= π, to within rounding at both ends.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// Whether the length is 1 up to rounding; not if anything is NaN.
pub(crate) fn is_unit(v: DVec3) -> bool {
    (v.length_squared() - 1.0).abs() <= UNIT_TOLERANCE
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A unit vector at `angle` from +Z, turned by `turn` around it, both in radians.
    fn tilted(angle: f64, turn: f64) -> DVec3 {
        DVec3::new(angle.sin() * turn.cos(), angle.sin() * turn.sin(), angle.cos())
    }

    fn minimal(normals: &[DVec3]) -> NormalCone {
        NormalCone::minimal(normals.iter().copied())
    }

    fn mean(normals: &[DVec3]) -> NormalCone {
        NormalCone::mean(normals.iter().copied())
    }

    #[track_caller]
    fn check_half_angle(cone: NormalCone, expected: f64) {
        let error = (cone.half_angle() - expected).abs();
        assert!(error <= 1e-14, "{} is not {expected}", cone.half_angle());
    }

    #[test]
    fn one_normal_is_its_own_cone() {
        check_half_angle(mean(&[DVec3::X]), 0.0);
        check_half_angle(minimal(&[DVec3::X, DVec3::X]), 0.0);
    }

    /// Angles so small that √(1 − cos²) is 0 or off by half.
    #[test]
    fn narrow_cones_keep_their_sine() {
        for angle in [1e-3, 1e-6, 1e-8, 1e-10] {
            let normals = [tilted(angle, 0.0), tilted(angle, 2.5), tilted(angle, 4.0)];
            check_half_angle(NormalCone::around(DVec3::Z, normals.into_iter()), angle);
            check_half_angle(minimal(&normals), angle);
        }
    }

    #[test]
    fn two_normals_share_the_angle() {
        let normals = [DVec3::X, DVec3::Y];
        check_half_angle(mean(&normals), std::f64::consts::FRAC_PI_4);
        check_half_angle(minimal(&normals), std::f64::consts::FRAC_PI_4);
        // The mean leans to where more normals are, the smallest cap does not.
        let crowded = [DVec3::X, DVec3::Y, DVec3::Y, DVec3::Y];
        check_half_angle(mean(&crowded), 3f64.atan());
        check_half_angle(minimal(&crowded), std::f64::consts::FRAC_PI_4);
    }

    #[test]
    fn three_normals_hold_up_a_cap() {
        let normals = [tilted(0.4, 0.0), tilted(0.4, 2.0), tilted(0.4, 4.0), tilted(0.1, 1.0)];
        check_half_angle(minimal(&normals), 0.4);
        assert!(minimal(&normals).axis.distance(DVec3::Z) < 1e-14);
    }

    #[test]
    fn what_has_no_bound_is_open() {
        let opens: [&[DVec3]; 8] = [
            &[],
            &[DVec3::X, DVec3::NEG_X],
            &[tilted(1.6, 0.0), tilted(1.6, 2.0), tilted(1.6, 4.0), DVec3::Z],
            &[DVec3::X, DVec3::ZERO],
            &[DVec3::X, DVec3::NAN],
            &[DVec3::NAN, DVec3::X],
            &[DVec3::new(f64::INFINITY, 0.0, 0.0), DVec3::X],
            &[DVec3::new(2.0, 0.0, 0.0)],
        ];
        for normals in opens {
            assert_eq!(minimal(normals), NormalCone::OPEN, "{normals:?}");
            assert_eq!(mean(normals), NormalCone::OPEN, "{normals:?}");
        }
        assert!(NormalCone::around(DVec3::ZERO, [].into_iter()).is_open());
        check_half_angle(NormalCone::OPEN, std::f64::consts::FRAC_PI_2);
    }

    #[test]
    fn merging_keeps_the_wider_cone_or_spans_both() {
        let cone = |angle: f64, axis| NormalCone { axis, sin: angle.sin(), cos: angle.cos() };
        let (wide, narrow) = (cone(0.5, DVec3::Z), cone(0.1, tilted(0.3, 1.0)));
        assert_eq!(wide.merged(&narrow), wide);
        assert_eq!(narrow.merged(&wide), wide);
        // From inside: rounding decides which angle is larger, and it may be wrong.
        for turn in 0..20 {
            let touching = cone(0.2, tilted(0.3, f64::from(turn)));
            assert!(wide.merged(&touching).half_angle() > wide.half_angle());
        }
        let apart = wide.merged(&cone(0.1, tilted(0.8, 1.0)));
        check_half_angle(apart, 0.7);
        assert!(apart.axis.distance(tilted(0.2, 1.0)) < 1e-14);
        assert!(wide.merged(&cone(0.5, DVec3::NEG_Z)).is_open());
        assert!(wide.merged(&cone(0.8, tilted(2.0, 0.0))).is_open());
        assert!(wide.merged(&NormalCone::OPEN).is_open());
    }

    /// The first normal that the cone should hold, and does not, to the last bit.
    fn first_outside<'a>(
        cone: NormalCone,
        mut normals: impl Iterator<Item = &'a DVec3>,
    ) -> Option<&'a DVec3> {
        let is_held = |normal: &DVec3| {
            // What is above 1 is so by rounding.
            let sin = normal.cross(cone.axis).length().min(1.0);
            cone.is_open() || (sin <= cone.sin && normal.dot(cone.axis) >= cone.cos)
        };
        normals.find(|normal| !is_held(normal))
    }

    /// Normals in a cap of any width below a hemisphere.
    fn normals() -> impl Strategy<Value = Vec<DVec3>> {
        let normal = (0.0..1.0f64, 0.0..std::f64::consts::TAU);
        (proptest::collection::vec(normal, 1..40), -9.0..0.17f64, 0.0..3.0f64, 0.0..6.0f64)
            .prop_map(|(tilts, width, tilt, turn)| {
                let place = glam::DQuat::from_rotation_z(turn) * glam::DQuat::from_rotation_x(tilt);
                let width = 10f64.powf(width);
                tilts.into_iter().map(|(a, t)| (place * tilted(width * a, t)).normalize()).collect()
            })
    }

    proptest! {
        #[test]
        fn both_cones_hold_every_normal(normals in normals()) {
            let (mean, minimal) = (mean(&normals), minimal(&normals));
            prop_assert!(!minimal.is_open(), "all are within 85° of one axis");
            prop_assert!(minimal.half_angle() <= mean.half_angle() + 1e-14);
            for cone in [mean, minimal] {
                prop_assert!(first_outside(cone, normals.iter()).is_none());
            }
        }

        /// Optimality, without the algorithm: moving the axis any way makes some normal farther.
        #[test]
        fn no_other_axis_is_better(normals in normals(), turn in 0.0..6.0f64, step in 1e-3..1.0f64) {
            let best = minimal(&normals);
            let sideways = glam::DQuat::from_axis_angle(best.axis, turn) * best.axis.any_orthonormal_vector();
            let moved = (best.axis + step * best.sin * sideways).normalize();
            let other = NormalCone::around(moved, normals.iter().copied());
            prop_assert!(best.half_angle() <= other.half_angle() + 1e-14);
        }

        #[test]
        fn a_merged_cone_holds_both(a in normals(), b in normals()) {
            let merged = minimal(&a).merged(&minimal(&b));
            prop_assert!(first_outside(merged, a.iter().chain(&b)).is_none());
        }

        /// Of axes that are almost the same or almost opposite.
        #[test]
        fn a_merged_cone_holds_narrow_ones(
            a in normals(), turn in 0.0..6.3f64, gap in -16.0..0.0f64, is_opposite in any::<bool>(),
        ) {
            let a = [a[0], a[a.len() - 1]];
            let gap = 10f64.powf(gap);
            let (sin, cos) = if is_opposite { (gap.sin(), -gap.cos()) } else { gap.sin_cos() };
            let sideways = glam::DQuat::from_axis_angle(a[0], turn) * a[0].any_orthonormal_vector();
            let b = [(cos * a[0] + sin * sideways).normalize()];
            for (a, b) in [(&a[..1], &b[..]), (&a, &b), (&b, &a)] {
                let merged = minimal(a).merged(&minimal(b));
                prop_assert!(first_outside(merged, a.iter().chain(b)).is_none());
            }
        }
    }
}
