//! On a device of wgpu's, in a command encoder of wgpu's: one of its own, since wgpu allows no mixing.
#![allow(unsafe_code, reason = "wgpu hands out raw handles")]
#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]

mod support;

use std::sync::mpsc;

use ash::vk;
use drypoint_ash::{
    Capacity, Commands, Device, MeshContours, MeshOptions, MeshPass, Method, Model,
    OptionalFeatures, REQUIRED_EXTENSIONS, RequiredFeatures,
};
use drypoint_fusion::Levels;
use drypoint_mesh::shapes;
use support::{Expected, patches, placements};
use wgpu::hal::api::Vulkan;

/// A device of wgpu's with what mesh shaders need.
async fn open() -> (wgpu::Adapter, wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await;
    let adapter = adapter.expect(
        "there is a Vulkan driver (Debian: mesa-vulkan-drivers of the backports); DRYPOINT_NO_GPU=1 passes over \
         the GPU tests",
    );
    let mut features = RequiredFeatures::default();
    let limits = adapter.limits();
    let opened = {
        // SAFETY: the handle is not destroyed.
        let hal = unsafe { adapter.as_hal::<Vulkan>() }.expect("it is of Vulkan");
        let more: Box<wgpu::hal::vulkan::CreateDeviceCallback<'_>> = Box::new(|args| {
            args.extensions.extend(REQUIRED_EXTENSIONS);
            *args.create_info = args
                .create_info
                .push_next(&mut features.dynamic_rendering)
                .push_next(&mut features.mesh_shader);
        });
        let hints = wgpu::MemoryHints::default();
        // SAFETY: extensions and features are added, and none is taken away.
        unsafe { hal.open_with_callback(wgpu::Features::empty(), &limits, &hints, Some(more)) }
            .expect("the device has mesh shaders")
    };
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    // SAFETY: it was opened from this adapter, with what the descriptor says.
    let made = unsafe { adapter.create_device_from_hal(opened, &descriptor) };
    let (device, queue) = made.expect("it is a device");
    (adapter, device, queue)
}

/// The same device, for this crate.
fn borrow(adapter: &wgpu::Adapter, device: &wgpu::Device) -> Device {
    // SAFETY: handles are not destroyed.
    let (adapter, hal) = unsafe { (adapter.as_hal::<Vulkan>(), device.as_hal::<Vulkan>()) };
    let (adapter, hal) = (adapter.expect("of Vulkan"), hal.expect("of Vulkan"));
    let instance = hal.shared_instance().raw_instance();
    let (physical, raw) = (adapter.raw_physical_device(), hal.raw_device());
    // SAFETY: it was opened with what is required, and goes last.
    unsafe { Device::from_raw(instance, physical, raw, OptionalFeatures::default()) }
        .expect("it has what is required")
}

#[test]
fn mesh_shaders_run_on_a_device_of_wgpu() {
    if support::is_without_gpu() {
        return;
    }
    let (adapter, device, queue) = pollster::block_on(open());
    let ours = borrow(&adapter, &device);
    let mesh = shapes::torus_knot(3_000);
    let set = patches(&mesh, Levels::Two);
    let all = placements(&mesh);
    let pass = MeshPass::new(&ours, &MeshOptions::default()).expect("shaders compile");

    // wgpu's own commands before and after.
    let bytes = 64;
    let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let make = |usage| {
        let label = Some("of wgpu");
        let descriptor =
            wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false };
        device.create_buffer(&descriptor)
    };
    let [source, copy] =
        [usage, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST].map(make);
    queue.write_buffer(&source, 0, &[7; 64]);
    let mut encoder = device.create_command_encoder(&Default::default());
    let record = |raw: vk::CommandBuffer| {
        // SAFETY: wgpu is recording it, and leaves that to us until this returns; it is submitted below, and what
        // it uses is kept until it has executed.
        let mut commands = unsafe { Commands::from_raw(&ours, raw) };
        let found = Model::new(&mut commands, &[&set]).and_then(|model| {
            let capacity = Capacity { placements: all.len() as u32, segments: 50_000 };
            let mut contours = MeshContours::new(&pass, &model, capacity)?;
            contours.prepare(&mut commands, &all, Method::Patches)?;
            pass.extract(&mut commands, &contours)?;
            contours.download(&mut commands)
        });
        (found.expect("it is recorded"), commands.finish())
    };
    // SAFETY: nothing of the encoder is destroyed, and its rendering is not open.
    let (found, recorded) = unsafe {
        encoder.as_hal_mut::<Vulkan, _, _>(|hal| record(hal.expect("of Vulkan").raw_handle()))
    };
    let mut own = device.create_command_encoder(&Default::default());
    own.copy_buffer_to_buffer(&source, 0, &copy, 0, bytes);
    queue.submit([encoder.finish(), own.finish()]);
    let (sender, receiver) = mpsc::channel();
    copy.slice(..).map_async(wgpu::MapMode::Read, move |mapped| sender.send(mapped).unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
    receiver.recv().expect("it was told").expect("it is mapped");
    assert_eq!(copy.slice(..).get_mapped_range().expect("it is mapped")[..], [7; 64]);

    // SAFETY: waiting for the device has told.
    let executed = unsafe { recorded.assume_executed() };
    let mut segments = found.segments(&executed).expect("they fit");
    segments.sort_unstable();
    Expected::new(&set, &all).compare(&segments, "beside wgpu");
    drop((found, pass, ours));
}
