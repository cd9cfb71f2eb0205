//! What geomdl (NURBS-Python) exports as JSON: spline surfaces with trims in their parameter space.
//!
//! As geomdl's own tessellator has it, a trim cuts away what it encloses unless its `reversed` is 1, when it
//! keeps only that. Trims may lie partly beyond the surface; they end where it does.

use super::trims::{ControlPoints, Sense, trim_loop};
use crate::assemble::Notes;
use crate::flat::{self, LengthUnit};
use crate::trimmed::{Look, TrimLoop, add_body, add_faces, add_failed};
use chordal_brep::{BodyKind, LooseItem, LooseKind, Model, Part, ReadIssue, Source};
use chordal_nurbs::{DVec3, NurbsError, NurbsSurface, Surface};
use serde::Deserialize;
use serde_json::Value;
use std::sync::Arc;

#[derive(Deserialize)]
struct File {
    shape: Shape,
}

#[derive(Deserialize)]
struct Shape {
    #[serde(default, rename = "type")]
    kind: String,
    data: Vec<Value>,
}

#[derive(Deserialize)]
struct SurfaceData {
    degree_u: usize,
    degree_v: usize,
    knotvector_u: Vec<f64>,
    knotvector_v: Vec<f64>,
    size_u: usize,
    size_v: usize,
    control_points: ControlPoints,
    #[serde(default)]
    name: String,
    #[serde(default)]
    reversed: Sense,
    #[serde(default)]
    trims: Trims,
}

#[derive(Default, Deserialize)]
struct Trims {
    data: Vec<Value>,
}

/// Reads an export; the text has been seen to be JSON with a `shape`.
pub(super) fn read(text: &[u8], name: &str) -> Result<Model, serde_json::Error> {
    let File { shape } = serde_json::from_slice(text)?;
    let mut part = Part::default();
    let notes = Notes::default();
    let count = shape.data.len();
    for (i, data) in shape.data.into_iter().enumerate() {
        // geomdl counts from 0; 0 means "no number" here.
        let source = Source { entity: i as u64 + 1, line: 0 };
        let looks_like_surface = data.get("degree_u").is_some() && data.get("degree_w").is_none();
        match shape.kind.as_str() {
            "surface" => surface(&mut part, data, source, &notes),
            "" if looks_like_surface => surface(&mut part, data, source, &notes),
            "curve" => {
                let name = data.get("name").and_then(Value::as_str).unwrap_or_default().to_owned();
                part.loose.push(LooseItem { kind: LooseKind::Wire, name, source });
            }
            other => {
                let what = format!("geometry of type {other:?}").into();
                notes.lose(source, ReadIssue::Unsupported { what });
            }
        }
    }
    let schema = format!("geomdl JSON ({count} of type {})", shape.kind);
    Ok(flat::model(name, schema, LengthUnit::unstated(), part, notes.take()))
}

fn surface(part: &mut Part, data: Value, source: Source, notes: &Notes) {
    let data: SurfaceData = match serde_json::from_value(data) {
        Ok(data) => data,
        Err(error) => {
            add_failed(
                part,
                ReadIssue::TextBroken { reason: error.to_string() },
                &Look { source, ..Look::default() },
            );
            return;
        }
    };
    let look = Look {
        name: data.name.clone(),
        flipped: data.reversed == Sense::Reversed,
        source,
        ..Look::default()
    };
    match (trims(&data, source, notes), spline(data)) {
        (Ok(trims), Ok(surface)) => {
            let surface = Arc::new(Surface::Nurbs(surface));
            let trims =
                trims.into_iter().map(|trim| trim.closed(&surface, source, notes)).collect::<Vec<TrimLoop>>();
            let faces = add_faces(part, &surface, &trims, &look, notes);
            add_body(part, faces, BodyKind::FaceSet, &look);
        }
        (Err(reason), _) | (_, Err(reason)) => {
            add_failed(part, reason, &look);
        }
    }
}

fn trims(data: &SurfaceData, source: Source, notes: &Notes) -> Result<Vec<super::trims::Trim>, ReadIssue> {
    let list = data.trims.data.iter().enumerate();
    list.map(|(i, trim)| trim_loop(trim, source, notes).map_err(|why| why.within("trim", i + 1))).collect()
}

fn spline(data: SurfaceData) -> Result<NurbsSurface, ReadIssue> {
    let counts = [&data.knotvector_u, &data.knotvector_v].map(Vec::len);
    for (knots, size, degree) in
        [(counts[0], data.size_u, data.degree_u), (counts[1], data.size_v, data.degree_v)]
    {
        if size.checked_add(degree).and_then(|n| n.checked_add(1)) != Some(knots) {
            return Err(NurbsError::KnotCount { knots, points: size, degree }.into());
        }
    }
    let point = |p: &Vec<f64>| match p[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        [x, y] => Ok(DVec3::new(x, y, 0.0)),
        _ => Err(ReadIssue::TooFew { what: "coordinates of a control point", found: p.len(), least: 2 }),
    };
    let points = data.control_points.points.iter().map(point).collect::<Result<_, _>>()?;
    let degree = [data.degree_u, data.degree_v];
    NurbsSurface::new(degree, data.knotvector_u, data.knotvector_v, points, data.control_points.weights)
        .map_err(ReadIssue::from)
}
