//! What becomes of commands.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::Error;
use crate::memory::Buffer;

/// What a command buffer uses: to be kept until it has executed, or will not be any more.
#[derive(Debug)]
#[must_use = "what the commands use goes with it"]
pub struct Recorded {
    pub(crate) id: u64,
    pub(crate) _kept: Vec<Arc<dyn Any + Send + Sync>>,
}

/// That commands have executed: what they were to download can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Executed {
    id: u64,
}

/// What was copied to where the processor sees it, once the commands have executed.
#[derive(Debug)]
pub(crate) struct Download {
    pub(crate) what: &'static str,
    pub(crate) id: u64,
    pub(crate) buffer: Buffer,
    /// Bytes of it that were copied.
    pub(crate) size: usize,
}

/// Whether commands came to nothing: what they were to write holds anything then.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fate {
    is_abandoned: Arc<AtomicBool>,
}

impl Fate {
    /// The commands will never execute.
    pub(crate) fn abandon(&self) {
        self.is_abandoned.store(true, Ordering::Release);
    }

    /// Fails if it is so, for what was made in them.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), Error> {
        if self.is_abandoned.load(Ordering::Acquire) {
            Err(Error::Abandoned { what })
        } else {
            Ok(())
        }
    }
}

impl Recorded {
    /// That what was recorded has executed.
    ///
    /// # Safety
    /// The command buffer was submitted once and has executed, as a fence or waiting for the device has told.
    pub unsafe fn assume_executed(self) -> Executed {
        Executed { id: self.id }
    }
}

impl Executed {
    /// Whether it is that of the commands of this number.
    pub(crate) fn is_of(&self, id: Option<u64>) -> bool {
        id == Some(self.id)
    }
}

impl Download {
    /// What was copied.
    pub(crate) fn read(&self, executed: &Executed) -> Result<&[u8], Error> {
        if !executed.is_of(Some(self.id)) {
            return Err(Error::OtherCommands { what: self.what });
        }
        Ok(&self.buffer.bytes()[..self.size])
    }
}
