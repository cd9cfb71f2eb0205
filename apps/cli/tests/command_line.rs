//! Options, exit codes, channels and files.

mod common;

use common::{chordal, corpus, files_in, json, model, run};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn options_without_effect_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let bracket = model("bracket");
    let refused = |line: &str, paths: &[&Path], word: &str| {
        let ran = run(line, paths).exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains(word), "{line}: {}", ran.stderr);
    };
    refused("mesh {} -o {} --winding even", &[&bracket, &at("a.stl")], "no effect on STEP");
    refused("mesh {} -o {} --winding odd", &[&bracket, &at("a.stl")], "no effect on STEP");
    refused("mesh {} -o {} --format glb", &[&bracket, &at("a.stl")], "must agree");
    refused("mesh {} -o {} --edges", &[&bracket, &at("a.stl")], "--edges");
    refused("mesh {} -o {} --quads", &[&bracket, &at("a.stl")], "--quads");
    let estimated = "mesh {} -o {} --strategy grid --bound estimated";
    refused(&format!("{estimated} --max-edge 1mm"), &[&bracket, &at("a.stl")], "--max-edge");
    refused(&format!("{estimated} --angle 5deg"), &[&bracket, &at("a.stl")], "--angle");
    refused("compare {} --strategy grid", &[&bracket], "--strategies");
    for command in ["compare", "bench"] {
        refused(&format!("{command} {{}} --sew auto"), &[&bracket], "--sew");
        refused(&format!("{command} {{}} --no-self-intersections"), &[&bracket], "--no-self-intersections");
    }
    refused("compare {} --bound estimated --strategies grid,cells --angle 5deg", &[&bracket], "--angle");
    refused("bench {} --bound estimated --strategy grid --max-edge 1mm", &[&bracket], "--max-edge");
    for option in
        ["--repeat 3", "--strategy grid", "--edge-method bezier2d", "--bound proven", "--winding odd"]
    {
        let name = option.split(' ').next().unwrap_or_default();
        refused(&format!("bench {{}} --papers {option}"), &[&bracket], name);
    }
    refused("info {} --full --json", &[&bracket], "--full");
    refused("info {} --input-format iges", &[&bracket], "is STEP, not IGES");
    assert_eq!(files_in(folder.path()), Vec::<String>::new());
}

/// The unit and the axis change the bytes of a file of any format.
#[test]
fn options_of_the_output_change_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    for extension in ["stl", "ply", "obj", "glb", "gltf", "3mf"] {
        let other_axis = if extension.starts_with("gl") { "--up z" } else { "--up y" };
        let mesh = |options: &str| {
            let made = folder.path().join(format!("out.{extension}"));
            let line = format!("mesh {{}} -o {{}} -q --tolerance 1% {options}");
            run(&line, &[&model("blade"), &made]).exits(&[0]);
            let files = files_in(folder.path());
            files
                .iter()
                .flat_map(|name| fs::read(folder.path().join(name)).expect("a file"))
                .collect::<Vec<u8>>()
        };
        let plain = mesh("");
        assert!(plain == mesh(""), "{extension}");
        for options in ["--unit in", other_axis] {
            assert!(plain != mesh(options), "{options} has no effect on {extension}");
        }
    }
}

#[test]
fn a_model_given_to_be_checked_gets_a_hint() {
    let folder = tempfile::tempdir().expect("a folder");
    let bracket = model("bracket");
    for ran in [run("check {}", &[&bracket]), run("sew {} -o {}", &[&bracket, &folder.path().join("a.stl")])]
    {
        let ran = ran.exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains("`chordal mesh`"), "{}", ran.stderr);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn results_that_cannot_be_written_are_told() {
    let full = |line: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_chordal"));
        command.args(line.split(' ')).arg(model("bracket"));
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
        let ran = command.stdout(full).output().expect("the program starts");
        (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned())
    };
    let (code, said) = full("info");
    assert!(code == Some(1) && said.contains("cannot write to standard output"), "{said}");
    let (code, said) = full("mesh -o - -q");
    assert!(code == Some(2) && said.contains("standard output: cannot write the mesh"), "{said}");
}

