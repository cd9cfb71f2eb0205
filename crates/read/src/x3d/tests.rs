use crate::testing::read_bytes;
use chordal_brep::{FaceGeometry, Loop, Model};
use chordal_nurbs::{DVec2, DVec3, Surface, math};

fn classic(text: &str) -> Model {
    read_bytes(format!("#X3D V3.3 utf8\nPROFILE Full\nCOMPONENT NURBS : 4\n{text}").as_bytes(), "test")
        .unwrap()
}

fn xml(text: &str) -> Model {
    read_bytes(
        format!("<?xml version='1.0'?>\n<X3D version='3.3'><Scene>{text}</Scene></X3D>").as_bytes(),
        "test",
    )
    .unwrap()
}

fn surfaces(model: &Model) -> Vec<(DAffine, &Surface)> {
    let mut found = Vec::new();
    for placed in model.placements() {
        for face in &model.parts[placed.part.index()].faces {
            if let FaceGeometry::Surface(surface) = &face.geometry {
                found.push((placed.world, surface.as_ref()));
            }
        }
    }
    found
}

type DAffine = chordal_nurbs::DAffine3;

const SQUARE: &str = "NurbsPatchSurface { uOrder 2 vOrder 2 uDimension 2 vDimension 2
    controlPoint Coordinate { point [ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ] } }";

/// A quarter of a cylinder, its points multiplied by their weights.
const QUARTER: &str = "uDimension='3' vDimension='2' vOrder='2' uKnot='0 0 0 1 1 1'
    weight='1 .70710678 1 1 .70710678 1'";
const QUARTER_POINTS: &str =
    "1 0 0, .70710678 .70710678 0, 0 1 0, 1 0 5, .70710678 .70710678 3.5355339, 0 1 5";

#[test]
fn points_are_multiplied_by_their_weights_already() {
    let model = xml(&format!(
        "<Shape><NurbsPatchSurface {QUARTER}><CoordinateDouble containerField='controlPoint' \
         point='{QUARTER_POINTS}'/>
         </NurbsPatchSurface></Shape>"
    ));
    let found = surfaces(&model);
    for k in 0..=10 {
        let p = found[0].1.point(DVec2::new(f64::from(k) / 10.0, 0.5));
        assert!((p.truncate().length() - 1.0).abs() < 1e-7 && (p.z - 2.5).abs() < 1e-6, "{p}");
    }
    assert_eq!(found[0].0.transform_point3(DVec3::X), DVec3::X * 1000.0);
}

#[test]
fn both_encodings_and_vrml97_say_the_same() {
    let body = "DEF Outer Transform { translation 1 2 3 rotation 0 0 1 1.5707963267948966 scale 2 2 2 \
        center 1 0 0
        children [ Shape { appearance Appearance { material DEF Red Material { diffuseColor 1 0 0 \
        transparency .25 } }
          geometry DEF Patch NurbsPatchSurface { uOrder 2 vOrder 2 uDimension 2 vDimension 2 ccw FALSE
            controlPoint Coordinate { point [ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ] } } } ] }";
    let a = classic(body);
    let b =
        xml("<Transform DEF='Outer' translation='1 2 3' rotation='0 0 1 1.5707963267948966' scale='2 2 2' \
         center='1 0 0'>
          <Shape><Appearance><Material DEF='Red' diffuseColor='1 0 0' transparency='.25'/></Appearance>
          <NurbsPatchSurface DEF='Patch' uOrder='2' vOrder='2' uDimension='2' vDimension='2' ccw='false'>
          <Coordinate containerField='controlPoint' point='0 0 0, 1 0 0, 0 2 0, 1 2 \
          3'/></NurbsPatchSurface></Shape></Transform>");
    let vrml = body
        .replace("NurbsPatchSurface", "NurbsSurface")
        .replace("Coordinate { point [ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ] }", "[ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ]");
    let c = read_bytes(format!("#VRML V2.0 utf8\n{vrml}").as_bytes(), "test").unwrap();
    for model in [&a, &b, &c] {
        let face = &model.parts[0].faces[0];
        assert_eq!((face.name.as_str(), face.flipped), ("Patch", true));
        assert_eq!(face.color.map(|c| c.0), Some([1.0, 0.0, 0.0, 0.75]));
        let FaceGeometry::Surface(surface) = &face.geometry else { panic!() };
        // (1, 2, 3) less the centre, doubled, turned, and back.
        assert!(surface.point(DVec2::ONE).distance(DVec3::new(2.0 - 4.0, 2.0, 9.0)) < 1e-12);
        assert!(model.issues.is_empty(), "{:?}", model.issues);
    }
}

