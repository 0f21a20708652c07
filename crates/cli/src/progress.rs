//! Progress on a terminal, for what takes longer than a second.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::output::harmless;

/// How long a stage may take in silence.
const PATIENCE: Duration = Duration::from_secs(1);

/// One stage of work. Shows itself on standard error if that is a terminal and the stage outlasts
/// [`PATIENCE`]; vanishes when dropped.
pub(crate) struct Stage {
    bar: ProgressBar,
    done: Option<Sender<()>>,
    watch: Option<JoinHandle<()>>,
}

impl Stage {
    /// A stage whose length is not known.
    pub(crate) fn new(name: &str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        bar.set_style(style("{spinner} {msg} [{elapsed}]"));
        Self::start(bar, name)
    }

    /// A stage of so many steps.
    pub(crate) fn with_length(name: &str, length: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        bar.set_style(style("{msg} {wide_bar} {percent:>3} % [{elapsed} of about {duration}]"));
        Self::start(bar, name)
    }

    fn start(bar: ProgressBar, name: &str) -> Self {
        bar.set_message(harmless(name));
        let (done, wait) = mpsc::channel();
        let shown = bar.clone();
        let watch = std::thread::spawn(move || {
            if wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                // Draws nothing where standard error is no terminal.
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(Duration::from_millis(100));
            }
        });
        Self { bar, done: Some(done), watch: Some(watch) }
    }

    /// So many steps are done.
    pub(crate) fn set(&self, position: u64) {
        self.bar.set_position(position);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        // Hanging up wakes the watch, which must not show the bar after it was cleared.
        drop(self.done.take());
        if let Some(watch) = self.watch.take() {
            // It cannot panic; if it did, there would be no bar to clear.
            let _ = watch.join();
        }
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
