//! From the options of a view to a camera.

use std::borrow::Cow;

use clap::{Args, ValueEnum};
use drypoint_lines::{Camera, CameraError, Page};
use drypoint_mesh::Mesh;
use glam::{DMat3, DVec3};

use crate::args::{number, vector};

/// In degrees, unless the user says otherwise.
const FIELD_OF_VIEW: f64 = 30.0;

/// Within this many degrees of straight up or down the up axis gives no direction on the page.
const NEARLY_VERTICAL: f64 = 1e-6;

/// Where to look from, and on what page.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "View")]
pub(crate) struct ViewArgs {
    /// Where to look from, in the file's own coordinates
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["view", "azimuth", "elevation", "distance"])]
    pub(crate) eye: Option<DVec3>,
    /// Where to look at [default: center of the bounding box]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,
    /// Direction that points up on the page [default: 0,1,0; from straight above or below, what
    /// lies ahead]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) up: Option<DVec3>,
    /// Vertical field of view in degrees [default: 30]
    #[arg(long, value_name = "DEGREES", value_parser = number, conflicts_with = "ortho")]
    #[arg(allow_hyphen_values = true)]
    pub(crate) fov: Option<f64>,
    /// Look from this side, at a distance that fills the page [default: iso]
    #[arg(long, value_enum, conflicts_with_all = ["azimuth", "elevation"])]
    pub(crate) view: Option<Side>,
    /// Look from this angle around the up axis, in degrees: 0 from the front, 90 from the right
    #[arg(long, value_name = "DEGREES", value_parser = number, allow_hyphen_values = true)]
    pub(crate) azimuth: Option<f64>,
    /// Look from this angle above the horizon, in degrees, -90 to 90
    #[arg(long, value_name = "DEGREES", value_parser = elevation, allow_hyphen_values = true)]
    pub(crate) elevation: Option<f64>,
    /// Distance from the target, in the file's unit [default: so that the model fills the page]
    #[arg(long, value_name = "D", value_parser = number, allow_hyphen_values = true)]
    #[arg(conflicts_with = "ortho")]
    pub(crate) distance: Option<f64>,
    /// Draw without perspective
    #[arg(long)]
    pub(crate) ortho: bool,
    /// Height of the page in the file's unit, without perspective [default: so that the model
    /// fills the page]
    #[arg(long, value_name = "H", value_parser = number, requires = "ortho")]
    #[arg(allow_hyphen_values = true)]
    pub(crate) height: Option<f64>,
    /// Size of the page in pixels
    #[arg(long, value_name = "WxH", default_value = "1000x1000", value_parser = size)]
    pub(crate) size: [u32; 2],
    /// Free border around a model that fills the page, in pixels [default: 4 % of the shorter side]
    #[arg(long, value_name = "PIXELS", value_parser = number, allow_hyphen_values = true)]
    pub(crate) margin: Option<f64>,
}

/// A side to look from.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Side {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    /// From the front, the right and above, each as much
    Iso,
}

/// Points that a view is to hold.
pub(crate) trait Points {
    /// Middle of the box around them.
    fn center(&self) -> DVec3;
    /// All of them.
    fn points(&self) -> impl Iterator<Item = DVec3>;
}

impl Points for Mesh {
    fn center(&self) -> DVec3 {
        self.bounds().map_or(DVec3::ZERO, |bounds| bounds.center())
    }

    fn points(&self) -> impl Iterator<Item = DVec3> {
        corners(Cow::Borrowed(self))
    }
}

/// The corners of all triangles: not vertices that none uses.
pub(crate) fn corners(mesh: Cow<'_, Mesh>) -> impl Iterator<Item = DVec3> {
    let count = 3 * mesh.triangles().len();
    let corner = move |i: usize| mesh.position(mesh.triangles()[i / 3][i % 3]).as_dvec3();
    (0..count).map(corner)
}

/// The camera that the options ask for.
pub(crate) fn camera(args: &ViewArgs, model: &impl Points) -> Result<Camera, String> {
    let page = page(args)?;
    build(args, model, page).map_err(refusal)
}

/// The page that the options ask for; a distance that makes no sense is refused.
fn page(args: &ViewArgs) -> Result<Page, String> {
    if let Some(distance) = args.distance.filter(|&distance| distance <= 0.0) {
        return Err(format!("--distance: {distance} is not above 0"));
    }
    let [width, height] = args.size;
    let margin = args.margin.unwrap_or(0.04 * f64::from(width.min(height)));
    if margin < 0.0 {
        return Err(format!("--margin: {margin} is below 0"));
    }
    Ok(Page { width, height, margin })
}

/// Names the option that is to blame.
fn refusal(error: CameraError) -> String {
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
}