#[test]
fn contours_cut_holes() {
    let contour =
        |points: &str| format!("Contour2D {{ children ContourPolyline2D {{ controlPoint [ {points} ] }} }}");
    let model = classic(&format!(
        "Shape {{ geometry NurbsTrimmedSurface {{ uOrder 2 vOrder 2 uDimension 2 vDimension 2
           controlPoint Coordinate {{ point [ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ] }}
           trimmingContour [ {} {}
             Contour2D {{ children [ NurbsCurve2D {{ knot [ 0 0 0 1 1 1 ] controlPoint [ .6 .6, .9 .6, .9 \
             .9 ] }}
                                     ContourPolyline2D {{ controlPoint [ .9 .9, .6 .9, .6 .6 ] }} ] }} ] }} \
                                     }}",
        contour("0 0, 1 0, 1 1, 0 1, 0 0"),
        contour(".2 .2, .2 .4, .4 .4, .4 .2"),
    ));
    let face = &model.parts[0].faces[0];
    let sizes: Vec<usize> = face
        .loops
        .iter()
        .map(|l| if let Loop::Edges { coedges, .. } = l { coedges.len() } else { 0 })
        .collect();
    assert_eq!(sizes, [4, 4, 3]);
    // The second contour was left open.
    assert_eq!(model.issues.len(), 1, "{:?}", model.issues);
    assert!(model.issues[0].to_string().contains("trim loop 2 is open"));
}

#[test]
fn vrml97_trims_a_surface_inside_another_node() {
    let text = "#VRML V2.0 utf8
        Shape { geometry TrimmedSurface { surface NurbsSurface { uDimension 3 vDimension 3
          controlPoint [ 0 0 0 1 0 0 2 0 0  0 1 0 1 1 1 2 1 0  0 2 0 1 2 0 2 2 0 ] }
          trimmingContour Contour2D { children Polyline2D { point [ .1 .1 .9 .1 .9 .9 .1 .1 ] } } } }";
    let model = read_bytes(text.as_bytes(), "test").unwrap();
    assert!(
        matches!(&model.parts[0].faces[0].loops[..], [Loop::Edges { coedges, .. }] if coedges.len() == 3)
    );
}

#[test]
fn closed_directions_without_knots_are_periodic() {
    // A hexagon repeated along v; its first point comes again at the end.
    let ring: Vec<[f64; 2]> = (0..7)
        .map(|k| math::sin_cos(f64::from(k % 6) * std::f64::consts::FRAC_PI_3))
        .map(|(s, c)| [c, s])
        .collect();
    let row = |z: f64| ring.iter().map(|p| format!("{} {} {z}, ", p[0], p[1])).collect::<String>();
    for (closed, period) in [("TRUE", true), ("FALSE", false)] {
        let model = classic(&format!(
            "Shape {{ geometry NurbsPatchSurface {{ uClosed {closed} uOrder 4 vOrder 2 uDimension 7 \
             vDimension 2
               controlPoint Coordinate {{ point [ {} {} ] }} }} }}",
            row(0.0),
            row(1.0)
        ));
        let surface = surfaces(&model)[0].1;
        let Surface::Nurbs(nurbs) = surface else { panic!() };
        let (start, end) = (nurbs.domain().min, nurbs.domain().max);
        let normals = [start.x, end.x].map(|u| nurbs.jet1(DVec2::new(u, 0.5)).1.normalize());
        assert!(surface.periods()[0].is_some());
        // Smooth where it closes, or sharp.
        assert_eq!(normals[0].distance(normals[1]) < 1e-9, period);
        assert_eq!(model.parts[0].faces[0].loops.len(), 2);
    }
}

#[test]
fn sweeps_along_lines_are_exact_and_others_say_why_not() {
    let sweep = |path: &str| {
        format!(
            "#X3D V3.3 utf8
             Shape {{ geometry NurbsSweptSurface {{
               crossSectionCurve NurbsCurve2D {{ controlPoint [ 1 0, 1 1, 0 1 ] weight [ 1 1 2 ] knot [ 0 0 \
               0 1 1 1 ] }}
               trajectoryCurve NurbsCurve {{ controlPoint Coordinate {{ point [ {path} ] }} }} }} }}"
        )
    };
    let model = read_bytes(sweep("1 2 3, 1 4 3, 1 7 3").as_bytes(), "test").unwrap();
    let surface = surfaces(&model)[0].1;
    // (1, 0), (1, 1), (0, 2)/2 in homogeneous coordinates: a point of the section at a half.
    let p = surface.point(DVec2::new(0.5, 0.5));
    let w = 0.25 + 0.5 + 0.25 * 2.0;
    assert!(p.distance(DVec3::new(1.0 + (0.25 + 0.5) / w, 4.5, 3.0 + (0.5 + 0.25) / w)) < 1e-12, "{p}");
    let error = read_bytes(sweep("0 0 0, 0 1 0, 1 1 0").as_bytes(), "test").unwrap_err().to_string();
    assert!(error.contains("trajectory is bent"), "{error}");
}

