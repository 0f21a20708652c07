//! A viewpoint with a lens and a page: where a point of the model lands on paper.

use drypoint_mesh::Viewpoint;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::{CameraError, Page};

/// Largest size of a coordinate that [`Viewpoint`] is exact for.
const MAX_COORDINATE: f64 = 1e60;

/// Below this sine two directions are taken as parallel.
const PARALLEL: f64 = 1e-9;

/// A viewpoint, a lens and a [`Page`]. All in f64: nothing is rounded before a point is on paper.
///
/// On the page x runs to the right and y **down**, in pixels, from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub(crate) viewpoint: Viewpoint,
    /// Lands in the middle of the page in an orthographic view; the eye in a perspective one.
    pub(crate) origin: DVec3,
    pub(crate) frame: Frame,
    /// Pixels a model unit takes, at depth 1 if in perspective.
    pub(crate) scale: f64,
    pub(crate) page: Page,
}

/// Directions of the view, of length 1 and at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    /// From the scene towards the viewer.
    pub(crate) back: DVec3,
}

/// What of a segment is on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clipped {
    /// Fractions of the segment, 0 and 1 where nothing was cut.
    pub(crate) range: [f64; 2],
    /// The ends on the page.
    pub(crate) page: [DVec2; 2],
    /// Depths of the ends; both 1 in an orthographic view.
    depths: [f64; 2],
}

impl Clipped {
    /// Pixels from end to end.
    pub(crate) fn length(&self) -> f64 {
        self.page[0].distance(self.page[1])
    }

    /// The fraction of the *segment in space* at a fraction of what is seen on the page. Fractions
    /// on paper are not those in space: the far half of a receding line is the shorter one.
    #[cfg_attr(
        not(feature = "visibility"),
        allow(dead_code, reason = "only rays go back to space")
    )]
    pub(crate) fn fraction_in_space(&self, on_page: f64) -> f64 {
        let [near, far] = [(1.0 - on_page) * self.depths[1], on_page * self.depths[0]];
        let within = if near + far > 0.0 { far / (near + far) } else { on_page };
        self.range[0] + within * (self.range[1] - self.range[0])
    }
}

impl Camera {
    /// A perspective view from `eye` to `target`, with a vertical field of view in degrees.
    ///
    /// `up` is what points up on the page; `None` is +Y, or if that is along the view, −Z seen from
    /// above and +Z from below, so that what faces +Z is nearest to the viewer's feet.
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn perspective(
        eye: DVec3,
        target: DVec3,
        up: Option<DVec3>,
        vertical_fov: f64,
        page: Page,
    ) -> Result<Self, CameraError> {
        check_point("the eye", eye)?;
        check_point("the target", target)?;
        if eye == target {
            return Err(CameraError::EyeAtTarget { eye });
        }
        let frame = Frame::new(eye - target, up)?;
        let scale = focal_length(vertical_fov, page)?;
        Ok(Self { viewpoint: Viewpoint::at(eye), origin: eye, frame, scale, page })
    }

    /// An orthographic view of `target` from the direction `towards_viewer`, of any length, with
    /// `height` model units from the lower to the upper border of the page. For `up` see
    /// [`Camera::perspective`].
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn orthographic(
        towards_viewer: DVec3,
        target: DVec3,
        up: Option<DVec3>,
        height: f64,
        page: Page,
    ) -> Result<Self, CameraError> {
        check_point("the target", target)?;
        let frame = Frame::new(towards_viewer, up)?;
        page.check()?;
        let scale = f64::from(page.height) / height;
        if !(height > 0.0 && scale.is_finite() && scale > 0.0) {
            return Err(CameraError::Height { height });
        }
        let viewpoint = Viewpoint::from_direction(towards_viewer);
        Ok(Self { viewpoint, origin: target, frame, scale, page })
    }

