//! Files into memory.

use std::fs::{self, File};
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use rayon::prelude::*;

/// Bytes that a thread reads at once.
const SHARE: usize = 1 << 23;

/// The whole of a file. By all threads where it is long, because one thread that copies from the system's
/// cache takes as long as all threads that parse.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let about = fs::metadata(path)?;
    let length = usize::try_from(about.len()).unwrap_or(usize::MAX);
    // Pipes have no length, and no second end to read from.
    if !about.is_file() || length < 2 * SHARE {
        return fs::read(path);
    }
    let mut bytes = bytemuck::allocation::try_zeroed_vec::<u8>(length)
        .map_err(|()| io::Error::from(io::ErrorKind::OutOfMemory))?;
    bytes.par_chunks_mut(SHARE).enumerate().try_for_each(|(index, share)| {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::Start((index * SHARE) as u64))?;
        file.read_exact(share)
    })?;
    Ok(bytes)
}