#[test]
fn swung_surfaces_multiply_profile_and_trajectory() {
    let arc = "weight [ 1 .70710678 1 ] knot [ 0 0 0 1 1 1 ]";
    let model = classic(&format!(
        "Shape {{ geometry NurbsSwungSurface {{
           profileCurve NurbsCurve2D {{ controlPoint [ 0 3, 2.12132034 2.12132034, 3 0 ] {arc} }}
           trajectoryCurve NurbsCurve2D {{ controlPoint [ 1 0, .70710678 .70710678, 0 1 ] {arc} }} }} }}"
    ));
    let surface = surfaces(&model)[0].1;
    // A circle turned along a circle: an octant of a sphere.
    for k in 0..=8 {
        let p = surface.point(DVec2::new(f64::from(k) / 8.0, f64::from(8 - k) / 8.0));
        assert!((p.length() - 3.0).abs() < 1e-7 && p.min_element() > -1e-9, "{p}");
    }
}

#[test]
fn prototypes_are_expanded() {
    let text = "PROTO Patch [ field SFColor color 0 1 0 exposedField MFVec3f points [ ] ] {
          Shape { appearance Appearance { material Material { diffuseColor IS color } }
                  geometry NurbsSurface { uOrder 2 vOrder 2 uDimension 2 vDimension 2 controlPoint IS \
                  points } } }
        PROTO Twice [ ] { Group { children [ Patch { points [ 0 0 0 1 0 0 0 1 0 1 1 0 ] }
          Transform { translation 5 0 0 children Patch { color 1 0 0 points [ 0 0 0 1 0 0 0 1 0 1 1 0 ] } } \
          ] } }
        Twice { }";
    let model = read_bytes(format!("#VRML V2.0 utf8\n{text}").as_bytes(), "test").unwrap();
    let colors: Vec<_> = model.parts[0].faces.iter().map(|f| f.color.unwrap().0).collect();
    assert_eq!(colors, [[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
    let xml = xml("<ProtoDeclare name='P'><ProtoInterface><field name='n' value='2'/><field name='c' \
         type='SFNode'/></ProtoInterface>
         <ProtoBody><NurbsPatchSurface vOrder='2' uDimension='2' vDimension='2'><IS><connect \
         nodeField='uOrder' protoField='n'/>
         <connect nodeField='controlPoint' protoField='c'/></IS></NurbsPatchSurface></ProtoBody>
         </ProtoDeclare>
         <Shape><ProtoInstance name='P' containerField='geometry'><fieldValue name='c'>
         <Coordinate point='0 0 0 1 0 0 0 1 0 1 1 0'/></fieldValue></ProtoInstance></Shape>");
    assert!(matches!(&xml.parts[0].faces[0].geometry, FaceGeometry::Surface(_)), "{:?}", xml.parts[0].faces);
    // One that consists of itself.
    let own = read_bytes(
        b"#VRML V2.0 utf8\nPROTO A [] { Group { children [ A {} A {} ] } } A {} Shape { geometry Box {} }",
        "x",
    )
    .unwrap();
    assert!(!own.parts.is_empty());
}

#[test]
fn what_is_used_twice_is_one_part() {
    let model = classic(&format!(
        "Group {{ children [ Transform {{ children DEF S Shape {{ geometry DEF G {SQUARE} }} }}
           Transform {{ translation 5 0 0 children USE S }}
           Shape {{ appearance Appearance {{ material Material {{ diffuseColor 1 0 0 }} }} geometry USE G }}
           Shape {{ geometry USE G }} Switch {{ whichChoice 0 choice [ USE S ] }} LOD {{ level [ USE S \
           Shape {{ }} ] }} ] }}"
    ));
    assert_eq!(model.placements().len(), 6);
    assert!(model.parts.len() <= 4, "{}", model.parts.len());
}

