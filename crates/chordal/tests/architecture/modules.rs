//! The modules of a crate, read from its sources, and the arrows between them.

use crate::graph::Graph;
use crate::tokens::{Token, behind_bracket, tokens, without_tests};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The names of a module from the crate's root down; the root has none.
type ModulePath = Vec<String>;

/// A path in the sources, as written from `crate`, `self` or `super`, made absolute.
#[derive(Debug)]
struct Use {
    path: Vec<String>,
    place: String,
}

/// What one module holds of interest here.
#[derive(Debug, Default)]
struct Module {
    children: BTreeSet<String>,
    /// Names that a `use` brings into the module, and where they come from.
    names: BTreeMap<String, Vec<String>>,
    uses: Vec<Use>,
}

/// All modules of a crate.
#[derive(Debug, Default)]
pub struct Tree {
    modules: BTreeMap<ModulePath, Module>,
}

/// Reads a crate from its root file.
pub fn read(root: &Path) -> Tree {
    let mut tree = Tree::default();
    let folder = root.parent().expect("a file is in a folder").to_owned();
    tree.read_file(root, &folder, &Vec::new());
    tree
}

impl Tree {
    /// Reads one file; the files of its children are in `folder`.
    fn read_file(&mut self, file: &Path, folder: &Path, module: &ModulePath) {
        let source = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.read_tokens(&without_tests(&tokens(&source)), &name, folder, module);
    }

    fn read_tokens(&mut self, tokens: &[Token], file: &str, folder: &Path, module: &ModulePath) {
        self.modules.entry(module.clone()).or_default();
        let word = |i: usize| tokens.get(i).map_or("", |t: &Token| t.text.as_str());
        let mut at = 0;
        while at < tokens.len() {
            let starts_item = at == 0 || !matches!(word(at - 1), "." | "::");
            match word(at) {
                "mod" if starts_item && word(at + 2) == ";" => {
                    self.read_child(word(at + 1), folder, module);
                    at += 3;
                }
                "mod" if starts_item && word(at + 2) == "{" => {
                    let end = behind_bracket(tokens, at + 2);
                    let child = self.add_child(word(at + 1), module);
                    let body = &tokens[at + 3..end.max(at + 4) - 1];
                    self.read_tokens(body, file, &folder.join(word(at + 1)), &child);
                    at = end;
                }
                "use" if starts_item => at = self.read_use(tokens, at + 1, file, module),
                "crate" | "self" | "super" if starts_item && word(at + 1) == "::" => {
                    at = self.read_path(tokens, at, file, module);
                }
                _ => at += 1,
            }
        }
    }

    fn add_child(&mut self, name: &str, module: &ModulePath) -> ModulePath {
        self.modules.entry(module.clone()).or_default().children.insert(name.to_owned());
        module.iter().cloned().chain([name.to_owned()]).collect()
    }

    fn read_child(&mut self, name: &str, folder: &Path, module: &ModulePath) {
        let child = self.add_child(name, module);
        let below = folder.join(name);
        let candidates: [PathBuf; 2] = [folder.join(format!("{name}.rs")), below.join("mod.rs")];
        let file = candidates.iter().find(|f| f.exists());
        let file = file.unwrap_or_else(|| panic!("module {name} of {} has no file", folder.display()));
        self.read_file(file, &below, &child);
    }

    /// Reads a `use` up to its `;` and returns the position behind it.
    fn read_use(&mut self, tokens: &[Token], start: usize, file: &str, module: &ModulePath) -> usize {
        let end = (start..tokens.len()).find(|&i| tokens[i].text == ";").unwrap_or(tokens.len());
        let mut leaves = Vec::new();
        expand(&tokens[start..end], &mut Vec::new(), &mut leaves);
        for (path, name) in leaves {
            let Some(path) = self.absolute(&path, module) else { continue };
            let place = format!("{file}:{}", tokens[start].line);
            let this = self.modules.entry(module.clone()).or_default();
            this.names.insert(name, path.clone());
            this.uses.push(Use { path, place });
        }
        end + 1
    }

