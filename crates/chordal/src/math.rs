//! The types of [glam](https://docs.rs/glam) that appear in signatures of Chordal.

pub use glam::{DAffine3, DMat3, DVec2, DVec3};