/// Cameras that go around the up axis through the target, one for each of `turns`, in degrees from where the
/// options look from. What they see, `model` of its index, fits all of them at one distance.
pub(crate) fn turntable<'a>(
    args: &ViewArgs,
    center: DVec3,
    turns: &[f64],
    model: impl Fn(usize) -> Cow<'a, Mesh>,
) -> Result<Vec<Camera>, String> {
    let axis = turn_to(args.up.and_then(DVec3::try_normalize).unwrap_or(DVec3::Y));
    let turn = |degrees: f64| {
        let (sin, cos) = sin_cos(degrees);
        let around_y =
            DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos));
        axis * around_y * axis.transpose()
    };
    let turns: Vec<DMat3> = turns.iter().map(|&degrees| turn(degrees)).collect();
    let about = args.target.unwrap_or(center);
    let first = camera(args, &Turning { turns: &turns, about, center, model })?;
    Ok(turns.iter().map(|&turn| first.turned(turn, about)).collect())
}

/// What a camera sees that stands still while all turns the other way.
struct Turning<'a, F> {
    turns: &'a [DMat3],
    about: DVec3,
    center: DVec3,
    model: F,
}

impl<'m, F: Fn(usize) -> Cow<'m, Mesh>> Points for Turning<'_, F> {
    fn center(&self) -> DVec3 {
        self.center
    }

    fn points(&self) -> impl Iterator<Item = DVec3> {
        let about = self.about;
        // One surface in memory at a time.
        self.turns.iter().enumerate().flat_map(move |(index, turn)| {
            let back = turn.transpose();
            corners((self.model)(index)).map(move |point| about + back * (point - about))
        })
    }
}

fn build(args: &ViewArgs, model: &impl Points, page: Page) -> Result<Camera, CameraError> {
    let target = args.target.unwrap_or_else(|| model.center());
    let (towards_viewer, up) = match args.eye {
        Some(eye) if eye == target => return Err(CameraError::EyeAtTarget { eye }),
        Some(eye) => (eye - target, args.up),
        None => direction(args),
    };
    let fov = args.fov.unwrap_or(FIELD_OF_VIEW);
    let ahead = towards_viewer.normalize_or_zero();
    let points = || {
        // With every point its mirror image beyond the line of sight: so the view that fits them
        // has the target in its middle.
        let mirrored = move |p: DVec3| 2.0 * (target + (p - target).dot(ahead) * ahead) - p;
        model
            .points()
            .flat_map(move |p| [Some(p), args.target.is_some().then(|| mirrored(p))])
            .flatten()
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

fn elevation(text: &str) -> Result<f64, String> {
    let degrees = number(text)?;
    let seen = (-90.0..=90.0).contains(&degrees);
    seen.then_some(degrees).ok_or("the angle must be within -90 and 90".to_owned())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    /// Most pixels a side: a PNG of this size is 1 GiB in memory.
    const MOST: u32 = 16_384;
    let parts = text.split_once(['x', 'X', '×']).ok_or("WIDTHxHEIGHT is wanted, as 800x600")?;
    let side = |text: &str| match text.trim().parse() {
        Ok(pixels) if (1..=MOST).contains(&pixels) => Ok(pixels),
        _ => Err(format!("'{text}' is no number of pixels from 1 to {MOST}")),
    };
    Ok([side(parts.0)?, side(parts.1)?])
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    #[test]
    fn a_turn_goes_round_the_up_axis_and_keeps_its_distance() {
        let target = DVec3::new(1.0, 2.0, 3.0);
        let turns = [0.0, 90.0, 180.0, 270.0];
        let cube = drypoint_mesh::shapes::by_name("cube", 12).unwrap();
        let mut command = crate::args::Cli::try_parse_from([
            "drypoint", "draw", "--view", "right", "--target", "1,2,3",
        ]);
        let Ok(crate::args::Cli { command: crate::args::Command::Draw(args) }) = &mut command
        else {
            panic!("draw draws")
        };
        let eyes = |args: &ViewArgs| -> Vec<DVec3> {
            let found = turntable(args, target, &turns, |_| Cow::Borrowed(&cube)).unwrap();
            found.iter().map(|camera| camera.viewpoint().xyz() - target).collect()
        };
        let found = eyes(&args.view);
        let far = found[0].x;
        let expected = [DVec3::X, -DVec3::Z, -DVec3::X, DVec3::Z].map(|side| far * side);
        assert!(far > 1.0 && found.iter().zip(expected).all(|(f, e)| f.distance(e) < 1e-9 * far));
        args.view = ViewArgs { eye: Some(target + DVec3::X), view: None, ..args.view.clone() };
        args.view.up = Some(DVec3::Z);
        assert_eq!(eyes(&args.view), [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y]);
    }

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
