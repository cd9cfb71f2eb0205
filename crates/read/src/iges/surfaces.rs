//! Surfaces, brought to the parameters that the model uses.

use super::curves::{Segment, joined, segments};
use super::document::{Args, Doc, Ix, Res};
use super::{matrix, ruled, splines};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DAffine3, DVec2, DVec3, Frame, Range, Surface, UvBox};
use std::f64::consts::TAU;

/// Surfaces that refer to surfaces, deeper than this, refer in a circle.
const MAX_DEPTH: u32 = 8;

/// How the file's parameters become ours: exchanged or not, then stretched, then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parameters {
    pub exchanged: bool,
    pub factors: DVec2,
    pub shift: DVec2,
}

impl Parameters {
    const SAME: Self = Self { exchanged: false, factors: DVec2::ONE, shift: DVec2::ZERO };

    pub(crate) fn map(&self, p_uv: DVec2) -> DVec2 {
        (if self.exchanged { DVec2::new(p_uv.y, p_uv.x) } else { p_uv }) * self.factors + self.shift
    }
}

/// A surface as an entity gives it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Patch {
    pub surface: Surface,
    /// `None` where the file's parameters of this surface are of no use: it is elementary, and points tell
    /// more.
    pub parameters: Option<Parameters>,
    /// Our Su × Sv points against the file's.
    pub reversed: bool,
    /// The bounds that the entity itself gives, in our parameters.
    pub bounds: Option<UvBox>,
}

impl Patch {
    fn elementary(surface: Surface) -> Self {
        Self { surface, parameters: None, reversed: false, bounds: None }
    }

    fn spline((surface, uv): (Surface, UvBox)) -> Self {
        let bounds = (surface.domain() != uv).then_some(uv);
        Self { surface, parameters: Some(Parameters::SAME), reversed: false, bounds }
    }
}

/// True for the types that are surfaces.
pub(crate) fn is_surface(kind: u32) -> bool {
    matches!(kind, 108 | 114 | 118 | 120 | 122 | 128 | 140 | 190 | 192 | 194 | 196 | 198)
}

/// The surface of an entity, moved by `by` after the entity's own transformation.
pub(crate) fn surface(doc: &Doc<'_>, ix: Ix, by: &DAffine3) -> Res<Patch> {
    nested(doc, ix, by, 0)
}

fn nested(doc: &Doc<'_>, ix: Ix, by: &DAffine3, depth: u32) -> Res<Patch> {
    if depth > MAX_DEPTH {
        return Err(doc.recursive(ix, MAX_DEPTH));
    }
    let by = *by * matrix::of_entity(doc, ix)?;
    let patch = plain(doc, ix, depth)?;
    if by == DAffine3::IDENTITY {
        return Ok(patch);
    }
    let moved = patch.surface.transformed(&by);
    let moved = moved.ok_or_else(|| doc.bad(ix, ReadIssue::NotTransformable { what: "surface" }))?;
    let factors = moved.factors();
    let parameters =
        patch.parameters.map(|p| Parameters { factors: p.factors * factors, shift: p.shift * factors, ..p });
    Ok(Patch {
        surface: moved.surface,
        parameters,
        reversed: patch.reversed != moved.flip_u,
        bounds: patch.bounds.map(|b| UvBox::from_points([b.min * factors, b.max * factors])),
    })
}

