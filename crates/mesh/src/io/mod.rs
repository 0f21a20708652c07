//! Readers of mesh files.
