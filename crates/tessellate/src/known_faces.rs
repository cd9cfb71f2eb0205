//! What earlier passes over a part found out about its faces.

use std::collections::BTreeSet;

/// Faces whose loops need care.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnownFaces {
    /// Faces whose loops run to and fro and bound no region.
    pub flat: BTreeSet<usize>,
    /// Faces whose loops meet in vertices.
    pub touching: BTreeSet<usize>,
}
