//! Shells, bodies and the other items of a representation.

use super::args::Args;
use super::builder::Builder;
use super::document::{Ix, Res};
use super::faces::FaceUse;
use super::keyword::Kw;
use chordal_brep::{Body, BodyKind, FaceId, LooseItem, LooseKind, ReadIssue, Shell, ShellId};

/// Items within items deeper than this refer in a circle.
const MAX_DEPTH: u32 = 8;

impl Builder<'_> {
    /// Adds what one item of a representation stands for.
    pub(crate) fn item(&mut self, ix: Ix) {
        self.item_at(ix, 0);
    }

    fn item_at(&mut self, ix: Ix, depth: u32) {
        if depth > MAX_DEPTH || !self.taken.insert(ix) {
            return;
        }
        if let Err(bad) = self.read_item(ix, depth) {
            self.lose_bad(&bad);
        }
    }

    fn read_item(&mut self, ix: Ix, depth: u32) -> Res<()> {
        let mut args = self.doc.open(ix)?;
        match self.doc.kw(ix) {
            Kw::ManifoldSolidBrep | Kw::FacetedBrep | Kw::BrepWithVoids => {
                let name = args.string();
                let outer = args.reference()?;
                let voids =
                    if self.doc.kw(ix) == Kw::BrepWithVoids { args.references_or_warn() } else { Vec::new() };
                self.solid(ix, name, outer, voids);
            }
            Kw::ShellBasedSurfaceModel => {
                let name = args.string();
                let shells = args.references_or_warn();
                self.body(ix, BodyKind::Sheet, name, &shells);
            }
            Kw::FaceBasedSurfaceModel => {
                let name = args.string();
                let sets = args.references_or_warn();
                self.body(ix, BodyKind::FaceSet, name, &sets);
            }
            Kw::ClosedShell | Kw::OpenShell | Kw::OrientedClosedShell | Kw::OrientedOpenShell => {
                let name = args.string();
                self.body(ix, BodyKind::Sheet, name, &[ix]);
            }
            Kw::ConnectedFaceSet | Kw::ConnectedFaceSubSet => {
                let name = args.string();
                self.body(ix, BodyKind::FaceSet, name, &[ix]);
            }
            Kw::AdvancedFace | Kw::FaceSurface | Kw::Face | Kw::OrientedFace | Kw::Subface => {
                let how = self.face_use(ix, false);
                let face = self.face(ix, &how);
                self.face_set(ix, String::new(), vec![face]);
            }
            Kw::GeometricSet | Kw::GeometricCurveSet => self.geometric_set(ix, args, depth),
            Kw::CompoundRepresentationItem => self.compound(ix, args, depth),
            Kw::Complex => self.complex_item(ix, depth)?,
            kw if is_surface(kw) => self.loose_surface(ix),
            kw if is_curve(kw) => self.loose(ix, LooseKind::Wire),
            Kw::CartesianPoint
            | Kw::PointOnCurve
            | Kw::PointOnSurface
            | Kw::VertexPoint
            | Kw::VertexShell => {
                self.loose(ix, LooseKind::Point);
            }
            kw if self.tessellated(ix, kw)? => {}
            kw if is_silent(kw) => {}
            Kw::Unknown => self.unknown_item(ix),
            kw => {
                return Err(self.doc.bad(ix, ReadIssue::Unsupported { what: kw.name().into() }));
            }
        }
        Ok(())
    }

    fn unknown_item(&mut self, ix: Ix) {
        let name = self.doc.written_name(ix);
        if !is_text_or_view(&name) {
            self.doc.lose(ix, ReadIssue::Unsupported { what: name.into() });
        }
    }

    /// A complex instance, by the leaf that determines its kind.
    fn complex_item(&mut self, ix: Ix, _depth: u32) -> Res<()> {
        let kinds = self.doc.kinds(ix);
        let has = |kw| kinds.contains(&kw);
        let name =
            self.doc.find_leaf(ix, Kw::RepresentationItem)?.map(|mut args| args.string()).unwrap_or_default();
        if has(Kw::ManifoldSolidBrep) {
            let outer = self.doc.leaf(ix, Kw::ManifoldSolidBrep)?.reference()?;
            let voids = self.doc.find_leaf(ix, Kw::BrepWithVoids)?.map(|mut args| args.references_or_warn());
            self.solid(ix, name, outer, voids.unwrap_or_default());
        } else if has(Kw::ShellBasedSurfaceModel) {
            let shells = self.doc.leaf(ix, Kw::ShellBasedSurfaceModel)?.references_or_warn();
            self.body(ix, BodyKind::Sheet, name, &shells);
        } else if has(Kw::FaceBasedSurfaceModel) {
            let sets = self.doc.leaf(ix, Kw::FaceBasedSurfaceModel)?.references_or_warn();
            self.body(ix, BodyKind::FaceSet, name, &sets);
        } else if has(Kw::FaceSurface) {
            let how = self.face_use(ix, false);
            let face = self.face(ix, &how);
            self.face_set(ix, name, vec![face]);
        } else if has(Kw::BSplineSurface) {
            self.loose_surface(ix);
        } else if kinds.iter().any(|&kw| is_curve(kw)) {
            self.loose(ix, LooseKind::Wire);
        } else if !kinds.iter().any(|&kw| is_silent(kw)) {
            return Err(self.doc.unknown(ix, "an item of a shape"));
        }
        Ok(())
    }

    fn geometric_set(&mut self, ix: Ix, mut args: Args<'_>, depth: u32) {
        args.skip(1);
        for element in args.references_or_warn() {
            self.item_at(element, depth + 1);
        }
        self.hand_down(ix, 0, |body| body.kind == BodyKind::FaceSet);
    }

    /// COMPOUND_REPRESENTATION_ITEM: a list or set of items, as a value of its select type.
    fn compound(&mut self, ix: Ix, mut args: Args<'_>, depth: u32) {
        args.skip(1);
        let before = self.build.part.bodies.len();
        if let Some((_, mut elements)) = args.typed() {
            for element in elements.references_or_warn() {
                self.item_at(element, depth + 1);
            }
        }
        self.hand_down(ix, before, |_| true);
    }

    /// The own colour and layer of a set belong to what it holds.
    fn hand_down(&mut self, set: Ix, first_body: usize, belongs: impl Fn(&Body) -> bool) {
        let (color, layer) = (self.color(set), self.layer(set));
        if color.is_none() && layer.is_none() {
            return;
        }
        for body in self.build.part.bodies[first_body..].iter_mut().filter(|body| belongs(body)) {
            body.color = body.color.or(color);
            body.layer = body.layer.take().or_else(|| layer.clone());
        }
    }

    fn solid(&mut self, ix: Ix, name: String, outer: Ix, voids: Vec<Ix>) {
        let mut shells = vec![outer];
        shells.extend(voids);
        self.body(ix, BodyKind::Solid, name, &shells);
    }

    fn body(&mut self, ix: Ix, kind: BodyKind, name: String, shells: &[Ix]) {
        let mut ids = Vec::new();
        for &shell in shells {
            self.taken.insert(shell);
            match self.shell(shell) {
                Ok(id) => ids.push(id),
                Err(bad) => self.lose_bad(&bad),
            }
        }
        if ids.is_empty() {
            return;
        }
        let (color, layer, source) = (self.color(ix), self.layer(ix), self.doc.source(ix));
        self.build.part.bodies.push(Body { kind, shells: ids, name, color, layer, source });
    }

    /// A shell with all its faces; oriented shells hand their orientation down.
    fn shell(&mut self, ix: Ix) -> Res<ShellId> {
        let (mut at, mut flipped) = (ix, false);
        for _ in 0..MAX_DEPTH {
            let mut args = self.doc.open(at)?;
            match self.doc.kw(at) {
                Kw::OrientedClosedShell | Kw::OrientedOpenShell => {
                    args.skip(2);
                    at = args.reference()?;
                    flipped = flipped == args.logical(true);
                }
                Kw::ClosedShell
                | Kw::OpenShell
                | Kw::ConnectedFaceSet
                | Kw::ConnectedFaceSubSet
                | Kw::Complex => {
                    let faces = self.shell_faces(at)?;
                    let closed = self.doc.kinds(at).contains(&Kw::ClosedShell);
                    return Ok(self.push_shell(ix, at, &faces, flipped, closed));
                }
                Kw::AdvancedFace | Kw::FaceSurface => {
                    return Ok(self.push_shell(ix, at, &[at], flipped, false));
                }
                _ => return Err(self.doc.unknown(at, "a shell")),
            }
        }
        Err(self.doc.recursive(ix, MAX_DEPTH))
    }

    fn shell_faces(&self, ix: Ix) -> Res<Vec<Ix>> {
        if self.doc.kw(ix) == Kw::Complex {
            return Ok(self.doc.leaf(ix, Kw::ConnectedFaceSet)?.references_or_warn());
        }
        let mut args = self.doc.open(ix)?;
        args.skip(1);
        Ok(args.references_or_warn())
    }

    fn face_use(&self, shell: Ix, flipped: bool) -> FaceUse {
        FaceUse { flipped, color: self.color(shell), layer: self.layer(shell) }
    }

    fn push_shell(&mut self, ix: Ix, element: Ix, faces: &[Ix], flipped: bool, closed: bool) -> ShellId {
        let mut how = self.face_use(element, flipped);
        if ix != element {
            how.color = self.color(ix).or(how.color);
            how.layer = self.layer(ix).or(how.layer);
        }
        let faces = faces.iter().map(|&face| self.face(face, &how)).collect();
        let id = ShellId::from(self.build.part.shells.len());
        self.build.part.shells.push(Shell { faces, closed, source: self.doc.source(ix) });
        id
    }

    fn face_set(&mut self, ix: Ix, name: String, faces: Vec<FaceId>) {
        let source = self.doc.source(ix);
        let shell = ShellId::from(self.build.part.shells.len());
        self.build.part.shells.push(Shell { faces, closed: false, source });
        let (color, layer) = (self.color(ix), self.layer(ix));
        self.build.part.bodies.push(Body {
            kind: BodyKind::FaceSet,
            shells: vec![shell],
            name,
            color,
            layer,
            source,
        });
    }

    /// A surface that is no face's: a face of its own where it has bounds.
    fn loose_surface(&mut self, ix: Ix) {
        match self.trimmed_surface(ix) {
            Err(bad) if matches!(bad.issue(), ReadIssue::SurfaceUnbounded) => {
                self.doc.warn(ix, ReadIssue::SurfaceIgnored);
            }
            built => {
                let mut args = self.doc.open(ix).ok();
                let name = match self.doc.kw(ix) {
                    Kw::Complex => String::new(),
                    _ => args.as_mut().map(|args| args.string()).unwrap_or_default(),
                };
                let face = self.push_face(ix, built, name, false, self.color(ix), self.layer(ix));
                self.face_set(ix, String::new(), vec![face]);
            }
        }
    }

    fn loose(&mut self, ix: Ix, kind: LooseKind) {
        let name = match self.doc.kw(ix) {
            Kw::Complex => String::new(),
            _ => self.doc.open(ix).map(|mut args| args.string()).unwrap_or_default(),
        };
        self.build.part.loose.push(LooseItem { kind, name, source: self.doc.source(ix) });
    }
}

