//! Where bytes go: a file that appears only when it is complete, and a counter.

use crate::WriteError;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Bytes gathered before a system call: large enough that a mesh of megabytes needs few of them, small beside
/// the mesh itself.
const BUFFER: usize = 1 << 20;

/// A writer that counts the bytes written to it.
#[derive(Debug)]
pub(crate) struct Counter<W> {
    inner: W,
    pub bytes: u64,
}

impl<W> Counter<W> {
    pub fn new(inner: W) -> Self {
        Self { inner, bytes: 0 }
    }
}

impl<W: Write> Write for Counter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.inner.write_all(bytes)?;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// A file being written beside the one that it will replace.
#[derive(Debug)]
pub(crate) struct NewFile {
    target: PathBuf,
    writer: BufWriter<NamedTempFile>,
}

impl NewFile {
    /// Starts a file in the folder of `path`; if `path` is a link, in the folder of the file that it points
    /// to.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let error = |source| WriteError::File { path: path.to_owned(), source };
        if fs::metadata(&target).is_ok_and(|m| !m.is_file()) {
            return Err(WriteError::NotAFile { path: path.to_owned() });
        }
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let temporary = builder().tempfile_in(folder).map_err(|e| error(without_temporary_name(e)))?;
        Ok(Self { target, writer: BufWriter::with_capacity(BUFFER, temporary) })
    }

    pub fn writer(&mut self) -> &mut BufWriter<NamedTempFile> {
        &mut self.writer
    }

    /// Puts the file in its place.
    pub fn commit(self) -> Result<(), WriteError> {
        let Self { target, writer } = self;
        let error = |source| WriteError::File { path: target.clone(), source };
        let temporary = writer.into_inner().map_err(|e| error(e.into_error()))?;
        temporary.persist(&target).map(|_: File| ()).map_err(|e| error(e.error))
    }
}

/// The same error without the name of the temporary file, which means nothing to a reader.
fn without_temporary_name(error: io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(_) => error,
        None => error.kind().into(),
    }
}

/// Temporary files are private by default; a mesh gets the permissions of any new file.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".chordal-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}
