//! A camera that turns around the middle of the scene.

use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};
use glam::{DVec3, Mat4};

pub(crate) struct Orbit {
    /// Radians around the vertical axis, and above the horizon.
    angles: [f64; 2],
    distance: f64,
    radius: f64,
    pub(crate) is_turning: bool,
    pointer: [f64; 2],
}

impl Orbit {
    /// Around a scene of that radius.
    pub(crate) fn around(radius: f64, is_turning: bool) -> Self {
        let pointer = [0.0; 2];
        Self { angles: [0.6, 0.5], distance: 2.2 * radius, radius, is_turning, pointer }
    }

    pub(crate) fn turn(&mut self, seconds: f64) {
        if self.is_turning {
            self.angles[0] += 0.2 * seconds.min(0.1);
        }
    }

    /// Takes where the pointer is, in pixels, and turns after it if it drags.
    pub(crate) fn point_at(&mut self, to: [f64; 2], drags: bool) {
        if drags {
            self.angles[0] -= 0.005 * (to[0] - self.pointer[0]);
            self.angles[1] = (self.angles[1] + 0.005 * (to[1] - self.pointer[1])).clamp(-1.5, 1.5);
        }
        self.pointer = to;
    }

    /// By so many notches of a wheel.
    pub(crate) fn come_closer(&mut self, notches: f64) {
        let nearest = 0.05 * self.radius.min(1.0);
        self.distance = (self.distance * 0.9f64.powf(notches)).clamp(nearest, 20.0 * self.radius);
    }

    pub(crate) fn eye(&self) -> DVec3 {
        let [around, above] = self.angles;
        let aside = above.cos();
        self.distance * DVec3::new(aside * around.sin(), above.sin(), aside * around.cos())
    }

    /// From the scene to clip space, for a picture of that width over height.
    pub(crate) fn scene_to_clip(&self, aspect: f64) -> Mat4 {
        let far = self.distance + 2.0 * self.radius;
        let near = (self.distance - 2.0 * self.radius).max(1e-3 * far);
        let lens = perspective(40f64.to_radians(), aspect, near, far);
        (lens * look_at_mat4(self.eye(), DVec3::ZERO, DVec3::Y)).as_mat4()
    }
}