#[test]
fn messages_name_no_temporary_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let bracket = model("bracket");
    let below_a_file = folder.path().join("gone/a.svg");
    let ran = run("compare {} --strategies default -q --tolerance 1% --plot {}", &[&bracket, &below_a_file]);
    let ran = ran.exits(&[1]);
    assert!(ran.stderr.contains("a.svg") && !ran.stderr.contains(".chordal-"), "{}", ran.stderr);
    for option in ["--face-timeout", "--jobs"] {
        let ran = run(&format!("mesh {{}} {option} -1"), &[&bracket]).exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains("number of"), "{}", ran.stderr);
    }
}

#[test]
fn a_mesh_given_to_be_meshed_gets_a_hint() {
    let folder = tempfile::tempdir().expect("a folder");
    for extension in ["stl", "ply", "glb", "3mf"] {
        let mesh = folder.path().join("a").with_extension(extension);
        run("mesh {} -o {} -q", &[&model("bracket"), &mesh]).exits(&[0]);
        let ran = run("mesh {}", &[&mesh]).exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains("`chordal check`"), "{}", ran.stderr);
    }
    let ascii = folder.path().join("b.stl");
    run("mesh {} -o {} --format stl-ascii -q", &[&model("bracket"), &ascii]).exits(&[0]);
    let ran = run("mesh {} -o {}", &[&ascii, &folder.path().join("c.obj")]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("(STL)"), "{}", ran.stderr);
}

#[test]
fn help_and_version_are_data() {
    for line in ["--help", "-h", "mesh --help", "info --help", "check --help", "bench --help", "--version"] {
        let ran = run(line, &[]).exits(&[0]);
        assert!(!ran.stdout.is_empty() && ran.stderr.is_empty(), "{line}");
    }
    assert!(run("--version", &[]).stdout.starts_with("chordal 0."));
    let help = run("mesh --help", &[]).stdout;
    for word in
        ["0.1%", "20deg", "--sag", "linear-deflection", "angular-deflection", "a bare number is in mm"]
    {
        assert!(help.contains(word), "{word}");
    }
    assert!(!run("--help", &[]).stdout.contains("bench"));
}

#[test]
fn mistakes_are_one_sentence_and_exit_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.stl");
    let bracket = model("bracket");
    let cases: [(&str, &[&Path], &str); 20] = [
        ("mesh {} -o {} --tolerance 0", &[&bracket, &out], "greater than zero"),
        ("mesh {} -o {} --tolerance -1mm", &[&bracket, &out], "greater than zero"),
        ("mesh {} -o {} --tolerance 0.1furlong", &[&bracket, &out], "furlong"),
        ("mesh {} -o {} --tolerance nan", &[&bracket, &out], "number"),
        ("mesh {} -o {} --sag 1mm%", &[&bracket, &out], "percentage"),
        ("mesh {} -o {} --angle 20mm", &[&bracket, &out], "angle"),
        ("mesh {} -o {} --jobs 0", &[&bracket, &out], "threads"),
        ("mesh {} -o {} --unit parsec", &[&bracket, &out], "parsec"),
        ("mesh {} -o {} --tollerance 1mm", &[&bracket, &out], "--tollerance"),
        ("mesh {} {} -o -", &[&bracket, &bracket], "folder"),
        ("mesh {} -o - --json", &[&bracket], "--json"),
        ("mesh {} -o {} --edges", &[&bracket, &out], "--edges"),
        ("mesh {} -o {} --quads", &[&bracket, &out], "--quads"),
        ("check {} --tolerance 1mm", &[&bracket], "--against"),
        ("mesh {} -o {}.xyz", &[&bracket], "{}.xyz"),
        ("mesh no-such-file.step -o {}", &[&out], "no-such-file.step"),
        ("mesh {} -o no-such-folder/out.stl", &[&bracket], "no-such-folder"),
        ("mesh {} {} -o {}", &[&bracket, &bracket, &out], "folder"),
        ("mesh {} -o {} --report no-such-folder/r.json", &[&bracket, &out], "no-such-folder"),
        ("frobnicate", &[], "frobnicate"),
    ];
    for (line, paths, word) in cases {
        let ran = run(line, paths).exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains(word), "{line}: {}", ran.stderr);
    }
    assert_eq!(files_in(folder.path()), [""; 0]);
}