    /// The same camera, carried along as `rotation` turns space around the point `about`: what turns with it
    /// stays where it is on the page.
    pub fn turned(&self, rotation: DMat3, about: DVec3) -> Self {
        let place = |point: DVec3| about + rotation * (point - about);
        let Frame { right, up, back } = self.frame;
        let [right, up, back] = [right, up, back].map(|axis| rotation * axis);
        let viewpoint = if self.viewpoint.is_point() {
            Viewpoint::at(place(self.viewpoint.xyz()))
        } else {
            Viewpoint::from_direction(rotation * self.viewpoint.xyz())
        };
        let (origin, frame) = (place(self.origin), Frame { right, up, back });
        Self { viewpoint, origin, frame, ..*self }
    }

    /// The eye as it was given, or the direction towards the viewer.
    pub fn viewpoint(&self) -> Viewpoint {
        self.viewpoint
    }

    /// The paper.
    pub fn page(&self) -> Page {
        self.page
    }

    /// Where `point` lands on the page, in pixels; `None` if it is not in front of the eye. In an
    /// orthographic view every point is in front.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let h = self.homogeneous(point);
        (h.z > 0.0).then(|| DVec2::new(h.x / h.z, h.y / h.z))
    }

    /// Model units that a pixel covers at the depth of `point`; not above 0 unless it is in front
    /// of the eye.
    pub fn pixel_size(&self, point: DVec3) -> f64 {
        self.homogeneous(point).z / self.scale
    }

    /// How far `point` is ahead: of the eye, or of the target in an orthographic view. In model units, along
    /// the line of sight.
    pub fn depth(&self, point: DVec3) -> f64 {
        -self.frame.back.dot(point - self.origin)
    }

    /// The same view for a GPU: from model units to clip space, where the page runs from -w to w, y **up**,
    /// and z from 0 at the first of two different depths to w at the second. For reversed depth the first is
    /// the larger one. In perspective both are above 0.
    pub fn clip_matrix(&self, [first, second]: [f64; 2]) -> DMat4 {
        let row = |axis: DVec3, scale: f64| (scale * axis).extend(-scale * axis.dot(self.origin));
        let [width, height] = self.page.sides();
        let x = row(self.frame.right, 2.0 * self.scale / width);
        let y = row(self.frame.up, 2.0 * self.scale / height);
        let depth = row(self.frame.back, -1.0);
        let range = second - first;
        let (z, w) = if self.viewpoint.is_point() {
            (second / range * depth - first * second / range * DVec4::W, depth)
        } else {
            (depth / range - first / range * DVec4::W, DVec4::W)
        };
        DMat4::from_cols(x, y, z, w).transpose()
    }

    /// What of the segment from `a` to `b` is on the page, if anything. A segment that passes the
    /// plane of the eye is cut, not mirrored.
    pub(crate) fn clip(&self, a: DVec3, b: DVec3) -> Option<Clipped> {
        let [from, to] = [self.homogeneous(a), self.homogeneous(b)];
        // A line through the eye itself has no place on the page there.
        let nearest = 1e-9 * from.z.abs().max(to.z.abs());
        let [width, height] = self.page.sides();
        let inside = |h: DVec3| [h.z - nearest, h.x, width * h.z - h.x, h.y, height * h.z - h.y];
        let mut range = [0.0f64, 1.0f64];
        for (at_from, at_to) in inside(from).into_iter().zip(inside(to)) {
            if at_from < 0.0 && at_to < 0.0 {
                return None;
            }
            let crossing = at_from / (at_from - at_to);
            if at_from < 0.0 {
                range[0] = range[0].max(crossing);
            } else if at_to < 0.0 {
                range[1] = range[1].min(crossing);
            }
        }
        if range[0] >= range[1] {
            return None;
        }
        let ends = range.map(|t| from + t * (to - from));
        let page = ends.map(|h| DVec2::new(h.x / h.z, h.y / h.z));
        let seen = page.iter().all(|p| p.is_finite()) && ends.iter().all(|h| h.z > 0.0);
        seen.then(|| Clipped { range, page, depths: ends.map(|h| h.z) })
    }

    /// (x w, y w, w) of a point on the page: linear in the point, so that segments can be cut
    /// before they are divided by the depth w.
    fn homogeneous(&self, point: DVec3) -> DVec3 {
        let from_origin = point - self.origin;
        let x = self.scale * self.frame.right.dot(from_origin);
        let y = self.scale * self.frame.up.dot(from_origin);
        let w = if self.viewpoint.is_point() { -self.frame.back.dot(from_origin) } else { 1.0 };
        let [width, height] = self.page.sides();
        DVec3::new(0.5 * width * w + x, 0.5 * height * w - y, w)
    }
}

