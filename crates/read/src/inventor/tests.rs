use crate::testing::read_bytes;
use chordal_brep::{FaceGeometry, Loop, Model, ReadIssue};
use chordal_nurbs::{DVec2, DVec3, Surface};

fn read(text: &str) -> Model {
    read_bytes(format!("#Inventor V2.1 ascii\n{text}").as_bytes(), "test").unwrap()
}

/// Points of a patch that is flat but for its corner, in a square of this size.
fn coordinates(size: f64) -> String {
    let mut points = String::new();
    for j in 0..3 {
        for i in 0..3 {
            let z = if i + j == 4 { 1.0 } else { 0.0 };
            points += &format!("{} {} {z},", size * f64::from(i) / 2.0, size * f64::from(j) / 2.0);
        }
    }
    format!("Coordinate3 {{ point [ {points} ] }}")
}

const PATCH: &str = "NurbsSurface { numUControlPoints 3 numVControlPoints 3
    uKnotVector [ 0 0 0 1 1 1 ] vKnotVector [ 0 0 0 1 1 1 ] }";

/// The corner u = v = 1 of every patch, in the file's units.
fn far_corners(model: &Model) -> Vec<DVec3> {
    let mut found = Vec::new();
    for placed in model.placements() {
        for face in &model.parts[placed.part.index()].faces {
            if let FaceGeometry::Surface(surface) = &face.geometry
                && let Surface::Nurbs(nurbs) = surface.as_ref()
            {
                found.push(placed.world.transform_point3(nurbs.point(DVec2::ONE)) / 1000.0);
            }
        }
    }
    found
}

fn assert_near(found: &[DVec3], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!(a.distance((*b).into()) < 1e-6, "{a} {b:?}");
    }
}

#[test]
fn transforms_gather_up_to_the_end_of_their_separator() {
    let patch = format!("{} {PATCH}", coordinates(2.0));
    let model = read(&format!(
        "Separator {{ Translation {{ translation 10 0 0 }} Scale {{ scaleFactor 2 2 2 }} {patch} }}
         Group {{ Translation {{ translation 0 5 0 }} }} {PATCH_AFTER}
         TransformSeparator {{ Translation {{ translation 100 0 0 }} {patch} }} {PATCH}",
        PATCH_AFTER = patch
    ));
    assert_near(
        &far_corners(&model),
        &[[14.0, 4.0, 2.0], [2.0, 7.0, 1.0], [102.0, 7.0, 1.0], [2.0, 7.0, 1.0]],
    );
}

#[test]
fn matrices_multiply_rows_and_units_scale_to_metres() {
    let patch = format!("{} {PATCH}", coordinates(2.0));
    let model = read(&format!(
        "Units {{ units CENTIMETERS }}
         MatrixTransform {{ matrix 0 1 0 0  -1 0 0 0  0 0 1 0  7 8 9 1 }} {patch}
         Units {{ units METERS }} {patch}"
    ));
    // A quarter turn about z, then a shift, in centimetres.
    let shift = [0.07, 0.08, 0.09];
    assert_near(
        &far_corners(&model),
        &[
            [shift[0] - 0.02, shift[1] + 0.02, shift[2] + 0.01],
            [shift[0] - 2.0, shift[1] + 2.0, shift[2] + 1.0],
        ],
    );
}

#[test]
fn what_is_used_more_than_once_is_one_part() {
    let model = read(&format!(
        "Separator {{ Material {{ diffuseColor 1 0 0 }}
           DEF Wheel Separator {{ {} {PATCH} }}
           Translation {{ translation 0 0 3 }} USE Wheel
           Translation {{ translation 0 0 3 }} USE Wheel
           Material {{ diffuseColor 0 1 0 }} USE Wheel }}",
        coordinates(2.0)
    ));
    assert_near(&far_corners(&model), &[[2., 2., 1.], [2., 2., 4.], [2., 2., 7.], [2., 2., 7.]]);
    // One in red, one in green.
    assert_eq!(model.parts.len(), 2);
    assert_eq!(model.parts[0].name, "Wheel");
    assert_eq!(model.parts[0].faces[0].color.map(|c| c.0), Some([1.0, 0.0, 0.0, 1.0]));
}