#[test]
fn a_tolerance_that_no_coordinate_can_hold_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.ply");
    let ran =
        run("mesh {} -o {} --tolerance 1e-18mm", &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("below double precision"), "{}", ran.stderr);
    assert!(!out.exists());
}

#[test]
fn an_output_is_never_an_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("copy.step");
    fs::copy(model("bracket"), &copy).expect("a copy");
    let ran = run("mesh {} -o {} --format ply", &[&copy, &copy]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("one of the inputs"), "{}", ran.stderr);
    assert_eq!(fs::read(&copy).expect("bytes"), fs::read(model("bracket")).expect("bytes"));
}

#[test]
fn a_mesh_goes_to_its_file_and_talk_to_standard_error() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a.stl", "a.ply", "a.obj", "a.glb", "a.3mf"] {
        let out = folder.path().join(name);
        let ran = run("mesh {} -o {}", &[&model("bracket"), &out]).exits(&[0]);
        assert_eq!(ran.stdout, "");
        assert!(
            ran.stderr.contains("tolerance 0.1 % = ") && ran.stderr.contains("angle 20"),
            "{}",
            ran.stderr
        );
        assert!(fs::metadata(&out).expect("a mesh").len() > 1000, "{name}");
        let ran = run("mesh {} -o {} --quiet", &[&model("bracket"), &out]).exits(&[0]);
        assert_eq!((ran.stdout.as_str(), ran.stderr.as_str()), ("", ""));
    }
}

#[test]
fn the_report_says_what_was_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, report) = (folder.path().join("out.ply"), folder.path().join("r.json"));
    let line = "mesh {} -o {} --report {} --tolerance 50um --angle off --max-edge 1cm --jobs 2";
    run(line, &[&model("bracket"), &out, &report]).exits(&[0]);
    let report = json(&report);
    assert_eq!(report["schema"], "chordal-report/2");
    assert_eq!(report["options"]["tolerance"], 0.05);
    assert_eq!(report["options"]["angle"], serde_json::Value::Null);
    assert_eq!(report["options"]["max_edge"], 10.0);
    assert_eq!(report["threads"], 2);
    assert_eq!(report["faces"]["total"], 28);
    assert_eq!(report["faces"]["meshed"], 28);
    assert_eq!(report["closedness"], "closed");
    assert_eq!(report["clean"], true);
    assert!(report["proven_error"].as_f64().is_some_and(|e| e > 0.0 && e <= 0.05));
    assert_eq!(report["faces_detail"].as_array().map(Vec::len), Some(28));
    for field in
        ["max_edge_gap", "lower_bound", "edge_rounds", "triangles", "vertices", "open_edges", "peak_memory"]
    {
        assert!(report[field].is_number(), "{field}");
    }
    for stage in ["read", "trim", "edges", "faces", "stitch", "audit", "write"] {
        assert!(report["seconds"][stage].is_number(), "{stage}");
    }
}

#[test]
fn every_field_of_a_report_is_documented() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, path) = (folder.path().join("out.ply"), folder.path().join("r.json"));
    run("mesh {} -o {} --report {}", &[&model("bracket"), &out, &path]).exits(&[0, 1]);
    let documented = fs::read_to_string(corpus().join("../docs/report.md")).expect("the documentation");
    let report = json(&path);
    let fields = report.as_object().expect("an object").iter().flat_map(|(name, value)| {
        let of = value.as_array().and_then(|list| list.first()).unwrap_or(value);
        let inner: Vec<String> = of.as_object().map_or(Vec::new(), |o| o.keys().cloned().collect());
        std::iter::once(name.clone()).chain(inner)
    });
    for field in fields {
        let named = [format!("`{field}`"), format!("{field},"), format!("{field}}}"), format!("{{{field}")];
        assert!(
            named.iter().any(|name| documented.contains(name)),
            "docs/report.md does not mention {field}"
        );
    }
}

