//! The documents keep up with the program: options.md has every option, and the tutorial's commands run.

mod common;

use common::{chordal, corpus};
use std::collections::BTreeSet;
use std::path::Path;

fn document(name: &str) -> String {
    let path = corpus().join("../docs").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The commands that `chordal --help` lists.
fn commands() -> Vec<String> {
    let help = chordal(["--help"]).exits(&[0]).stdout;
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let names = list.lines().take_while(|line| !line.trim().is_empty());
    let names: Vec<String> = names
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| Some(line.split_whitespace().next()?.to_owned()))
        .filter(|name| name != "help")
        .collect();
    assert!(names.len() > 5, "{names:?}");
    names
}

/// The words of a text that are long options, such as `--angle`.
fn long_options(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    text.split(|c: char| !is_part(c))
        .filter(|word| word.starts_with("--") && word.len() > 3)
        .map(|word| word.trim_end_matches('-').to_owned())
        .collect()
}

/// The options that a command defines: help lists each at the beginning of a line.
fn options_of(command: &str) -> BTreeSet<String> {
    let help = chordal([command, "--help"]).exits(&[0]).stdout;
    let (_, list) = help.split_once("Options:\n").expect("a list of options");
    let defining = list.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let first = defining.map(|line| line.split("  ").next().unwrap_or_default());
    first.flat_map(long_options).filter(|option| option != "--help").collect()
}

#[test]
fn every_option_is_documented_and_no_other() {
    let documented = document("options.md");
    let mut known = long_options(&chordal(["bench", "--help"]).exits(&[0]).stdout);
    known.extend(long_options(&chordal(["--help"]).exits(&[0]).stdout));
    for command in commands() {
        let (_, section) = documented
            .split_once(&format!("\n## {command}\n"))
            .unwrap_or_else(|| panic!("options.md has no section `{command}`"));
        assert!(section.contains(&format!("chordal {command}")), "{command} is not described");
        for option in options_of(&command) {
            assert!(documented.contains(&format!("`{option}")), "options.md lacks {option} of {command}");
        }
        known.extend(long_options(&chordal([&command, "--help"]).stdout));
    }
    for option in long_options(&documented) {
        assert!(known.contains(&option), "options.md has {option}, which no command knows");
    }
}

#[test]
fn the_commands_of_the_tutorial_run() {
    let text = document("tutorial.md");
    let scratch = tempfile::tempdir().expect("a folder");
    let mut count = 0;
    for block in text.split("```sh\n").skip(1) {
        let (block, _) = block.split_once("```").expect("a block ends");
        for line in block.lines().filter(|line| line.starts_with("chordal ")) {
            let broken = line.contains("/bad/");
            let args: Vec<String> =
                line.split_whitespace().skip(1).map(|word| place(word, scratch.path())).collect();
            chordal(&args).exits(if broken { &[1] } else { &[0] });
            count += 1;
        }
    }
    assert!(count > 7, "only {count} commands were found");
}

/// Files of the corpus at their place, all other files in a folder of the test.
fn place(word: &str, scratch: &Path) -> String {
    let is_file = [".stl", ".glb", ".ply", ".json", ".png"].iter().any(|end| word.ends_with(end));
    match word.strip_prefix("corpus/") {
        Some(name) => corpus().join(name).display().to_string(),
        None if is_file => scratch.join(word).display().to_string(),
        None => word.to_owned(),
    }
}
