//! Errors of the library as the exceptions of `chordal._errors`, with the sentences of the command line.

use chordal::Error;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An exception of this package, by the name of its class.
fn exception(class: &str, sentence: &str, fields: &[(&str, Option<u64>)]) -> PyErr {
    let made = Python::attach(|py| -> PyResult<PyErr> {
        let class = py.import("chordal._errors")?.getattr(class)?;
        let named = PyDict::new(py);
        for (name, value) in fields {
            named.set_item(name, value)?;
        }
        Ok(PyErr::from_value(class.call((sentence,), Some(&named))?))
    });
    made.unwrap_or_else(|_| PyRuntimeError::new_err(sentence.to_owned()))
}

/// What the caller requested is not possible.
pub fn request(sentence: &str) -> PyErr {
    exception("RequestError", sentence, &[])
}

/// An argument that is not possible; the sentence begins with its name.
pub fn argument(name: &str, why: impl std::fmt::Display) -> PyErr {
    request(&format!("{name}: {why}"))
}

/// A bug, or a system that refuses what it should give.
pub fn internal(sentence: &str) -> PyErr {
    exception("InternalError", sentence, &[])
}

/// An error of a job on the input of this name; empty where the message needs no name.
pub fn of_input(input: &str, error: &Error) -> PyErr {
    let named = if input.is_empty() { error.to_string() } else { format!("{input}: {error}") };
    match error {
        Error::File { .. } => {
            let place = error.source_place();
            let entity = (place.entity > 0).then_some(place.entity);
            let line = (place.line > 0).then_some(u64::from(place.line));
            exception("FileError", &error.to_string(), &[("entity", entity), ("line", line)])
        }
        Error::Request(_) => exception("RequestError", &named, &[]),
        Error::Cancelled => exception("Cancelled", &named, &[]),
        _ => exception("InternalError", &named, &[]),
    }
}