/// A surface in its own coordinates.
fn plain(doc: &Doc<'_>, ix: Ix, depth: u32) -> Res<Patch> {
    let mut args = doc.open(ix)?;
    match doc.kind(ix) {
        108 => plane(doc, ix, args),
        114 => Ok(Patch::spline(splines::cubic_surface(doc, ix)?)),
        118 => Ok(Patch::spline(ruled::surface(doc, ix)?)),
        120 => revolution(doc, ix, args),
        122 => tabulated(doc, ix, args),
        128 => Ok(Patch::spline(splines::surface(doc, ix)?)),
        140 => offset(doc, args, depth),
        190 => {
            let frame = placed(doc, ix, &mut args, 0, None)?;
            Ok(Patch::elementary(Surface::Plane { frame }))
        }
        192 => {
            let (frame, [radius]) = axial(doc, ix, args)?;
            Ok(Patch::elementary(Surface::Cylinder { frame, radius: size(doc, ix, radius)? }))
        }
        194 => {
            let (frame, [radius, degrees]) = axial(doc, ix, args)?;
            cone(doc, ix, frame, radius, degrees.to_radians())
        }
        196 => {
            let origin = args.reference()?;
            let radius = size(doc, ix, args.real()?)?;
            let origin = point(doc, origin)?;
            let axis =
                args.optional_reference().ok().flatten().map(|axis| direction(doc, axis)).transpose()?;
            let x = args.optional_reference().ok().flatten().map(|x| direction(doc, x)).transpose()?;
            let frame = Frame::new(origin, axis.unwrap_or(DVec3::Z), x.unwrap_or(DVec3::X));
            Ok(Patch::elementary(Surface::Sphere { frame, radius }))
        }
        198 => {
            let (frame, [major, minor]) = axial(doc, ix, args)?;
            let minor = size(doc, ix, minor)?;
            Ok(Patch::elementary(Surface::Torus { frame, major, minor }))
        }
        _ => Err(doc.unknown(ix, "a surface")),
    }
}

/// A radius. Negative ones keep their sign, see [`crate::settle_surfaces`].
fn size(doc: &Doc<'_>, ix: Ix, radius: f64) -> Res<f64> {
    let sound = radius.is_finite() && radius != 0.0;
    if sound {
        Ok(radius)
    } else {
        Err(doc.bad(ix, ReadIssue::BadValue { what: "radius", value: Real(radius) }))
    }
}

/// Type 116, moved by its own transformation.
pub(crate) fn point(doc: &Doc<'_>, ix: Ix) -> Res<DVec3> {
    if doc.kind(ix) != 116 {
        return Err(doc.unknown(ix, "a point"));
    }
    let p = doc.open(ix)?.point()?;
    Ok(matrix::of_entity(doc, ix)?.transform_point3(p))
}

/// Type 123, turned by its own transformation.
fn direction(doc: &Doc<'_>, ix: Ix) -> Res<DVec3> {
    if doc.kind(ix) != 123 {
        return Err(doc.unknown(ix, "a direction"));
    }
    let d = matrix::of_entity(doc, ix)?.transform_vector3(doc.open(ix)?.point()?);
    d.try_normalize().ok_or_else(|| doc.bad(ix, ReadIssue::ZeroVector { what: "direction" }))
}

/// A point, an axis, `N` numbers, and in form 1 a reference direction.
fn axial<const N: usize>(doc: &Doc<'_>, ix: Ix, mut args: Args<'_>) -> Res<(Frame, [f64; N])> {
    let mut numbers = [0.0; N];
    let frame = placed(doc, ix, &mut args, N, Some(&mut numbers))?;
    Ok((frame, numbers))
}

fn placed(
    doc: &Doc<'_>,
    ix: Ix,
    args: &mut Args<'_>,
    between: usize,
    numbers: Option<&mut [f64]>,
) -> Res<Frame> {
    let (origin, axis) = (args.reference()?, args.reference()?);
    match numbers {
        Some(numbers) => {
            for number in numbers {
                *number = args.real()?;
            }
        }
        None => args.skip(between),
    }
    let (origin, axis) = (point(doc, origin)?, direction(doc, axis)?);
    let x = if doc.entry(ix).form == 1 { args.optional_reference().ok().flatten() } else { None };
    let x = x.map(|x| direction(doc, x)).transpose()?;
    Ok(Frame::new(origin, axis, x.unwrap_or(DVec3::X)))
}

fn cone(doc: &Doc<'_>, ix: Ix, frame: Frame, radius: f64, half_angle: f64) -> Res<Patch> {
    if !(radius.is_finite() && half_angle.is_finite()) {
        return Err(doc.bad(ix, ReadIssue::NotFinite { what: "radius or half angle" }));
    }
    Ok(Patch::elementary(Surface::Cone { frame, radius, half_angle }))
}

