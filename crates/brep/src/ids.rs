//! Typed indices. Each is the position in the vector of the same name of its [`crate::Part`] or
//! [`crate::Model`].

macro_rules! id {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);
        impl $name {
            /// The position as an index.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
        impl From<usize> for $name {
            /// # Panics
            /// Where the index needs more than 32 bits.
            fn from(index: usize) -> Self {
                Self(u32::try_from(index).expect("fewer than 2^32 items of one kind"))
            }
        }
    )*};
}

id!(
    /// A vertex of a part.
    VertexId,
    /// An edge of a part.
    EdgeId,
    /// A face of a part.
    FaceId,
    /// A shell of a part.
    ShellId,
    /// A body of a part.
    BodyId,
    /// A part of a model.
    PartId,
    /// A node of the assembly tree.
    NodeId,
);
