//! How far a fusion has come, and how to stop it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How far a fusion has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Edges' worth of work done.
    pub edges_done: usize,
    /// Edges to do.
    pub edges: usize,
}

impl Progress {
    /// Share of the work done, 0 ..= 1. Some of the work is estimated: it may stand still
    /// before the end.
    pub fn fraction(&self) -> f64 {
        if self.edges == 0 { 1.0 } else { self.edges_done as f64 / self.edges as f64 }
    }
}

/// The progress callback asked to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("fusion was cancelled")]
pub struct Cancelled;

/// Counts the steps of all threads. Each edge is two: it becomes a cluster, and that is fused with
/// another or found to be done.
pub(crate) struct Counter<'a> {
    steps: AtomicUsize,
    edges: usize,
    is_cancelled: AtomicBool,
    on_progress: &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync),
}

impl<'a> Counter<'a> {
    pub(crate) fn new(
        edges: usize,
        on_progress: &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync),
    ) -> Self {
        let (steps, is_cancelled) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { steps, edges, is_cancelled, on_progress }
    }

    /// Adds steps and tells. Once told to stop, all threads stop at their next call.
    pub(crate) fn count(&self, steps: usize) -> Result<(), Cancelled> {
        let steps = self.steps.fetch_add(steps, Ordering::Relaxed) + steps;
        self.tell(steps / 2)
    }

    /// Tells that all is done.
    pub(crate) fn finish(&self) -> Result<(), Cancelled> {
        self.tell(self.edges)
    }

    /// Whether to stop, without telling anything.
    pub(crate) fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    fn tell(&self, edges_done: usize) -> Result<(), Cancelled> {
        self.check()?;
        if (self.on_progress)(Progress {
            edges_done: edges_done.min(self.edges),
            edges: self.edges,
        })
        .is_break()
        {
            self.is_cancelled.store(true, Ordering::Relaxed);
        }
        self.check()
    }
}