/// 108: A x + B y + C z = D.
fn plane(doc: &Doc<'_>, ix: Ix, mut args: Args<'_>) -> Res<Patch> {
    let (normal, distance) = (args.point()?, args.real()?);
    let length = normal.length();
    if !(length > 0.0) {
        return Err(doc.bad(ix, ReadIssue::ZeroVector { what: "normal" }));
    }
    let origin = normal * (distance / (length * length));
    Ok(Patch::elementary(Surface::Plane { frame: Frame::new(origin, normal, DVec3::X) }))
}

/// A curve as profile: one curve with its range.
fn profile(doc: &Doc<'_>, ix: Ix, curve: Ix) -> Res<Segment> {
    joined(doc, ix, segments(doc, curve, &DAffine3::IDENTITY)?)
}

/// 120: axis (a line), generatrix, start and end angle. The file's u runs along the generatrix, ours round
/// the axis.
fn revolution(doc: &Doc<'_>, ix: Ix, mut args: Args<'_>) -> Res<Patch> {
    let (axis, generatrix) = (args.reference()?, args.reference()?);
    let (start, end) = (args.real()?, args.real()?);
    let axis = profile(doc, ix, axis)?;
    let (axis_origin, direction) = (axis.start(), (axis.end() - axis.start()).try_normalize());
    let Some(axis) = direction else { return Err(doc.bad(ix, ReadIssue::ZeroVector { what: "axis" })) };
    let Segment { curve: profile, range } = profile(doc, ix, generatrix)?;
    let end = if end > start { end } else { end + TAU };
    // Angles are rounded: nearly a whole turn is one.
    let end = if (end - start - TAU).abs() < 1e-6 { start + TAU } else { end };
    let whole = end - start >= TAU && range == profile.domain();
    let bounds = (!whole).then(|| UvBox::from_ranges(Range::new(start, end.min(start + TAU)), range));
    Ok(Patch {
        surface: Surface::Revolution { profile, axis_origin, axis },
        parameters: Some(Parameters { exchanged: true, ..Parameters::SAME }),
        reversed: true,
        bounds,
    })
}

/// 122: directrix, and where the generatrix through the directrix's start ends. Both parameters run over
/// 0..=1.
fn tabulated(doc: &Doc<'_>, ix: Ix, mut args: Args<'_>) -> Res<Patch> {
    let directrix = args.reference()?;
    let end = args.point()?;
    let Segment { curve: profile, range } = profile(doc, ix, directrix)?;
    let direction = end - profile.point(range.start);
    if !(direction.length() > 0.0) {
        return Err(doc.bad(ix, ReadIssue::NoLength { what: "generatrix" }));
    }
    Ok(Patch {
        surface: Surface::Extrusion { profile, direction },
        parameters: Some(Parameters {
            exchanged: false,
            factors: DVec2::new(range.length(), 1.0),
            shift: DVec2::new(range.start, 0.0),
        }),
        reversed: false,
        bounds: Some(UvBox::from_ranges(range, Range::new(0.0, 1.0))),
    })
}

/// 140: a vector on the side of the offset, distance, basis.
fn offset(doc: &Doc<'_>, mut args: Args<'_>, depth: u32) -> Res<Patch> {
    let (side, distance) = (args.point()?, args.real()?);
    let basis = nested(doc, args.reference()?, &DAffine3::IDENTITY, depth + 1)?;
    let uv = basis.bounds.unwrap_or_else(|| basis.surface.domain());
    let middle = if uv.is_finite() { uv.center() } else { DVec2::ZERO };
    let normal = basis.surface.normal(middle).unwrap_or(DVec3::Z);
    let distance = if normal.dot(side) < 0.0 { -distance } else { distance };
    Ok(Patch { surface: Surface::Offset { basis: Box::new(basis.surface), distance }, ..basis })
}
