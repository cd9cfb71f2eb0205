//! Which file every input is written to.

use crate::args::MeshArgs;
use crate::batch::Batch;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Where the outputs go.
#[derive(Debug)]
pub struct Outputs {
    files: Vec<PathBuf>,
    /// The folder, where this run made it.
    made: Option<PathBuf>,
    /// All or nothing: the files are collected here first. The folder that they belong in.
    staging: Option<(TempDir, PathBuf)>,
}

/// Plans one output per input.
///
/// Inputs of one name in several folders get `name`, `name-2`, `name-3` …, in the order of the command line.
///
/// # Errors
/// One sentence where the outputs cannot be: a folder without a format, several inputs for one file, a folder that
/// is missing, an output that is one of the inputs.
pub fn plan(args: &MeshArgs) -> Result<Outputs, String> {
    let out = &args.output;
    let says_folder = out.as_os_str().to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR]);
    if !(says_folder || out.is_dir()) {
        if args.inputs.len() > 1 {
            return Err(format!("{}: {} inputs need a folder as output", out.display(), args.inputs.len()));
        }
        folder_exists(out.parent())?;
        not_an_input(out, &args.inputs)?;
        return Ok(Outputs { files: vec![out.clone()], made: None, staging: None });
    }
    let format = args
        .format
        .ok_or_else(|| format!("{}: a folder as output needs --format to say what to write", out.display()))?
        .format();
    let made = (!out.is_dir()).then(|| out.clone());
    let failed = |e: std::io::Error| format!("{}: cannot write to the folder: {e}", out.display());
    std::fs::create_dir_all(out).map_err(failed)?;
    let mut taken = BTreeSet::new();
    let names: Vec<String> =
        args.inputs.iter().map(|i| free_name(i, format.extension(), &mut taken)).collect();
    names.iter().try_for_each(|name| not_an_input(&out.join(name), &args.inputs))?;
    let staging = if args.strict && args.inputs.len() > 1 {
        let folder = tempfile::Builder::new().prefix(".chordal-").tempdir_in(out).map_err(failed)?;
        Some((folder, out.clone()))
    } else {
        None
    };
    let folder = staging.as_ref().map_or(out.as_path(), |(staging, _)| staging.path());
    Ok(Outputs { files: names.iter().map(|name| folder.join(name)).collect(), made, staging })
}

impl Outputs {
    /// One per input.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Nothing was written: leaves no trace.
    pub fn discard(self) {
        drop(self.staging);
        if let Some(folder) = self.made {
            // It stays where somebody else has put something in it.
            let _ = std::fs::remove_dir(folder);
        }
    }

    /// Moves collected files to where they belong, and says so in the reports.
    ///
    /// # Errors
    /// One sentence where a file cannot be moved.
    pub fn settle(self, batch: &mut Batch) -> Result<(), String> {
        let Some((staging, folder)) = self.staging else { return Ok(()) };
        let failed = |e: std::io::Error| format!("{}: cannot write to the folder: {e}", folder.display());
        for entry in std::fs::read_dir(staging.path()).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            std::fs::rename(entry.path(), folder.join(entry.file_name())).map_err(failed)?;
        }
        for output in batch.reports.iter_mut().filter_map(|r| r.output.as_mut()) {
            if let Some(name) = Path::new(&output.path).file_name() {
                output.path = folder.join(name).display().to_string();
            }
        }
        Ok(())
    }
}

/// `stem.extension`, with a number where that is taken; names that differ only in case count as one.
fn free_name(input: &Path, extension: &str, taken: &mut BTreeSet<String>) -> String {
    let stem = input.file_stem().map_or_else(|| "mesh".into(), |s| s.to_string_lossy().into_owned());
    let numbered =
        |n: usize| if n == 1 { format!("{stem}.{extension}") } else { format!("{stem}-{n}.{extension}") };
    (1..)
        .map(numbered)
        .find(|name| taken.insert(name.to_lowercase()))
        .expect("there are more numbers than inputs")
}

fn folder_exists(folder: Option<&Path>) -> Result<(), String> {
    match folder {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(format!("{}: there is no such folder to write to", folder.display()))
        }
        _ => Ok(()),
    }
}

fn not_an_input(output: &Path, inputs: &[PathBuf]) -> Result<(), String> {
    let Ok(real) = output.canonicalize() else { return Ok(()) };
    if inputs.iter().any(|input| input.canonicalize().is_ok_and(|i| i == real)) {
        return Err(format!("{}: the output is one of the inputs", output.display()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_collide() {
        let mut taken = BTreeSet::new();
        let names: Vec<String> = ["a/x.step", "b/X.stp", "x.p21", "y"]
            .iter()
            .map(|p| free_name(Path::new(p), "ply", &mut taken))
            .collect();
        assert_eq!(names, ["x.ply", "X-2.ply", "x-3.ply", "y.ply"]);
    }
}
