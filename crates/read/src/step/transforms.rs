//! Placements of parts: transformations between representations.

use super::document::{Doc, Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use super::units::Units;
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DAffine3, DVec3, Frame};

/// One side of a transformation: the units in which an item is written, in millimetres per unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Side {
    pub item: Ix,
    pub length_mm: f64,
}

/// From coordinates of `from` to those of `to`, so that the two items coincide.
pub(crate) fn between(doc: &Doc<'_>, from: Side, to: Side) -> Res<DAffine3> {
    let scale = DAffine3::from_scale(DVec3::splat(from.length_mm / to.length_mm));
    let source = placement(doc, from.item)?;
    let target = placement(doc, to.item)?;
    if source.matrix3.determinant().abs() < 1e-30 {
        return Err(doc.bad(from.item, ReadIssue::FlatPlacement));
    }
    let placed = target * scale * source.inverse();
    if placed.is_finite() {
        Ok(placed)
    } else {
        Err(doc.bad(to.item, ReadIssue::NotFinite { what: "placement" }))
    }
}

/// The transformation that an axis placement or a transformation operator stands for.
pub(crate) fn placement(doc: &Doc<'_>, ix: Ix) -> Res<DAffine3> {
    let mut geometry = Geometry::new(doc, Units::default());
    match doc.kw(ix) {
        Kw::CartesianTransformationOperator3d => operator(&mut geometry, ix),
        Kw::Complex => operator_of_leaves(&mut geometry, ix),
        _ => Ok(from_frame(&geometry.frame(ix)?)),
    }
}

fn from_frame(frame: &Frame) -> DAffine3 {
    DAffine3::from_mat3_translation(glam::DMat3::from_cols(frame.x, frame.y, frame.z), frame.origin)
}

/// CARTESIAN_TRANSFORMATION_OPERATOR_3D: names first (one or three), then axis 1, axis 2, origin, scale, axis
/// 3.
fn operator(geometry: &mut Geometry<'_>, ix: Ix) -> Res<DAffine3> {
    let mut args = geometry.doc.open(ix)?;
    args.skip(args.left().saturating_sub(5));
    let [axis1, axis2] = [args.optional_reference(), args.optional_reference()];
    let origin = geometry.point(args.reference()?)?;
    let scale = args.optional_real().unwrap_or(1.0);
    let axis3 = args.optional_reference();
    assemble(geometry, ix, [axis1, axis2, axis3], origin, scale)
}

fn operator_of_leaves(geometry: &mut Geometry<'_>, ix: Ix) -> Res<DAffine3> {
    let doc = geometry.doc;
    let leaves = doc.open(ix)?.leaves();
    let Some((_, mut own)) =
        leaves.iter().find(|(kw, _)| *kw == Kw::CartesianTransformationOperator3d).cloned()
    else {
        return Err(doc.unknown(ix, "a placement"));
    };
    let Some((_, mut base)) = leaves.into_iter().find(|(_, args)| args.left() >= 3) else {
        return Err(doc.bad(ix, ReadIssue::Missing { what: "origin" }));
    };
    let [axis1, axis2] = [base.optional_reference(), base.optional_reference()];
    let origin = geometry.point(base.reference()?)?;
    let scale = base.optional_real().unwrap_or(1.0);
    let axis3 = own.optional_reference();
    assemble(geometry, ix, [axis1, axis2, axis3], origin, scale)
}

/// The axes made orthonormal as ISO 10303-42 does (third, first, second in this order); the second keeps its
/// side, so that a mirrored operator mirrors.
fn assemble(
    geometry: &Geometry<'_>,
    ix: Ix,
    axes: [Option<Ix>; 3],
    origin: DVec3,
    scale: f64,
) -> Res<DAffine3> {
    let given =
        axes.map(|axis| axis.and_then(|axis| geometry.direction(axis).ok()).and_then(DVec3::try_normalize));
    let frame = Frame::new(origin, given[2].unwrap_or(DVec3::Z), given[0].unwrap_or(DVec3::X));
    let mirrored = given[1].is_some_and(|y| y.dot(frame.y) < 0.0);
    let y = if mirrored { -frame.y } else { frame.y };
    if scale == 0.0 {
        return Err(geometry.doc.bad(ix, ReadIssue::BadValue { what: "scale", value: Real(0.0) }));
    }
    let axes = glam::DMat3::from_cols(frame.x * scale, y * scale, frame.z * scale);
    Ok(DAffine3::from_mat3_translation(axes, origin))
}
