//! Readers of mesh files: OBJ, PLY, STL, glTF and GLB.
//!
//! [`read`] takes the format from the extension and checks it against the content. Vertices keep
//! the order of the file, so that an index printed by any tool of Drypoint can be looked up there:
//! OBJ by its `v` lines, PLY by its rows, STL as 3 · facet + corner; all from 0. glTF files are
//! drawn as a whole, so their vertices are renumbered: by exact position, in order of first use.
//!
//! Positions are f32, each rounded once. A bad file is a [`ReadError`] that says what is wrong and
//! where, never a panic, and never costs more memory than a file of its size can need.
//!
//! ```
//! use drypoint_mesh::io::{Format, parse};
//!
//! let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let model = parse(Format::Obj, text)?;
//! assert_eq!(model.mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
//!
//! let error = parse(Format::Obj, b"v 0 0 0\nf 1 2 3\n").unwrap_err();
//! assert_eq!(error.to_string(), "line 2: uses vertex 2, but there are only 1");
//! # Ok::<(), drypoint_mesh::io::ReadError>(())
//! ```

// What readers share lies idle where only some of them are built.
#![cfg_attr(
    not(all(feature = "obj", feature = "ply", feature = "stl", feature = "gltf")),
    allow(dead_code, unused_variables, reason = "the readers that need it are not built")
)]

#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod content;
mod error;
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod estimate;
mod file;
mod format;
mod parts;
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod polygon;
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod text;

#[cfg(feature = "gltf")]
mod gltf;
#[cfg(feature = "obj")]
mod obj;
#[cfg(feature = "ply")]
mod ply;
#[cfg(feature = "stl")]
mod stl;

use std::fs;
use std::path::Path;

pub use error::{Fault, Place, ReadError};
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
pub use estimate::{Estimate, estimate};
pub use format::Format;
pub use parts::{Dropped, Model, Part};

/// Bytes of a text, or of rows, that a thread reads at once: few enough that all threads have some of a
/// file of a megabyte, and enough that handing them out costs nothing. What is read does not depend on it.
const PIECE: usize = 1 << 18;

/// How to read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// A vertex that is NaN, infinite or beyond the range of f32 is an error. Else it and the faces that
    /// use it are left out and counted in [`Model::dropped`].
    pub strict: bool,
}

/// Reads the mesh in a file, and leaves out what is not finite.
///
/// The format is that of the extension, in any case; content that is plainly of another format is
/// refused. Buffers of a glTF file are looked for beside it. The file is read once, whole.
///
/// # Errors
/// Whatever is wrong with the file, in one line.
pub fn read(path: &Path) -> Result<Model, ReadError> {
    read_with(path, &ReadOptions::default())
}

/// As [`read`], with options.
///
/// # Errors
/// Whatever is wrong with the file, in one line.
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Model, ReadError> {
    // A missing file is the first thing to say, whatever its name.
    fs::metadata(path)?;
    let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
    let Some(format) = Format::of_extension(&extension) else {
        return Err(ReadError::UnknownExtension { extension });
    };
    let bytes = file::read(path)?;
    if let Some(content) = Format::of_content(&bytes).filter(|&content| content != format) {
        return Err(ReadError::WrongExtension { extension, content });
    }
    parse_with(format, &bytes, path.parent(), options)
}

/// Reads the mesh in `bytes`, a whole file of the given format.
///
/// # Errors
/// Whatever is wrong with it; also a glTF file that names other files, for which [`parse_in`] is.
pub fn parse(format: Format, bytes: &[u8]) -> Result<Model, ReadError> {
    parse_in(format, bytes, None)
}

/// As [`parse`], with the folder in which a glTF file's buffers are looked for.
///
/// # Errors
/// Whatever is wrong with the file or its buffers.
pub fn parse_in(format: Format, bytes: &[u8], folder: Option<&Path>) -> Result<Model, ReadError> {
    parse_with(format, bytes, folder, &ReadOptions::default())
}

/// As [`parse_in`], with options.
///
/// # Errors
/// Whatever is wrong with the file or its buffers.
pub fn parse_with(
    format: Format,
    bytes: &[u8],
    folder: Option<&Path>,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    parse_in_pieces(format, bytes, PIECE, folder, options)
}

/// As [`parse_with`], in pieces of some `size` bytes instead of [`PIECE`], which changes nothing: tests
/// and fuzz targets compare, whose files are smaller than one piece.
///
/// # Errors
/// As [`parse_with`].
#[doc(hidden)]
pub fn parse_in_pieces(
    format: Format,
    bytes: &[u8],
    size: usize,
    folder: Option<&Path>,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty);
    }
    match format {
        #[cfg(feature = "obj")]
        Format::Obj => obj::parse(bytes, size, options),
        #[cfg(feature = "ply")]
        Format::Ply => ply::parse(bytes, size, options),
        #[cfg(feature = "stl")]
        Format::Stl => stl::parse(bytes, size, options),
        #[cfg(feature = "gltf")]
        Format::Gltf => gltf::parse(bytes, folder, options),
        #[cfg(not(all(feature = "obj", feature = "ply", feature = "stl", feature = "gltf")))]
        format => Err(ReadError::NotBuiltIn { format }),
    }
}
