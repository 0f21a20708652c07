//! Views that just hold a set of points.

use drypoint_mesh::Viewpoint;
use glam::DVec3;

use crate::camera::{Frame, check_point, focal_length};
use crate::{Camera, CameraError, Page};

impl Camera {
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const PAGE: Page = Page { width: 300, height: 200, margin: 20.0 };

    fn point() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    /// All points are within the margin, and none is left on opposite sides of it.
    fn check(camera: &Camera, points: &[DVec3]) -> Result<(), TestCaseError> {
        let seen: Vec<_> = points.iter().filter_map(|&p| camera.project(p)).collect();
        prop_assert_eq!(seen.len(), points.len());
        let room = |p: &glam::DVec2| {
            let [x, y] = [p.x - PAGE.margin, p.y - PAGE.margin];
            [x, 260.0 - x, y, 160.0 - y]
        };
        let least = seen.iter().map(room).fold([f64::INFINITY; 4], |least, room| {
            std::array::from_fn(|side| least[side].min(room[side]))
        });
        prop_assert!(least.iter().all(|&room| room > -1e-6), "{least:?} is outside the margin");
        let fills = |i: usize| least[i].abs() < 1e-6 && least[i + 1].abs() < 1e-6;
        prop_assert!(fills(0) || fills(2), "{least:?} leaves room");
        Ok(())
    }

    proptest! {
        #[test]
        fn a_fitted_view_just_holds_all_points(
            points in proptest::collection::vec(point(), 2..20), towards_viewer in point(),
            fov in 1.0f64..120.0, far in -1e4f64..1e4,
        ) {
            prop_assume!(towards_viewer.length() > 0.1);
            let points: Vec<_> = points.iter().map(|&p| p + far).collect();
            let placed = || points.iter().copied();
            let spread = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
            prop_assume!(spread > 0.5);
            check(&Camera::fit_orthographic(placed(), towards_viewer, None, PAGE).unwrap(), &points)?;
            let camera = Camera::fit_perspective(placed(), towards_viewer, None, fov, PAGE).unwrap();
            // Two points one behind the other are not seen as far apart as the page is wide.
            let nearest = points.iter().map(|&p| camera.pixel_size(p)).fold(f64::INFINITY, f64::min);
            prop_assume!(nearest * camera.scale > 2e-3 * spread);
            check(&camera, &points)?;
        }
    }

    #[test]
    fn a_point_or_none_has_a_view_too() {
        let far = DVec3::splat(1e6);
        for points in [vec![], vec![far], vec![far, far], vec![far, far + DVec3::Z]] {
            let placed = || points.iter().copied();
            let views = [
                Camera::fit_perspective(placed(), DVec3::Z, None, 30.0, PAGE).unwrap(),
                Camera::fit_orthographic(placed(), DVec3::Z, None, PAGE).unwrap(),
            ];
            for (camera, point) in
                views.iter().flat_map(|view| points.iter().map(move |p| (view, p)))
            {
                let found = camera.project(*point).expect("in front of the eye");
                assert!(found.distance(glam::DVec2::new(150.0, 100.0)) < 1e-6);
            }
        }
    }
}
