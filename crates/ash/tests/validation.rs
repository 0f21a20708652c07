//! The validation layers are on: they object to what is planted here, of both kinds.
#![allow(
    unsafe_code,
    reason = "errors are planted by raw handles, as this crate lets none be made"
)]

#[path = "support/raw.rs"]
mod raw;
mod support;

use ash::vk;
use drypoint_ash::{Error, Gpu};

/// A buffer of the test's own, with its memory.
fn buffer(gpu: &Gpu) -> (vk::Buffer, vk::DeviceMemory) {
    let device = gpu.device().raw();
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let info = vk::BufferCreateInfo::default().size(64).usage(usage);
    // SAFETY: a small buffer with memory of its own.
    unsafe {
        let buffer = device.create_buffer(&info, None).expect("a buffer is made");
        let needed = device.get_buffer_memory_requirements(buffer);
        let memory = raw::allocate(gpu, needed, vk::MemoryPropertyFlags::DEVICE_LOCAL);
        device.bind_buffer_memory(buffer, memory, 0).expect("it is bound");
        (buffer, memory)
    }
}

/// Executes two fills of a buffer, with a barrier between them or without, the second one from `offset` on. What
/// the layers say.
fn heard_of_fills(gpu: &Gpu, has_barrier: bool, offset: u64) -> Vec<String> {
    let (buffer, memory) = buffer(gpu);
    let device = gpu.device().raw();
    let run = gpu.run(|commands| {
        let raw = commands.raw();
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE);
        let stage = vk::PipelineStageFlags::TRANSFER;
        // SAFETY: the buffer is there. What is wrong, if anything, is what the layers are to tell; software
        // does not mind.
        unsafe {
            device.cmd_fill_buffer(raw, buffer, 0, 64, 1);
            if has_barrier {
                let none = vk::DependencyFlags::empty();
                device.cmd_pipeline_barrier(raw, stage, stage, none, &[barrier], &[], &[]);
            }
            device.cmd_fill_buffer(raw, buffer, offset, 16, 2);
        }
        Ok::<_, Error>(())
    });
    // SAFETY: it has executed, or was refused.
    unsafe {
        device.destroy_buffer(buffer, None);
        device.free_memory(memory, None);
    }
    let _ = run;
    std::mem::take(&mut *support::messages())
}

/// One test of a program of its own, since all tests of one hear the same messages.
#[test]
fn planted_errors_are_heard() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    assert_eq!(heard_of_fills(&gpu, true, 16), Vec::<String>::new());
    let heard = heard_of_fills(&gpu, true, 18);
    assert!(
        heard.iter().any(|message| message.contains("VUID-vkCmdFillBuffer-dstOffset")),
        "core validation is deaf: {heard:?}"
    );
    let heard = heard_of_fills(&gpu, false, 16);
    assert!(
        heard.iter().any(|message| message.contains("SYNC-HAZARD-WRITE-AFTER-WRITE")),
        "validation of synchronisation is deaf: {heard:?}"
    );
}
