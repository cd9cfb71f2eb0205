//! Types of the fields of Inventor's own nodes: binary files do not say them.

/// How a field's value is laid out in a binary file: words of four bytes, the first one highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// This many 32-bit floating point numbers.
    Floats(usize),
    /// One whole number, or a truth value.
    Whole,
    /// 64 bits.
    Double,
    /// A text, or the name of an enumerator.
    Text,
    /// Names of flags up to an empty one.
    Flags,
    Node,
    Image,
    /// Nothing.
    Trigger,
}

/// A layout, and whether a count and that many values follow.
pub(super) type FieldType = (Layout, bool);

use Layout::{Double, Flags, Floats, Image, Node, Text, Trigger, Whole};

/// The type of a field that a file spells out for nodes that are not Inventor's own ("SFFloat", "MFNode" …).
pub(super) fn named(name: &str) -> Option<FieldType> {
    let many = match name.get(..2)? {
        "SF" => false,
        "MF" => true,
        _ => return None,
    };
    let layout = match &name[2..] {
        "Float" => Floats(1),
        "Vec2f" => Floats(2),
        "Vec3f" | "Color" => Floats(3),
        "Vec4f" | "Rotation" | "Plane" => Floats(4),
        "Matrix" => Floats(16),
        "Bool" | "Long" | "ULong" | "Int32" | "UInt32" | "Short" | "UShort" => Whole,
        "Time" | "Double" => Double,
        "String" | "Name" | "Enum" => Text,
        "BitMask" => Flags,
        "Node" | "Engine" | "Path" => Node,
        "Image" => Image,
        "Trigger" => Trigger,
        _ => return None,
    };
    Some((layout, many))
}

/// The type of a field of one of Inventor's own nodes; `None` where it has none of this name.
pub(super) fn of(kind: &str, field: &str) -> Option<FieldType> {
    let one = |layout| Some((layout, false));
    let many = |layout| Some((layout, true));
    match (kind, field) {
        ("Coordinate4", "point") => return many(Floats(4)),
        ("ProfileCoordinate2" | "TextureCoordinate2", "point") => return many(Floats(2)),
        ("Sphere" | "Cylinder", "radius") => return one(Floats(1)),
        ("Complexity", "value") => return one(Floats(1)),
        ("Info" | "Label", "string" | "label") => return one(Text),
        ("Texture2" | "Texture3", "filename") => return one(Text),
        ("FaceSet" | "LineSet" | "TriangleStripSet", "startIndex") => return one(Whole),
        ("Cylinder" | "Cone", "parts") => return one(Flags),
        (
            "LightModel" | "Environment" | "DrawStyle" | "Complexity",
            "model" | "fogType" | "style" | "type",
        ) => {
            return one(Text);
        }
        ("Switch" | "Blinker", "whichChild") => return one(Whole),
        ("ClipPlane", "plane") => return one(Floats(4)),
        ("Font", "name") | ("WWWInline" | "WWWAnchor" | "File", "name") => return one(Text),
        ("Text2" | "Text3" | "AsciiText", "parts") => return one(Flags),
        ("RotationXYZ", "axis") => return one(Text),
        ("ResetTransform", "whatToReset") => return one(Flags),
        ("Texture2Transform", "rotation") => return one(Floats(1)),
        ("Texture2Transform", "translation" | "scaleFactor" | "center") => return one(Floats(2)),
        ("Environment", "ambientColor") => return one(Floats(3)),
        _ => {}
    }
    Some(match field {
        "point" | "vector" | "vertex" | "normal" => (Floats(3), true),
        "ambientColor" | "diffuseColor" | "specularColor" | "emissiveColor" | "rgb" => (Floats(3), true),
        "shininess" | "transparency" | "uKnotVector" | "vKnotVector" | "sKnotVector" | "tKnotVector"
        | "knotVector" | "range" | "screenArea" => (Floats(1), true),
        "texCoord" => (Floats(2), true),
        "matrix" => (Floats(16), kind == "MultipleCopy"),
        "orderedRGBA" | "numVertices" | "index" | "coordIndex" | "materialIndex" | "normalIndex"
        | "textureCoordIndex" | "markerIndex" => (Whole, true),
        "string" => (Text, true),
        "translation" | "translation0" | "translation1" | "directionS" | "directionT" | "scaleFactor"
        | "center" | "separation1" | "separation2" | "separation3" | "location" | "direction" | "color"
        | "ambientColorF" | "fogColor" | "position" | "bboxCenter" | "bboxSize" | "blendColor"
        | "attenuation" => (Floats(3), false),
        "rotation" | "rotation0" | "rotation1" | "scaleOrientation" | "orientation" => (Floats(4), false),
        "angle" | "creaseAngle" | "width" | "height" | "depth" | "bottomRadius" | "size" | "spacing"
        | "pointSize" | "lineWidth" | "intensity" | "dropOffRate" | "cutOffAngle" | "nearDistance"
        | "farDistance" | "aspectRatio" | "focalDistance" | "heightAngle" | "textureQuality"
        | "ambientIntensity" | "fogVisibility" | "speed" => (Floats(1), false),
        "numUControlPoints" | "numVControlPoints" | "numSControlPoints" | "numTControlPoints"
        | "numControlPoints" | "numElements1" | "numElements2" | "numElements3" | "startIndex"
        | "numPoints" | "verticesPerRow" | "verticesPerColumn" | "linePattern" | "whichChild" | "on"
        | "isActive" => (Whole, false),
        "linkage" | "origin" | "value" | "vertexOrdering" | "shapeType" | "faceType" | "units"
        | "justification" | "renderCaching" | "boundingBoxCaching" | "renderCulling" | "pickCulling"
        | "type" | "style" | "model" | "family" | "normalBinding" | "materialBinding" | "wrapS" | "wrapT"
        | "filename" | "name" | "description" | "map" | "viewportMapping" | "policy" => (Text, false),
        "image" => (Image, false),
        "vertexProperty" | "alternateRep" => (Node, false),
        _ => return None,
    })
}

/// True for nodes whose children old files count without saying that there are any.
pub(super) fn is_group(kind: &str) -> bool {
    matches!(
        kind,
        "Group"
            | "Separator"
            | "Annotation"
            | "Selection"
            | "Switch"
            | "LOD"
            | "LevelOfDetail"
            | "Array"
            | "MultipleCopy"
            | "PathSwitch"
            | "TransformSeparator"
            | "Blinker"
            | "WWWAnchor"
    )
}

/// True for nodes without fields, of which old files do not write that there are none.
pub(super) fn has_no_fields(kind: &str) -> bool {
    matches!(kind, "Group" | "TransformSeparator")
}
