//! `chordal render` on the command line.

mod common;

use common::{model, run};

/// Without the feature the program says how to get a build that draws, and writes nothing.
#[cfg(not(feature = "gpu"))]
#[test]
fn a_build_without_pictures_says_how_to_get_one_with() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let ran = run("render {} -o {}", &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("--features gpu"), "{}", ran.stderr);
    assert!(!out.exists());
}

/// A picture is a PNG file, and the adapter that drew it is named.
#[cfg(feature = "gpu")]
#[test]
fn a_picture_is_written_and_the_adapter_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let ran = run(
        "render {} -o {} --size 200x100 --camera top --mode nurbs --normals interpolated",
        &[&model("bracket"), &out],
    );
    if ran.lacks_gpu() {
        return;
    }
    let ran = ran.exits(&[0]);
    assert!(ran.stderr.contains("drawn by"), "{}", ran.stderr);
    assert!(std::fs::read(&out).unwrap().starts_with(b"\x89PNG"));
}

#[cfg(feature = "gpu")]
#[test]
fn bad_options_are_one_sentence() {
    for options in
        ["--camera corner", "--background blue", "--section 0,0,0,1", "--zoom -1", "--normals none"]
    {
        let line = format!("render {{}} -o {{}} {options}");
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.png");
        run(&line, &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
        assert!(!out.exists());
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.jpg");
    run("render {} -o {}", &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
    assert!(!out.exists());
}

#[cfg(feature = "gpu")]
#[test]
fn options_without_effect_are_refused() {
    for (options, word) in [
        ("--mode nurbs --style wireframe", "--style"),
        ("--mode nurbs --style error", "--style"),
        ("--mode nurbs --style edges --normals exact", "--normals"),
        ("--normals exact", "--normals"),
        ("--trim texture", "--trim"),
        ("--fit", "--fit"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.png");
        let line = format!("render {{}} -o {{}} {options}");
        let ran = run(&line, &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
        assert!(ran.stderr.contains(word), "{options}: {}", ran.stderr);
        assert!(!out.exists());
    }
}
