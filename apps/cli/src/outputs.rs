//! Which file every input is written to.

use crate::args::{FormatArg, MeshArgs};
use crate::inputs::Input;
use chordal::{OutputFormat, Report};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The destination of the mesh of one input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file.
    File(PathBuf),
}

/// The destinations of all meshes.
#[derive(Debug)]
pub struct Outputs {
    targets: Vec<Target>,
    /// The format of each.
    formats: Vec<OutputFormat>,
    /// The folder, where this run made it.
    made: Option<PathBuf>,
    /// All or nothing: the files are collected here first. By the folder that they belong in.
    staging: BTreeMap<PathBuf, TempDir>,
}

/// Plans one output per input.
///
/// Without `-o` a mesh lies beside its input, that of standard input goes to standard output. Meshes of one
/// name in one folder get `name`, `name-2`, `name-3` …, in the order of the inputs.
///
/// # Errors
/// One sentence where the outputs cannot be: several inputs for one file, an extension that names no format,
/// a folder that is missing, an output that is one of the inputs.
pub fn plan(args: &MeshArgs, inputs: &[Input]) -> Result<Outputs, String> {
    let mut made = None;
    let (targets, formats) = match &args.output {
        Some(out) if out.as_os_str() == "-" => one(inputs, args.format(), Target::Stdout, "-")?,
        Some(out) if is_folder(out) => {
            made = (!out.is_dir()).then(|| out.clone());
            in_folder(out, inputs, args.format())?
        }
        Some(out) => {
            folder_exists(out.parent())?;
            let format = format_of(out, args.format.map(FormatArg::format))?;
            one(inputs, format, Target::File(out.clone()), &out.display().to_string())?
        }
        None => beside(inputs, args.format()),
    };
    targets.iter().try_for_each(|target| not_an_input(target, inputs))?;
    let mut outputs = Outputs { targets, formats, made, staging: BTreeMap::new() };
    if args.strict && inputs.len() > 1 {
        outputs.stage()?;
    }
    Ok(outputs)
}

type Plan = (Vec<Target>, Vec<OutputFormat>);

fn is_folder(out: &Path) -> bool {
    out.as_os_str().to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR]) || out.is_dir()
}

/// The format of an output file: the one given, or that of the extension.
///
/// # Errors
/// One sentence where neither names a format, or where they name different ones.
pub fn format_of(out: &Path, given: Option<OutputFormat>) -> Result<OutputFormat, String> {
    let extension = out.extension().and_then(|e| e.to_str()).unwrap_or_default();
    match (given, OutputFormat::from_extension(extension)) {
        (Some(given), Some(named)) if given.extension() != named.extension() => Err(format!(
            "{}: --format names {given}, and the extension .{extension} names {named}; they must agree",
            out.display()
        )),
        (Some(given), _) => Ok(given),
        (None, Some(named)) => Ok(named),
        (None, None) => Err(format!(
            "{}: unsupported output extension (supported: stl, ply, obj, glb, gltf, 3mf)",
            out.display()
        )),
    }
}

fn one(inputs: &[Input], format: OutputFormat, target: Target, name: &str) -> Result<Plan, String> {
    match inputs.len() {
        1 => Ok((vec![target], vec![format])),
        n => Err(format!("{name}: {n} inputs need a folder as output")),
    }
}

fn in_folder(out: &Path, inputs: &[Input], format: OutputFormat) -> Result<Plan, String> {
    let mut taken = BTreeSet::new();
    let mut targets = Vec::with_capacity(inputs.len());
    for input in inputs {
        let below = match input {
            Input::Stdin => Path::new("stdin"),
            Input::File { below, .. } => below,
        };
        let path = free_path(&out.join(below), format.extension(), &mut taken);
        let folder = path.parent().unwrap_or(out);
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("{}: cannot make the folder: {e}", folder.display()))?;
        targets.push(Target::File(path));
    }
    Ok((targets, vec![format; inputs.len()]))
}

fn beside(inputs: &[Input], format: OutputFormat) -> Plan {
    let mut taken = BTreeSet::new();
    let target = |input: &Input| match input {
        Input::Stdin => Target::Stdout,
        Input::File { path, .. } => {
            Target::File(free_path(&path.with_extension(""), format.extension(), &mut taken))
        }
    };
    (inputs.iter().map(target).collect(), vec![format; inputs.len()])
}

impl Outputs {
    /// One per input, with its format: where it goes in the end.
    pub fn targets(&self) -> impl Iterator<Item = (&Target, OutputFormat)> {
        self.targets.iter().zip(self.formats.iter().copied())
    }

    /// Where a file is to be written for now.
    pub fn path_now(&self, path: &Path) -> PathBuf {
        let staged = path.parent().and_then(|folder| self.staging.get(folder));
        match (staged, path.file_name()) {
            (Some(folder), Some(name)) => folder.path().join(name),
            _ => path.to_owned(),
        }
    }

