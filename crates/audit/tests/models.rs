//! Real models, meshed and audited: what is found, and what the audit costs beside the meshing.
//!
//! `cargo test --release -p chordal-audit --test models -- --ignored --nocapture` reads them from
//! `CHORDAL_MODELS`, or else from `../shared/models` beside the repository; `CHORDAL_ONLY` picks those whose
//! name contains it, `CHORDAL_SHARE` the tolerance as a share of each part's diagonal (1e-3).

#![allow(clippy::unwrap_used)]

mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

fn models() -> Vec<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = std::env::var_os("CHORDAL_MODELS").map_or(beside, PathBuf::from).join("step");
    let only = std::env::var("CHORDAL_ONLY").unwrap_or_default();
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("SKIPPED: there are no models at {}", folder.display());
        return Vec::new();
    };
    let mut found: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    found.retain(|p| {
        p.extension().is_some_and(|e| e.to_ascii_lowercase().to_string_lossy().starts_with("st"))
    });
    found.retain(|p| p.to_string_lossy().contains(&only));
    found.sort();
    found
}

#[test]
#[ignore = "minutes; a report to read, not a gate"]
fn real_models_are_audited() {
    let share: f64 = std::env::var("CHORDAL_SHARE").map_or(1e-3, |s| s.parse().unwrap());
    for path in models() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let model = match chordal_read::read_file(&path, &chordal_read::ReadOptions::default()) {
            Ok(model) => model,
            Err(e) => {
                println!("{name}: {e}");
                continue;
            }
        };
        let (mut triangles, mut meshing, mut auditing, mut failed) = (0, 0.0, 0.0, 0);
        let mut kinds: BTreeMap<_, (usize, String)> = BTreeMap::new();
        for part in &model.parts {
            let tolerance = share * common::diagonal(part);
            if tolerance == 0.0 {
                continue;
            }
            let clock = Instant::now();
            let (mesh, report) = common::mesh(part, tolerance, None);
            meshing += clock.elapsed().as_secs_f64();
            let clock = Instant::now();
            let audit = common::audit(part, &mesh, &report, tolerance);
            auditing += clock.elapsed().as_secs_f64();
            triangles += mesh.triangle_count();
            failed += report.faces.iter().filter(|f| f.failed.is_some()).count();
            for problem in audit.problems {
                if std::env::var_os("CHORDAL_ONLY").is_some() {
                    println!("    {problem}");
                }
                let entry = kinds.entry(problem.issue.code()).or_insert((0, problem.to_string()));
                entry.0 += 1;
            }
        }
        println!(
            "{name}: {triangles} triangles, {failed} faces failed, meshing {meshing:.2} s, audit \
             {auditing:.2} s ({:.0} %)",
            100.0 * auditing / meshing
        );
        for (kind, (count, sentence)) in kinds {
            println!("    {count} × {kind}, as: {sentence}");
        }
    }
}
