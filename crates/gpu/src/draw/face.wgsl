// Exact faces: grids of points that a kernel has left in a buffer, drawn from there, trimmed at every sample
// and lit by the exact normal of every pixel.

struct Face {
    offset: vec3<f32>,   // local coordinates to the part's: offset + size * local
    size: f32,
    color: vec4<f32>,    // linear, with opacity
    first: u32,          // number of its first point in the buffer
    height: u32,         // points along v
    row_u: u32,          // its columns' places in the unit square
    row_v: u32,
    lists: u32,          // its trimming
    bands: u32,
    turn: f32,           // -1: the outside is against the surface's normal
    border: u32,         // number of its first border point
    rectangle: vec4<f32>,    // its trim texture: corner and size in texture coordinates
    half_texel: vec2<f32>,   // of the unit square
    plane: u32,              // 4 layer + channel
    width: u32,              // points along u
    borders: u32,            // pieces of its border
    net: u32,                // first Bézier control point of the spans that it lies in
    degrees: u32,            // along u, and 256 times along v; 0: there are no nets, normals are interpolated
    cells_v: u32,            // spans of the whole surface along v
    spans_u: u32,            // the records of the spans that it lies in
    spans_v: u32,
    count_u: u32,
    count_v: u32,
}

@group(0) @binding(2) var<storage, read> faces: array<Face>;
@group(0) @binding(3) var<storage, read> points: array<f32>;
// Of every column and row of a grid the place in the face's square, by native and by NURBS parameters; and
// the spans of faces.
@group(0) @binding(4) var<storage, read> places: array<vec2<f32>>;
@group(0) @binding(7) var trims: texture_2d_array<f32>;
@group(0) @binding(8) var trim_sampler: sampler;

// Some cells of one face's grid, or some pieces of its border, in one placement.
struct Block {
    face: u32,
    placement: u32,
    first: u32,
    spare: u32,
}

// Instances run through the blocks from `first`, once for each placement from `placement`.
struct Batch {
    first: u32,
    records: u32,
    placement: u32,
    rows: u32,
}

@group(1) @binding(0) var<storage, read> blocks: array<Block>;

var<immediate> batch: Batch;

fn block_of(instance: u32) -> Block {
    var block = blocks[batch.first + instance % batch.records];
    block.placement += batch.placement + instance / batch.records;
    return block;
}

struct ExactOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) place: vec2<f32>,
    @location(3) @interpolate(flat) color: vec4<f32>,
    @location(4) @interpolate(flat) trim: vec2<u32>,
    @location(5) @interpolate(flat) face: u32,
    @location(6) @interpolate(flat) placement: u32,
    // The place by NURBS parameters; within the triangle also where the middle of the pixel is not.
    @location(7) @interpolate(perspective, centroid) spot: vec2<f32>,
}

fn color_of(face: Face, placement: Placement) -> vec4<f32> {
    return select(face.color, placement.color, placement.color.a > 0.0);
}

fn point_of(face: Face, number: u32) -> vec3<f32> {
    let at = 6u * number;
    return face.offset + face.size * vec3<f32>(points[at], points[at + 1u], points[at + 2u]);
}

fn normal_of(face: Face, number: u32) -> vec3<f32> {
    let at = 6u * number + 3u;
    return face.turn * vec3<f32>(points[at], points[at + 1u], points[at + 2u]);
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> ExactOut {
    let block = block_of(instance);
    let face = faces[block.face];
    let placement = placements[block.placement];
    // Cells beyond the grid have no size.
    let i = min((block.first & 0xffffu) + index / (batch.rows + 1u), face.width - 1u);
    let j = min((block.first >> 16u) + index % (batch.rows + 1u), face.height - 1u);
    let number = face.first + i * face.height + j;
    let p = placement.view * vec4<f32>(point_of(face, number), 1.0);
    var out: ExactOut;
    out.clip = view.projection * p;
    out.p = p.xyz;
    out.normal = placement.normal * normal_of(face, number);
    let along_u = places[face.row_u + i];
    let along_v = places[face.row_v + j];
    out.place = vec2<f32>(along_u.x, along_v.x);
    out.spot = vec2<f32>(along_u.y, along_v.y);
    out.color = color_of(face, placement);
    out.trim = vec2<u32>(face.lists, face.bands);
    out.face = block.face;
    out.placement = block.placement;
    return out;
}

struct Covered {
    @location(0) color: vec4<f32>,
    @builtin(sample_mask) samples: u32,
}

// The four samples of a pixel, from its middle.
const SAMPLES_X = vec4<f32>(-0.125, 0.375, -0.375, 0.125);
const SAMPLES_Y = vec4<f32>(-0.375, -0.125, 0.125, 0.375);

// Colour is found once a pixel, what is trimmed at each of its samples.
@fragment
fn fragment(in: ExactOut, @builtin(front_facing) front: bool) -> Covered {
    let right = dpdx(in.place);
    let down = dpdy(in.place);
    let x = in.place.x + SAMPLES_X * right.x + SAMPLES_Y * down.x;
    let y = in.place.y + SAMPLES_X * right.y + SAMPLES_Y * down.y;
    let bits = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), inside(in.trim.x, in.trim.y, x, y));
    return covered(in, front, bits.x | bits.y | bits.z | bits.w);
}

