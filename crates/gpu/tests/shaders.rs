//! Every WGSL source validates, in both precisions, without any device.

use chordal_gpu::SHADERS;
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn validate(name: &str, source: &str, capabilities: Capabilities) {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
    let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module);
    info.unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
}

#[test]
fn every_shader_validates() {
    for shader in SHADERS {
        let sampled = Capabilities::IMMEDIATES | Capabilities::MULTISAMPLED_SHADING;
        validate(shader.name, &shader.source::<f32>(), sampled);
        if shader.generic {
            let name = format!("{} in f64", shader.name);
            validate(&name, &shader.source::<f64>(), Capabilities::IMMEDIATES | Capabilities::FLOAT64);
        }
    }
}

#[test]
fn every_wgsl_file_is_part_of_a_shader() {
    let all: String = SHADERS.iter().map(|s| s.source::<f32>()).collect();
    for folder in ["src/kernels", "src/draw"] {
        let Ok(entries) = std::fs::read_dir(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder))
        else {
            continue;
        };
        for path in entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "wgsl"))
        {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(all.contains(&text), "{} is in no shader of SHADERS", path.display());
        }
    }
}
