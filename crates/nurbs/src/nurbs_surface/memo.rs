//! Something found out about a value once and kept beside it.

use crate::work;
use std::sync::OnceLock;

/// A derived fact: it follows from the rest of the value, so that two values are equal whether or not it is
/// known yet.
#[derive(Clone, Debug)]
pub(crate) struct Memo<T>(OnceLock<T>);

impl<T> Default for Memo<T> {
    fn default() -> Self {
        Self(OnceLock::new())
    }
}

impl<T> PartialEq for Memo<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T: Copy> Memo<T> {
    /// The fact, found by `find` the first time.
    pub fn get(&self, find: impl FnOnce() -> T) -> T {
        *self.0.get_or_init(|| work::uncounted(find))
    }
}
