// What all evaluation kernels share. `real` is f32 or f64, declared above this text by the host, with its
// vectors.

// One grid or list of points on one surface. Point (i, j) of a grid is output number first + i * height + j.
struct Head {
    net: u32,      // its first control point
    stride: u32,   // control points along v
    bezier: u32,   // its first Bézier control point
    cells_v: u32,  // spans along v
    row_u: u32,    // its first row along u
    row_v: u32,    // its first row along v
    width: u32,    // points along u
    height: u32,   // points along v
    first: u32,    // number of its first point
    paired: u32,   // 1: a list, point i takes row i of both directions
    spare0: u32,
    spare1: u32,
}

// 64 points of one head: 8 × 8 of a grid from (i, j), 64 of a list from i.
struct Tile { head: u32, i: u32, j: u32, spare: u32 }

// One parameter value: its span, where its own knots lie, where its basis functions lie and how far apart.
struct Row { span: u32, window: u32, basis: u32, step: u32 }

// One non-empty knot span. At `window`: 1 / length, then the knots s-p .. s+p+1 with the span made 0 .. 1.
struct Span { window: u32, first: u32, degree: u32, cell: u32 }

struct Params {
    level: u32,    // degree that this pass reaches
    planes: u32,   // 1 + order of derivatives
    columns: u32,  // widest row
    rows: u32,     // number of rows, or of packs of four
    tile0: u32,    // first tile of this dispatch
    out0: u32,     // number of the first point in the output
    half: u32,     // where the second half of the basis buffer starts
    groups: u32,   // workgroups along x
}

var<immediate> params: Params;
