//! A window on hundreds of instances of a model, each with its contours, drawn by task and mesh shaders:
//! `mesh_viewer [MODEL] [--instances N]`. It is the `viewer` of `drypoint-wgpu` with Vulkan's own calls, and shows
//! how a renderer with several frames under way calls `drypoint-ash`.
//!
//! Drag to turn, scroll to come closer. `C` switches culling by patches, `V` switches between one pass of mesh
//! shaders and two passes with compute shaders, space stops the turning, escape ends. The title tells what was
//! tested, how many mesh workgroups were launched, and how long the GPU took for a frame.
#![allow(unsafe_code, reason = "Vulkan's own calls; each block says what it relies on")]

#[path = "../../../wgpu/examples/viewer/app.rs"]
mod app;
#[path = "../../../wgpu/examples/viewer/field.rs"]
mod field;
mod frames;
#[path = "../../../wgpu/examples/viewer/orbit.rs"]
mod orbit;
mod scene;
mod swapchain;

use std::error::Error;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::Parser;
use drypoint_ash::{Gpu, GpuOptions, Listener, Method};
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

use app::{AppArgs, Show};
use field::Field;
use frames::Frames;
use orbit::Orbit;
use scene::{Scene, Shaders};
use swapchain::Swapchain;

/// Shows the contours of many instances of a model, drawn by task and mesh shaders.
///
/// Drag to turn, scroll to come closer. C switches culling, V switches between mesh shaders and compute shaders,
/// space stops the turning, escape ends.
#[derive(Debug, Parser)]
struct Args {
    #[command(flatten)]
    app: AppArgs,
    #[command(flatten)]
    own: OwnArgs,
}

#[derive(Debug, clap::Args)]
struct OwnArgs {
    /// Begin with compute shaders.
    #[arg(long)]
    compute: bool,
    /// Ask Vulkan's validation layers, and fail if they have something to say.
    #[arg(long)]
    validate: bool,
}

/// Members go in this order, and wait until the device is idle.
struct Viewer {
    frames: Frames,
    scene: Scene,
    swapchain: Swapchain,
    gpu: Gpu,
    /// Of the window.
    size: [u32; 2],
    /// Of the newest frame.
    method: Method,
}

/// What the validation layers said.
static MESSAGES: AtomicU64 = AtomicU64::new(0);

fn main() -> Result<(), Box<dyn Error>> {
    let Args { app, own } = Args::parse();
    app::run::<Viewer>(&app, own)?;
    match MESSAGES.load(Ordering::Relaxed) {
        0 => Ok(()),
        count => Err(format!("the validation layers had {count} things to say").into()),
    }
}

fn tell(message: &str) {
    MESSAGES.fetch_add(1, Ordering::Relaxed);
    eprintln!("{message}");
}

impl Show for Viewer {
    type Args = OwnArgs;

    fn open(
        args: &OwnArgs,
        field: &Rc<Field>,
        window: &Arc<Window>,
        _: &ActiveEventLoop,
    ) -> Result<Self, Box<dyn Error>> {
        let listener = args.validate.then(|| Arc::new(tell) as Listener);
        let [instance_extensions, device_extensions] = swapchain::extensions(window)?;
        let gpu = Gpu::request_with(&GpuOptions {
            listener,
            instance_extensions,
            device_extensions,
            ..GpuOptions::default()
        })?;
        let size = window.inner_size();
        let size = [size.width, size.height];
        let swapchain = Swapchain::new(&gpu, window, size)?;
        let shaders = if args.compute { Shaders::Compute } else { Shaders::Mesh };
        let scene = Scene::new(&gpu, field, &swapchain.attachments(), shaders)?;
        let frames = Frames::new(&gpu)?;
        Ok(Self { frames, scene, swapchain, gpu, size, method: Method::Patches })
    }

    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>> {
        self.size = size;
        Ok(())
    }

    fn draw(&mut self, orbit: &Orbit, method: Method) -> Result<(), Box<dyn Error>> {
        self.method = method;
        let Self { frames, scene, swapchain, gpu, size, .. } = self;
        if swapchain.is_stale(*size) {
            frames.wait()?;
            if !swapchain.remake(*size)? {
                return Ok(());
            }
            scene.resize(gpu, &swapchain.attachments())?;
        }
        let (frame, counted) = frames.next()?;
        if let Some(counted) = counted {
            scene.look_back(gpu, counted)?;
        }
        let Some(image) = swapchain.acquire(frame.acquired())? else { return Ok(()) };
        frame.execute(&image, |commands| scene.draw(commands, &image, orbit, method))?;
        swapchain.present(&image)
    }

    fn press(&mut self, letter: &str) {
        if letter == "v" {
            self.scene.switch();
        }
    }

    fn summary(&self) -> String {
        self.scene.summary(self.method)
    }
}
