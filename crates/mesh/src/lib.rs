//! Mesh buffers that remember where every vertex came from, and the scene of placed meshes that writers
//! write.

#![deny(missing_docs)]

mod analytic;
mod import;
mod part_mesh;
mod scene;

pub use analytic::AnalyticFace;
pub use import::{
    AccessorFault, ImportError, ImportFault, ImportFormat, ImportPlace, SoupGroup, TriangleSoup,
    import_bytes, import_mesh,
};
pub use part_mesh::{Corner, FaceMesh, Origin, PartMesh};
pub use scene::{PassThrough, PlacedPart, Rgba, Scene, SceneNode, ScenePart};
