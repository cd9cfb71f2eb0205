//! The encoding of names: text formats do not state it, and CAD systems write that of their country.
//!
//! Text that is valid UTF-8 is UTF-8. Else each candidate gets points for what is frequent in names of its
//! language: GBK for Chinese characters, Shift-JIS for kana and kanji, Latin-1 for one or two bytes beside
//! small letters. Bytes that are none of an encoding cost points. The whole file counts, so all names of a
//! file are decoded alike.
//!
//! Not guaranteed: a file with very few names that make sense in two encodings, such as half-width katakana,
//! may be taken for the wrong one. Only names depend on it.

use encoding_rs::{GBK, SHIFT_JIS};
use std::borrow::Cow;

/// What a byte that is none of an encoding costs: one such byte outweighs four frequent characters.
const INVALID: i64 = -8;

/// An encoding of text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// UTF-8, and ASCII.
    #[default]
    Utf8,
    /// Chinese.
    Gbk,
    /// Japanese.
    ShiftJis,
    /// Latin-1, between sequences of UTF-8.
    Latin1,
}

impl Encoding {
    /// The encoding of the text of a file.
    pub(crate) fn of(text: &[u8]) -> Self {
        if std::str::from_utf8(text).is_ok() {
            return Encoding::Utf8;
        }
        let (gbk, shift_jis, latin) = (gbk(text), shift_jis(text), latin(text));
        if latin >= gbk.max(shift_jis) {
            Encoding::Latin1
        } else if gbk >= shift_jis {
            Encoding::Gbk
        } else {
            Encoding::ShiftJis
        }
    }

    /// Bytes of a file of this encoding as text.
    pub(crate) fn decode(self, bytes: &[u8]) -> Cow<'_, str> {
        match self {
            Encoding::Gbk => GBK.decode_without_bom_handling(bytes).0,
            Encoding::ShiftJis => SHIFT_JIS.decode_without_bom_handling(bytes).0,
            Encoding::Utf8 | Encoding::Latin1 => match std::str::from_utf8(bytes) {
                Ok(text) => Cow::Borrowed(text),
                Err(_) => Cow::Owned(utf8_or_latin(bytes)),
            },
        }
    }
}

/// The same text as UTF-8.
pub(crate) fn as_utf8(text: Cow<'_, [u8]>) -> Cow<'_, [u8]> {
    match Encoding::of(&text) {
        Encoding::Utf8 => text,
        encoding => Cow::Owned(encoding.decode(&text).into_owned().into_bytes()),
    }
}

/// Sequences of UTF-8 where there are some, else Latin-1.
fn utf8_or_latin(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|&b| char::from(b)));
    }
    text
}

/// Points of a text as GBK: characters of the first level of GB 2312 are frequent, those of the second are
/// rare.
fn gbk(text: &[u8]) -> i64 {
    points(text, |lead, trail| match (lead, trail?) {
        (0xb0..=0xd7, 0xa1..=0xfe) => Some((2, 2)),
        (0xd8..=0xf7 | 0xa1..=0xa3, 0xa1..=0xfe) => Some((1, 2)),
        (0x81..=0xfe, 0x40..=0x7e | 0x80..=0xfe) => Some((0, 2)),
        _ => None,
    })
}

/// Points of a text as Shift-JIS: kana say most, kanji of the first level are frequent.
fn shift_jis(text: &[u8]) -> i64 {
    points(text, |lead, trail| match (lead, trail) {
        (0xa1..=0xdf, _) => Some((0, 1)),
        (0x82, Some(0x9f..=0xf1)) | (0x83, Some(0x40..=0x7e | 0x80..=0x96)) => Some((4, 2)),
        (0x88..=0x97, Some(0x40..=0x7e | 0x80..=0xfc)) => Some((2, 2)),
        (0x81..=0x9f | 0xe0..=0xea, Some(0x40..=0x7e | 0x80..=0xfc)) => Some((1, 2)),
        (0xeb..=0xfc, Some(0x40..=0x7e | 0x80..=0xfc)) => Some((0, 2)),
        _ => None,
    })
}

/// The sum over all characters that begin with a high byte. `rate` gives the points of one and its length.
fn points(text: &[u8], rate: impl Fn(u8, Option<u8>) -> Option<(i64, usize)>) -> i64 {
    let (mut sum, mut at) = (0, 0);
    while let Some(&lead) = text.get(at) {
        let (points, length) = match lead {
            0..=0x7f => (0, 1),
            _ => rate(lead, text.get(at + 1).copied()).unwrap_or((INVALID, 1)),
        };
        sum += points;
        at += length;
    }
    sum
}

/// Points of a text as Latin-1: letters with accents stand alone or in pairs, beside other letters.
fn latin(text: &[u8]) -> i64 {
    let (mut sum, mut at) = (0, 0);
    while at < text.len() {
        let run = text[at..].iter().take_while(|b| !b.is_ascii()).count();
        let beside = [at.checked_sub(1), Some(at + run)];
        let beside = |is: fn(&u8) -> bool| beside.iter().flatten().filter_map(|&i| text.get(i)).any(is);
        let letters =
            text[at..at + run].iter().filter(|b| matches!(b, 0xc0..=0xd6 | 0xd8..=0xf6 | 0xf8..=0xff));
        sum += match run {
            1 | 2 if beside(u8::is_ascii_lowercase) => 2 * letters.count() as i64,
            1 | 2 if beside(u8::is_ascii_alphanumeric) => letters.count() as i64,
            _ => 0,
        };
        at += run.max(1);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> (Encoding, String) {
        let encoding = Encoding::of(bytes);
        (encoding, encoding.decode(bytes).into_owned())
    }

    #[test]
    fn names_are_read_in_the_encoding_of_their_country() {
        for name in ["底板", "螺栓M8", "上盖(左)", "零件1", "#1=PRODUCT('轴承座','齿轮',(#2));"]
        {
            assert_eq!(decoded(&GBK.encode(name).0), (Encoding::Gbk, name.to_owned()));
        }
        for name in ["ボルト", "部品1", "ベース板", "#1=PRODUCT('ソケット表','カバー',(#2));"]
        {
            assert_eq!(decoded(&SHIFT_JIS.encode(name).0), (Encoding::ShiftJis, name.to_owned()));
        }
        for name in ["Träger", "Größe", "Gehäuse Ø20", "pièce", "Ø20 Loch", "tornillería"] {
            let bytes: Vec<u8> = name.chars().map(|c| c as u8).collect();
            assert_eq!(decoded(&bytes), (Encoding::Latin1, name.to_owned()));
            assert_eq!(decoded(name.as_bytes()), (Encoding::Utf8, name.to_owned()));
        }
    }

    #[test]
    fn utf_8_between_latin_1_stays() {
        assert_eq!(decoded(b"gr\xf6\xdfe \xc3\xa4").1, "größe ä");
        assert_eq!(decoded(b"cut \xe4").1, "cut ä");
    }
}
