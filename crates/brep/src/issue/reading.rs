//! What can be found while a file is read: every issue with its values, its code and its sentence.

use super::Issue;
use super::values::{Millimetres, Percent, Real, SplineFault};
use super::words::count;
use chordal_nurbs::NurbsError;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt;

/// The kind of an entity as the file spells it: `PLANE`, `type 108`, `NurbsSurface`.
pub type Word = Cow<'static, str>;

/// Declares the issues. A row is the documentation, the name, the values with their documentation, the code
/// and the sentence with its arguments; values are in scope by name.
macro_rules! issues {
    ($($(#[$doc:meta])* $name:ident
        $({ $($field:ident: $type:ty = $field_doc:literal),* $(,)? })?
        => $code:literal, $format:literal $(, $arg:expr)*;
    )*) => {
        /// Found while a file is read.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        #[non_exhaustive]
        pub enum ReadIssue {$(
            $(#[$doc])*
            $name $({ $(#[doc = $field_doc] $field: $type),* })?,
        )*}

        impl ReadIssue {
            /// A stable name for programs to match.
            pub fn code(&self) -> &'static str {
                match self {
                    ReadIssue::Recorded { code, .. } => return code,
                    ReadIssue::Of { issue } => return issue.kind.code(),
                    _ => {}
                }
                match self {$(
                    ReadIssue::$name $({ $($field: _),* })? => $code,
                )*}
            }

            /// The codes of all issues, in the order of their declaration.
            pub const CODES: &[&str] = &[$($code),*];
        }

        impl fmt::Display for ReadIssue {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {$(
                    ReadIssue::$name $({ $($field),* })? => {
                        // A value may be for programs only.
                        $($(let _ = $field;)*)?
                        write!(f, $format $(, $arg)*)
                    }
                )*}
            }
        }
    };
}

issues! {
    // The file as a whole.
    /// The file is of a form of its format that is not read.
    OtherForm {
        form: &'static str = "The form.",
        instead: &'static str = "The form that is read.",
    } => "other-form", "the {form} form is not supported; write the file as {instead}";
    /// The file is of a version that is not read.
    UnknownVersion { version: u32 = "The version." } => "unknown-version",
        "version {version} is not supported";
    /// JSON that is neither a model of this program nor an export of geomdl.
    UnknownJson => "unknown-json",
        "neither the \"schema\" of a Chordal model nor the \"shape\" of a geomdl export";
    /// Further issues of the file were counted, not kept.
    NotListed { issues: usize = "How many." } => "not-listed",
        "{} not listed", count(*issues, "further issue is", "further issues are");
    /// An issue that a model document carries from the file that it was made of.
    Recorded {
        code: &'static str = "The code it had; `recorded` where that is not known any more.",
        sentence: String = "The sentence it had.",
    } => "recorded", "{sentence}";
    /// The file ends early.
    FileTruncated => "file-truncated", "the file is truncated; everything complete was read";
    /// The file ends within an entity.
    EntityTruncated => "entity-truncated", "the file is truncated inside this entity; ignored";
    /// A part of the file cannot be decoded.
    Damaged {
        what: &'static str = "The part.",
        cause: Box<ReadIssue> = "Why.",
    } => "damaged", "{what} is damaged: {cause}";
    /// A section of the file is missing.
    SectionMissing { section: &'static str = "The section." } => "section-missing",
        "the section {section} is missing";
    /// A section of the file breaks off.
    SectionTruncated {
        section: &'static str = "The section.",
        item: usize = "The item at which it breaks off, from 1.",
        cause: Box<ReadIssue> = "Why.",
    } => "section-truncated", "section {section} breaks off at item {item}: {cause}";
    /// The last items of a list are missing.
    ItemsMissing {
        what: &'static str = "The items.",
        missing: usize = "How many are missing.",
        declared: usize = "How many the file declares.",
        cause: Box<ReadIssue> = "Why.",
    } => "items-missing", "the last {missing} of {declared} {what} are missing: {cause}";
    /// A comment has no end.
    CommentUnterminated => "comment-unterminated", "comment without an end; ignored";
    /// Bytes that belong to no statement.
    StrayBytes => "stray-bytes", "bytes outside of any statement ignored";
    /// A statement that is no entity.
    NotAnEntity { word: String = "The word that begins it." } => "not-an-entity",
        "{word} is not an entity; ignored";
    /// A `#` without a number.
    NoEntityNumber => "no-entity-number", "'#' without an entity number; statement ignored";
    /// An entity number without `=`.
    NoEqualsSign => "no-equals-sign", "entity number without '='; statement ignored";
    /// An entity without attributes.
    NoAttributes => "no-attributes", "entity without attributes ignored";
    /// A closing parenthesis is missing.
    ParenthesisMissing => "parenthesis-missing", "missing ')' in this entity";
    /// A semicolon is missing.
    SemicolonMissing => "semicolon-missing", "missing ';' after this entity";
    /// An entity number is used more than once.
    DuplicateNumber { line: u32 = "The line of the first use." } => "duplicate-number",
        "entity number already used at line {line}; references mean the nearest entity before them";
    /// The file refers in circles, or uses shapes within shapes without end.
    TooManyReferences => "too-many-references", "too many references lead here; the file may refer to itself";
    /// A list is longer than this program reads.
    TooMany {
        what: &'static str = "The items.",
        limit: usize = "How many are read.",
    } => "too-many", "more than {limit} {what}; the rest is ignored";
    /// Statements of a kind that is not read.
    StatementsIgnored {
        keyword: String = "The keyword.",
        statements: usize = "How many.",
    } => "statements-ignored",
        "{} ignored", count(*statements, &format!("{keyword} statement"), &format!("{keyword} statements"));
    /// A statement whose words make no sense.
    BadStatement { keyword: String = "The keyword." } => "bad-statement",
        "{keyword} statement without usable values";
    /// A statement outside of the element to which it belongs.
    MisplacedStatement { keyword: String = "The keyword." } => "misplaced-statement",
        "{keyword} statement outside of any curve or surface ignored";
    /// Objects of kinds that are not read.
    ObjectsIgnored {
        objects: usize = "How many.",
        what: &'static str = "What they are, in the plural.",
    } => "objects-ignored", "{} ignored: {what} are not supported", count(*objects, "object", "objects");
    /// A reference to another file, which is not read.
    OtherFile { name: String = "The name of the file; empty where it is not known." } => "other-file",
        "refers to {}, which is not read",
        if name.is_empty() { "another file".to_owned() } else { format!("the file {name:?}") };
    /// Commands and scripts of a file are never run.
    ProgramIgnored { what: &'static str = "What holds them." } => "program-ignored",
        "{what} ignored: programs in a file are never run";
    /// The count of a string is not its length; the delimiters are used.
    StringCount {
        field: usize = "The number of the parameter, from 1.",
        owner: &'static str = "Whose parameter it is.",
        counted: usize = "The count in the file.",
        length: usize = "The characters up to the delimiter.",
    } => "string-count",
        "parameter {field} {owner} counts {counted} characters and has {length}; read up to its delimiter";
    /// The parameters of a global section are not of the kinds that they must be.
    GlobalSectionShifted => "global-section-shifted",
        "the parameters of the global section are of wrong kinds; unit and accuracy may be wrong";
    /// Text of the file is not valid.
    TextBroken { reason: String = "What the decoder reports." } => "text-broken", "{reason}";

    // Entities and their attributes.
    /// An issue in a node of a scene.
    InNode {
        node: String = "The kind of the node.",
        cause: Box<ReadIssue> = "The issue.",
    } => "in-node", "{node}: {cause}";
    /// An issue of a trim loop of a scene.
    Trim {
        node: String = "The kind of the trim's node.",
        line: u32 = "Its line.",
        cause: Box<ReadIssue> = "The issue.",
    } => "trim", "trim {node} (line {line}): {cause}";
    /// An issue at a place of a binary file; everything behind it is lost.
    AtByte {
        byte: u64 = "The position in the file, from 0.",
        cause: Box<ReadIssue> = "The issue.",
    } => "at-byte", "byte {byte}: {cause}; the rest of the file is ignored";
    /// A node, prototype or block is used inside itself.
    UsedInItself { node: String = "Its kind or name." } => "used-in-itself",
        "{node} is used inside itself; ignored there";
    /// A node of a kind that has no effect on shapes or is not read.
    NotRead => "not-read", "not supported; ignored";
    /// The data of an object are shorter than its stated length.
    EndsEarly { bytes: usize = "The bytes that are missing." } => "ends-early",
        "the data end {bytes} bytes early";
    /// A list is longer than the file.
    ListTooLong { items: u64 = "The number of items that the file states." } => "list-too-long",
        "a list of {items} items does not fit into the file";
    /// Values that must increase do not.
    NotIncreasing { what: &'static str = "The values." } => "not-increasing", "the {what} do not increase";
    /// An entity is of another kind than its use needs.
    UnknownKind {
        found: Word = "What it is.",
        expected: &'static str = "What belongs there: `a surface`.",
    } => "unknown-kind", "{found} is not {expected}";
    /// A kind of entity is not read.
    Unsupported { what: Word = "The kind." } => "unsupported", "{what} is not supported; ignored";
    /// A version of an entity is not read.
    UnsupportedVersion {
        what: &'static str = "The kind.",
        major: i32 = "The major version.",
        minor: i32 = "The minor version.",
    } => "unsupported-version", "version {major}.{minor} of {what} is not supported";
    /// An entity is defined by itself, or by too many others one within the other.
    Recursive {
        keyword: Word = "The kind of the entity.",
        levels: u32 = "The levels that are read.",
    } => "recursive", "{keyword} is recursive or nested more than {levels} levels";
    /// An attribute is missing.
    MissingAttribute {
        keyword: Word = "The kind of the entity.",
        number: u32 = "The number of the attribute, from 1.",
        expected: &'static str = "What belongs there, such as `a number`.",
    } => "missing-attribute", "attribute {number} of {keyword} is missing, expected {expected}";
    /// An attribute is of another kind than it must be.
    WrongAttribute {
        keyword: Word = "The kind of the entity.",
        number: u32 = "The number of the attribute, from 1.",
        expected: &'static str = "What belongs there, such as `a number`.",
        found: String = "How the attribute begins.",
    } => "wrong-attribute", "attribute {number} of {keyword} is {found:?}, expected {expected}";
    /// Something else than the format needs at this place.
    Expected {
        expected: &'static str = "What belongs there.",
        found: String = "How what is there begins; empty at the end of the file.",
    } => "expected",
        "{}",
        if found.is_empty() {
            format!("{expected} is missing")
        } else {
            format!("{found:?} in place of {expected}")
        };
    /// A reference to something that does not exist.
    NotFound {
        what: &'static str = "What is referred to.",
        number: i64 = "Its number in the file.",
    } => "not-found", "{what} {number} does not exist";
    /// A reference by name to something that does not exist.
    NameNotFound {
        what: &'static str = "What is referred to.",
        name: String = "Its name.",
    } => "name-not-found", "{what} {name} is not defined";
    /// Something that belongs to an entity is missing.
    Missing { what: &'static str = "What is missing." } => "missing", "no {what}";
    /// An issue of a part of an entity.
    Within {
        what: &'static str = "The part.",
        number: usize = "Its number.",
        cause: Box<ReadIssue> = "What is wrong with it.",
    } => "within", "{what} {number}: {cause}";
    /// An issue of another entity, on which this one depends; it has the code of that issue.
    Of { issue: Box<Issue> = "The issue." } => "of", "{issue}";
    /// Something is ignored.
    Ignored {
        what: Word = "What is ignored.",
        cause: Box<ReadIssue> = "Why.",
    } => "ignored", "{what} ignored: {cause}";

    // Numbers, directions, placements.
    /// A value is not possible.
    BadValue {
        what: &'static str = "What it is.",
        value: Real = "The value.",
    } => "bad-value", "{what} of {value} is not valid";
    /// A negative size is taken positive.
    NegativeValue {
        what: &'static str = "What it is.",
        value: Real = "The value.",
    } => "negative-value", "negative {what} {value} taken as positive";
    /// A value or a place is not finite.
    NotFinite { what: &'static str = "What it is." } => "not-finite", "the {what} is not finite";
    /// A list has another length than the definition needs.
    Count {
        what: &'static str = "What is listed.",
        found: usize = "How many there are.",
        expected: usize = "How many are needed.",
    } => "count", "number of {what} is {found}, expected {expected}";
    /// A list is too short.
    TooFew {
        what: &'static str = "What is listed.",
        found: usize = "How many there are.",
        least: usize = "How many are needed.",
    } => "too-few", "number of {what} is {found}, at least {least} needed";
    /// A parameter range is empty, reversed or not finite.
    EmptyRange {
        start: Real = "Its start.",
        end: Real = "Its end.",
    } => "empty-range", "parameter range {start}..{end} is empty";
    /// A parameter range reaches beyond the domain of its curve or surface.
    RangeCut {
        start: Real = "The start of the range.",
        end: Real = "The end of the range.",
    } => "range-cut", "parameter range {start}..{end} reaches beyond the domain; cut off there";
    /// A parameter range lies outside of the domain of its surface.
    OutsideDomain => "outside-domain", "the parameter range lies outside of the domain of the surface";
    /// A direction is a zero vector.
    ZeroVector { what: &'static str = "Which direction." } => "zero-vector", "the {what} is a zero vector";
    /// A direction is a zero vector.
    ZeroVectorReplaced { what: &'static str = "Which direction." } => "zero-vector-replaced",
        "the {what} is a zero vector; replaced by the default";
    /// Two axes of a placement are parallel.
    ParallelAxes => "parallel-axes",
        "the reference direction is parallel to the axis; replaced by the default";
    /// A direction stands in place of a vector.
    DirectionForVector => "direction-for-vector", "DIRECTION in place of VECTOR; length 1 assumed";
    /// A vector has the magnitude 0.
    ZeroLengthVector => "zero-length-vector", "VECTOR of length 0; length 1 assumed";
    /// A placement flattens space.
    FlatPlacement => "flat-placement", "the placement flattens space";
    /// The axes of a placement are not unit vectors at right angles.
    AxesNotOrthogonal => "axes-not-orthogonal", "the axes are not unit vectors at right angles";
    /// A component of an assembly has no usable placement.
    ComponentAtOrigin {
        cause: Option<Box<Issue>> = "Why; `None` where the file gives no placement.",
    } => "component-at-origin",
        "component placed at the origin: {}",
        cause.as_ref().map_or("the file gives no placement".to_owned(), |cause| cause.to_string());
    /// A usage of a component lacks a reference.
    NothingPlaced => "nothing-placed", "a reference is missing; nothing is placed";
    /// The two items of a transformation belong to the other representation each.
    PlacementExchanged => "placement-exchanged", "the two items of the transformation are exchanged";
    /// A context names no length unit.
    UnitMissing => "unit-missing", "no length unit given; millimetres assumed";
    /// A unit is not known.
    UnitUnknown {
        name: String = "Its name.",
        assumed: &'static str = "The unit that is assumed; empty where it is ignored.",
    } => "unit-unknown",
        "unit {name:?} is unknown; {}",
        if assumed.is_empty() { "ignored".to_owned() } else { format!("{assumed} assumed") };
    /// The conversion factor of a unit cannot be read.
    UnitByName { name: String = "Its name." } => "unit-by-name",
        "the conversion factor of unit {name:?} cannot be read; its name is used";
    /// The scale of the model is not possible.
    ScaleIgnored { scale: Real = "The scale." } => "scale-ignored", "model scale {scale} ignored";

    // Curves and surfaces.
    /// Degree, knots, weights and control points make no spline.
    Spline { error: SplineFault = "What is wrong with them." } => "spline", "{error}";
    /// The knot multiplicities do not add up.
    KnotSum {
        sum: i64 = "Their sum.",
        expected: usize = "The number of knots.",
    } => "knot-sum", "the knot multiplicities sum to {sum}, expected {expected}";
    /// The rows of a control net differ in length.
    RowsDiffer => "rows-differ", "the rows of the control net differ in length";
    /// The multiplicity of an end knot is over the degree + 1.
    SurplusKnots => "surplus-knots",
        "the multiplicity of an end knot exceeds degree + 1; control points without effect removed";
    /// The knots do not fit the control points.
    KnotsReplaced {
        which: &'static str = "Which knots.",
        found: usize = "How many there are.",
        expected: usize = "How many are needed.",
    } => "knots-replaced",
        "{found} {which} knots where {expected} in increasing order are needed; uniform knots used";
    /// The weights do not fit the control points.
    WeightsIgnored {
        found: usize = "How many there are.",
        expected: usize = "The number of control points.",
    } => "weights-ignored", "{found} weights for {expected} control points ignored";
    /// A surface without parameters in one direction.
    OneSegment { direction: &'static str = "The direction." } => "one-segment",
        "no parameters along {direction}: read as one segment";
    /// A section that turns with its trajectory has no exact spline form.
    SweepNotExact {
        trajectory: &'static str = "What the trajectory is: `closed`, `bent`.",
    } => "sweep-not-exact",
        "the trajectory is {trajectory}; a section that turns with it has no exact spline form";
    /// A weight is zero.
    ZeroWeight => "zero-weight", "weight 0 replaced by a weight too small to matter";
    /// A bounded curve is needed.
    CurveUnbounded => "curve-unbounded", "unbounded curve in place of a bounded one";
    /// A surface that is a shape by itself is infinite.
    SurfaceUnbounded => "surface-unbounded", "the surface is unbounded and has no boundary";
    /// An unbounded surface that belongs to no face.
    SurfaceIgnored => "surface-ignored", "unbounded surface outside of any face ignored";
    /// The trims of a curve or surface leave nothing.
    TrimmedToNothing => "trimmed-to-nothing", "the trims leave nothing";
    /// The trims of a curve run against its sense.
    TrimSense => "trim-sense", "the trims run against the sense of the curve; sense corrected";
    /// A trim is neither a point nor a parameter.
    TrimUnknown => "trim-unknown", "a trim is neither a point nor a parameter";
    /// The half angle of a cone is zero.
    ConeIsCylinder => "cone-is-cylinder", "half angle 0: cone read as a cylinder";
    /// The curve in space cannot be used.
    CurveFromSurface { cause: Box<ReadIssue> = "Why." } => "curve-from-surface",
        "the curve in space cannot be used ({cause}); the curve on the surface is used";
    /// One of several curves of a boundary cannot be used; another one is.
    CurveIgnored { cause: Box<ReadIssue> = "Why." } => "curve-ignored",
        "one of the curves of the boundary ignored: {cause}";
    /// A curve in parameter space cannot be used.
    PcurveRecomputed { cause: Box<ReadIssue> = "Why." } => "pcurve-recomputed",
        "trim curve ignored and recomputed from the edge: {cause}";
    /// The corners of a polygon are not on the plane of its face.
    PlaneContradicted { off: Percent = "Their largest distance, as a share of the face's extent." } =>
        "plane-contradicted", "the corners are off the plane of the face by {off} of its extent; their own is used";
    /// An arc of an indexed polyline.
    ArcAsChords => "arc-as-chords", "arc of an indexed polyline replaced by its chords";
    /// A ruled surface is ruled by arc length.
    RuledByLength => "ruled-by-length", "surface ruled by arc length read as ruled by parameter";
    /// A shape has no exact form after its transformation.
    NotTransformable { what: &'static str = "The shape." } => "not-transformable",
        "the transformation of the {what} cannot be applied exactly";
    /// A curve has no length.
    NoLength { what: &'static str = "The curve." } => "no-length", "the {what} has no length";
    /// A boundary has no extent.
    NoExtent => "no-extent", "the boundary has no extent";
    /// The coefficients are those of no bounded conic.
    NotAConic => "not-a-conic", "the coefficients describe no conic with two ends";
    /// Normals that do not fit the points.
    NormalsIgnored {
        found: usize = "How many there are.",
        expected: usize = "The number of points.",
    } => "normals-ignored", "{found} normals for {expected} points ignored";
    /// A tessellated item without triangles.
    NoTriangles => "no-triangles", "no triangles";
    /// Polygons with corners that do not exist.
    PolygonsLost { polygons: usize = "How many." } => "polygons-lost",
        "{} with missing corners ignored", count(*polygons, "polygon", "polygons");
    /// An array of too many copies.
    ArrayTooLarge {
        copies: u64 = "How many.",
        limit: u64 = "How many are read.",
    } => "array-too-large", "array of {copies} copies ignored (limit {limit})";
    /// The shape has no size.
    Empty => "empty-shape", "the shape has no size; ignored";
    /// Only the first level of detail is read.
    FirstLevelOnly => "first-level-only", "only the first level of detail is read";
    /// A switch shows none of its children.
    NoChoice => "no-choice", "no child of the switch is shown; all are ignored";

    // Edges, loops and faces.
    /// The sense of an edge contradicts its vertices.
    EdgeSense => "edge-sense", "the sense of the edge contradicts its vertices; the vertices are used";
    /// An edge without extent.
    EdgeIsPoint {
        cause: Option<Box<Issue>> = "Why its curve is not used, where it has one.",
    } => "edge-is-point",
        "edge read as a single point{}", cause.as_ref().map_or(String::new(), |cause| format!(": {cause}"));
    /// The curve of an edge cannot be used.
    EdgeStraightened { cause: Box<Issue> = "Why." } => "edge-straightened",
        "edge replaced by a straight line: {cause}";
    /// The curve of an edge has no length between its vertices.
    NoCurveBetween => "no-curve-between", "the curve has no length between its vertices";
    /// A vertex lies far from the curve of its edge.
    VertexOffCurve {
        gap: Millimetres = "The distance.",
        length: Millimetres = "The length of the edge.",
    } => "vertex-off-curve", "vertex lies {gap} from the curve of its edge, which is {length} long";
    /// The loops use the part of a closed curve that the edge does not name.
    VerticesExchanged => "vertices-exchanged",
        "the loops use the other part of the edge's closed curve; its vertices are exchanged";
    /// The edges of a loop are not listed in the order in which they follow each other.
    EdgesSorted => "edges-sorted", "the edges of the loop are not in order; sorted";
    /// An edge of a loop runs against the others.
    EdgeTurned => "edge-turned", "an edge runs against the other edges of the loop; reversed";
    /// Consecutive edges of a loop do not meet.
    GapClosed { gap: Millimetres = "The widest gap." } => "gap-closed",
        "gap of {gap} between consecutive edges closed with a straight edge";
    /// Consecutive curves of a boundary do not meet.
    GapOnSurface { gap: Millimetres = "The widest gap." } => "gap-on-surface",
        "gap of {gap} between consecutive curves closed along the surface";
    /// Edges of a loop cannot be read.
    EdgesLost {
        lost: usize = "How many.",
        edges: usize = "How many the loop has.",
        cause: Box<Issue> = "What is wrong with the first.",
    } => "edges-lost", "{lost} of {edges} edges could not be read; loop closed with straight edges ({cause})";
    /// A loop without edges.
    NoEdges => "no-edges", "loop without edges";
    /// Consecutive edges of a loop do not share a vertex.
    LoopBroken { coedge: usize = "The coedge after which the loop is broken, from 0." } => "loop-broken",
        "the loop is broken after coedge {coedge}";
    /// A wire consists of several closed loops.
    WireIsLoops { loops: usize = "How many." } => "wire-is-loops",
        "the wire consists of {loops} closed loops";
    /// A face without a surface.
    NoSurface => "no-surface", "the face has no surface";
    /// A face of an unbounded surface without a boundary.
    NoBoundary => "no-boundary", "the face has neither a boundary nor a bounded surface";
    /// A face without area.
    NoArea => "no-area", "the face has no area";
    /// An open boundary runs along the border of its surface.
    BoundaryIsBorder => "boundary-is-border",
        "open boundary runs along the border of the surface; the border is used";
    /// An inner boundary has no extent.
    InnerBoundaryIgnored => "inner-boundary-ignored", "inner boundary without extent ignored";
    /// Boundaries with curves in space only and others with curves in parameter space only.
    MixedCurves => "mixed-curves",
        "the boundary has no curve in space, and other boundaries have none in parameter space";
    /// A shell or face of a body is ignored.
    ShellIgnored {
        what: &'static str = "What is ignored.",
        cause: Box<ReadIssue> = "Why.",
    } => "shell-ignored", "{what} ignored: {cause}";
    /// A piece of a trim loop has no finite extent.
    TrimPieceNotFinite {
        trim: usize = "The number of the loop on its surface, from 1.",
    } => "trim-piece-not-finite",
        "trim loop {trim} has a piece without finite extent";
    /// A trim loop is open; straight lines close it.
    TrimLoopOpen {
        trim: usize = "The number of the loop on its surface, from 1.",
        gap: Percent = "The widest gap as a share of the surface's parameter range.",
    } => "trim-loop-open",
        "trim loop {trim} is open by up to {gap} of the parameter range; closed with straight lines";
    /// A trim loop leaves the domain of its surface where it cannot be cut off.
    TrimLoopBeyond {
        trim: usize = "The number of the loop on its surface, from 1.",
        by: Percent = "By how much, as a share of the parameter range.",
    } => "trim-loop-beyond", "trim loop {trim} leaves the surface by {by} of its parameter range";
    /// A trim loop that ends at the border of its surface.
    TrimClosedAlongBorder => "trim-closed-along-border",
        "open trim loop closed along the border of its surface, the shorter way";
    /// Trim loops cross or touch; there is a vertex at each place where they do.
    TrimsUntangled {
        loops: usize = "The number of trim loops.",
        places: usize = "The number of places.",
    } => "trims-untangled",
        "{} at {}; a vertex is set at each",
        match *loops {
            1 => "the trim loop crosses or touches itself",
            _ => "trim loops cross or touch each other",
        },
        count(*places, "place", "places");
    /// The trim loops remove all of the surface.
    NothingTrimmed => "nothing-trimmed", "the trim loops remove the whole surface";
    /// The trim loops lie outside of the domain of the surface.
    TrimsBeyond => "trims-beyond", "the trim loops lie beyond the surface";
    /// A trim loop leaves the surface and cannot be cut at its border.
    TrimNotCut => "trim-not-cut", "a trim loop cannot be cut at the border of the surface";
    /// Trim loops cross each other outside of the surface.
    TrimsCrossBeyond => "trims-cross-beyond",
        "the trim loops cross each other beyond the border of the surface";

    // Assemblies and products.
    /// An assembly unfolds to too many nodes.
    AssemblyTooLarge { nodes: usize = "How many are read." } => "assembly-too-large",
        "the assembly has more than {nodes} nodes; the rest is ignored";
    /// An assembly contains itself.
    AssemblyRecursive => "assembly-recursive", "the assembly contains itself; cut off here";
    /// An assembly is nested too deeply.
    AssemblyTooDeep { levels: u32 = "The levels that are read." } => "assembly-too-deep",
        "the assembly is nested more than {levels} levels; cut off here";
    /// Every product is a component of another one.
    NoTopProduct => "no-top-product",
        "every product is a component of another; this one is used as the whole";
    /// A shape that belongs to no product.
    ShapeWithoutProduct => "shape-without-product",
        "the shape belongs to no product; read as a part of its own";
    /// A file without product structure.
    NoProducts => "no-products", "the file has no product structure; its bodies are read directly";
}

impl ReadIssue {
    /// The issue as the reason of another one.
    pub fn boxed(self) -> Box<Self> {
        Box::new(self)
    }

    /// The issue as one of a part of an entity.
    pub fn within(self, what: &'static str, number: usize) -> Self {
        ReadIssue::Within { what, number, cause: Box::new(self) }
    }
}

impl From<NurbsError> for ReadIssue {
    fn from(error: NurbsError) -> Self {
        ReadIssue::Spline { error: SplineFault(error) }
    }
}
