//! Colours and layers of entities.
//!
//! STEP's colours are the sRGB values that a screen shows; the model holds linear ones.

use super::args::{Args, Kind};
use super::document::{Doc, Ix};
use super::keyword::Kw;
use crate::srgb::linear;
use chordal_brep::Color;
use rustc_hash::FxHashMap;

/// Colours and layers by the entity that they are given to.
#[derive(Debug, Default)]
pub(crate) struct Styles {
    pub colors: FxHashMap<Ix, Color>,
    pub layers: FxHashMap<Ix, String>,
    /// Colours given to an item only within one use of it: (item, the use's entities, colour).
    pub in_context: Vec<(Ix, Vec<Ix>, Color)>,
}

/// The styles of one item that concern surfaces.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    fill: Option<[f64; 3]>,
    rendered: Option<[f64; 3]>,
    transparency: Option<f64>,
}

/// Styles nest a few levels; more is a circle.
const MAX_DEPTH: u32 = 8;

impl Styles {
    /// All colours and layers of the file.
    pub(crate) fn read(doc: &Doc<'_>) -> Self {
        let mut styles = Self::default();
        let mut known = FxHashMap::default();
        let plain = doc.all(|kw| kw == Kw::StyledItem);
        let overriding = doc.all(|kw| kw == Kw::OverRidingStyledItem);
        for ix in plain.into_iter().chain(overriding) {
            styles.styled_item(doc, ix, &mut known);
        }
        for ix in doc.all(|kw| kw == Kw::ContextDependentOverRidingStyledItem) {
            styles.in_context(doc, ix, &mut known);
        }
        styles.read_layers(doc);
        styles
    }

    fn styled_item(&mut self, doc: &Doc<'_>, ix: Ix, known: &mut FxHashMap<Ix, Found>) {
        let Ok(mut args) = doc.open(ix) else { return };
        args.skip(1);
        let color = color_of(doc, &mut args, known);
        let item = args.optional_reference();
        if let (Some(color), Some(item)) = (color, item) {
            self.colors.insert(item, color);
        }
    }

    fn in_context(&mut self, doc: &Doc<'_>, ix: Ix, known: &mut FxHashMap<Ix, Found>) {
        let Ok(mut args) = doc.open(ix) else { return };
        args.skip(1);
        let color = color_of(doc, &mut args, known);
        let item = args.optional_reference();
        args.skip(1);
        if let (Some(color), Some(item)) = (color, item) {
            self.in_context.push((item, args.references_or_warn(), color));
        }
    }

    fn read_layers(&mut self, doc: &Doc<'_>) {
        for ix in doc.all(|kw| kw == Kw::PresentationLayerAssignment) {
            let Ok(mut args) = doc.open(ix) else { continue };
            let name = args.string();
            args.skip(1);
            for item in args.references_or_warn() {
                self.layers.insert(styled(doc, item).unwrap_or(item), name.clone());
            }
        }
    }
}

/// The item of a styled item: layers list either.
fn styled(doc: &Doc<'_>, ix: Ix) -> Option<Ix> {
    if !matches!(doc.kw(ix), Kw::StyledItem | Kw::OverRidingStyledItem) {
        return None;
    }
    let mut args = doc.open(ix).ok()?;
    args.skip(2);
    args.optional_reference()
}

/// The colour that a list of styles gives to surfaces.
fn color_of(doc: &Doc<'_>, args: &mut Args<'_>, known: &mut FxHashMap<Ix, Found>) -> Option<Color> {
    let mut found = Found::default();
    for style in args.references_or_warn() {
        let new = match known.get(&style) {
            Some(&new) => new,
            None => {
                let mut new = Found::default();
                walk(doc, style, &mut new, 0);
                known.insert(style, new);
                new
            }
        };
        found.fill = found.fill.or(new.fill);
        found.rendered = found.rendered.or(new.rendered);
        found.transparency = found.transparency.or(new.transparency);
    }
    let rgb = found.fill.or(found.rendered)?;
    let alpha = 1.0 - found.transparency.unwrap_or(0.0).clamp(0.0, 1.0);
    let [r, g, b] = rgb.map(linear);
    Some(Color([r, g, b, alpha as f32]))
}

/// Follows a style down to its colours.
fn walk(doc: &Doc<'_>, ix: Ix, found: &mut Found, depth: u32) {
    if depth > MAX_DEPTH {
        return;
    }
    let Ok(mut args) = doc.open(ix) else { return };
    match doc.kw(ix) {
        Kw::PresentationStyleAssignment | Kw::PresentationStyleByContext => walk_all(doc, args, found, depth),
        Kw::SurfaceStyleUsage => {
            args.skip(1);
            if let Some(side) = args.optional_reference() {
                walk(doc, side, found, depth + 1);
            }
        }
        Kw::SurfaceSideStyle | Kw::FillAreaStyle => {
            args.skip(1);
            walk_all(doc, args, found, depth);
        }
        Kw::SurfaceStyleFillArea => {
            if let Some(area) = args.optional_reference() {
                walk(doc, area, found, depth + 1);
            }
        }
        Kw::FillAreaStyleColour => {
            args.skip(1);
            found.fill = found.fill.or(args.optional_reference().and_then(|colour| rgb(doc, colour)));
        }
        Kw::SurfaceStyleRendering | Kw::SurfaceStyleRenderingWithProperties => {
            args.skip(1);
            found.rendered = found.rendered.or(args.optional_reference().and_then(|colour| rgb(doc, colour)));
            if args.kind() == Kind::List {
                walk_all(doc, args, found, depth);
            }
        }
        Kw::SurfaceStyleTransparent => found.transparency = found.transparency.or(args.optional_real()),
        _ => {}
    }
}

/// Follows each member of the list that comes next.
fn walk_all(doc: &Doc<'_>, mut args: Args<'_>, found: &mut Found, depth: u32) {
    for style in args.references().unwrap_or_default().into_iter().flatten() {
        walk(doc, style, found, depth + 1);
    }
}

fn rgb(doc: &Doc<'_>, ix: Ix) -> Option<[f64; 3]> {
    let mut args = doc.open(ix).ok()?;
    match doc.kw(ix) {
        Kw::ColourRgb => {
            args.skip(1);
            Some([args.real().ok()?, args.real().ok()?, args.real().ok()?])
        }
        Kw::DraughtingPreDefinedColour | Kw::PreDefinedColour => {
            match args.string().to_ascii_lowercase().as_str() {
                "red" => Some([1.0, 0.0, 0.0]),
                "green" => Some([0.0, 1.0, 0.0]),
                "blue" => Some([0.0, 0.0, 1.0]),
                "yellow" => Some([1.0, 1.0, 0.0]),
                "magenta" => Some([1.0, 0.0, 1.0]),
                "cyan" => Some([0.0, 1.0, 1.0]),
                "black" => Some([0.0; 3]),
                "white" => Some([1.0; 3]),
                _ => None,
            }
        }
        _ => None,
    }
}
