//! Files that appear only when they are complete.

use std::io::{self, Write};
use std::path::Path;

/// Writes `data` to `path`: the file is replaced by the whole of it, or stays as it was.
///
/// # Errors
/// Those of the file system.
pub fn write_whole(path: &Path, data: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".chordal-").suffix(".part");
    // Temporary files are private by default; a new file gets the usual permissions.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(without_temporary_name)?;
    file.write_all(data)?;
    file.persist(path).map_err(|error| without_temporary_name(error.error))?;
    Ok(())
}

/// Replaces the name of the temporary file, which users do not know, by the name of the output.
fn without_temporary_name(error: io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(_) => error,
        None => error.kind().into(),
    }
}
