//! The program as a user runs it: shapes of JSON, exit status, messages, files left behind.

mod animation;
#[cfg(feature = "ash")]
mod ash;
mod bench;
mod draw;
mod extract;
mod files;
mod frames;
#[cfg(any(feature = "ash", feature = "wgpu"))]
mod gpu;
mod help;
mod islands;
mod lines;
mod moving;
mod options;
mod patches;
mod reliability;
mod show;
#[cfg(feature = "wgpu")]
mod wgpu;