#[test]
fn profiles_trim_the_surfaces_behind_them() {
    let model = read(&format!(
        "{}
         ProfileCoordinate2 {{ point [ .1 .1, .9 .1, .9 .9, .1 .9, .3 .3, .3 .7, .7 .7, .7 .3 ] }}
         LinearProfile {{ index [ 0 1 2 3 0 ] }}
         LinearProfile {{ index [ 4 5 6 ] linkage START_NEW }}
         NurbsProfile {{ index [ 6 7 4 ] linkage ADD_TO_CURRENT knotVector [ 0 0 0 1 1 1 ] }}
         {PATCH}
         Separator {{ LinearProfile {{ index [ 0 1 2 0 ] }} {PATCH} }}",
        coordinates(2.0)
    ));
    let part = &model.parts[0];
    assert_eq!(part.faces.len(), 2);
    let loops: Vec<usize> = part.faces[0]
        .loops
        .iter()
        .map(|l| if let Loop::Edges { coedges, .. } = l { coedges.len() } else { 0 })
        .collect();
    assert_eq!(loops, [4, 3]);
    assert_eq!(part.faces[1].loops.len(), 1);
    assert!(model.issues.is_empty(), "{:?}", model.issues);
}

#[test]
fn rational_points_are_divided_by_their_weights() {
    let model = read(
        "Coordinate4 { point [ 1 0 0 1, 0.70710678 0.70710678 0 0.70710678, 0 1 0 1,
                               1 0 3 1, 0.70710678 0.70710678 2.12132034 0.70710678, 0 1 3 1 ] }
         IndexedNurbsSurface { numUControlPoints 3 numVControlPoints 2 coordIndex [ 0 1 2 3 4 5 ]
           uKnotVector [ 0 0 0 1 1 1 ] vKnotVector [ 0 0 1 1 ] }",
    );
    let FaceGeometry::Surface(surface) = &model.parts[0].faces[0].geometry else { panic!() };
    for k in 0..=10 {
        let p = surface.point(DVec2::new(f64::from(k) / 10.0, 0.3));
        assert!((p.truncate().length() - 1.0).abs() < 1e-7 && (p.z - 0.9).abs() < 1e-7, "{p}");
    }
}

#[test]
fn faces_without_sense_fail_with_a_reason() {
    for (text, reason) in [
        (PATCH.to_owned(), "no coordinates before it"),
        (
            format!("Coordinate3 {{ point [ 0 0 0, 1 1 1 ] }} {PATCH}"),
            "number of control points is 2, at least 9 needed",
        ),
        (format!("{} {}", coordinates(1.0), PATCH.replace("1 1 1 ] v", "] v")), "order of 0 is not valid"),
        (
            format!("{} LinearProfile {{ index [ 0 1 2 ] }} {PATCH}", coordinates(1.0)),
            "no profile coordinates before it",
        ),
        (
            format!(
                "{} ProfileCoordinate2 {{ point [ 0 0 ] }} LinearProfile {{ index [ 0 1 ] }} {PATCH}",
                coordinates(1.0)
            ),
            "no coordinate for an index",
        ),
    ] {
        let text = format!("#Inventor V2.1 ascii\n{text}");
        let error = read_bytes(text.as_bytes(), "test").unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
        // Beside a sound one, such a face is a failed one.
        let model = read_bytes(format!("{text} Cube {{ }}").as_bytes(), "test").unwrap();
        let FaceGeometry::Failed(found) = &model.parts[0].faces[0].geometry else { panic!("{reason}") };
        assert!(found.to_string().contains(reason), "{found}");
    }
}

#[test]
fn solids_are_exact_and_polygons_pass_through() {
    let model = read(
        "Translation { translation 1 2 3 } Cube { width 1 } Sphere { } Cone { parts (SIDES) } Cylinder { \
         parts ALL }
         Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }
         IndexedFaceSet { coordIndex [ 0 1 2 3 -1 0 1 2 ] }
         ShapeHints { vertexOrdering CLOCKWISE } FaceSet { numVertices 3 }
         Array { numElements1 3 separation1 1 0 0 Separator { QuadMesh { verticesPerRow 2 verticesPerColumn \
         2 } } }
         Switch { Cube { } } Switch { whichChild 0 Sphere { } }
         DEF Text Text3 { string \"hi\" } PointSet { }",
    );
    let kinds: Vec<(usize, usize)> = model
        .placements()
        .iter()
        .map(|p| &model.parts[p.part.index()])
        .map(|p| (p.faces.len(), p.bodies.len()))
        .collect();
    // The common part, four solids, and the sphere that is switched on.
    assert_eq!(kinds, [(0, 0), (6, 1), (1, 1), (1, 1), (3, 1), (1, 1)]);
    let items = &model.parts[0].tessellated;
    assert_eq!(items.iter().map(|i| i.triangles.len()).collect::<Vec<_>>(), [3, 1, 2, 2, 2]);
    assert_eq!(items[0].points[2], DVec3::new(2.0, 3.0, 3.0));
    assert_eq!(items[1].triangles, [[0, 2, 1]]);
    assert_eq!(model.parts[0].loose.len(), 1);
}

#[test]
fn another_file_is_named_by_an_issue() {
    let model = read("Cube { } WWWInline { name \"wheel.iv\" }");
    let issue = model.issues.iter().find(|issue| issue.is_error()).expect("an issue");
    assert_eq!(issue.kind, ReadIssue::OtherFile { name: "wheel.iv".into() }.into());
    assert_eq!(issue.kind.to_string(), "refers to the file \"wheel.iv\", which is not read");
}