#[test]
fn many_inputs_go_to_a_folder_without_collisions() {
    let folder = tempfile::tempdir().expect("a folder");
    let other = folder.path().join("other");
    fs::create_dir(&other).expect("a folder");
    let twin = other.join("Bracket.step");
    fs::copy(model("bracket"), &twin).expect("a copy");
    let out = folder.path().join("out/");
    let slash = format!("{}/", out.display());
    let report = folder.path().join("r.json");

    run("mesh {} {} -o {}", &[&model("bracket"), &twin, Path::new(&slash)]).exits(&[0]);
    assert_eq!(files_in(&out), ["Bracket-2.glb", "bracket.glb"]);
    fs::remove_dir_all(&out).expect("removed");

    let line = "mesh {} {} {} -o {} --format ply --report {}";
    run(line, &[&model("bracket"), &twin, &model("sphere_full"), Path::new(&slash), &report]).exits(&[0]);
    assert_eq!(files_in(&out), ["Bracket-2.ply", "bracket.ply", "sphere_full.ply"]);
    let batch = json(&report);
    assert_eq!(batch["schema"], "chordal-report-batch/2");
    assert_eq!(batch["reports"].as_array().map(Vec::len), Some(3));
}

#[test]
fn one_bad_input_of_many_is_exit_1_and_with_strict_nothing_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let empty = corpus().join("bad/empty.step");
    let out = folder.path().join("out");
    let slash = format!("{}/", out.display());
    let line = "mesh {} {} -o {} --format stl";
    run(line, &[&model("bracket"), &empty, Path::new(&slash)]).exits(&[1]);
    assert_eq!(files_in(&out), ["bracket.stl"]);

    let strict = folder.path().join("strict");
    let slash = format!("{}/", strict.display());
    let line = "mesh {} {} -o {} --format stl --strict";
    run(line, &[&model("bracket"), &empty, Path::new(&slash)]).exits(&[2]);
    assert!(!strict.exists());
    let line = "mesh {} {} -o {} --format obj --strict";
    run(line, &[&model("bracket"), &model("sphere_full"), Path::new(&slash)]).exits(&[0]);
    assert_eq!(files_in(&strict), ["bracket.obj", "sphere_full.obj"]);
}

#[test]
fn strict_writes_nothing_where_there_is_a_problem() {
    let folder = tempfile::tempdir().expect("a folder");
    let broken = corpus().join("bad/missing_entity.step");
    let (out, report) = (folder.path().join("out.ply"), folder.path().join("r.json"));
    let ran =
        run("mesh {} -o {} --report {} --strict", &[&broken, &out, &report]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("--strict"), "{}", ran.stderr);
    assert_eq!(files_in(folder.path()), [""; 0]);

    let ran = run("mesh {} -o {} --report {}", &[&broken, &out, &report]).exits(&[1]);
    assert!(ran.stderr.contains("problem: ") && ran.stderr.contains('#'), "{}", ran.stderr);
    let report = json(&report);
    assert_eq!(report["clean"], false);
    assert_eq!((&report["faces"]["failed"], &report["missing_faces"]), (&1.into(), &1.into()));
    let failed = &report["problems"][0];
    assert!(
        failed["entity"].as_str().is_some_and(|id| id.starts_with('#')) && failed["line"].as_u64() > Some(0)
    );
    let face = failed["face"].as_u64().expect("the index of a face") as usize;
    assert_eq!(
        (&failed["severity"], &report["faces_detail"][face]["status"]),
        (&"error".into(), &"failed".into())
    );
}

#[test]
fn info_is_data() {
    let ran = run("info {}", &[&model("bracket")]).exits(&[0]);
    assert!(ran.stderr.is_empty(), "{}", ran.stderr);
    for word in ["28", "plane", "cylinder", "tree", "gaps", "unit"] {
        assert!(ran.stdout.contains(word), "{word} is not in\n{}", ran.stdout);
    }
    let ran = run("info {} --json", &[&model("assembly_200")]).exits(&[0]);
    let info: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(info["faces"], 1280);
    assert_eq!(info["parts"].as_array().map(Vec::len), Some(4));
    run("info no-such-file", &[]).exits(&[2]).says_one_sentence();
}