    /// Reads a path in code and returns the position behind it.
    fn read_path(&mut self, tokens: &[Token], start: usize, file: &str, module: &ModulePath) -> usize {
        let mut path = vec![tokens[start].text.clone()];
        let mut at = start + 1;
        while at + 1 < tokens.len() && tokens[at].text == "::" && is_name(&tokens[at + 1].text) {
            path.push(tokens[at + 1].text.clone());
            at += 2;
        }
        if let Some(path) = self.absolute(&path, module) {
            let place = format!("{file}:{}", tokens[start].line);
            self.modules.entry(module.clone()).or_default().uses.push(Use { path, place });
        }
        at
    }

    /// The path from the crate's root; none for a path into another crate.
    fn absolute(&self, path: &[String], module: &ModulePath) -> Option<Vec<String>> {
        let mut base = module.clone();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => (base, rest) = (Vec::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|word| word == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            first if !self.modules.get(module).is_some_and(|m| m.children.contains(first)) => return None,
            _ => {}
        }
        base.extend(rest.iter().cloned());
        Some(base)
    }

    /// The module in which the item of an absolute path is defined, followed through `use`.
    fn home(&self, path: &[String], steps: usize) -> ModulePath {
        let mut module = ModulePath::new();
        for (i, name) in path.iter().enumerate() {
            let here = &self.modules[&module];
            if here.children.contains(name) {
                module.push(name.clone());
                continue;
            }
            if steps > 0
                && let Some(origin) = here.names.get(name)
            {
                let full: Vec<String> = origin.iter().chain(&path[i + 1..]).cloned().collect();
                return self.home(&full, steps - 1);
            }
            break;
        }
        module
    }

    /// The graph between the children of each module that has children.
    pub fn folders(&self) -> Vec<(ModulePath, Graph)> {
        const MOST_STEPS: usize = 8;
        let mut graphs: BTreeMap<ModulePath, Graph> = BTreeMap::new();
        for (module, content) in &self.modules {
            for a_use in &content.uses {
                let home = self.home(&a_use.path, MOST_STEPS);
                let common = module.iter().zip(&home).take_while(|(a, b)| a == b).count();
                if let (Some(from), Some(to)) = (module.get(common), home.get(common)) {
                    let graph = graphs.entry(module[..common].to_vec()).or_default();
                    graph.add(from, to, &a_use.place);
                }
            }
        }
        graphs.into_iter().collect()
    }
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The leaves of a `use`: each whole path with the name that it brings in.
fn expand(tokens: &[Token], prefix: &mut Vec<String>, leaves: &mut Vec<(Vec<String>, String)>) {
    let depth = prefix.len();
    let mut at = 0;
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            "::" => at += 1,
            "{" => {
                let end = behind_bracket(tokens, at);
                for part in split_at_commas(&tokens[at + 1..end - 1]) {
                    expand(part, prefix, leaves);
                }
                prefix.truncate(depth);
                return;
            }
            "as" => {
                let name = tokens.get(at + 1).map_or_else(String::new, |t| t.text.clone());
                leaves.push((prefix.clone(), name));
                prefix.truncate(depth);
                return;
            }
            "self" if !prefix.is_empty() => at += 1,
            other => {
                prefix.push(other.to_owned());
                at += 1;
            }
        }
    }
    if let Some(last) = prefix.last().cloned() {
        leaves.push((prefix.clone(), last));
    }
    prefix.truncate(depth);
}

fn split_at_commas(tokens: &[Token]) -> Vec<&[Token]> {
    let mut parts = Vec::new();
    let (mut start, mut at) = (0, 0);
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            "{" => at = behind_bracket(tokens, at),
            "," => {
                parts.push(&tokens[start..at]);
                at += 1;
                start = at;
            }
            _ => at += 1,
        }
    }
    parts.push(&tokens[start..]);
    parts.retain(|part| !part.is_empty());
    parts
}
