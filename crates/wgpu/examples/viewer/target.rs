//! What frames are drawn to: the window, its depth, and what lines cover of it.

use std::error::Error;
use std::sync::Arc;

use drypoint_wgpu::{DepthOrder, DepthPass, LinePass, LineStyle, LineTarget, WANTED_FEATURES};
use glam::Mat4;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use crate::orbit::Orbit;
use crate::scene::Scene;

pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

pub(crate) struct Target {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) depth_pass: DepthPass,
    pub(crate) line_pass: LinePass,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    depth: wgpu::TextureView,
    lines: LineTarget,
}

impl Target {
    /// Asks for a device that can show pictures in `window`.
    pub(crate) fn new(
        window: &Arc<Window>,
        display: OwnedDisplayHandle,
    ) -> Result<Self, Box<dyn Error>> {
        let descriptor =
            wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(display));
        let instance = wgpu::Instance::new(descriptor);
        let surface = instance.create_surface(Arc::clone(window))?;
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: adapter.features() & WANTED_FEATURES,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
        let size = window.inner_size();
        let [width, height] = [size.width.max(1), size.height.max(1)];
        let configuration = surface.get_default_config(&adapter, width, height);
        let mut configuration = configuration.ok_or("the adapter cannot show pictures there")?;
        // Colors are given as the eye sees them.
        configuration.format = configuration.format.remove_srgb_suffix();
        surface.configure(&device, &configuration);
        let line_pass = LinePass::new(&device, configuration.format, 1)?;
        let depth = depth(&device, [width, height]);
        Ok(Self {
            depth_pass: DepthPass::new(&device, DEPTH, DepthOrder::Standard)?,
            lines: LineTarget::new(&line_pass, &depth, DepthOrder::Standard)?,
            line_pass,
            device,
            queue,
            surface,
            configuration,
            depth,
        })
    }

    /// Of the picture.
    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.configuration.format
    }

    pub(crate) fn resize(&mut self, size: [u32; 2]) -> Result<(), drypoint_wgpu::Error> {
        if size.contains(&0) {
            // Minimised: nothing is drawn until it has a size again.
            return Ok(());
        }
        [self.configuration.width, self.configuration.height] = size;
        self.surface.configure(&self.device, &self.configuration);
        self.depth = depth(&self.device, size);
        self.lines = LineTarget::new(&self.line_pass, &self.depth, DepthOrder::Standard)?;
        Ok(())
    }

    /// Draws a frame and shows it.
    pub(crate) fn draw(&mut self, scene: &mut Scene, orbit: &Orbit) -> Result<(), Box<dyn Error>> {
        let texture = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture)
            | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => texture,
            wgpu::CurrentSurfaceTexture::Outdated => {
                self.surface.configure(&self.device, &self.configuration);
                return Ok(());
            }
            wgpu::CurrentSurfaceTexture::Timeout | wgpu::CurrentSurfaceTexture::Occluded => {
                return Ok(());
            }
            other => return Err(format!("the window cannot be drawn to: {other:?}").into()),
        };
        let aspect = f64::from(self.configuration.width) / f64::from(self.configuration.height);
        let scene_to_clip = orbit.scene_to_clip(aspect);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        scene.find_contours(&mut encoder, orbit.eye())?;
        self.depth_pass.prepare(&mut encoder, scene_to_clip)?;
        let width = LineStyle { width: 1.2, ..LineStyle::default() };
        self.line_pass.prepare(&mut encoder, scene_to_clip, &width)?;
        self.draw_depth(&mut encoder, scene);
        self.line_pass.cover(&mut encoder, &self.lines, &[&scene.lines]);
        let view = texture.texture.create_view(&Default::default());
        self.draw_paper(&mut encoder, &view, scene, &scene_to_clip);
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("lines"),
                color_attachments: &[Some(color(&view, wgpu::LoadOp::Load))],
                ..Default::default()
            });
            self.line_pass.ink(&mut pass, &self.lines);
        }
        self.queue.submit([encoder.finish()]);
        self.queue.present(texture);
        Ok(())
    }

    fn draw_depth(&self, encoder: &mut wgpu::CommandEncoder, scene: &Scene) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(self.depth(wgpu::LoadOp::Clear(1.0))),
            ..Default::default()
        });
        self.depth_pass.record(&mut pass, &scene.surface, &scene.contours);
    }

    /// White, or patches in their colors on white.
    fn draw_paper(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        scene: &Scene,
        scene_to_clip: &Mat4,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("paper"),
            color_attachments: &[Some(color(view, wgpu::LoadOp::Clear(wgpu::Color::WHITE)))],
            depth_stencil_attachment: Some(self.depth(wgpu::LoadOp::Load)),
            ..Default::default()
        });
        if scene.shows_patches {
            let instances = scene.contours.placement_count();
            scene.colored.draw(&self.queue, &mut pass, scene_to_clip, instances);
        }
    }

    fn depth(&self, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }
    }
}

fn color(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

fn depth(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
