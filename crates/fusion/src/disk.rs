//! Patches in the file system.

use std::io::{self, Write};
use std::path::Path;

use crate::PatchSet;

impl PatchSet {
    /// Writes [`PatchSet::to_bytes`] to `path`, whole or not at all: to a file beside it, which is
    /// brought to the disk and then renamed. If anything fails, what was at `path` is as it was, and
    /// nothing is left behind. A file that is replaced keeps its permissions.
    ///
    /// # Errors
    /// What the file system fails with.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".drypoint-").suffix(".part");
        // A private temporary file would make a private asset; the user's umask decides instead.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.tempfile_in(folder.unwrap_or(Path::new(".")))?;
        file.write_all(&self.to_bytes())?;
        if let Ok(there) = std::fs::metadata(path) {
            file.as_file().set_permissions(there.permissions())?;
        }
        file.as_file().sync_all()?;
        file.persist(path)?;
        Ok(())
    }

    /// Reads what [`PatchSet::save`] wrote, as [`PatchSet::from_bytes`] does.
    ///
    /// # Errors
    /// What the file system fails with; [`io::ErrorKind::InvalidData`] around a
    /// [`PatchFileError`](crate::PatchFileError) if it is no patches file, or a broken one.
    pub fn load(path: &Path) -> io::Result<Self> {
        let bytes = std::fs::read(path)?;
        Self::from_bytes(&bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    }
}
