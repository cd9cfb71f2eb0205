//! Why a document could not be read or written.

/// A document that yields no model, or a model that cannot be written. Each message is one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    #[error("{0}")]
    Syntax(#[from] serde_json::Error),
    #[error("its schema is {found:?}, and this program reads {expected:?}", expected = crate::SCHEMA)]
    Schema { found: String },
    #[error("node {node} of the tree {why}")]
    Tree { node: usize, why: &'static str },
    #[error("{0} is of a kind that {schema} does not have", schema = crate::SCHEMA)]
    Kind(String),
}
