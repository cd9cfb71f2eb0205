//! Bytes and chunks of an archive.
//!
//! A chunk is a type code, a length (32 bits, from version 50 on 64) and a body; short ones hold a number in
//! place of the length. Bodies that end in a checksum have a bit for it in the type code.

use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DVec3, Range};

/// What is wrong with a piece of the archive.
pub(super) type Res<T> = Result<T, ReadIssue>;

/// The code of chunks without a name of their own.
pub(super) const ANONYMOUS: u32 = 0x4000_8000;

const SHORT: u32 = 0x8000_0000;
const HAS_CHECKSUM: u32 = 0x0000_8000;

/// A stretch of the file that is read from its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    rest: &'a [u8],
    /// The archive's version: 1, 2, 3, 4, then 50, 60, 70, 80.
    pub version: u32,
}

/// A chunk that was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk<'a> {
    pub code: u32,
    /// The number of a short chunk.
    pub value: i64,
    pub body: Bytes<'a>,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(bytes: &'a [u8], version: u32) -> Self {
        Self { rest: bytes, version }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn take(&mut self, count: usize) -> Res<&'a [u8]> {
        if count > self.rest.len() {
            return Err(ReadIssue::EndsEarly { bytes: count - self.rest.len() });
        }
        let (head, rest) = self.rest.split_at(count);
        self.rest = rest;
        Ok(head)
    }

    fn array<const N: usize>(&mut self) -> Res<[u8; N]> {
        Ok(self.take(N)?.try_into().expect("as many as were taken"))
    }

    pub(super) fn u8(&mut self) -> Res<u8> {
        Ok(self.take(1)?[0])
    }
    pub(super) fn u16(&mut self) -> Res<u16> {
        Ok(u16::from_le_bytes(self.array()?))
    }
    pub(super) fn u32(&mut self) -> Res<u32> {
        Ok(u32::from_le_bytes(self.array()?))
    }
    pub(super) fn i32(&mut self) -> Res<i32> {
        Ok(i32::from_le_bytes(self.array()?))
    }
    pub(super) fn f32(&mut self) -> Res<f32> {
        Ok(f32::from_le_bytes(self.array()?))
    }
    pub(super) fn f64(&mut self) -> Res<f64> {
        Ok(f64::from_le_bytes(self.array()?))
    }
    pub(super) fn uuid(&mut self) -> Res<[u8; 16]> {
        self.array()
    }
    pub(super) fn point(&mut self) -> Res<DVec3> {
        Ok(DVec3::new(self.f64()?, self.f64()?, self.f64()?))
    }

    /// Two numbers, the first less than the second.
    pub(super) fn range(&mut self) -> Res<Range> {
        let range = Range::new(self.f64()?, self.f64()?);
        if range.is_finite() && range.start < range.end {
            Ok(range)
        } else {
            Err(ReadIssue::EmptyRange { start: Real(range.start), end: Real(range.end) })
        }
    }

    /// A number of items of `size` bytes each that can still follow.
    pub(super) fn count(&mut self, size: usize) -> Res<usize> {
        let count = self.i32()?;
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= self.rest.len() / size)
            .ok_or(ReadIssue::ListTooLong { items: count as u64 })
    }

    pub(super) fn f64s(&mut self, count: usize) -> Res<Vec<f64>> {
        let size = count.checked_mul(8).ok_or(ReadIssue::ListTooLong { items: count as u64 })?;
        let (numbers, _) = self.take(size)?.as_chunks::<8>();
        Ok(numbers.iter().map(|number| f64::from_le_bytes(*number)).collect())
    }

    /// A list of integers with its count.
    pub(super) fn i32s(&mut self) -> Res<Vec<i32>> {
        let count = self.count(4)?;
        (0..count).map(|_| self.i32()).collect()
    }

    /// A version packed into a byte: major and minor.
    pub(super) fn version(&mut self) -> Res<(u8, u8)> {
        let byte = self.u8()?;
        Ok((byte >> 4, byte & 15))
    }

    /// UTF-16 text with its count, the final zero included.
    pub(super) fn text(&mut self) -> Res<String> {
        let count = self.count(2)?;
        let units: Vec<u16> = (0..count).map(|_| self.u16()).collect::<Res<_>>()?;
        let end = units.iter().position(|&unit| unit == 0).unwrap_or(units.len());
        Ok(String::from_utf16_lossy(&units[..end]))
    }

    /// The next chunk, or what is wrong with it.
    pub(super) fn chunk(&mut self) -> Res<Chunk<'a>> {
        let code = self.u32()?;
        let value =
            if self.version >= 50 { i64::from_le_bytes(self.array()?) } else { i64::from(self.i32()?) };
        if code & SHORT != 0 {
            return Ok(Chunk { code, value, body: Bytes::new(&[], self.version) });
        }
        let length = usize::try_from(value)
            .map_err(|_| ReadIssue::BadValue { what: "chunk length", value: Real(value as f64) })?;
        let body = self.take(length)?;
        // Version 1 has short checksums, and chunks that reach over the one of what they are in.
        let checksum = if code & HAS_CHECKSUM != 0 && self.version > 1 { 4 } else { 0 };
        let body = &body[..body.len().saturating_sub(checksum)];
        Ok(Chunk { code, value: 0, body: Bytes::new(body, self.version) })
    }

    /// The next chunk, which must have this code.
    pub(super) fn chunk_of(&mut self, code: u32) -> Res<Bytes<'a>> {
        let chunk = self.chunk()?;
        if chunk.code == code {
            Ok(chunk.body)
        } else {
            Err(ReadIssue::UnknownKind {
                found: format!("chunk of type {:#010x}", chunk.code).into(),
                expected: "the chunk that belongs here",
            })
        }
    }

    /// Where this stands in `whole`, of which it is a part.
    pub(super) fn place_in(&self, whole: &[u8]) -> u64 {
        (self.rest.as_ptr() as usize).saturating_sub(whole.as_ptr() as usize) as u64
    }
}
