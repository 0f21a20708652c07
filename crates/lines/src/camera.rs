//! A viewpoint with a lens and a page: where a point of the model lands on paper.

use drypoint_mesh::Viewpoint;
use glam::{DVec2, DVec3};

/// Largest size of a coordinate that [`Viewpoint`] is exact for.
const MAX_COORDINATE: f64 = 1e60;

/// Below this sine two directions are taken as parallel.
const PARALLEL: f64 = 1e-9;

/// Most pixels of a side of the [`Page`].
const MAX_SIDE: u32 = 65_535;

/// The paper, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page {
    /// 1 to 65,535.
    pub width: u32,
    /// 1 to 65,535.
    pub height: u32,
    /// Kept free at each side when a view is fitted to a mesh; lines are clipped at the border of
    /// the page, not at the margin. At least 0 and below half the shorter side.
    pub margin: f64,
}

/// A viewpoint, a lens and a [`Page`]. All in f64: nothing is rounded before a point is on paper.
///
/// On the page x runs to the right and y **down**, in pixels, from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    viewpoint: Viewpoint,
    /// Lands in the middle of the page in an orthographic view; the eye in a perspective one.
    origin: DVec3,
    frame: Frame,
    /// Pixels a model unit takes, at depth 1 if in perspective.
    scale: f64,
    page: Page,
}

/// Directions of the view, of length 1 and at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    right: DVec3,
    up: DVec3,
    /// From the scene towards the viewer.
    back: DVec3,
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

    /// The nearest perspective view from the direction `towards_viewer` in which all `points` are
    /// within the page's margin. Exact and linear: the four sides of the view pyramid each touch a
    /// point, or two opposite ones do and the points are in the middle between the others.
    ///
    /// Without points it looks at the origin from a distance of 1.
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn fit_perspective(
        points: impl IntoIterator<Item = DVec3>,
        towards_viewer: DVec3,
        up: Option<DVec3>,
        vertical_fov: f64,
        page: Page,
    ) -> Result<Self, CameraError> {
        let frame = Frame::new(towards_viewer, up)?;
        let scale = focal_length(vertical_fov, page)?;
        let [tan_x, tan_y] = page.half_inside().map(|half| half / scale);
        // A point is inside if |x − eye x| ≤ tan (eye z − z), z towards the viewer. Each side of
        // the page so asks for a least value of tan · eye z ± eye x.
        let sides = [
            frame.right + tan_x * frame.back,
            -frame.right + tan_x * frame.back,
            frame.up + tan_y * frame.back,
            -frame.up + tan_y * frame.back,
            frame.back,
        ];
        let Extent { most: [right, left, top, bottom, front], center, radius } =
            Extent::new(points, sides);
        // Points in one place, or in a line with the eye, must not end up on the eye.
        let away = if radius > 0.0 { 1e-3 * radius } else { 1.0 };
        let distance =
            (0.5 * (right + left) / tan_x).max(0.5 * (top + bottom) / tan_y).max(front + away);
        let offset = 0.5 * (right - left) * frame.right + 0.5 * (top - bottom) * frame.up;
        let eye = center + offset + distance * frame.back;
        check_point("the eye", eye)?;
        Ok(Self { viewpoint: Viewpoint::at(eye), origin: eye, frame, scale, page })
    }

    /// The orthographic view from the direction `towards_viewer` in which all `points` just fill
    /// the page within its margin. Without points, or if all are in one line with the viewer, the
    /// page is 1 unit high.
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn fit_orthographic(
        points: impl IntoIterator<Item = DVec3>,
        towards_viewer: DVec3,
        up: Option<DVec3>,
        page: Page,
    ) -> Result<Self, CameraError> {
        page.check()?;
        let frame = Frame::new(towards_viewer, up)?;
        let sides = [frame.right, -frame.right, frame.up, -frame.up];
        let Extent { most: [right, left, top, bottom], center, .. } = Extent::new(points, sides);
        let [half_width, half_height] = page.half_inside();
        let units = (0.5 * (right + left) / half_width).max(0.5 * (top + bottom) / half_height);
        let height = if units > 0.0 { units * f64::from(page.height) } else { 1.0 };
        let offset = 0.5 * (right - left) * frame.right + 0.5 * (top - bottom) * frame.up;
        Self::orthographic(towards_viewer, center + offset, up, height, page)
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

impl Page {
    fn check(&self) -> Result<(), CameraError> {
        let Self { width, height, margin } = *self;
        if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(CameraError::Page { width, height });
        }
        if !(margin >= 0.0 && 2.0 * margin < f64::from(width.min(height))) {
            return Err(CameraError::Margin { margin, width, height });
        }
        Ok(())
    }

    /// Half the width and half the height within the margin.
    fn half_inside(&self) -> [f64; 2] {
        self.sides().map(|side| 0.5 * side - self.margin)
    }

    fn sides(&self) -> [f64; 2] {
        [self.width, self.height].map(f64::from)
    }
}

