//! The tags of an XML document, as much of XML as 3MF needs: no entities of its own, no text between tags.

use std::borrow::Cow;

/// An opening or closing tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tag<'a> {
    /// Without its namespace.
    pub name: &'a str,
    /// `</name>`.
    pub closing: bool,
    /// `<name/>`.
    pub empty: bool,
    attributes: &'a str,
}

impl<'a> Tag<'a> {
    /// An attribute's raw value, by its name without a namespace.
    pub fn attribute(&self, wanted: &str) -> Option<&'a str> {
        let mut rest = self.attributes;
        loop {
            let (name, after) = rest.split_once('=')?;
            let after = after.trim_start();
            let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, after) = after[1..].split_once(quote)?;
            if local(name.trim()) == wanted {
                return Some(value);
            }
            rest = after;
        }
    }

    /// An attribute as a number.
    pub fn number<T: std::str::FromStr>(&self, name: &str) -> Option<T> {
        self.attribute(name)?.trim().parse().ok()
    }
}

fn local(name: &str) -> &str {
    name.rsplit(':').next().unwrap_or(name)
}

/// The tags of a document in their order; comments, declarations and text are skipped.
pub(super) fn tags(document: &str) -> impl Iterator<Item = Tag<'_>> {
    let mut rest = document;
    std::iter::from_fn(move || {
        loop {
            rest = &rest[rest.find('<')? + 1..];
            let skipped = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>"), ("!", ">")];
            if let Some((_, end)) = skipped.iter().find(|(start, _)| rest.starts_with(start)) {
                rest = &rest[rest.find(end)? + end.len()..];
                continue;
            }
            let end = tag_end(rest)?;
            let inside = &rest[..end];
            rest = &rest[end + 1..];
            return Some(tag(inside));
        }
    })
}

/// Where the tag ends; a `>` in quotes does not end it.
fn tag_end(text: &str) -> Option<usize> {
    let mut quote = None;
    text.bytes().position(|b| {
        match (quote, b) {
            (None, b'"' | b'\'') => quote = Some(b),
            (Some(q), b) if q == b => quote = None,
            (None, b'>') => return true,
            _ => {}
        }
        false
    })
}

fn tag(inside: &str) -> Tag<'_> {
    let closing = inside.starts_with('/');
    let inside = inside.strip_prefix('/').unwrap_or(inside);
    let empty = inside.ends_with('/');
    let inside = inside.strip_suffix('/').unwrap_or(inside);
    let end = inside.find(char::is_whitespace).unwrap_or(inside.len());
    Tag { name: local(&inside[..end]), closing, empty, attributes: &inside[end..] }
}

/// A value with XML's five entities resolved.
pub(super) fn unescape(value: &str) -> Cow<'_, str> {
    if !value.contains('&') {
        return value.into();
    }
    let quotes = value.replace("&quot;", "\"").replace("&apos;", "'");
    quotes.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_and_attributes() {
        let text = "<?xml a=\"<b>\"?><!-- <c> --><m:a x=\"1>2\" p:y = '3'><b/></m:a><unfinished";
        let tags: Vec<_> = tags(text).collect();
        let shapes: Vec<_> = tags.iter().map(|t| (t.name, t.closing, t.empty)).collect();
        assert_eq!(shapes, [("a", false, false), ("b", false, true), ("a", true, false)]);
        assert_eq!(tags[0].attribute("x"), Some("1>2"));
        assert_eq!(tags[0].number("y"), Some(3));
        assert_eq!(tags[0].attribute("z"), None);
        assert_eq!(unescape("a&amp;lt;&lt;"), "a&lt;<");
    }
}
