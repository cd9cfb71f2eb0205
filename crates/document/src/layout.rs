//! The layout of the text: every object begins a line, so that errors name a useful line and files can be
//! compared.

use serde_json::ser::{CompactFormatter, Formatter};
use std::io::{self, Write};

/// Compact JSON with a line break before every object but the first.
#[derive(Debug, Default)]
pub(crate) struct ObjectsOnLines {
    begun: bool,
}

impl Formatter for ObjectsOnLines {
    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if std::mem::replace(&mut self.begun, true) {
            writer.write_all(b"\n")?;
        }
        CompactFormatter.begin_object(writer)
    }
}
