//! The program as a user runs it: shapes of JSON, exit status, messages, files left behind.

mod bench;
mod draw;
mod extract;
mod files;
mod help;
mod options;
mod patches;
mod show;
#[cfg(feature = "wgpu")]
mod wgpu;
