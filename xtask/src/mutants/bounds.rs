//! Ways to break `drypoint-bounds`.

use super::{Mutant, mutant};

const CONE: &str = "crates/bounds/src/cone.rs";
const SPHERE: &str = "crates/bounds/src/sphere.rs";
const SPATIALIZED: &str = "crates/bounds/src/spatialized.rs";
const DOUBLE: &str = "crates/bounds/src/double_cone.rs";
const TIGHT: &str = "crates/bounds/src/tight.rs";
const SPREAD: &str = "crates/bounds/src/least_spread.rs";

pub(super) const BOUNDS: &[Mutant] = &[
    mutant(
        "`SpatializedNormalCone`: radius × 0.97",
        SPATIALIZED,
        "viewpoint.w() * self.sphere.radius",
        "viewpoint.w() * 0.97 * self.sphere.radius",
    ),
    mutant(
        "`SpatializedNormalCone`: radius × 0.8",
        SPATIALIZED,
        "viewpoint.w() * self.sphere.radius",
        "viewpoint.w() * 0.8 * self.sphere.radius",
    ),
    mutant(
        "`SpatializedNormalCone`: radius × 0.5",
        SPATIALIZED,
        "viewpoint.w() * self.sphere.radius",
        "viewpoint.w() * 0.5 * self.sphere.radius",
    ),
    mutant(
        "`SpatializedNormalCone`: sin × 0.97",
        SPATIALIZED,
        "height > sin * tangent",
        "height > 0.97 * sin * tangent",
    ),
    mutant(
        "`SpatializedNormalCone`: lost `abs`",
        SPATIALIZED,
        "axis.dot(to_viewpoint).abs()",
        "axis.dot(to_viewpoint)",
    ),
    mutant(
        "`SpatializedNormalCone`: `return true`",
        SPATIALIZED,
        "!is_culled",
        "is_culled || true",
    ),
    mutant(
        "`DoubleCone`: radius × 0.97",
        DOUBLE,
        "sphere.radius / wider.cos()",
        "0.97 * sphere.radius / wider.cos()",
    ),
    mutant(
        "`DoubleCone`: radius × 0.8",
        DOUBLE,
        "sphere.radius / wider.cos()",
        "0.8 * sphere.radius / wider.cos()",
    ),
    mutant(
        "`DoubleCone`: radius × 0.5",
        DOUBLE,
        "sphere.radius / wider.cos()",
        "0.5 * sphere.radius / wider.cos()",
    ),
    mutant(
        "`DoubleCone`: sin × 0.97",
        DOUBLE,
        "cone.half_angle() + tilt",
        "(0.97 * cone.sin).atan2(cone.cos) + tilt",
    ),
    mutant("`DoubleCone`: lost `abs`", DOUBLE, "height.abs()", "height"),
    mutant("`DoubleCone`: `return true`", DOUBLE, "!is_culled", "is_culled || true"),
    mutant(
        "`DoubleCone`: no inflation",
        DOUBLE,
        "pub const SLACK: f64 = 8.0",
        "pub const SLACK: f64 = 0.0",
    ),
    mutant(
        "`DoubleCone`: \\|w\\|² − h² for \\|p\\|²",
        DOUBLE,
        "across.length_squared()",
        "(to_viewpoint.length_squared() - height * height)",
    ),
    mutant(
        "`DoubleCone`: squares below 2⁻¹²⁶ trusted",
        DOUBLE,
        "MIN_CLEARANCE: f32 = 1.0",
        "MIN_CLEARANCE: f32 = 0.0",
    ),
    mutant(
        "`DoubleCone`: t not dropped in orthographic views",
        DOUBLE,
        "height.abs() - w * self.apex_distance",
        "height.abs() - w.max(1.0) * self.apex_distance",
    ),
    mutant(
        "`NormalCone`: sine by √(1 − cos²)",
        CONE,
        "normal.cross(axis).length_squared()",
        "1.0 - normal_cos * normal_cos",
    ),
    mutant(
        "`NormalCone::minimal`: a support too few",
        "crates/bounds/src/cap.rs",
        "        consider(a + last, [last, a, a], 2);",
        "        consider(a, [last, a, a], 2);",
    ),
    mutant(
        "`Sphere::reduced`: radius × 0.97",
        SPHERE,
        "radius: largest(edges",
        "radius: 0.97 * largest(edges",
    ),
    mutant(
        "`Sphere::mean`: radius × 0.97",
        SPHERE,
        "radius: largest(points",
        "radius: 0.97 * largest(points",
    ),
    mutant(
        "`Sphere::minimal`: radius × 0.97",
        SPHERE,
        "minimal.radius < reduced.radius { minimal }",
        "minimal.radius < reduced.radius { Self { radius: 0.97 * minimal.radius, ..minimal } }",
    ),
    mutant(
        "`Sphere::minimal`: the Reduced Sphere",
        SPHERE,
        "minimal.radius < reduced.radius { minimal }",
        "minimal.radius < reduced.radius { reduced }",
    ),
    mutant(
        "`Sphere::minimal`: an end too soon",
        "crates/bounds/src/least_ball.rs",
        "const TOLERANCE: f64 = 1e-8",
        "const TOLERANCE: f64 = 1e-2",
    ),
    mutant(
        "`DoubleCone`: t not grown",
        DOUBLE,
        "SLACK * apex_distance / half_angle.cos()",
        "0.0 * apex_distance",
    ),
    mutant(
        "`DoubleCone`: α not grown",
        DOUBLE,
        "half_angle + SLACK;\n        let growth",
        "half_angle;\n        let growth",
    ),
    mutant(
        "`DoubleCone::tight`: t × 0.999",
        TIGHT,
        "largest(planes.map(crossing))",
        "0.999 * largest(planes.map(crossing))",
    ),
    mutant(
        "`DoubleCone::tight`: t of the center before it is rounded",
        TIGHT,
        "largest(planes.map(crossing))",
        "0.5 * (high - low)",
    ),
    mutant(
        "`DoubleCone::about`: α about another axis",
        TIGHT,
        "NormalCone::around(axis, planes",
        "NormalCone::minimal(planes",
    ),
    mutant(
        "`DoubleCone::tight`: normals trusted without doubt",
        TIGHT,
        "NORMAL_ERROR: f64 = 1.0",
        "NORMAL_ERROR: f64 = 0.0",
    ),
    mutant(
        "`DoubleCone::tight`: moved along the axis the wrong way",
        TIGHT,
        "point + 0.5 * (low + high) * axis",
        "point - 0.5 * (low + high) * axis",
    ),
    mutant(
        "`DoubleCone::tight`: the mean cone",
        TIGHT,
        "Self::about(cap.axis,",
        "Self::about(NormalCone::mean(planes.clone().map(|plane| plane.normal)).axis,",
    ),
    mutant(
        "`DoubleCone::tight`: about the mean of the points",
        SPREAD,
        "    start + place.x * right + place.y * up",
        "    start + 0.0 * (place.x * right + place.y * up)",
    ),
    mutant(
        "`DoubleCone::tight`: the center far off",
        SPREAD,
        ".clamp_length_max(reach)",
        ".clamp_length_max(9.0 * reach)",
    ),
];
