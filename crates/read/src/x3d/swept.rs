//! Swept and swung surfaces, where they are splines.
//!
//! A cross-section swept along a straight trajectory is a ruled spline. Along a bent one the section turns
//! with the trajectory, and no spline does that exactly: such faces fail with that reason.
//!
//! A swung surface (Piegl and Tiller, *The NURBS Book*, 10.4) turns a profile in the yz plane about the y
//! axis along a trajectory in the xz plane that says how far out each direction is: (z·x', y, z·z') for
//! profile points (y, z) and trajectory points (x', z').

use super::curves::{curve2, curve3};
use crate::scene::graph::{Graph, NodeIx};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve2, DVec2, DVec3, NurbsCurve2, NurbsSurface};
use glam::DQuat;

/// Trajectories that leave their chord by less than this part of it are straight.
const STRAIGHT: f64 = 1e-9;

const PLANAR: &[&str] = &["NurbsCurve2D", "ContourPolyline2D"];

pub(super) fn swept(
    graph: &Graph,
    ix: NodeIx,
    notes: &mut Vec<ReadIssue>,
) -> Result<NurbsSurface, ReadIssue> {
    let section = planar(graph, ix, "crossSectionCurve", notes)?;
    let trajectory = graph
        .child(ix, "trajectoryCurve", &["NurbsCurve"])
        .ok_or(ReadIssue::Missing { what: "trajectory" })?;
    let points: Vec<DVec3> = curve3(graph, trajectory, notes).iter().map(|p| p.truncate() / p.w).collect();
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Err(ReadIssue::TooFew { what: "points of the trajectory", found: 0, least: 2 });
    };
    let chord = last - first;
    let Some(along) = chord.try_normalize() else {
        return Err(ReadIssue::SweepNotExact { trajectory: "closed" });
    };
    let off = |p: &DVec3| (*p - first).cross(along).length();
    if points.iter().any(|p| off(p) > STRAIGHT * chord.length()) {
        return Err(ReadIssue::SweepNotExact { trajectory: "bent" });
    }
    // The section lies in the xz plane and is turned so that y runs along the trajectory.
    let turn = DQuat::from_rotation_arc(DVec3::Y, along);
    let rows = section.points().iter().map(|p| turn * DVec3::new(p.x, 0.0, p.y));
    let net = rows.flat_map(|p| [p + first, p + last]).collect();
    let weights = section.weights().map(|w| w.iter().flat_map(|&w| [w, w]).collect());
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    NurbsSurface::new([section.degree(), 1], section.knots().to_vec(), knots, net, weights)
        .map_err(ReadIssue::from)
}

pub(super) fn swung(
    graph: &Graph,
    ix: NodeIx,
    notes: &mut Vec<ReadIssue>,
) -> Result<NurbsSurface, ReadIssue> {
    let profile = planar(graph, ix, "profileCurve", notes)?;
    let other = graph.node(ix).nodes("trajectoryCurve").first().copied();
    let trajectory = match other.map(|other| graph.node(other)) {
        Some(node) => curve(node, notes)?,
        None => return Err(ReadIssue::Missing { what: "trajectory" }),
    };
    let weight = |curve: &NurbsCurve2, i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let (mut net, mut weights) = (Vec::new(), Vec::new());
    for (i, p) in profile.points().iter().enumerate() {
        for (j, t) in trajectory.points().iter().enumerate() {
            net.push(DVec3::new(p.y * t.x, p.x, p.y * t.y));
            weights.push(weight(&profile, i) * weight(&trajectory, j));
        }
    }
    let degrees = [profile.degree(), trajectory.degree()];
    NurbsSurface::new(degrees, profile.knots().to_vec(), trajectory.knots().to_vec(), net, Some(weights))
        .map_err(ReadIssue::from)
}

fn planar(
    graph: &Graph,
    ix: NodeIx,
    field: &str,
    notes: &mut Vec<ReadIssue>,
) -> Result<NurbsCurve2, ReadIssue> {
    let child = graph
        .child(ix, field, PLANAR)
        .ok_or_else(|| ReadIssue::NameNotFound { what: "field", name: field.to_owned() })?;
    curve(graph.node(child), notes)
}

fn curve(node: &crate::scene::graph::Node, notes: &mut Vec<ReadIssue>) -> Result<NurbsCurve2, ReadIssue> {
    match curve2(node, notes) {
        Some(Ok(Curve2::Nurbs(curve))) => Ok(curve),
        Some(Ok(Curve2::Polyline(points))) => polyline(points),
        Some(Err(reason)) => Err(ReadIssue::InNode { node: node.kind.clone(), cause: reason.boxed() }),
        _ => Err(ReadIssue::UnknownKind { found: node.kind.clone().into(), expected: "a planar curve" }),
    }
}

fn polyline(points: Vec<DVec2>) -> Result<NurbsCurve2, ReadIssue> {
    let last = points.len() - 1;
    let knots = (0..points.len() + 2).map(|i| i.clamp(1, last + 1) as f64 - 1.0).collect();
    NurbsCurve2::new(1, knots, points, None).map_err(ReadIssue::from)
}
