//! How native parameters (angles) turn into those of a NURBS form, and back.

use super::{LONGEST_ARC, LONGEST_HYPERBOLA, spans};
use crate::math;
use crate::{Curve, NurbsError, Range, Surface, UvBox};
use glam::DVec2;

/// The parameter of the NURBS form of a curve as a function of the curve's own. Increasing; the two agree at
/// the ends.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ParameterMap {
    /// Both parameters are the same.
    Identity,
    /// Equal arcs of the angle `step` from `start` on: `m + h tan(θ/2)/tan(h/2)` in each, θ from its middle
    /// m, h = step/2.
    Arcs {
        /// The first angle.
        start: f64,
        /// The angle of one arc.
        step: f64,
    },
    /// The same with hyperbolic tangents.
    Hyperbolas {
        /// The first parameter.
        start: f64,
        /// The length of one piece.
        step: f64,
    },
    /// Pieces of unit length: the piece's own parameters at its two ends, and its map.
    Pieces(Vec<(f64, f64, ParameterMap)>),
}

impl ParameterMap {
    /// The NURBS parameter at a native one.
    pub fn nurbs_from_native(&self, t: f64) -> f64 {
        self.map(t, true)
    }

    /// The native parameter at a NURBS one.
    pub fn native_from_nurbs(&self, s: f64) -> f64 {
        self.map(s, false)
    }

    fn map(&self, t: f64, forward: bool) -> f64 {
        match self {
            ParameterMap::Identity => t,
            ParameterMap::Arcs { start, step } => {
                let (m, h) = middle(t, *start, *step);
                let whole = math::tan(0.5 * h);
                if forward {
                    m + h * math::tan(0.5 * (t - m)) / whole
                } else {
                    m + 2.0 * math::atan((t - m) / h * whole)
                }
            }
            ParameterMap::Hyperbolas { start, step } => {
                let (m, h) = middle(t, *start, *step);
                let whole = math::tanh(0.5 * h);
                if forward {
                    m + h * math::tanh(0.5 * (t - m)) / whole
                } else {
                    m + 2.0 * math::atanh((t - m) / h * whole)
                }
            }
            ParameterMap::Pieces(pieces) => {
                let Some((i, s)) = crate::conic::piece_of(pieces.len(), t) else { return t };
                let (start, end, own) = &pieces[i];
                let length = end - start;
                if length == 0.0 {
                    return t;
                }
                i as f64 + (own.map(start + s * length, forward) - start) / length
            }
        }
    }
}

/// The middle and half the length of the span around `t`.
fn middle(t: f64, start: f64, step: f64) -> (f64, f64) {
    // Both parameters of a span have the same ends, so this serves both directions.
    let index = ((t - start) / step).floor();
    (start + (index + 0.5) * step, 0.5 * step)
}

/// How the parameters of a surface turn into those of its NURBS form: each direction by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsParameters {
    /// The map along u.
    pub u: ParameterMap,
    /// The map along v.
    pub v: ParameterMap,
}

impl NurbsParameters {
    /// The NURBS parameters at native ones.
    pub fn nurbs_from_native(&self, p_uv: DVec2) -> DVec2 {
        DVec2::new(self.u.nurbs_from_native(p_uv.x), self.v.nurbs_from_native(p_uv.y))
    }

    /// The native parameters at NURBS ones.
    pub fn native_from_nurbs(&self, p_uv: DVec2) -> DVec2 {
        DVec2::new(self.u.native_from_nurbs(p_uv.x), self.v.native_from_nurbs(p_uv.y))
    }
}

impl Curve {
    /// How this curve's parameters turn into those of [`Curve::to_nurbs`] over the same range.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where the range is.
    pub fn nurbs_parameters(&self, range: Range) -> Result<ParameterMap, NurbsError> {
        Ok(match self {
            Curve::Circle { .. } | Curve::Ellipse { .. } => arcs(range)?,
            Curve::Hyperbola { .. } => {
                let count = spans(range, LONGEST_HYPERBOLA)?;
                ParameterMap::Hyperbolas { start: range.start, step: range.length() / count as f64 }
            }
            Curve::Composite(segments) => {
                let piece = |i: usize| {
                    let segment = &segments[i];
                    let (s0, s1) = super::curve::part_of(i, range);
                    let own = segment.curve.nurbs_parameters(segment.own_range(s0, s1));
                    // Outside the requested range there is no NURBS form to agree with.
                    Ok((segment.start, segment.end, if s0 < s1 { own? } else { ParameterMap::Identity }))
                };
                ParameterMap::Pieces((0..segments.len()).map(piece).collect::<Result<_, NurbsError>>()?)
            }
            _ => ParameterMap::Identity,
        })
    }
}

fn arcs(range: Range) -> Result<ParameterMap, NurbsError> {
    let count = spans(range, LONGEST_ARC)?;
    Ok(ParameterMap::Arcs { start: range.start, step: range.length() / count as f64 })
}

impl Surface {
    /// How this surface's parameters turn into those of [`Surface::to_nurbs`] over the same box.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where the box is.
    pub fn nurbs_parameters(&self, uv: UvBox) -> Result<NurbsParameters, NurbsError> {
        let same = ParameterMap::Identity;
        Ok(match self {
            Surface::Cylinder { .. } | Surface::Cone { .. } => NurbsParameters { u: arcs(uv.u())?, v: same },
            Surface::Sphere { .. } | Surface::Torus { .. } => {
                NurbsParameters { u: arcs(uv.u())?, v: arcs(uv.v())? }
            }
            Surface::Extrusion { profile, .. } => {
                NurbsParameters { u: profile.nurbs_parameters(uv.u())?, v: same }
            }
            Surface::Revolution { profile, .. } => {
                NurbsParameters { u: arcs(uv.u())?, v: profile.nurbs_parameters(uv.v())? }
            }
            Surface::Offset { .. } => match self.clone().simplified() {
                Surface::Offset { .. } => NurbsParameters { u: same.clone(), v: same },
                exact => exact.nurbs_parameters(uv)?,
            },
            Surface::Plane { .. } | Surface::Nurbs(_) => NurbsParameters { u: same.clone(), v: same },
        })
    }
}
