//! A window on a field of instances: what the viewers of all runtimes have in common.

use std::error::Error;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use drypoint_mesh::{io, shapes};
use drypoint_shaders::Method;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

use crate::field::{self, Field};
use crate::orbit::Orbit;

/// What every viewer is asked for.
#[derive(Debug, clap::Args)]
pub(crate) struct AppArgs {
    /// An OBJ, PLY, STL or glTF file; a torus knot without.
    model: Option<PathBuf>,
    /// Number of instances.
    #[arg(long, default_value_t = 252, value_parser = clap::value_parser!(u32).range(1..))]
    instances: u32,
    /// Begin without culling.
    #[arg(long)]
    brute_force: bool,
    /// Begin at rest.
    #[arg(long)]
    still: bool,
}

/// What draws in a window. It goes before the window does.
pub(crate) trait Show: Sized {
    /// What it alone is asked for.
    type Args;

    /// Begins to show `field` in `window`.
    fn open(
        args: &Self::Args,
        field: &Rc<Field>,
        window: &Arc<Window>,
        event_loop: &ActiveEventLoop,
    ) -> Result<Self, Box<dyn Error>>;

    /// Takes another size of the window, at least a pixel a side.
    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>>;

    /// Draws a frame and shows it.
    fn draw(&mut self, orbit: &Orbit, method: Method) -> Result<(), Box<dyn Error>>;

    /// Hears the key of a letter, in lower case.
    fn press(&mut self, letter: &str);

    /// For the title.
    fn summary(&self) -> String;
}

/// What is open while the window is.
struct Open<S> {
    show: S,
    window: Arc<Window>,
    /// Without pixels while it is minimised: nothing is drawn then.
    is_visible: bool,
}

struct App<S: Show> {
    args: S::Args,
    field: Rc<Field>,
    orbit: Orbit,
    method: Method,
    open: Option<Open<S>>,
    is_dragging: bool,
    last_frame: Instant,
    last_title: Instant,
    /// Why it ended, if not because somebody closed it.
    failure: Option<Box<dyn Error>>,
}

/// Opens a window, and returns when it was closed.
pub(crate) fn run<S: Show>(common: &AppArgs, args: S::Args) -> Result<(), Box<dyn Error>> {
    let mesh = match &common.model {
        Some(path) => io::read(path).map_err(|error| format!("{}: {error}", path.display()))?.mesh,
        None => shapes::torus_knot(20_000),
    };
    if mesh.triangles().is_empty() {
        return Err("the model has no triangles".into());
    }
    let now = Instant::now();
    let mut app = App::<S> {
        args,
        field: Rc::new(Field::new(mesh, common.instances)?),
        orbit: Orbit::around(field::radius(common.instances), !common.still),
        method: if common.brute_force { Method::BruteForce } else { Method::Patches },
        open: None,
        is_dragging: false,
        last_frame: now,
        last_title: now,
        failure: None,
    };
    EventLoop::new()?.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

impl<S: Show> App<S> {
    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Open<S>, Box<dyn Error>> {
        let size = PhysicalSize::new(1280, 800);
        let attributes = Window::default_attributes().with_title("Drypoint").with_inner_size(size);
        let window = Arc::new(event_loop.create_window(attributes)?);
        let show = S::open(&self.args, &self.field, &window, event_loop)?;
        Ok(Open { show, window, is_visible: true })
    }

    fn resize(&mut self, size: PhysicalSize<u32>) -> Result<(), Box<dyn Error>> {
        let Some(open) = &mut self.open else { return Ok(()) };
        open.is_visible = size.width > 0 && size.height > 0;
        if open.is_visible {
            open.show.resize([size.width, size.height])?;
            open.window.request_redraw();
        }
        Ok(())
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        let Some(Open { show, window, is_visible: true }) = &mut self.open else { return Ok(()) };
        let elapsed = self.last_frame.elapsed();
        self.last_frame = Instant::now();
        self.orbit.turn(elapsed.as_secs_f64());
        show.draw(&self.orbit, self.method)?;
        if self.last_title.elapsed() > Duration::from_millis(250) {
            self.last_title = Instant::now();
            window.set_title(&format!("{}; {elapsed:.1?} a frame", show.summary()));
        }
        window.request_redraw();
        Ok(())
    }

    fn press(&mut self, key: &Key, event_loop: &ActiveEventLoop) {
        let Some(Open { show, .. }) = &mut self.open else { return };
        match key {
            Key::Named(NamedKey::Escape) => event_loop.exit(),
            Key::Named(NamedKey::Space) => self.orbit.is_turning ^= true,
            Key::Character(letter) if letter.eq_ignore_ascii_case("c") => {
                self.method = match self.method {
                    Method::BruteForce => Method::Patches,
                    Method::Patches => Method::BruteForce,
                };
            }
            Key::Character(letter) => show.press(&letter.to_lowercase()),
            _ => {}
        }
    }

    /// Ends if something failed.
    fn check(&mut self, event_loop: &ActiveEventLoop, done: Result<(), Box<dyn Error>>) {
        if let Err(failure) = done {
            self.failure = Some(failure);
            event_loop.exit();
        }
    }
}

impl<S: Show> ApplicationHandler for App<S> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_none() {
            let opened = self.open(event_loop).map(|open| self.open = Some(open));
            self.check(event_loop, opened);
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // While there still is what it was made from.
        self.open = None;
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                let resized = self.resize(size);
                self.check(event_loop, resized);
            }
            WindowEvent::RedrawRequested => {
                let drawn = self.draw();
                self.check(event_loop, drawn);
            }
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                self.press(&event.logical_key, event_loop);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.is_dragging = state == ElementState::Pressed;
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.orbit.point_at([position.x, position.y], self.is_dragging);
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let lines = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / 40.0,
                };
                self.orbit.come_closer(lines);
            }
            _ => {}
        }
    }
}
