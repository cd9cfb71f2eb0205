//! Opens the entities of the table: their attributes, and the leaves of complex instances.

use super::args::Args;
use super::document::{Doc, Ix, Res};
use super::keyword::Kw;

impl Doc<'_> {
    /// The attributes of a simple entity, or the leaves of a complex one.
    pub(crate) fn open(&self, ix: Ix) -> Res<Args<'_>> {
        Ok(Args::new(self, ix, self.text(ix)?))
    }

    /// The attributes of `ix` as an entity of kind `kw`: its own where it is simple, those of the leaf of
    /// that name where it is complex.
    pub(crate) fn leaf(&self, ix: Ix, kw: Kw) -> Res<Args<'_>> {
        match self.find_leaf(ix, kw)? {
            Some(args) => Ok(args),
            None => Err(self.unknown(ix, kw.name())),
        }
    }

    /// As [`Doc::leaf`]; `None` where there is no such leaf.
    pub(crate) fn find_leaf(&self, ix: Ix, kw: Kw) -> Res<Option<Args<'_>>> {
        let args = self.open(ix)?;
        if self.kw(ix) != Kw::Complex {
            return Ok((self.kw(ix) == kw).then_some(args));
        }
        Ok(args.leaves().into_iter().find(|(name, _)| *name == kw).map(|(_, args)| args))
    }

    /// What an instance is, with the attributes that follow its name: those of a simple entity, or those of
    /// the first leaf of a complex instance that is one of `principal`.
    pub(crate) fn body(&self, ix: Ix, principal: &[Kw]) -> Res<(Kw, Args<'_>)> {
        let mut args = self.open(ix)?;
        if self.kw(ix) != Kw::Complex {
            args.skip(1);
            return Ok((self.kw(ix), args));
        }
        let leaves = args.leaves();
        let found = principal.iter().find_map(|kw| leaves.iter().find(|(name, _)| name == kw));
        Ok(found.map_or((Kw::Complex, self.open(ix)?), |(kw, args)| (*kw, args.clone())))
    }

    /// Keywords of the leaves of a complex instance, or the one of a simple entity.
    pub(crate) fn kinds(&self, ix: Ix) -> Vec<Kw> {
        if self.kw(ix) != Kw::Complex {
            return vec![self.kw(ix)];
        }
        self.open(ix).map(|args| args.leaves().into_iter().map(|(kw, _)| kw).collect()).unwrap_or_default()
    }
}