fn is_surface(kw: Kw) -> bool {
    matches!(
        kw,
        Kw::Plane
            | Kw::CylindricalSurface
            | Kw::ConicalSurface
            | Kw::SphericalSurface
            | Kw::ToroidalSurface
            | Kw::DegenerateToroidalSurface
            | Kw::SurfaceOfLinearExtrusion
            | Kw::SurfaceOfRevolution
            | Kw::BSplineSurface
            | Kw::BSplineSurfaceWithKnots
            | Kw::UniformSurface
            | Kw::QuasiUniformSurface
            | Kw::BezierSurface
            | Kw::PiecewiseBezierSurface
            | Kw::OffsetSurface
            | Kw::OrientedSurface
            | Kw::RectangularTrimmedSurface
            | Kw::CurveBoundedSurface
    )
}

fn is_curve(kw: Kw) -> bool {
    matches!(
        kw,
        Kw::Line
            | Kw::Circle
            | Kw::Ellipse
            | Kw::Parabola
            | Kw::Hyperbola
            | Kw::Polyline
            | Kw::IndexedPolyCurve
            | Kw::TrimmedCurve
            | Kw::CompositeCurve
            | Kw::CompositeCurveOnSurface
            | Kw::BSplineCurve
            | Kw::BSplineCurveWithKnots
            | Kw::UniformCurve
            | Kw::QuasiUniformCurve
            | Kw::BezierCurve
            | Kw::PiecewiseBezierCurve
            | Kw::OffsetCurve3d
            | Kw::SurfaceCurve
            | Kw::SeamCurve
            | Kw::IntersectionCurve
            | Kw::Pcurve
            | Kw::EdgeCurve
            | Kw::EdgeLoop
            | Kw::PolyLoop
            | Kw::VertexLoop
            | Kw::Path
            | Kw::ConnectedEdgeSet
            | Kw::EdgeBasedWireframeModel
            | Kw::ShellBasedWireframeModel
            | Kw::WireShell
            | Kw::TessellatedCurveSet
            | Kw::TessellatedEdge
            | Kw::TessellatedConnectingEdge
            | Kw::TessellatedWire
    )
}

/// Items that have no shape of their own, or are read elsewhere.
fn is_silent(kw: Kw) -> bool {
    matches!(
        kw,
        Kw::Axis1Placement
            | Kw::Axis2Placement2d
            | Kw::Axis2Placement3d
            | Kw::CartesianTransformationOperator3d
            | Kw::Direction
            | Kw::Vector
            | Kw::MappedItem
            | Kw::StyledItem
            | Kw::OverRidingStyledItem
            | Kw::GeometricRepresentationContext
            | Kw::MeasureWithUnit
            | Kw::LengthMeasureWithUnit
            | Kw::PlaneAngleMeasureWithUnit
    )
}

/// Items that describe a shape but are none.
fn is_text_or_view(name: &str) -> bool {
    [
        "MEASURE",
        "ANNOTATION",
        "DRAUGHTING",
        "CALLOUT",
        "LEADER_CURVE",
        "DIMENSION_CURVE",
        "PROJECTION_CURVE",
        "TERMINATOR_SYMBOL",
        "CAMERA",
        "DESCRIPTIVE",
        "TEXT",
        "VALUE_REPRESENTATION",
        "PLANAR_BOX",
        "INTEGER_REPRESENTATION",
    ]
    .iter()
    .any(|word| name.contains(word))
}