impl Frame {
    fn new(towards_viewer: DVec3, up: Option<DVec3>) -> Result<Self, CameraError> {
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

/// How far points reach in N directions.
struct Extent<const N: usize> {
    /// Largest dot product with each direction, from the center.
    most: [f64; N],
    /// Of the box around the points.
    center: DVec3,
    /// Half the diagonal of that box.
    radius: f64,
}

impl<const N: usize> Extent<N> {
    /// All zero without points.
    fn new(points: impl IntoIterator<Item = DVec3>, directions: [DVec3; N]) -> Self {
        let mut most = [f64::NEG_INFINITY; N];
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for point in points {
            (min, max) = (min.min(point), max.max(point));
            for (most, direction) in most.iter_mut().zip(directions) {
                *most = most.max(direction.dot(point));
            }
        }
        if min.x > max.x {
            return Self { most: [0.0; N], center: DVec3::ZERO, radius: 0.0 };
        }
        let center = 0.5 * (min + max);
        for (most, direction) in most.iter_mut().zip(directions) {
            *most -= direction.dot(center);
        }
        Self { most, center, radius: 0.5 * (max - min).length() }
    }
}

/// Pixels from the eye to a page of that height.
fn focal_length(vertical_fov: f64, page: Page) -> Result<f64, CameraError> {
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

fn check_point(what: &'static str, point: DVec3) -> Result<(), CameraError> {
    if point.is_finite() && point.abs().max_element() <= MAX_COORDINATE {
        Ok(())
    } else {
        Err(CameraError::Coordinates { what, point })
    }
}

/// Why there is no such view.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is NaN, infinite or beyond 1e60.
    #[error("{what} is ({}, {}, {}), which is not finite or beyond 1e60", point.x, point.y, point.z)]
    Coordinates {
        /// The parameter.
        what: &'static str,
        /// Its value.
        point: DVec3,
    },
    /// The eye is where it looks.
    #[error("eye and target are both at ({}, {}, {})", eye.x, eye.y, eye.z)]
    EyeAtTarget {
        /// That point.
        eye: DVec3,
    },
    /// The direction towards the viewer is zero.
    #[error("the direction of the view is (0, 0, 0)")]
    NoDirection,
    /// The direction that points up is zero.
    #[error("the direction up is (0, 0, 0)")]
    NoUp,
    /// The direction that was to point up points at the viewer, or away.
    #[error("up ({}, {}, {}) is parallel to the view", up.x, up.y, up.z)]
    UpParallel {
        /// That direction.
        up: DVec3,
    },
    /// The field of view is not between 0 and 180 degrees.
    #[error("a field of view of {degrees} degrees is not between 0 and 180")]
    FieldOfView {
        /// What was asked for.
        degrees: f64,
    },
    /// An orthographic view of no height.
    #[error("a view {height} units high is not above 0")]
    Height {
        /// What was asked for.
        height: f64,
    },
    /// A page without area, or too large.
    #[error("a page of {width} x {height} pixels is not between 1 and 65535 on each side")]
    Page {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// A margin that leaves no page.
    #[error("a margin of {margin} pixels leaves nothing of a page of {width} x {height}")]
    Margin {
        /// Pixels.
        margin: f64,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
}
