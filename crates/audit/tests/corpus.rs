//! Every model of the corpus, meshed and audited.

mod common;

use std::fmt::Write;

#[test]
fn every_model_audits_clean() {
    let mut faults = String::new();
    for name in common::names() {
        eprintln!("{name}");
        let model = common::load(&name);
        for (index, part) in model.parts.iter().enumerate() {
            let diagonal = common::diagonal(part);
            for share in [1e-3, 1e-4] {
                let tolerance = share * diagonal;
                if !(tolerance > 0.0) {
                    continue;
                }
                let clock = std::time::Instant::now();
                let (mesh, report) = common::mesh(part, tolerance, None);
                let meshing = clock.elapsed().as_secs_f64();
                if meshing > 5.0 {
                    println!("{name}: slow to mesh: {meshing:.1} s");
                }
                let clock = std::time::Instant::now();
                let audit = common::audit(part, &mesh, &report, tolerance);
                let auditing = clock.elapsed().as_secs_f64();
                if mesh.triangle_count() > 2000 {
                    println!(
                        "{name}: {} triangles, mesh {meshing:.3}, audit {auditing:.3}",
                        mesh.triangle_count()
                    );
                }
                for face in report.faces.iter().filter(|f| f.failed.is_some()) {
                    println!("{name} part {index} at {share}: face {} failed: {:?}", face.face, face.failed);
                }
                for problem in &audit.problems {
                    writeln!(
                        faults,
                        "{name} part {index} at {share}: {:?} {:?}: {problem}",
                        problem.subject, problem.kind
                    )
                    .unwrap();
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{faults}");
}
