//! Models from files and from standard input.

use crate::inputs::Input;
use chordal::{Error, FileError, InputFormat, Model, ReadOptions};
use std::io::Read;

/// Reads one input; `None` recognises the format by content.
///
/// # Errors
/// Where it cannot be read or holds nothing to mesh.
pub fn read_model(input: &Input, format: Option<InputFormat>, options: &ReadOptions) -> Result<Model, Error> {
    match input {
        Input::File { path, .. } => Model::open_with(path, format, options),
        Input::Stdin => {
            let mut bytes = Vec::new();
            let name = input.name();
            match std::io::stdin().lock().read_to_end(&mut bytes) {
                Ok(_) => Model::from_bytes_with(&bytes, format, &options.clone().with_name(name)),
                Err(source) => Err(Error::File { name, reason: FileError::Io(source) }),
            }
        }
    }
}
