//! Cross-crate properties.
