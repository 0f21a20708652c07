//! A window on hundreds of instances of a model, each with its contours, as the demo application of
//! Tsiapkolis and Bénard (CGF 2024): `viewer [MODEL] [--instances N]`.
//!
//! Drag to turn, scroll to come closer. `C` switches culling by patches, `P` shows patches in colors, space
//! stops the turning, escape ends. The title tells what was tested and how long the GPU took for it.

mod colored;
mod orbit;
mod scene;
mod target;

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::Parser;
use drypoint_mesh::{Mesh, io, shapes};
use drypoint_wgpu::Method;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

use orbit::Orbit;
use scene::Scene;
use target::Target;

/// Shows the contours of many instances of a model.
///
/// Drag to turn, scroll to come closer. C switches culling, P shows patches in colors, space stops the
/// turning, escape ends.
#[derive(Debug, Parser)]
struct Args {
    /// An OBJ, PLY, STL or glTF file; a torus knot without.
    model: Option<PathBuf>,
    /// Number of instances.
    #[arg(long, default_value_t = 252, value_parser = clap::value_parser!(u32).range(1..))]
    instances: u32,
    /// Begin without culling.
    #[arg(long)]
    brute_force: bool,
    /// Begin with patches in colors.
    #[arg(long)]
    patches: bool,
    /// Begin at rest.
    #[arg(long)]
    still: bool,
}

/// What is open while the window is.
struct Open {
    window: Arc<Window>,
    target: Target,
    scene: Scene,
}

struct App {
    args: Args,
    mesh: Mesh,
    orbit: Orbit,
    open: Option<Open>,
    is_dragging: bool,
    last_frame: Instant,
    last_title: Instant,
    /// Why it ended, if not because somebody closed it.
    failure: Option<Box<dyn Error>>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let mesh = match &args.model {
        Some(path) => io::read(path)?.mesh,
        None => shapes::torus_knot(20_000),
    };
    if mesh.triangles().is_empty() {
        return Err("the model has no triangles".into());
    }
    let now = Instant::now();
    let mut app = App {
        orbit: Orbit::around(scene::radius(args.instances), !args.still),
        args,
        mesh,
        open: None,
        is_dragging: false,
        last_frame: now,
        last_title: now,
        failure: None,
    };
    EventLoop::new()?.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

impl App {
    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Open, Box<dyn Error>> {
        let size = PhysicalSize::new(1280, 800);
        let attributes = Window::default_attributes().with_title("Drypoint").with_inner_size(size);
        let window = Arc::new(event_loop.create_window(attributes)?);
        let target = Target::new(&window, event_loop.owned_display_handle())?;
        let mut scene = Scene::new(&target, &self.mesh, self.args.instances)?;
        if self.args.brute_force {
            scene.method = Method::BruteForce;
        }
        scene.shows_patches = self.args.patches;
        Ok(Open { window, target, scene })
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        let Some(Open { window, target, scene }) = &mut self.open else { return Ok(()) };
        let elapsed = self.last_frame.elapsed();
        self.last_frame = Instant::now();
        self.orbit.turn(elapsed.as_secs_f64());
        scene.look_back(target, &self.mesh)?;
        target.draw(scene, &self.orbit)?;
        if self.last_title.elapsed() > Duration::from_millis(250) {
            self.last_title = Instant::now();
            window.set_title(&scene.summary(elapsed));
        }
        window.request_redraw();
        Ok(())
    }

    fn press(&mut self, key: &Key, event_loop: &ActiveEventLoop) {
        let Some(Open { scene, .. }) = &mut self.open else { return };
        match key {
            Key::Named(NamedKey::Escape) => event_loop.exit(),
            Key::Named(NamedKey::Space) => self.orbit.is_turning ^= true,
            Key::Character(letter) if letter.eq_ignore_ascii_case("p") => {
                scene.shows_patches ^= true
            }
            Key::Character(letter) if letter.eq_ignore_ascii_case("c") => {
                scene.method = match scene.method {
                    Method::BruteForce => Method::Patches,
                    Method::Patches => Method::BruteForce,
                };
            }
            _ => {}
        }
    }

    fn end(&mut self, event_loop: &ActiveEventLoop, failure: Box<dyn Error>) {
        self.failure = Some(failure);
        event_loop.exit();
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(event_loop) {
                Ok(open) => self.open = Some(open),
                Err(failure) => self.end(event_loop, failure),
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                if let Err(failure) = open.target.resize([size.width, size.height]) {
                    self.end(event_loop, failure.into());
                }
            }
            WindowEvent::RedrawRequested => {
                if let Err(failure) = self.draw() {
                    self.end(event_loop, failure);
                }
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