// Towards the outside, in view space.
fn normal_in(in: ExactOut) -> vec3<f32> {
    if view.depth.y > 0.0 && faces[in.face].degrees > 0u {
        let normal = face_normal(in.face, in.spot);
        if any(normal != vec3<f32>(0.0)) {
            return placements[in.placement].normal * (faces[in.face].turn * normal);
        }
    }
    return in.normal;
}

fn covered(in: ExactOut, front: bool, inside: u32) -> Covered {
    if is_cut(in.p) || inside == 0u {
        discard;
    }
    if view.fill.a > 0.0 {
        return Covered(vec4<f32>(view.fill.rgb, 1.0), inside);
    }
    let samples = inside & veil(in.color.a, in.clip, front, in.face + in.placement);
    return Covered(vec4<f32>(lit(in.color.rgb, normal_in(in), in.p), 1.0), samples);
}

// What a fragment knows of its place and the normal it is lit by, as numbers: for the tests, which compare
// them with double precision.
struct Probed {
    @location(0) place: vec4<f32>,
    @location(1) normal: vec4<f32>,
}

@fragment
fn fragment_probe(in: ExactOut) -> Probed {
    return Probed(vec4<f32>(in.spot, f32(in.face), 1.0), vec4<f32>(normal_in(in), 1.0));
}

// By the trim texture. No answer is interpolated with a neighbour's rectangle.
@fragment
fn fragment_texture(in: ExactOut, @builtin(front_facing) front: bool) -> Covered {
    let right = dpdx(in.place);
    let down = dpdy(in.place);
    if in.trim.y == 0u {
        return covered(in, front, 15u);
    }
    let rectangle = faces[in.face].rectangle;
    let half = faces[in.face].half_texel;
    let plane = faces[in.face].plane;
    var samples = 0u;
    for (var k = 0u; k < 4u; k++) {
        let place = in.place + SAMPLES_X[k] * right + SAMPLES_Y[k] * down;
        let at = rectangle.xy + rectangle.zw * clamp(place, half, 1.0 - half);
        let share = textureSampleLevel(trims, trim_sampler, at, plane / 4u, 0.0)[plane % 4u];
        samples |= select(0u, 1u << k, share >= 0.5);
    }
    return covered(in, front, samples);
}

struct BorderOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
}

// A strip along the border of a face, as wide as neighbours that are sampled differently may stand apart, and
// a pixel behind both: it is seen in cracks alone. That of a face turned away lies further back, so that
// silhouettes are drawn in the colours of what faces the eye.
@vertex
fn border_vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> BorderOut {
    let block = block_of(instance);
    let face = faces[block.face];
    let placement = placements[block.placement];
    // Pieces beyond the last have no size.
    let piece = min(block.first + index / 4u, face.borders - 1u);
    let number = face.border + 2u * piece;
    let corner = select(0u, index % 4u, piece == block.first + index / 4u);
    let at_b = corner == 1u || corner == 2u;
    let side = select(-1.0, 1.0, corner >= 2u);
    let a = placement.view * vec4<f32>(point_of(face, number), 1.0);
    let b = placement.view * vec4<f32>(point_of(face, number + 1u), 1.0);
    let ca = view.projection * a;
    let cb = view.projection * b;
    let along = (cb.xy / cb.w - ca.xy / ca.w) * view.viewport;
    let direction = along / max(length(along), 1e-6);
    let shift = vec2<f32>(-direction.y, direction.x) * side;
    var clip = select(ca, cb, at_b);
    clip = vec4<f32>(clip.xy + shift / view.viewport * clip.w, clip.zw);
    var out: BorderOut;
    out.p = select(a.xyz, b.xyz, at_b);
    out.normal = placement.normal * normal_of(face, number + select(0u, 1u, at_b));
    out.clip = nearer(clip, out.p, select(-1.0, -2.0, dot(out.normal, towards_eye(out.p)) < 0.0));
    out.color = color_of(face, placement);
    return out;
}

@fragment
fn border_fragment(in: BorderOut) -> @location(0) vec4<f32> {
    // Behind a face that is seen through a strip would be seen too.
    if is_cut(in.p) || (in.color.a < 1.0 && view.fill.a == 0.0) {
        discard;
    }
    if view.fill.a > 0.0 {
        return vec4<f32>(view.fill.rgb, 1.0);
    }
    return vec4<f32>(lit(in.color.rgb, in.normal, in.p), 1.0);
}
