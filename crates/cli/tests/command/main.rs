//! The program as a user runs it: shapes of JSON, exit status, messages, files left behind.

#[cfg(feature = "ash")]
mod ash;
mod bench;
mod draw;
mod extract;
mod files;
#[cfg(any(feature = "ash", feature = "wgpu"))]
mod gpu;
mod help;
mod options;
mod patches;
mod show;
#[cfg(feature = "wgpu")]
mod wgpu;
