//! Every WGSL source of the crate, by name, as it is given to the device.

use crate::real::Real;

/// A shader: the files it is put together from, in order.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// The name of its last file.
    pub name: &'static str,
    files: &'static [&'static str],
    /// The storage buffers of a compute shader, and whether it only reads them.
    pub(crate) bindings: &'static [(u32, bool)],
    /// True where numbers are `real`: it exists in both precisions.
    pub generic: bool,
}

macro_rules! file {
    ($name:literal) => {
        include_str!(concat!("kernels/", $name, ".wgsl"))
    };
}

macro_rules! drawing {
    ($name:literal) => {
        Shader {
            name: $name,
            files: &[include_str!("draw/view.wgsl"), include_str!(concat!("draw/", $name, ".wgsl"))],
            bindings: &[],
            generic: false,
        }
    };
}

macro_rules! kernel {
    ($bindings:expr, $name:literal, [$($file:literal),*]) => {
        Shader { name: $name, files: &[$(file!($file)),*], bindings: $bindings, generic: true }
    };
}

/// The buffers of `samples.wgsl` and, at 6, the last input of a point kernel.
const POINT_BINDINGS: &[(u32, bool)] =
    &[(0, true), (1, true), (2, true), (3, true), (4, true), (5, true), (6, true), (7, false)];

pub(crate) const BASIS_INDEXED: Shader = kernel!(
    &[(2, true), (3, true), (4, true), (6, true), (7, false)],
    "basis_indexed",
    ["common", "basis_pass", "basis_indexed"]
);
pub(crate) const BASIS_UNPACKED: Shader = kernel!(
    &[(2, true), (3, true), (4, true), (7, false)],
    "basis_unpacked",
    ["common", "basis_pass", "basis_unpacked"]
);
pub(crate) const BASIS_PACKED: Shader =
    kernel!(&[(2, true), (4, true), (7, false)], "basis_packed", ["common", "basis_pass", "basis_packed"]);
pub(crate) const TENSOR: Shader =
    kernel!(POINT_BINDINGS, "tensor", ["common", "normal", "samples", "sums", "tensor"]);
pub(crate) const DIRECT: Shader =
    kernel!(POINT_BINDINGS, "direct", ["common", "normal", "samples", "sums", "direct"]);
pub(crate) const BERNSTEIN: Shader =
    kernel!(POINT_BINDINGS, "bernstein", ["common", "normal", "samples", "bezier", "bernstein"]);
pub(crate) const FIND_SPANS: Shader = kernel!(
    &[(0, true), (1, true), (2, false), (5, true), (7, false)],
    "find_spans",
    ["common", "find_spans"]
);
pub(crate) const MESH: Shader = drawing!("mesh");
pub(crate) const LINES: Shader = drawing!("lines");
pub(crate) const FACE: Shader = Shader {
    name: "face",
    files: &[
        include_str!("draw/view.wgsl"),
        include_str!("faces/inside.wgsl"),
        file!("normal"),
        file!("bezier"),
        include_str!("draw/face_normal.wgsl"),
        include_str!("draw/face.wgsl"),
    ],
    bindings: &[],
    generic: false,
};

pub(crate) const TRIM_TEXTURE: Shader = Shader {
    name: "trim_texture",
    files: &[include_str!("draw/trim_texture.wgsl")],
    bindings: &[],
    generic: false,
};

/// All of them.
pub const SHADERS: &[Shader] = &[
    BASIS_INDEXED,
    BASIS_UNPACKED,
    BASIS_PACKED,
    TENSOR,
    DIRECT,
    BERNSTEIN,
    FIND_SPANS,
    MESH,
    LINES,
    FACE,
    TRIM_TEXTURE,
];

impl Shader {
    /// The whole source in the precision `R`.
    pub fn source<R: Real>(&self) -> String {
        let suffix = if R::WGSL == "f64" { "lf" } else { "f" };
        let degenerate = format!("const DEGENERATE: real = {:e}{suffix};\n", R::DEGENERATE);
        let vectors = "alias real3 = vec3<real>;\nalias real4 = vec4<real>;\n";
        format!("alias real = {};\n{vectors}{degenerate}{}", R::WGSL, self.files.concat())
    }
}
