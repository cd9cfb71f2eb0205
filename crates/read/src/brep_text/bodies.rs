//! Solids, shells and loose faces.

use super::builder::Builder;
use super::locations::{Loc, NOWHERE};
use super::shapes::{Ix, Kind, Orientation};
use chordal_brep::{Body, BodyKind, FaceId, LooseItem, LooseKind, ReadIssue, Shell, ShellId, Source};

impl Builder<'_> {
    /// Adds what a record is; the faces that belong to no shell are handed back.
    pub(crate) fn item(&mut self, ix: Ix, reversed: bool) -> Vec<FaceId> {
        let Ok(shape) = self.shape(ix) else { return Vec::new() };
        let source = self.doc.source(ix);
        match shape.kind {
            Kind::Solid => self.solid(ix, reversed),
            Kind::Shell => {
                let shell = self.shell(ix, NOWHERE, reversed, shape.closed);
                self.body(BodyKind::Sheet, vec![shell], source);
            }
            Kind::Face(_) => return self.face(ix, NOWHERE, reversed),
            Kind::Wire | Kind::Edge(_) => self.loose(LooseKind::Wire, source),
            Kind::Vertex { .. } => self.loose(LooseKind::Point, source),
            Kind::CompSolid | Kind::Compound => {}
        }
        Vec::new()
    }

    /// One body for all faces that belong to no shell.
    pub(crate) fn face_set(&mut self, faces: Vec<FaceId>) {
        if !faces.is_empty() {
            let shell = self.push_shell(faces, false, Source::default());
            self.body(BodyKind::FaceSet, vec![shell], Source::default());
        }
    }

    fn solid(&mut self, ix: Ix, reversed: bool) {
        let source = self.doc.source(ix);
        let Ok(shape) = self.shape(ix) else { return };
        let mut shells = Vec::new();
        for sub in shape.subs {
            let is_shell = self.shape(sub.shape).is_ok_and(|shape| shape.kind == Kind::Shell);
            if !is_shell || sub.orientation == Orientation::Aside {
                let what =
                    ReadIssue::Unsupported { what: "a shape inside a solid that does not bound it".into() };
                self.doc.notes.warn(self.doc.source(sub.shape), what);
                continue;
            }
            match self.within(NOWHERE, sub.location) {
                Ok(at) => {
                    let flipped = reversed != (sub.orientation == Orientation::Reversed);
                    shells.push(self.shell(sub.shape, at, flipped, true));
                }
                Err(why) => self
                    .doc
                    .notes
                    .lose(source, ReadIssue::ShellIgnored { what: "shell of a solid", cause: why.boxed() }),
            }
        }
        self.body(BodyKind::Solid, shells, source);
    }

    fn shell(&mut self, ix: Ix, loc: Loc, reversed: bool, closed: bool) -> ShellId {
        let source = self.doc.source(ix);
        let mut faces = Vec::new();
        for sub in self.shape(ix).map(|shape| shape.subs).unwrap_or_default() {
            if !self.spend() {
                self.doc.notes.lose(source, ReadIssue::TooManyReferences);
                break;
            }
            match self.within(loc, sub.location) {
                Ok(at) => {
                    let flipped = reversed != (sub.orientation == Orientation::Reversed);
                    faces.extend(self.face(sub.shape, at, flipped));
                }
                Err(why) => self
                    .doc
                    .notes
                    .lose(source, ReadIssue::ShellIgnored { what: "face of a shell", cause: why.boxed() }),
            }
        }
        self.push_shell(faces, closed, source)
    }

    fn push_shell(&mut self, faces: Vec<FaceId>, closed: bool, source: Source) -> ShellId {
        let id = ShellId::from(self.build.part.shells.len());
        self.build.part.shells.push(Shell { faces, closed, source });
        id
    }

    fn body(&mut self, kind: BodyKind, shells: Vec<ShellId>, source: Source) {
        let body = Body { kind, shells, name: String::new(), color: None, layer: None, source };
        self.build.part.bodies.push(body);
    }

    fn loose(&mut self, kind: LooseKind, source: Source) {
        self.build.part.loose.push(LooseItem { kind, name: String::new(), source });
    }
}
