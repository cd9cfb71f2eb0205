//! Why the GPU could not be used; each message is one sentence.

use crate::device_choice::{ADVICE, BACKENDS, DeviceChoice};
use std::fmt;

/// Why a device could not be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all, or none of the requested kind.
    #[error("no {BACKENDS} device was found{choice}; {ADVICE}")]
    NoDevice {
        /// The requested kind of adapter.
        choice: DeviceChoice,
    },
    /// The adapter lacks what the kernels need.
    #[error("the adapter {adapter} cannot be used: it lacks {what}")]
    Lacks {
        /// The adapter's name.
        adapter: String,
        /// What it lacks.
        what: Capability,
    },
    /// The driver gave no device.
    #[error("the adapter {adapter} refused a device: {reason}")]
    Refused {
        /// The adapter's name.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The device was lost; the message is the driver's.
    #[error("the device was lost: {0}")]
    Lost(String),
    /// A buffer is larger than the device can bind.
    #[error("{what} takes {bytes} bytes, more than the {limit} that {adapter} can bind at once")]
    TooLarge {
        /// What the buffer holds.
        what: Resource,
        /// Its size.
        bytes: u64,
        /// The most that the device binds.
        limit: u64,
        /// The adapter's name.
        adapter: String,
    },
    /// More points in one evaluation than 32 bits can count.
    #[error("{0} points are more than one evaluation takes (4294967295)")]
    TooManyPoints(usize),
    /// The device has no memory left.
    #[error("the device ran out of memory while {0}")]
    OutOfMemory(Task),
    /// The device reported an error.
    #[error("the device reported an error while {task}: {reason}")]
    Device {
        /// What it was doing.
        task: Task,
        /// The driver's words.
        reason: String,
    },
    /// A kernel that does not fit the set of surfaces.
    #[error("this kernel does not fit: {0}")]
    Unsuitable(Unsuitable),
    /// An index beyond the surfaces of a set.
    #[error("{0} is not a surface of the set")]
    NoSuchSurface(usize),
    /// A surface cannot be replaced in place.
    #[error(
        "surface {index} has another degree or another number of control points or knot spans than before"
    )]
    OtherShape {
        /// The surface.
        index: usize,
    },
    /// A picture was to be read before anything was drawn.
    #[error("nothing has been drawn")]
    NothingDrawn,
    /// A picture has no pixels, or more than the device can draw.
    #[error("{width} × {height} pixels are not between 1 and {limit} on {adapter}")]
    PictureSize {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// The most of either.
        limit: u32,
        /// The adapter's name.
        adapter: String,
    },
    /// A picture could not be written as PNG or read from it; the PNG library's words.
    #[error("PNG: {0}")]
    Png(String),
    /// A PNG file with pixels of another kind than RGB or RGBA of 8 bits.
    #[error("PNG: neither RGB nor RGBA of 8 bits")]
    PixelFormat,
}

/// Why an option of a picture cannot be read from text; each message is one sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The text is neither the name of a view nor six numbers.
    #[error("neither iso, top, bottom, front, back, left or right nor six numbers eye,target (x,y,z,x,y,z)")]
    View,
    /// The eye and the target are the same point.
    #[error("the eye is at the target")]
    EyeAtTarget,
    /// The text is no colour.
    #[error("neither light, dark, transparent nor #rrggbb")]
    Background,
}

/// What kernels need of an adapter. Numbers are what the adapter has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Capability {
    /// Shaders that compute.
    ComputeShaders,
    /// Small constants that are set without a buffer.
    ImmediateData,
    /// 64 bytes of such constants.
    ImmediateBytes(u32),
    /// Workgroups of 64 invocations.
    Workgroups(u32),
    /// Eight storage buffers in one stage.
    StorageBuffers(u32),
    /// Textures of 2048 × 2048 texels.
    Textures(u32),
    /// Double precision in shaders.
    DoublePrecision,
}

impl fmt::Display for Capability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ComputeShaders => write!(f, "compute shaders"),
            Self::ImmediateData => write!(f, "immediate data (push constants)"),
            Self::ImmediateBytes(has) => write!(f, "64 bytes of immediate data (it has {has})"),
            Self::Workgroups(has) => write!(f, "compute workgroups of 64 (it has {has})"),
            Self::StorageBuffers(has) => write!(f, "8 storage buffers a stage (it has {has})"),
            Self::Textures(has) => write!(f, "textures of 2048 × 2048 (it has {has})"),
            Self::DoublePrecision => write!(f, "double precision in shaders"),
        }
    }
}