#[test]
fn solids_and_polygons() {
    let model =
        xml("<Transform translation='0 9 0' scale='1 -1 1'><Shape><Box size='1 2 3'/></Shape><Shape><Cone \
         side='false'/></Shape>
         <Shape><IndexedFaceSet coordIndex='0 1 2 3 -1'><Coordinate point='0 0 0 1 0 0 1 1 0 0 1 \
         0'/></IndexedFaceSet></Shape></Transform>
         <Shape><IndexedTriangleFanSet ccw='false' index='0 1 2 3'><Coordinate point='0 0 0 1 0 0 1 1 0 0 1 \
         0'/></IndexedTriangleFanSet></Shape>
         <Shape><TriangleStripSet stripCount='4'><Coordinate point='0 0 0 1 0 0 0 1 0 1 1 \
         0'/></TriangleStripSet></Shape>
         <Shape><ElevationGrid xDimension='2' zDimension='2' height='0 0 0 1'/></Shape>
         <Shape><Extrusion/></Shape><Shape><Text string='\"hi\"'/></Shape><Inline url='\"other.x3d\"'/>");
    let items = &model.parts[0].tessellated;
    assert_eq!(items.iter().map(|i| i.triangles.len()).collect::<Vec<_>>(), [2, 2, 2, 2]);
    // Mirrored polygons still face the same way, clockwise ones the other.
    assert_eq!(items[0].triangles[0], [0, 2, 1]);
    assert_eq!(items[1].triangles[0], [0, 2, 1]);
    assert_eq!(items[2].triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(model.placements().len(), 3);
    assert_eq!(model.issues.iter().filter(|w| w.is_error()).count(), 2, "{:?}", model.issues);
}

#[test]
fn units_of_the_file_hold() {
    let inches = classic(&format!(
        "UNIT length inch 0.0254\nUNIT angle degree 0.017453292519943295\n
        Transform {{ rotation 0 0 1 90 children Shape {{ geometry {SQUARE} }} }}"
    ));
    assert_eq!(inches.unit, "inch");
    let (world, surface) = surfaces(&inches)[0];
    assert!(
        world.transform_point3(surface.point(DVec2::new(1.0, 0.0))).distance(DVec3::new(0.0, 25.4, 0.0))
            < 1e-9
    );
}

#[test]
fn files_cut_anywhere_are_read_up_to_there_or_refused() {
    let classic = format!(
        "#X3D V3.3 utf8\nPROTO P [ inputOutput SFInt32 n 2 ] {{ {SQUARE} }}\nDEF T Transform {{ children [ \
         Shape {{ geometry P {{ }} }}
         Shape {{ geometry NurbsTrimmedSurface {{ uOrder 2 vOrder 2 uDimension 2 vDimension 2 uKnot [ 0 0 1 \
         1 ]
         controlPoint Coordinate {{ point [ 0 0 0, 1 0 0, 0 2 0, 1 2 3 ] }} trimmingContour Contour2D {{ \
         children
         NurbsCurve2D {{ controlPoint [ .1 .1 .9 .1 .5 .9 .1 .1 ] closed TRUE }} }} }} }} ] }} ROUTE a.b TO \
         c.d USE T"
    );
    let xml = "<X3D version='3.3'><Scene><ProtoDeclare name='P'><ProtoInterface><field name='n' \
        value='2'/></ProtoInterface>
        <ProtoBody><NurbsPatchSurface uDimension='2' vDimension='2' uOrder='2' vOrder='2'><Coordinate \
        point='0 0 0 1 0 0 0 1 0 1 1 1'/>
        </NurbsPatchSurface></ProtoBody></ProtoDeclare><Shape DEF='S'><ProtoInstance \
        name='P'/></Shape><Transform scale='2 2 2'>
        <Shape USE='S'/><Shape><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate point='0 0 0 1 &amp;#48; 0 \
        1 1 0'/></IndexedFaceSet></Shape>
        </Transform></Scene></X3D>";
    for whole in [classic.as_bytes(), xml.as_bytes()] {
        for end in 0..whole.len() {
            let _ = read_bytes(&whole[..end], "cut");
        }
        let mut random = 11u64;
        for _ in 0..3000 {
            let mut broken = whole.to_vec();
            for _ in 0..4 {
                random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let at = 16 + (random >> 33) as usize % (broken.len() - 16);
                broken[at] = (random >> 17) as u8;
            }
            let _ = read_bytes(&broken, "broken");
        }
    }
}

#[test]
fn nests_and_fans_of_uses_end() {
    let deep = format!("#VRML V2.0 utf8\n{}Shape {{ geometry Box {{ }} }}", "Group { children ".repeat(5000));
    assert!(read_bytes(deep.as_bytes(), "deep").is_err());
    let deep = format!("<X3D><Scene>{}<Shape><Box/></Shape>", "<Group>".repeat(5000));
    assert!(read_bytes(deep.as_bytes(), "deep").is_err());
    let mut text = "#VRML V2.0 utf8\nPROTO P0 [] { Shape { geometry Box { } } }".to_owned();
    for i in 1..1000 {
        text += &format!(
            "PROTO P{i} [] {{ Group {{ children P{j} {{ }} }} }}\nDEF N{i} Group {{ children P{j} {{ }} }}",
            j = i - 1
        );
    }
    let _ = read_bytes(text.as_bytes(), "chain");
    let mut text = "#VRML V2.0 utf8\nDEF N0 Shape { geometry Box { } }".to_owned();
    for i in 1..64 {
        text += &format!("DEF N{i} Group {{ children [ USE N{j} USE N{j} USE N{j} ] }}", j = i - 1);
    }
    let model = read_bytes(text.as_bytes(), "fan").unwrap();
    assert!(model.placements().len() < 100_000);
    assert!(model.issues.iter().any(|w| w.is_error()));
}
