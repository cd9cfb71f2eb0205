//! The readers, and how the format is recognised from the content of a file.

use crate::{Format, ReadError, ReadOptions};
use chordal_brep::Model;

impl Format {
    /// The format of a file's content; `None` where no reader of this build knows it. Compressed content is
    /// unpacked by [`crate::read_bytes`] before.
    ///
    /// ```
    /// use chordal_read::Format;
    /// assert_eq!(Format::of(b"{\"schema\": \"chordal-model/1\"}"), Some(Format::Json));
    /// assert_eq!(Format::of(b"no CAD file"), None);
    /// ```
    pub fn of(bytes: &[u8]) -> Option<Format> {
        READERS.iter().find(|reader| (reader.looks_like)(bytes)).map(|reader| reader.format)
    }

    /// Reads content that is of this format.
    pub(crate) fn read(self, bytes: &[u8], options: &ReadOptions) -> Result<Model, ReadError> {
        let reader = READERS.iter().find(|reader| reader.format == self);
        let reader = reader.ok_or(ReadError::NotCompiled { format: self })?;
        (reader.read)(bytes, options)
    }
}

/// How a format is recognised by its content, and how it is read.
struct Reader {
    format: Format,
    looks_like: fn(&[u8]) -> bool,
    read: fn(&[u8], &ReadOptions) -> Result<Model, ReadError>,
}

/// In the order in which they are tried: the surest signs first.
const READERS: &[Reader] = &[
    #[cfg(feature = "rhino")]
    Reader {
        format: Format::Rhino,
        looks_like: crate::rhino::looks_like_3dm,
        read: |bytes, options| crate::rhino::read(bytes, &options.name),
    },
    #[cfg(feature = "step")]
    Reader {
        format: Format::Step,
        looks_like: crate::step::looks_like_step,
        read: |bytes, options| crate::step::read(bytes, &options.name),
    },
    Reader {
        format: Format::Json,
        looks_like: crate::json::looks_like_json,
        read: |bytes, options| crate::json::read(bytes, &options.name),
    },
    #[cfg(feature = "brep")]
    Reader {
        format: Format::Brep,
        looks_like: crate::brep_text::looks_like_brep,
        read: |bytes, options| crate::brep_text::read(bytes, &options.name),
    },
    #[cfg(feature = "iges")]
    Reader {
        format: Format::Iges,
        looks_like: crate::iges::looks_like_iges,
        read: |bytes, options| crate::iges::read(bytes, &options.name),
    },
    #[cfg(feature = "scene")]
    Reader {
        format: Format::Inventor,
        looks_like: crate::inventor::looks_like_inventor,
        read: |bytes, options| crate::inventor::read(bytes, &options.name, options),
    },
    #[cfg(feature = "scene")]
    Reader {
        format: Format::X3d,
        looks_like: crate::x3d::looks_like_x3d,
        read: |bytes, options| crate::x3d::read(bytes, &options.name, options),
    },
    #[cfg(feature = "obj")]
    Reader {
        format: Format::Obj,
        looks_like: crate::obj::looks_like_obj,
        read: |bytes, options| crate::obj::read(bytes, &options.name),
    },
];
