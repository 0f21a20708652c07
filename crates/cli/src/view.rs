//! From the options of a view to a camera.

use drypoint_lines::{Camera, CameraError, Page};
use drypoint_mesh::Mesh;
use glam::{DMat3, DVec3};

use crate::args::{Side, ViewArgs};

/// In degrees, unless the user says otherwise.
const FIELD_OF_VIEW: f64 = 30.0;

/// Within this many degrees of straight up or down the up axis gives no direction on the page.
const NEARLY_VERTICAL: f64 = 1e-6;

/// The camera that the options ask for.
pub(crate) fn camera(args: &ViewArgs, mesh: &Mesh) -> Result<Camera, String> {
    if let Some(distance) = args.distance.filter(|&distance| distance <= 0.0) {
        return Err(format!("--distance: {distance} is not above 0"));
    }
    let [width, height] = args.size;
    let margin = args.margin.unwrap_or(0.04 * f64::from(width.min(height)));
    if margin < 0.0 {
        return Err(format!("--margin: {margin} is below 0"));
    }
    build(args, mesh, Page { width, height, margin }).map_err(|error| {
        let option = match error {
            CameraError::EyeAtTarget { .. } => "--eye",
            CameraError::NoUp | CameraError::UpParallel { .. } => "--up",
            CameraError::FieldOfView { .. } => "--fov",
            CameraError::Height { .. } => "--height",
            CameraError::Page { .. } => "--size",
            CameraError::Margin { .. } => "--margin",
            CameraError::Coordinates { .. } | CameraError::NoDirection => "view",
        };
        format!("{option}: {error}")
    })
}

fn build(args: &ViewArgs, mesh: &Mesh, page: Page) -> Result<Camera, CameraError> {
    let center = mesh.bounds().map_or(DVec3::ZERO, |bounds| bounds.center());
    let target = args.target.unwrap_or(center);
    let (towards_viewer, up) = match args.eye {
        Some(eye) if eye == target => return Err(CameraError::EyeAtTarget { eye }),
        Some(eye) => (eye - target, args.up),
        None => direction(args),
    };
    let fov = args.fov.unwrap_or(FIELD_OF_VIEW);
    let ahead = towards_viewer.normalize_or_zero();
    let points = || {
        let mesh = mesh.triangles().iter().flatten().map(|&v| mesh.position(v).as_dvec3());
        // With every point its mirror image beyond the line of sight: so the view that fits them
        // has the target in its middle.
        let mirrored = move |p: DVec3| 2.0 * (target + (p - target).dot(ahead) * ahead) - p;
        mesh.flat_map(move |p| [Some(p), args.target.is_some().then(|| mirrored(p))]).flatten()
    };
    match (args.eye, args.distance, args.height) {
        (_, _, Some(height)) => Camera::orthographic(towards_viewer, target, up, height, page),
        _ if args.ortho => Camera::fit_orthographic(points(), towards_viewer, up, page),
        (Some(eye), ..) => Camera::perspective(eye, target, up, fov, page),
        (None, Some(distance), _) => {
            Camera::perspective(target + distance * ahead, target, up, fov, page)
        }
        _ => Camera::fit_perspective(points(), towards_viewer, up, fov, page),
    }
}

/// The direction towards the viewer and what points up on the page, by side or by angles.
///
/// Angles are measured around the up axis. For the default, +Y, the front is what faces +Z; any
/// other up axis turns the whole frame with it, so that for +Z the front is what faces −Y.
fn direction(args: &ViewArgs) -> (DVec3, Option<DVec3>) {
    let (azimuth, elevation) = angles(args);
    let (sin, cos) = sin_cos(azimuth);
    let ahead = DVec3::new(sin, 0.0, cos);
    let (rise, level) = sin_cos(elevation);
    let towards_viewer = level * ahead + rise * DVec3::Y;
    // Seen from straight above or below, what lies ahead of the viewer points up on the page.
    let pole = 90.0 - elevation.abs() < NEARLY_VERTICAL;
    let up_on_page = if pole { -rise.signum() * ahead } else { DVec3::Y };
    match args.up.map(DVec3::try_normalize) {
        None => (towards_viewer, Some(up_on_page)),
        Some(Some(up)) => {
            let turn = turn_to(up);
            (turn * towards_viewer, Some(turn * up_on_page))
        }
        // No direction: passed on, to be refused with its reason.
        Some(None) => (towards_viewer, args.up),
    }
}

/// The rotation that takes +Y to `up` the shortest way. Exact for the axes, so that an axis-aligned
/// face seen edge-on stays so; from −Y half a turn around X.
fn turn_to(up: DVec3) -> DMat3 {
    if up.y < -1.0 + 1e-12 {
        return DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    }
    let k = 1.0 / (1.0 + up.y);
    DMat3::from_cols(
        DVec3::new(1.0 - k * up.x * up.x, -up.x, -k * up.x * up.z),
        up,
        DVec3::new(-k * up.x * up.z, -up.z, 1.0 - k * up.z * up.z),
    )
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}

/// Azimuth and elevation in degrees.
fn angles(args: &ViewArgs) -> (f64, f64) {
    /// From here the three axes of a cube are equally long on paper: atan(1 / √2).
    const ISOMETRIC: f64 = 35.264_389_682_754_654;
    let (azimuth, elevation) = match args.view.unwrap_or(Side::Iso) {
        Side::Front => (0.0, 0.0),
        Side::Right => (90.0, 0.0),
        Side::Back => (180.0, 0.0),
        Side::Left => (270.0, 0.0),
        Side::Top => (0.0, 90.0),
        Side::Bottom => (0.0, -90.0),
        Side::Iso if args.azimuth.is_none() && args.elevation.is_none() => (45.0, ISOMETRIC),
        Side::Iso => (0.0, 0.0),
    };
    (args.azimuth.unwrap_or(azimuth), args.elevation.unwrap_or(elevation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_axes_turn_the_frame_exactly() {
        for up in [DVec3::Y, DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z, -DVec3::Y] {
            let turn = turn_to(up);
            assert_eq!(turn * DVec3::Y, up);
            assert_eq!((turn * turn.transpose(), turn.determinant()), (DMat3::IDENTITY, 1.0));
        }
        assert_eq!(turn_to(DVec3::Z) * DVec3::Z, -DVec3::Y, "a part on its feet is seen from −Y");
        let slanted = DVec3::new(0.48, 0.6, -0.64);
        assert!((turn_to(slanted) * DVec3::Y).distance(slanted) < 1e-15);
        assert!((turn_to(slanted).determinant() - 1.0).abs() < 1e-15);
    }
}