/// What the device was doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Task {
    /// Shaders for pictures are compiled.
    CompilingShaders,
    /// Kernels that evaluate surfaces are compiled.
    CompilingKernels,
    /// A model's faces are copied to the device.
    UploadingModel,
    /// A set of surfaces, or one of them, is copied to the device.
    UploadingSurfaces,
    /// Buffers or textures are made.
    Allocating,
    /// The buffers of an evaluation are filled.
    PreparingEvaluation,
    /// Kernels run.
    Evaluating,
    /// A picture is drawn.
    Drawing,
    /// Results are copied back.
    ReadingResults,
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CompilingShaders => "compiling shaders",
            Self::CompilingKernels => "compiling kernels",
            Self::UploadingModel => "uploading the model",
            Self::UploadingSurfaces => "uploading surfaces",
            Self::Allocating => "allocating memory",
            Self::PreparingEvaluation => "preparing an evaluation",
            Self::Evaluating => "evaluating",
            Self::Drawing => "drawing",
            Self::ReadingResults => "reading results",
        })
    }
}

/// Why a kernel does not fit a set of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unsuitable {
    /// The kernel evaluates Bézier nets.
    #[error("the set was made without Bézier nets")]
    NoBezierNets,
    /// The kernel reads copies of knots, which the host makes.
    #[error("copies of knots are made where spans are found on the host")]
    SpansOnDevice,
    /// The kernel takes degrees up to a limit.
    #[error("the degree along u is {degree}, more than {most}")]
    Degree {
        /// The degree.
        degree: usize,
        /// The limit.
        most: usize,
    },
}

/// What a buffer on the device holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Resource {
    /// Knot spans of all surfaces.
    KnotSpans,
    /// Knots of all surfaces.
    Knots,
    /// Distinct knots of all surfaces.
    DistinctKnots,
    /// Directions of all surfaces.
    Directions,
    /// Control points of all surfaces.
    ControlPoints,
    /// Bézier points of all surfaces.
    BezierPoints,
    /// Rows of all parameters.
    Rows,
    /// Rows of all parameters, four at a time.
    PackedRows,
    /// Knots of all rows.
    KnotsOfRows,
    /// All parameters.
    Parameters,
    /// Basis functions of all rows.
    BasisFunctions,
    /// Grids of points.
    Grids,
    /// Tiles of all grids.
    Tiles,
    /// Evaluated points.
    Points,
    /// Samples of faces that must be in one buffer.
    FaceSamples,
    /// Vertices of a part.
    Vertices,
    /// Triangles of a part.
    Triangles,
    /// Lines of a part.
    Lines,
    /// Placements of all parts.
    Placements,
    /// Faces.
    Faces,
    /// Parameters of the faces' grids.
    FaceParameters,
    /// Blocks of all faces.
    Blocks,
    /// Trimming curves.
    TrimmingCurves,
    /// Bands of the trimming curves.
    TrimmingBands,
    /// Loops of all faces.
    Loops,
    /// Rectangles of trim textures.
    TrimRectangles,
    /// Triangle fans of trim textures.
    TrimFans,
}

impl Resource {
    /// Its name, with an article.
    pub fn name(self) -> &'static str {
        match self {
            Self::KnotSpans => "the knot spans",
            Self::Knots => "the knots",
            Self::DistinctKnots => "all distinct knots",
            Self::Directions => "the directions of all surfaces",
            Self::ControlPoints => "the control points of the model",
            Self::BezierPoints => "the Bézier points of the model",
            Self::Rows => "the rows of all parameters",
            Self::PackedRows => "the packed rows of all parameters",
            Self::KnotsOfRows => "the knots of all rows",
            Self::Parameters => "all parameters",
            Self::BasisFunctions => "the basis functions of all rows",
            Self::Grids => "the grids",
            Self::Tiles => "the tiles of all grids",
            Self::Points => "the points",
            Self::FaceSamples => "the samples of some faces",
            Self::Vertices => "the vertices of one part",
            Self::Triangles => "the triangles of one part",
            Self::Lines => "the lines of one part",
            Self::Placements => "the placements of all parts",
            Self::Faces => "the faces",
            Self::FaceParameters => "the parameters of all grids",
            Self::Blocks => "the blocks of all faces",
            Self::TrimmingCurves => "the trimming curves",
            Self::TrimmingBands => "the bands of the trimming curves",
            Self::Loops => "the loops of all faces",
            Self::TrimRectangles => "the rectangles of trim textures",
            Self::TrimFans => "the fans of trim textures",
        }
    }
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
