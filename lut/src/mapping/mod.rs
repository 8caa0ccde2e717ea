//! Table mappings.
