//! The box that a percentage is a percentage of, against closed forms.

use chordal::Cancel;
use chordal::brep::Model;
use chordal::nurbs::{DAffine3, DVec3};
use chordal::stages::{edge_box, part_uses, tight_box};
use chordal_nurbs::math;
use std::path::Path;

fn model(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step");
    chordal::Model::open(&path).expect("a model of the corpus").brep().clone()
}

fn size(model: &Model) -> DVec3 {
    let uses = part_uses(model);
    let found = tight_box(model, &uses, edge_box(model, &uses), None, &Cancel::default());
    found.max - found.min
}

/// Turns and scales the whole model.
fn placed(mut model: Model, by: DAffine3) -> Model {
    for root in model.roots.clone() {
        let node = &mut model.nodes[root.index()];
        node.transform = by * node.transform;
    }
    model
}

#[track_caller]
fn assert_near(found: DVec3, expected: DVec3, what: &str) {
    let off = (found - expected).abs().max_element() / expected.length();
    assert!(off < 1e-5, "{what}: {found} is not {expected}");
}

#[test]
fn boxes_are_those_of_the_closed_forms() {
    for (name, x, y, z) in [
        ("sphere_full", 20.0, 20.0, 20.0),
        ("sphere_no_loop", 20.0, 20.0, 20.0),
        ("torus_full", 52.0, 52.0, 12.0),
        ("torus_no_loop", 52.0, 52.0, 12.0),
        ("cylinder_oblique", 20.0, 20.0, 25.0),
        ("sphere_cap", 20.0, 20.0, 16.0),
        ("spline_ball", 20.0, 20.0, 20.0),
    ] {
        assert_near(size(&model(name)), DVec3::new(x, y, z), name);
    }
}

/// A ball has the same box whichever way it is turned; a torus reaches R·√(1 − d·z²) + r along d.
#[test]
fn boxes_turn_with_the_model() {
    for angle in [0.1, 0.7, 1.3] {
        let turn = DAffine3::from_quat(math::rotation(DVec3::new(1.0, 2.0, -0.5).normalize(), angle));
        assert_near(size(&placed(model("spline_ball"), turn)), DVec3::splat(20.0), "a turned ball");
        let axis = turn.transform_vector3(DVec3::Z);
        let reach = DVec3::AXES.map(|d| 2.0 * (20.0 * (1.0 - math::square(d.dot(axis))).sqrt() + 6.0));
        assert_near(size(&placed(model("torus_full"), turn)), DVec3::from_array(reach), "a turned torus");
    }
}

#[test]
fn boxes_scale_and_mirror_with_the_model() {
    for name in ["bracket", "blade", "thread"] {
        let once = size(&model(name));
        let large = DAffine3::from_scale(DVec3::new(1000.0, -1000.0, 1000.0));
        let off = (size(&placed(model(name), large)) / 1000.0 - once).abs().max_element();
        assert!(off < 1e-6 * once.length(), "{name}: {off}");
    }
}