#[test]
fn uses_of_uses_end() {
    let mut text = format!("DEF N0 Separator {{ {} {PATCH} }}", coordinates(1.0));
    for i in 1..64 {
        text += &format!("DEF N{i} Separator {{ USE N{j} USE N{j} USE N{j} USE N{j} }}", j = i - 1);
    }
    let model = read(&text);
    assert!(
        model.issues.iter().any(|w| w.is_error() && w.kind == ReadIssue::TooManyReferences.into()),
        "{:?}",
        model.issues
    );
    // A chain of single uses, far longer than any file's.
    let mut text = "DEF N0 Separator { Cube { } }".to_owned();
    for i in 1..3000 {
        text += &format!("DEF N{i} Separator {{ USE N{j} }}", j = i - 1);
    }
    // In another colour all of it is walked through once more.
    text += "Material { diffuseColor 1 0 0 } USE N2999";
    assert!(!read(&text).parts.is_empty());
    // A node inside itself.
    let model = read(&format!("DEF A Group {{ {} {PATCH} USE A USE A }}", coordinates(1.0)));
    assert!(!model.parts.is_empty());
}

/// The binary form of a few kinds of values.
struct Binary(Vec<u8>);

impl Binary {
    fn text(&mut self, text: &str) -> &mut Self {
        self.word(text.len() as u32);
        self.0.extend(text.bytes());
        self.0.resize(self.0.len().next_multiple_of(4), 0);
        self
    }
    fn word(&mut self, word: u32) -> &mut Self {
        self.0.extend(word.to_be_bytes());
        self
    }
    fn floats(&mut self, numbers: &[f32]) -> &mut Self {
        numbers.iter().for_each(|x| self.0.extend(x.to_be_bytes()));
        self
    }
    fn knots(&mut self, name: &str) -> &mut Self {
        self.text(name).word(6).floats(&[0., 0., 0., 1., 1., 1.]).word(0)
    }
}

fn binary_patch() -> Vec<u8> {
    let mut file = Binary(b"#Inventor V2.1 binary  \n".to_vec());
    file.text("DEF").text("Top").text("Separator").word(2).word(1);
    file.text("renderCaching").text("OFF").word(0).word(4);
    file.text("Unknown")
        .word(0)
        .word(0x8000 | 1)
        .text("SFVec2f")
        .text("size")
        .text("size")
        .floats(&[1.0, 2.0])
        .word(0);
    file.text("Cone").word(0).word(1).text("parts").text("SIDES").text("").word(0);
    let points: Vec<f32> =
        (0..9).flat_map(|k| [(k % 3) as f32, (k / 3) as f32, if k == 8 { 1.0 } else { 0.0 }]).collect();
    file.text("Coordinate3").word(0).word(1).text("point").word(9).floats(&points).word(0);
    file.text("NurbsSurface").word(0).word(4);
    file.text("numUControlPoints").word(3).word(0).text("numVControlPoints").word(3).word(0);
    file.knots("uKnotVector").knots("vKnotVector");
    file.text("USE").text("Top");
    file.0
}

#[test]
fn binary_files_hold_the_same_nodes() {
    let model = read_bytes(&binary_patch(), "test").unwrap();
    assert!(model.issues.is_empty(), "{:?}", model.issues);
    assert_eq!(model.schema, "Inventor V2.1 binary");
    // The separator is used twice: the patch is a part placed twice, and so is the cone's side.
    assert_near(&far_corners(&model), &[[2.0, 2.0, 1.0], [2.0, 2.0, 1.0]]);
    assert_eq!(model.placements().len(), 4);
}

#[test]
fn files_cut_anywhere_are_read_up_to_there_or_refused() {
    let binary = binary_patch();
    let text = format!(
        "#Inventor V2.1 ascii\nDEF A Separator {{ {} ProfileCoordinate2 {{ point [ 0 0 1 0 1 1 ] }}
         LinearProfile {{ index [ 0, 1, 2, 0 ] }} {PATCH} Info {{ string \"a\\\"b\" }} Switch {{ whichChild \
         -3 USE A }} }} USE A",
        coordinates(1.0)
    );
    for whole in [binary.as_slice(), text.as_bytes()] {
        for end in 0..whole.len() {
            let _ = read_bytes(&whole[..end], "cut");
        }
        let mut random = 7u64;
        for _ in 0..3000 {
            let mut broken = whole.to_vec();
            for _ in 0..4 {
                random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let at = 24 + (random >> 33) as usize % (broken.len() - 24);
                broken[at] = (random >> 17) as u8;
            }
            let _ = read_bytes(&broken, "broken");
        }
    }
}
