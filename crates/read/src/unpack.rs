//! Compressed input: gzip (`part.stp.gz`) and zip archives of one file (`part.stpZ`).
//!
//! What a file may unpack to is bounded, since a few bytes can stand for gigabytes: text of CAD files shrinks
//! to a fifth or a tenth, so that [`GROWTH`] leaves room enough.

use crate::ReadError;
use flate2::read::{DeflateDecoder, MultiGzDecoder};
use std::borrow::Cow;
use std::io::Read;

/// Unpacked bytes that any input may have. With it, small files of long runs are read.
const ALWAYS: u64 = 16 << 20;

/// Unpacked bytes per byte of the input. A larger value allows a small hostile file to fill the memory.
const GROWTH: u64 = 64;

/// Archives within archives that are opened: `part.stp.gz` in a zip archive has two.
const LEVELS: usize = 3;

/// The content of a file, unpacked where it is compressed.
///
/// # Errors
/// [`ReadError::Compressed`] where it cannot be unpacked, [`ReadError::TooLarge`] where it unpacks to too
/// much.
pub(crate) fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, ReadError> {
    let limit = ALWAYS + GROWTH * bytes.len() as u64;
    let mut content = Cow::Borrowed(bytes);
    for _ in 0..LEVELS {
        content = match *content {
            [0x1f, 0x8b, 8, ..] => Cow::Owned(all_of(MultiGzDecoder::new(&*content), limit)?),
            [b'P', b'K', 3, 4, ..] => Cow::Owned(first_of_archive(&content, limit)?),
            _ => break,
        };
    }
    Ok(content)
}

fn all_of(stream: impl Read, limit: u64) -> Result<Vec<u8>, ReadError> {
    let mut unpacked = Vec::new();
    let read = stream.take(limit + 1).read_to_end(&mut unpacked);
    read.map_err(|error| ReadError::Compressed { reason: error.to_string() })?;
    if unpacked.len() as u64 > limit { Err(ReadError::TooLarge { limit }) } else { Ok(unpacked) }
}

/// The first file of a zip archive. Its local header is enough: a deflated stream ends by itself, a stored
/// one has its length there.
fn first_of_archive(archive: &[u8], limit: u64) -> Result<Vec<u8>, ReadError> {
    let broken =
        || ReadError::Compressed { reason: "the zip archive has no file that can be unpacked".to_owned() };
    let mut at = 0usize;
    loop {
        let head =
            archive.get(at..at + 30).filter(|head| head.starts_with(b"PK\x03\x04")).ok_or_else(broken)?;
        let u16_at = |i: usize| usize::from(u16::from_le_bytes([head[i], head[i + 1]]));
        let packed = u32::from_le_bytes([head[18], head[19], head[20], head[21]]) as usize;
        let (encrypted, method) = (head[6] & 1 != 0, u16_at(8));
        let name = archive.get(at + 30..at + 30 + u16_at(26)).ok_or_else(broken)?;
        let data = archive.get(at + 30 + u16_at(26) + u16_at(28)..).ok_or_else(broken)?;
        if name.ends_with(b"/") {
            at = archive.len() - data.len() + packed;
            continue;
        }
        return match method {
            _ if encrypted => {
                Err(ReadError::Compressed { reason: "the zip archive is encrypted".to_owned() })
            }
            8 => all_of(DeflateDecoder::new(data), limit),
            0 => data.get(..packed).map(<[u8]>::to_vec).ok_or_else(broken),
            _ => Err(broken()),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::{DeflateEncoder, GzEncoder};
    use std::io::Write;

    fn gzipped(text: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(text).expect("memory");
        encoder.finish().expect("memory")
    }

    fn zipped(name: &[u8], method: u8, packed: &[u8]) -> Vec<u8> {
        let mut archive = b"PK\x03\x04\x14\0\0\0".to_vec();
        archive.extend([method, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        archive.extend((packed.len() as u32).to_le_bytes());
        archive.extend([0; 4]);
        archive.extend((name.len() as u16).to_le_bytes());
        archive.extend([0; 2]);
        archive.extend(name);
        archive.extend(packed);
        archive
    }

    #[test]
    fn gzip_and_zip_and_both() {
        let text = b"ISO-10303-21;".repeat(100);
        assert_eq!(&*unpacked(&text).expect("plain"), &text[..]);
        assert_eq!(&*unpacked(&gzipped(&text)).expect("gzip"), &text[..]);
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&text).expect("memory");
        let deflated = encoder.finish().expect("memory");
        assert_eq!(&*unpacked(&zipped(b"part.stp", 8, &deflated)).expect("zip"), &text[..]);
        assert_eq!(&*unpacked(&zipped(b"part.stp.gz", 0, &gzipped(&text))).expect("both"), &text[..]);
    }

    #[test]
    fn bombs_are_refused() {
        let bomb = gzipped(&vec![b' '; 64 << 20]);
        assert!(matches!(unpacked(&bomb), Err(ReadError::TooLarge { .. })));
        // Within the bomb the unpacked text is bounded by what the whole input may become.
        assert!(matches!(unpacked(&gzipped(&bomb)), Err(ReadError::TooLarge { .. })));
    }

    #[test]
    fn broken_archives_are_refused() {
        let whole = gzipped(&b"ISO-10303-21;".repeat(100));
        assert!(matches!(unpacked(&whole[..whole.len() / 2]), Err(ReadError::Compressed { .. })));
        assert!(matches!(unpacked(b"PK\x03\x04"), Err(ReadError::Compressed { .. })));
        assert!(matches!(unpacked(&zipped(b"a.stp", 99, b"x")), Err(ReadError::Compressed { .. })));
    }
}