impl Frame {
    pub(crate) fn new(towards_viewer: DVec3, up: Option<DVec3>) -> Result<Self, CameraError> {
        check_point("the direction of the view", towards_viewer)?;
        if towards_viewer == DVec3::ZERO {
            return Err(CameraError::NoDirection);
        }
        let back = unit(towards_viewer);
        let right = match up {
            Some(up) => {
                check_point("up", up)?;
                if up == DVec3::ZERO {
                    return Err(CameraError::NoUp);
                }
                Some(unit(up).cross(back)).filter(|right| right.length() > PARALLEL)
            }
            None => [DVec3::Y, DVec3::new(0.0, 0.0, -back.y.signum())]
                .map(|up| up.cross(back))
                .into_iter()
                .find(|right| right.length() > PARALLEL),
        };
        let right = right.ok_or(CameraError::UpParallel { up: up.unwrap_or(DVec3::Y) })?;
        let right = right.normalize();
        Ok(Self { right, up: back.cross(right), back })
    }
}

/// Pixels from the eye to a page of that height.
pub(crate) fn focal_length(vertical_fov: f64, page: Page) -> Result<f64, CameraError> {
    page.check()?;
    let tan = (0.5 * vertical_fov.to_radians()).tan();
    let focal_length = 0.5 * f64::from(page.height) / tan;
    if !(vertical_fov > 0.0 && vertical_fov < 180.0 && focal_length.is_finite()) {
        return Err(CameraError::FieldOfView { degrees: vertical_fov });
    }
    Ok(focal_length)
}

/// Length 1, whatever the length: 1e-60 squared is still an f64, but 1e-200 is not.
fn unit(direction: DVec3) -> DVec3 {
    (direction / direction.abs().max_element()).normalize()
}

