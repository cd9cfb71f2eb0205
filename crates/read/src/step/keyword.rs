//! The entity names that the reader supports, as an enum.

use rustc_hash::FxHashMap;

macro_rules! keywords {
    ($($variant:ident = $name:literal),* $(,)?) => {
        /// An entity name; `Unknown` for those that carry nothing of the shape.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub(crate) enum Kw {
            Unknown,
            /// `(A(..)B(..))`: several leaves.
            Complex,
            $($variant),*
        }

        const NAMES: &[(&str, Kw)] = &[$(($name, Kw::$variant)),*];

        impl Kw {
            /// The name as the file spells it.
            pub(crate) fn name(self) -> &'static str {
                match self {
                    Kw::Unknown => "an unknown entity",
                    Kw::Complex => "a complex instance",
                    $(Kw::$variant => $name),*
                }
            }
        }
    };
}

keywords! {
    AdvancedBrepShapeRepresentation = "ADVANCED_BREP_SHAPE_REPRESENTATION",
    AdvancedFace = "ADVANCED_FACE",
    Axis1Placement = "AXIS1_PLACEMENT",
    Axis2Placement2d = "AXIS2_PLACEMENT_2D",
    Axis2Placement3d = "AXIS2_PLACEMENT_3D",
    BSplineCurve = "B_SPLINE_CURVE",
    BSplineCurveWithKnots = "B_SPLINE_CURVE_WITH_KNOTS",
    BSplineSurface = "B_SPLINE_SURFACE",
    BSplineSurfaceWithKnots = "B_SPLINE_SURFACE_WITH_KNOTS",
    BezierCurve = "BEZIER_CURVE",
    BezierSurface = "BEZIER_SURFACE",
    Block = "BLOCK",
    BooleanResult = "BOOLEAN_RESULT",
    BoundaryCurve = "BOUNDARY_CURVE",
    BoundedPcurve = "BOUNDED_PCURVE",
    BoundedSurfaceCurve = "BOUNDED_SURFACE_CURVE",
    BrepWithVoids = "BREP_WITH_VOIDS",
    CartesianPoint = "CARTESIAN_POINT",
    CartesianTransformationOperator3d = "CARTESIAN_TRANSFORMATION_OPERATOR_3D",
    Circle = "CIRCLE",
    ClosedShell = "CLOSED_SHELL",
    ColourRgb = "COLOUR_RGB",
    ComplexTriangulatedFace = "COMPLEX_TRIANGULATED_FACE",
    ComplexTriangulatedSurfaceSet = "COMPLEX_TRIANGULATED_SURFACE_SET",
    CompositeCurve = "COMPOSITE_CURVE",
    CompositeCurveOnSurface = "COMPOSITE_CURVE_ON_SURFACE",
    CompositeCurveSegment = "COMPOSITE_CURVE_SEGMENT",
    CompoundRepresentationItem = "COMPOUND_REPRESENTATION_ITEM",
    ConicalSurface = "CONICAL_SURFACE",
    ConnectedEdgeSet = "CONNECTED_EDGE_SET",
    ConnectedFaceSet = "CONNECTED_FACE_SET",
    ConnectedFaceSubSet = "CONNECTED_FACE_SUB_SET",
    ConstructiveGeometryRepresentation = "CONSTRUCTIVE_GEOMETRY_REPRESENTATION",
    ConstructiveGeometryRepresentationRelationship = "CONSTRUCTIVE_GEOMETRY_REPRESENTATION_RELATIONSHIP",
    ContextDependentOverRidingStyledItem = "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM",
    ContextDependentShapeRepresentation = "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION",
    ConversionBasedUnit = "CONVERSION_BASED_UNIT",
    CoordinatesList = "COORDINATES_LIST",
    CurveBoundedSurface = "CURVE_BOUNDED_SURFACE",
    CylindricalSurface = "CYLINDRICAL_SURFACE",
    DefinitionalRepresentation = "DEFINITIONAL_REPRESENTATION",
    DegeneratePcurve = "DEGENERATE_PCURVE",
    DegenerateToroidalSurface = "DEGENERATE_TOROIDAL_SURFACE",
    Direction = "DIRECTION",
    DraughtingPreDefinedColour = "DRAUGHTING_PRE_DEFINED_COLOUR",
    EdgeBasedWireframeModel = "EDGE_BASED_WIREFRAME_MODEL",
    EdgeCurve = "EDGE_CURVE",
    EdgeLoop = "EDGE_LOOP",
    Ellipse = "ELLIPSE",
    EvaluatedDegeneratePcurve = "EVALUATED_DEGENERATE_PCURVE",
    Face = "FACE",
    FaceBasedSurfaceModel = "FACE_BASED_SURFACE_MODEL",
    FaceBound = "FACE_BOUND",
    FaceOuterBound = "FACE_OUTER_BOUND",
    FaceSurface = "FACE_SURFACE",
    FacetedBrep = "FACETED_BREP",
    FacetedBrepShapeRepresentation = "FACETED_BREP_SHAPE_REPRESENTATION",
    FillAreaStyle = "FILL_AREA_STYLE",
    FillAreaStyleColour = "FILL_AREA_STYLE_COLOUR",
    GeometricCurveSet = "GEOMETRIC_CURVE_SET",
    GeometricRepresentationContext = "GEOMETRIC_REPRESENTATION_CONTEXT",
    GeometricSet = "GEOMETRIC_SET",
    GeometricallyBoundedSurfaceShapeRepresentation = "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
    GeometricallyBoundedWireframeShapeRepresentation = "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
    GlobalUncertaintyAssignedContext = "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT",
    GlobalUnitAssignedContext = "GLOBAL_UNIT_ASSIGNED_CONTEXT",
    Hyperbola = "HYPERBOLA",
    IndexedPolyCurve = "INDEXED_POLY_CURVE",
    IntersectionCurve = "INTERSECTION_CURVE",
    ItemDefinedTransformation = "ITEM_DEFINED_TRANSFORMATION",
    LengthMeasureWithUnit = "LENGTH_MEASURE_WITH_UNIT",
    LengthUnit = "LENGTH_UNIT",
    Line = "LINE",
    ManifoldSolidBrep = "MANIFOLD_SOLID_BREP",
    ManifoldSubsurfaceShapeRepresentation = "MANIFOLD_SUBSURFACE_SHAPE_REPRESENTATION",
    ManifoldSurfaceShapeRepresentation = "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
    MappedItem = "MAPPED_ITEM",
    MeasureWithUnit = "MEASURE_WITH_UNIT",
    NamedUnit = "NAMED_UNIT",
    NextAssemblyUsageOccurrence = "NEXT_ASSEMBLY_USAGE_OCCURRENCE",
    NonManifoldSurfaceShapeRepresentation = "NON_MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
    OffsetCurve2d = "OFFSET_CURVE_2D",
    OffsetCurve3d = "OFFSET_CURVE_3D",
    OffsetSurface = "OFFSET_SURFACE",
    OpenShell = "OPEN_SHELL",
    OrientedClosedShell = "ORIENTED_CLOSED_SHELL",
    OrientedEdge = "ORIENTED_EDGE",
    OrientedFace = "ORIENTED_FACE",
    OrientedOpenShell = "ORIENTED_OPEN_SHELL",
    OrientedSurface = "ORIENTED_SURFACE",
    OuterBoundaryCurve = "OUTER_BOUNDARY_CURVE",
    OverRidingStyledItem = "OVER_RIDING_STYLED_ITEM",
    Parabola = "PARABOLA",
    Path = "PATH",
    Pcurve = "PCURVE",
    PlaneAngleMeasureWithUnit = "PLANE_ANGLE_MEASURE_WITH_UNIT",
    PlaneAngleUnit = "PLANE_ANGLE_UNIT",
    PiecewiseBezierCurve = "PIECEWISE_BEZIER_CURVE",
    PiecewiseBezierSurface = "PIECEWISE_BEZIER_SURFACE",
    Plane = "PLANE",
    PointOnCurve = "POINT_ON_CURVE",
    PointOnSurface = "POINT_ON_SURFACE",
    PolyLoop = "POLY_LOOP",
    Polyline = "POLYLINE",
    PreDefinedColour = "PRE_DEFINED_COLOUR",
    PresentationLayerAssignment = "PRESENTATION_LAYER_ASSIGNMENT",
    PresentationStyleAssignment = "PRESENTATION_STYLE_ASSIGNMENT",
    PresentationStyleByContext = "PRESENTATION_STYLE_BY_CONTEXT",
    Product = "PRODUCT",
    ProductDefinition = "PRODUCT_DEFINITION",
    ProductDefinitionFormation = "PRODUCT_DEFINITION_FORMATION",
    ProductDefinitionFormationWithSpecifiedSource = "PRODUCT_DEFINITION_FORMATION_WITH_SPECIFIED_SOURCE",
    ProductDefinitionShape = "PRODUCT_DEFINITION_SHAPE",
    ProductDefinitionWithAssociatedDocuments = "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS",
    QuasiUniformCurve = "QUASI_UNIFORM_CURVE",
    QuasiUniformSurface = "QUASI_UNIFORM_SURFACE",
    RationalBSplineCurve = "RATIONAL_B_SPLINE_CURVE",
    RationalBSplineSurface = "RATIONAL_B_SPLINE_SURFACE",
    RectangularCompositeSurface = "RECTANGULAR_COMPOSITE_SURFACE",
    RectangularTrimmedSurface = "RECTANGULAR_TRIMMED_SURFACE",
    RepositionedTessellatedItem = "REPOSITIONED_TESSELLATED_ITEM",
    Representation = "REPRESENTATION",
    RepresentationItem = "REPRESENTATION_ITEM",
    RepresentationMap = "REPRESENTATION_MAP",
    RepresentationRelationship = "REPRESENTATION_RELATIONSHIP",
    RepresentationRelationshipWithTransformation = "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION",
    SeamCurve = "SEAM_CURVE",
    ShapeDefinitionRepresentation = "SHAPE_DEFINITION_REPRESENTATION",
    ShapeRepresentation = "SHAPE_REPRESENTATION",
    ShapeRepresentationRelationship = "SHAPE_REPRESENTATION_RELATIONSHIP",
    ShapeRepresentationWithParameters = "SHAPE_REPRESENTATION_WITH_PARAMETERS",
    ShellBasedSurfaceModel = "SHELL_BASED_SURFACE_MODEL",
    ShellBasedWireframeModel = "SHELL_BASED_WIREFRAME_MODEL",
    SiUnit = "SI_UNIT",
    SolidReplica = "SOLID_REPLICA",
    SphericalSurface = "SPHERICAL_SURFACE",
    StyledItem = "STYLED_ITEM",
    Subedge = "SUBEDGE",
    Subface = "SUBFACE",
    SurfaceCurve = "SURFACE_CURVE",
    SurfaceOfLinearExtrusion = "SURFACE_OF_LINEAR_EXTRUSION",
    SurfaceOfRevolution = "SURFACE_OF_REVOLUTION",
    SurfaceReplica = "SURFACE_REPLICA",
    SurfaceSideStyle = "SURFACE_SIDE_STYLE",
    SurfaceStyleFillArea = "SURFACE_STYLE_FILL_AREA",
    SurfaceStyleRendering = "SURFACE_STYLE_RENDERING",
    SurfaceStyleRenderingWithProperties = "SURFACE_STYLE_RENDERING_WITH_PROPERTIES",
    SurfaceStyleTransparent = "SURFACE_STYLE_TRANSPARENT",
    SurfaceStyleUsage = "SURFACE_STYLE_USAGE",
    TessellatedConnectingEdge = "TESSELLATED_CONNECTING_EDGE",
    TessellatedCurveSet = "TESSELLATED_CURVE_SET",
    TessellatedEdge = "TESSELLATED_EDGE",
    TessellatedGeometricSet = "TESSELLATED_GEOMETRIC_SET",
    TessellatedPointSet = "TESSELLATED_POINT_SET",
    TessellatedShapeRepresentation = "TESSELLATED_SHAPE_REPRESENTATION",
    TessellatedShell = "TESSELLATED_SHELL",
    TessellatedSolid = "TESSELLATED_SOLID",
    TessellatedVertex = "TESSELLATED_VERTEX",
    TessellatedWire = "TESSELLATED_WIRE",
    ToroidalSurface = "TOROIDAL_SURFACE",
    TriangulatedFace = "TRIANGULATED_FACE",
    TriangulatedSurfaceSet = "TRIANGULATED_SURFACE_SET",
    TrimmedCurve = "TRIMMED_CURVE",
    UncertaintyMeasureWithUnit = "UNCERTAINTY_MEASURE_WITH_UNIT",
    UniformCurve = "UNIFORM_CURVE",
    UniformSurface = "UNIFORM_SURFACE",
    Vector = "VECTOR",
    VertexLoop = "VERTEX_LOOP",
    VertexPoint = "VERTEX_POINT",
    VertexShell = "VERTEX_SHELL",
    WireShell = "WIRE_SHELL",
}

/// Finds keywords by their spelling.
#[derive(Debug)]
pub(crate) struct Keywords {
    by_name: FxHashMap<&'static [u8], Kw>,
}

impl Keywords {
    pub(crate) fn new() -> Self {
        Self { by_name: NAMES.iter().map(|&(name, kw)| (name.as_bytes(), kw)).collect() }
    }

    /// The keyword of this spelling; lower case is accepted.
    pub(crate) fn find(&self, name: &[u8]) -> Kw {
        if let Some(&kw) = self.by_name.get(name) {
            return kw;
        }
        if name.iter().any(u8::is_ascii_lowercase) {
            return self.by_name.get(name.to_ascii_uppercase().as_slice()).copied().unwrap_or(Kw::Unknown);
        }
        Kw::Unknown
    }
}
