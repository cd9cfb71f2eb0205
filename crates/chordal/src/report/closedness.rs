//! Whether the surface of a mesh is closed.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Whether the surface of a mesh encloses what it should enclose.
///
/// A mesh is judged by its shells, and edges pair up by the identity of their vertices, never by coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Closedness {
    /// Every shell is closed: no open edge, no inconsistent edge, no missing face. Only such a mesh is called
    /// watertight.
    Closed,
    /// Every shell that the file declares closed is closed, and at least one other shell has a border. The
    /// file does not promise that such a shell encloses a volume.
    OpenByDesign,
    /// A shell that the file declares closed has an open edge, an inconsistent edge or a missing face.
    Leaking,
}

impl fmt::Display for Closedness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Closedness::Closed => "watertight",
            Closedness::OpenByDesign => "open by design",
            Closedness::Leaking => "leaking",
        })
    }
}
