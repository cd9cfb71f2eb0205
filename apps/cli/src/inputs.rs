//! What is read: files, folders of files, standard input.

use chordal::InputFormat;
use std::path::{Path, PathBuf};

/// One input of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// Standard input.
    Stdin,
    /// A file, and where its output belongs below an output folder, without the extension.
    File { path: PathBuf, below: PathBuf },
}

impl Input {
    /// A file, or standard input where the argument is `-`.
    pub fn of(argument: &Path) -> Self {
        if argument.as_os_str() == "-" {
            return Input::Stdin;
        }
        let below = PathBuf::from(argument.file_stem().unwrap_or(argument.as_os_str()));
        Input::File { path: argument.to_owned(), below }
    }

    /// Its name in messages and reports.
    pub fn name(&self) -> String {
        match self {
            Input::Stdin => "standard input".into(),
            Input::File { path, .. } => path.display().to_string(),
        }
    }
}

/// The inputs that arguments stand for: a folder stands for the CAD files in it, at any depth, in the order
/// of their names.
///
/// # Errors
/// One sentence where a folder cannot be read or has no CAD file, or where standard input is named twice.
pub fn expand(arguments: &[PathBuf]) -> Result<Vec<Input>, String> {
    let mut inputs = Vec::new();
    for argument in arguments {
        if argument.as_os_str() == "-" {
            if inputs.contains(&Input::Stdin) {
                return Err("standard input (`-`) can be read only once".into());
            }
            inputs.push(Input::Stdin);
        } else if argument.is_dir() {
            let before = inputs.len();
            collect(argument, Path::new(""), &mut inputs)?;
            if inputs.len() == before {
                return Err(format!("{}: the folder has no CAD file", argument.display()));
            }
        } else {
            inputs.push(Input::of(argument));
        }
    }
    Ok(inputs)
}

fn collect(folder: &Path, below: &Path, inputs: &mut Vec<Input>) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("{}: cannot read the folder: {e}", folder.display());
    let entries: Result<Vec<_>, _> = std::fs::read_dir(folder).map_err(failed)?.collect();
    let mut paths: Vec<PathBuf> = entries.map_err(failed)?.into_iter().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let (Some(name), Some(stem)) = (path.file_name(), path.file_stem()) else { continue };
        if path.is_dir() {
            // A link may lead back to a folder above: links are not followed.
            if !path.is_symlink() {
                collect(&path, &below.join(name), inputs)?;
            }
        } else if is_cad_file(&path) {
            let below = below.join(stem);
            inputs.push(Input::File { path, below });
        }
    }
    Ok(())
}

/// By the extension. JSON and OBJ are left out: most of such files are no CAD models.
fn is_cad_file(path: &Path) -> bool {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let format = InputFormat::of_extension(extension);
    format.is_some_and(|format| !matches!(format, InputFormat::Json | InputFormat::Obj))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_stands_for_its_cad_files() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir_all(folder.path().join("b/c")).expect("folders");
        for name in ["z.step", "a.STP", "notes.txt", "b/x.igs", "b/c/x.3dm", "r.json"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        let inputs = expand(&[folder.path().to_owned(), PathBuf::from("-")]).expect("files");
        let below: Vec<String> = inputs
            .iter()
            .map(|input| match input {
                Input::Stdin => "-".into(),
                Input::File { below, .. } => below.to_string_lossy().replace('\\', "/"),
            })
            .collect();
        assert_eq!(below, ["a", "b/c/x", "b/x", "z", "-"]);
        assert!(expand(&[PathBuf::from("-"), PathBuf::from("-")]).is_err());
        assert!(expand(&[folder.path().join("b/c/../c"), PathBuf::from("no-such-file")]).is_ok());
    }
}