    fn stage(&mut self) -> Result<(), String> {
        for target in &self.targets {
            let Target::File(path) = target else { continue };
            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
            let Entry::Vacant(entry) = self.staging.entry(folder) else { continue };
            let there = if entry.key().as_os_str().is_empty() { Path::new(".") } else { entry.key() };
            let made = tempfile::Builder::new().prefix(".chordal-").tempdir_in(there);
            let made = made.map_err(|e| format!("{}: cannot write to the folder: {e}", there.display()))?;
            entry.insert(made);
        }
        Ok(())
    }

    /// Nothing was written: leaves no trace.
    pub fn discard(self) {
        drop(self.staging);
        if let Some(folder) = self.made {
            remove_empty(&folder);
        }
    }

    /// Moves collected files to where they belong.
    ///
    /// # Errors
    /// One sentence where a file cannot be moved.
    pub fn settle(self) -> Result<(), String> {
        for (folder, staging) in &self.staging {
            let failed = |e: std::io::Error| format!("{}: cannot write to the folder: {e}", folder.display());
            for entry in std::fs::read_dir(staging.path()).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                std::fs::rename(entry.path(), folder.join(entry.file_name())).map_err(failed)?;
            }
        }
        Ok(())
    }
}

/// Removes folders that have nothing in them; a folder that somebody else has put something in stays.
fn remove_empty(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.path().is_dir() {
            remove_empty(&entry.path());
        }
    }
    let _ = std::fs::remove_dir(folder);
}

/// `stem.extension`, with a number where that is taken; names that differ only in case count as one.
fn free_path(stem: &Path, extension: &str, taken: &mut BTreeSet<String>) -> PathBuf {
    let name = stem.file_name().map_or_else(|| "mesh".into(), |s| s.to_string_lossy().into_owned());
    let numbered = |n: usize| match n {
        1 => stem.with_file_name(format!("{name}.{extension}")),
        n => stem.with_file_name(format!("{name}-{n}.{extension}")),
    };
    (1..)
        .map(numbered)
        .find(|path| taken.insert(path.to_string_lossy().to_lowercase()))
        .expect("there are more numbers than inputs")
}

fn folder_exists(folder: Option<&Path>) -> Result<(), String> {
    match folder {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(format!("{}: no such folder", folder.display()))
        }
        _ => Ok(()),
    }
}

/// A hint for a triangle mesh in place of a model: its name is that of the output.
fn mesh_hint(output: &Path) -> &'static str {
    let is_obj = output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if is_obj {
        ""
    } else {
        ", and a mesh already; `chordal check` examines meshes, `chordal sew` joins their borders"
    }
}

fn not_an_input(target: &Target, inputs: &[Input]) -> Result<(), String> {
    let Target::File(output) = target else { return Ok(()) };
    let Ok(real) = output.canonicalize() else { return Ok(()) };
    let is_output = |input: &Input| match input {
        Input::Stdin => false,
        Input::File { path, .. } => path.canonicalize().is_ok_and(|path| path == real),
    };
    if inputs.iter().any(is_output) {
        return Err(format!("{}: the output is one of the inputs{}", output.display(), mesh_hint(output)));
    }
    Ok(())
}

/// Adds the written file to a report, under its final name.
pub fn add_output(
    report: &mut Report,
    target: &Target,
    format: OutputFormat,
    summary: &chordal::write::WriteSummary,
) {
    let path = match target {
        Target::Stdout => "-".into(),
        Target::File(path) => path.display().to_string(),
    };
    report.add_output(&path, format, summary);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_must_agree_with_the_extension() {
        use OutputFormat::{Glb, StlAscii, StlBinary};
        let of = |name: &str, given| format_of(Path::new(name), given).ok();
        assert_eq!(of("a.STL", None), Some(StlBinary));
        assert_eq!(of("a.stl", Some(StlAscii)), Some(StlAscii));
        assert_eq!(of("a.mesh", Some(Glb)), Some(Glb));
        assert_eq!((of("a.stl", Some(Glb)), of("a.mesh", None), of("a", None)), (None, None, None));
    }

    #[test]
    fn names_do_not_collide() {
        let mut taken = BTreeSet::new();
        let names: Vec<String> = ["o/x", "o/X", "o/x", "o/b/x", "o/y.v2"]
            .iter()
            .map(|p| free_path(Path::new(p), "ply", &mut taken).to_string_lossy().replace('\\', "/"))
            .collect();
        assert_eq!(names, ["o/x.ply", "o/X-2.ply", "o/x-3.ply", "o/b/x.ply", "o/y.v2.ply"]);
    }
}