pub(crate) fn check_point(what: &'static str, point: DVec3) -> Result<(), CameraError> {
    if point.is_finite() && point.abs().max_element() <= MAX_COORDINATE {
        Ok(())
    } else {
        Err(CameraError::Coordinates { what, point })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Page = Page { width: 400, height: 200, margin: 10.0 };

    fn ahead() -> Camera {
        // Half the height of the page is 1 unit at a distance of 1.
        Camera::perspective(DVec3::Z, DVec3::ZERO, None, 90.0, PAGE).unwrap()
    }

    #[track_caller]
    fn check(camera: &Camera, point: [f64; 3], expected: Option<[f64; 2]>) {
        let found = camera.project(DVec3::from_array(point));
        match (found, expected.map(DVec2::from_array)) {
            (Some(found), Some(expected)) if found.distance(expected) < 1e-9 => {}
            (None, None) => {}
            (found, expected) => panic!("{point:?} lands at {found:?}, not {expected:?}"),
        }
    }

    #[test]
    fn right_is_right_and_up_is_up() {
        check(&ahead(), [0.0, 0.0, 0.0], Some([200.0, 100.0]));
        check(&ahead(), [1.0, 0.5, 0.0], Some([300.0, 50.0]));
        check(&ahead(), [1.0, 0.5, -1.0], Some([250.0, 75.0]));
        check(&ahead(), [0.0, 0.0, 1.0], None);
        check(&ahead(), [0.0, 0.0, 2.0], None);
        let flat = Camera::orthographic(DVec3::Z * 1e-60, DVec3::X, None, 2.0, PAGE).unwrap();
        check(&flat, [2.0, 0.5, 77.0], Some([300.0, 50.0]));
        assert_eq!(flat.pixel_size(DVec3::ONE), 0.01);
        assert!((ahead().pixel_size(DVec3::NEG_Z) - 0.02).abs() < 1e-15);
    }

    #[test]
    fn the_front_is_at_the_viewers_feet_seen_from_above_and_below() {
        let seen_from = |y: f64| {
            let eye = DVec3::new(0.0, y, 0.0);
            let camera = Camera::perspective(eye, DVec3::ZERO, None, 90.0, PAGE).unwrap();
            camera.project(DVec3::Z).unwrap()
        };
        assert!(seen_from(1.0).y > 100.0, "the near side of a table is low on the page");
        assert!(seen_from(-1.0).y < 100.0, "the near side of a ceiling is high on the page");
        assert_eq!((seen_from(1.0).x, seen_from(-1.0).x), (200.0, 200.0));
    }

    #[test]
    fn the_viewpoint_is_the_eye_as_given() {
        let eye = DVec3::new(0.1, 1e-30, -7e12);
        let camera = Camera::perspective(eye, DVec3::ONE, None, 30.0, PAGE).unwrap();
        assert_eq!(camera.viewpoint(), Viewpoint::at(eye));
        let camera = Camera::orthographic(eye, DVec3::ONE, None, 1.0, PAGE).unwrap();
        assert_eq!(camera.viewpoint(), Viewpoint::from_direction(eye));
    }

    #[test]
    fn what_turns_with_the_camera_stays_on_the_page() {
        let (about, point) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.25, -0.5, -0.125));
        let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.0);
        let flat = Camera::orthographic(DVec3::ONE, DVec3::X, None, 2.0, PAGE).unwrap();
        for camera in [ahead(), flat] {
            let turned = camera.turned(turn, about);
            let [before, after] = [
                camera.project(point).unwrap(),
                turned.project(about + turn * (point - about)).unwrap(),
            ];
            assert!(before.distance(after) < 1e-9, "{before} is not {after}");
            assert_eq!(turned.viewpoint().is_point(), camera.viewpoint().is_point());
            assert!(turned.viewpoint().xyz().distance(camera.viewpoint().xyz()) > 0.5);
        }
    }

    #[track_caller]
    fn check_clip(from: [f64; 3], to: [f64; 3], expected: Option<[f64; 2]>) {
        let [from, to] = [from, to].map(DVec3::from_array);
        let clipped = ahead().clip(from, to);
        match (clipped.map(|c| c.range), expected) {
            (Some(found), Some(expected)) => {
                let apart = found[0] - expected[0] + found[1] - expected[1];
                assert!(apart.abs() < 1e-9, "{found:?} is not {expected:?}");
            }
            (found, expected) => assert_eq!(found, expected),
        }
        let back = ahead().clip(to, from).map(|c| c.length());
        assert_eq!(back.is_some(), clipped.is_some());
        if let (Some(back), Some(clipped)) = (back, clipped) {
            assert!((back - clipped.length()).abs() < 1e-4, "direction matters");
        }
    }

    #[test]
    fn segments_are_cut_at_the_border_of_the_page() {
        check_clip([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], Some([0.0, 1.0]));
        check_clip([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], Some([0.0, 0.5]));
        check_clip([0.0, -2.0, 0.0], [0.0, 2.0, 0.0], Some([0.25, 0.75]));
        check_clip([-3.0, 1.5, 0.0], [3.0, 1.5, 0.0], None);
        check_clip([0.0, 1.6, 0.0], [3.0, 0.0, 0.0], Some([0.375, 2.0 / 3.0]));
        check_clip([0.0, 3.2, 0.0], [3.0, 0.0, 0.0], None);
    }

    #[test]
    fn segments_behind_the_eye_are_cut_not_mirrored() {
        check_clip([0.0, 0.0, 2.0], [0.0, 0.0, 3.0], None);
        // Down the middle of the floor: seen from where the ray to the lower border meets it.
        check_clip([0.0, -1.0, -1.0], [0.0, -1.0, 3.0], Some([0.0, 0.25]));
        // Through the eye itself: seen up to it.
        check_clip([0.0, 0.0, -1.0], [0.0, 0.0, 3.0], Some([0.0, 0.5]));
        // In the plane of the eye.
        check_clip([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], None);
    }

    #[test]
    fn the_middle_on_paper_is_nearer_to_the_near_end() {
        let camera = ahead();
        let [a, b] = [DVec3::new(-0.5, 0.0, 0.0), DVec3::new(1.0, 0.3, -3.0)];
        let clipped = camera.clip(a, b).unwrap();
        for on_page in [0.0, 0.25, 0.5, 1.0] {
            let expected = clipped.page[0].lerp(clipped.page[1], on_page);
            let point = a.lerp(b, clipped.fraction_in_space(on_page));
            assert!(camera.project(point).unwrap().distance(expected) < 1e-9);
        }
        assert!(clipped.fraction_in_space(0.5) < 0.3);
    }

    #[test]
    fn a_gpu_sees_the_same_page() {
        let (eye, target) = (DVec3::new(3.0, 2.0, 9.0), DVec3::new(0.5, 0.0, -1.0));
        let perspective = Camera::perspective(eye, target, None, 40.0, PAGE).unwrap();
        let orthographic = Camera::orthographic(eye, target, None, 7.0, PAGE).unwrap();
        for camera in [perspective, orthographic] {
            for point in [DVec3::ZERO, DVec3::new(1.0, -0.5, 2.0), DVec3::new(-2.0, 0.3, 0.1)] {
                let depth = camera.depth(point);
                for (depths, z) in [([depth, 20.0], 0.0), ([20.0, depth], 1.0)] {
                    let ndc = camera.clip_matrix(depths).project_point3(point);
                    let page = DVec2::new(200.0 + 200.0 * ndc.x, 100.0 - 100.0 * ndc.y);
                    assert!(page.distance(camera.project(point).unwrap()) < 1e-9);
                    assert!((ndc.z - z).abs() < 1e-12, "{} is not {z}", ndc.z);
                }
            }
        }
    }

    #[test]
    fn impossible_views_say_why() {
        let nan = DVec3::new(f64::NAN, 0.0, 0.0);
        let eye = DVec3::new(0.0, 3.0, 0.0);
        let view = |eye, target, up, fov, page: Page| {
            Camera::perspective(eye, target, up, fov, page).unwrap_err().to_string()
        };
        let none = DVec3::ZERO;
        assert_eq!(
            view(nan, none, None, 30.0, PAGE),
            "the eye is (NaN, 0, 0), which is not finite or beyond 1e60"
        );
        assert_eq!(view(eye, eye, None, 30.0, PAGE), "eye and target are both at (0, 3, 0)");
        assert_eq!(
            view(eye, none, Some(DVec3::Y), 30.0, PAGE),
            "up (0, 1, 0) is parallel to the view"
        );
        assert_eq!(view(eye, none, Some(none), 30.0, PAGE), "the direction up is (0, 0, 0)");
        for fov in [0.0, -1.0, 180.0, 1e-320, f64::NAN, f64::INFINITY] {
            assert!(view(eye, none, None, fov, PAGE).contains("is not between 0 and 180"));
        }
        let page =
            |width, height, margin| view(eye, none, None, 30.0, Page { width, height, margin });
        assert!(page(0, 9, 0.0).starts_with("a page of 0 x 9 pixels is not"));
        assert!(page(9, 65_536, 0.0).starts_with("a page of 9 x 65536 pixels is not"));
        for margin in [-1.0, 4.5, f64::NAN] {
            assert!(page(9, 100, margin).ends_with("leaves nothing of a page of 9 x 100"));
        }
        for height in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Camera::orthographic(eye, none, None, height, PAGE).unwrap_err();
            assert!(matches!(error, CameraError::Height { .. }));
        }
        let error = Camera::orthographic(none, none, None, 1.0, PAGE).unwrap_err();
        assert_eq!(error, CameraError::NoDirection);
    }
}