#[test]
fn bench_prints_its_timings() {
    let line = "bench {} --repeat 2 --warm 0 --tolerance 0.1mm";
    let ran = run(line, &[&model("bracket")]).exits(&[0]);
    let timings: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(timings[0]["mesh"].as_array().map(Vec::len), Some(2));
    assert_eq!(timings[0]["faces"], 28);
}

#[test]
fn an_unwritable_output_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.ply");
    fs::write(&out, "before").expect("a file");
    run("mesh {} -o {}", &[&corpus().join("bad/not_step.step"), &out]).exits(&[2]).says_one_sentence();
    assert_eq!(fs::read_to_string(&out).expect("a file"), "before");
    chordal(["mesh"]).exits(&[2]).says_one_sentence();
}

#[test]
fn without_an_output_the_mesh_lies_beside_its_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("part.v2.step");
    fs::copy(model("bracket"), &copy).expect("a copy");
    // The subcommand may be missing, too.
    run("{} -q", &[&copy]).exits(&[0]);
    run("mesh {} -q --format stl", &[&copy]).exits(&[0]);
    assert_eq!(files_in(folder.path()), ["part.v2.glb", "part.v2.step", "part.v2.stl"]);
    let glb = fs::read(folder.path().join("part.v2.glb")).expect("a mesh");
    assert_eq!(&glb[..4], b"glTF");
}

#[test]
fn standard_input_and_output_are_files_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.stl");
    run("mesh {} -o {} -q", &[&model("bracket"), &file]).exits(&[0]);
    let expected = fs::read(&file).expect("a mesh");
    for line in [
        "mesh - -o - --format stl -q",
        "- --format stl -q",
        "mesh - --input-format step --format stl -q -o -",
    ] {
        let input = fs::File::open(model("bracket")).expect("a model");
        let args = line.split(' ');
        let ran =
            Command::new(env!("CARGO_BIN_EXE_chordal")).args(args).stdin(input).output().expect("it runs");
        assert!(ran.status.success(), "{line}: {}", String::from_utf8_lossy(&ran.stderr));
        assert!(ran.stdout == expected, "{line}");
    }
    assert_eq!(files_in(folder.path()), ["a.stl"]);
}

#[test]
fn a_folder_is_an_input_and_keeps_its_tree() {
    let folder = tempfile::tempdir().expect("a folder");
    let parts = folder.path().join("parts");
    fs::create_dir_all(parts.join("left")).expect("folders");
    fs::create_dir_all(parts.join("right")).expect("folders");
    for name in ["left/bracket.step", "right/bracket.step", "ball.stp"] {
        fs::copy(model("sphere_full"), parts.join(name)).expect("a copy");
    }
    fs::write(parts.join("notes.txt"), "no model").expect("a file");
    let out = folder.path().join("out");
    let slash = format!("{}/", out.display());
    let ran = run("mesh {} -o {} --json -q", &[&parts, Path::new(&slash)]).exits(&[0]);
    assert_eq!(files_in(&out), ["ball.glb", "left", "right"]);
    assert_eq!(
        (files_in(&out.join("left")), files_in(&out.join("right"))),
        (vec!["bracket.glb".into()], vec!["bracket.glb".into()])
    );
    let batch: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(batch["reports"].as_array().map(Vec::len), Some(3));
    assert!(batch["reports"][0]["output"]["path"].as_str().is_some_and(|path| path.ends_with("ball.glb")));
}

#[test]
fn completions_and_the_manual_page_are_made() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = chordal(["completions", shell]).exits(&[0]);
        assert!(ran.stdout.contains("chordal") && ran.stdout.contains("tolerance"), "{shell}");
    }
    let page = run("man", &[]).exits(&[0]).stdout;
    assert!(page.contains(".TH chordal") && page.contains("boundary") && page.contains("OPTIONS"));
}

#[test]
fn verbose_shows_the_stages() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("a.gltf");
    let ran = run("mesh {} -o {} -v", &[&model("bracket"), &out]).exits(&[0]);
    assert!(
        ran.stderr.contains("audit") && ran.stderr.contains("all 28 faces proven within"),
        "{}",
        ran.stderr
    );
    assert!(fs::read_to_string(&out).expect("text").contains("\"asset\""));
}
