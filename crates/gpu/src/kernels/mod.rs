//! One WGSL file per kernel, and next to each a CPU twin of the same name: the same arithmetic in the same
//! order. In double precision, where nothing is fused, the two agree to the bit.

pub(crate) mod basis_indexed;
pub(crate) mod basis_packed;
mod basis_pass;
pub(crate) mod basis_unpacked;
pub(crate) mod bernstein;
pub(crate) mod bezier;
pub(crate) mod direct;
pub(crate) mod find_spans;
pub(crate) mod normal;
pub(crate) mod samples;
pub(crate) mod tensor;
pub(crate) mod vector;
