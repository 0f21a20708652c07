//! A window on hundreds of instances of a model, each with its contours, as the demo application of
//! Tsiapkolis and Bénard (CGF 2024): `viewer [MODEL] [--instances N]`.
//!
//! Drag to turn, scroll to come closer. `C` switches culling by patches, `P` shows patches in colors, space
//! stops the turning, escape ends. The title tells what was tested and how long the GPU took for it.

mod app;
mod colored;
mod field;
mod orbit;
mod scene;
mod target;

use std::error::Error;
use std::rc::Rc;
use std::sync::Arc;

use clap::Parser;
use drypoint_wgpu::Method;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

use app::{AppArgs, Show};
use field::Field;
use orbit::Orbit;
use scene::Scene;
use target::Target;

/// Shows the contours of many instances of a model.
///
/// Drag to turn, scroll to come closer. C switches culling, P shows patches in colors, space stops the
/// turning, escape ends.
#[derive(Debug, Parser)]
struct Args {
    #[command(flatten)]
    app: AppArgs,
    #[command(flatten)]
    own: OwnArgs,
}

#[derive(Debug, clap::Args)]
struct OwnArgs {
    /// Begin with patches in colors.
    #[arg(long)]
    patches: bool,
}

struct Viewer {
    target: Target,
    scene: Scene,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Args { app, own } = Args::parse();
    app::run::<Viewer>(&app, own)
}

impl Show for Viewer {
    type Args = OwnArgs;

    fn open(
        args: &OwnArgs,
        field: &Rc<Field>,
        window: &Arc<Window>,
        event_loop: &ActiveEventLoop,
    ) -> Result<Self, Box<dyn Error>> {
        let target = Target::new(window, event_loop.owned_display_handle())?;
        let mut scene = Scene::new(&target, field)?;
        scene.shows_patches = args.patches;
        Ok(Self { target, scene })
    }

    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>> {
        Ok(self.target.resize(size)?)
    }

    fn draw(&mut self, orbit: &Orbit, method: Method) -> Result<(), Box<dyn Error>> {
        self.scene.method = method;
        self.scene.look_back(&self.target)?;
        self.target.draw(&mut self.scene, orbit)
    }

    fn press(&mut self, letter: &str) {
        if letter == "p" {
            self.scene.shows_patches ^= true;
        }
    }

    fn summary(&self) -> String {
        self.scene.summary()
    }
}
