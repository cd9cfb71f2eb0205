// What all drawing shaders share: the view, the placements, the light.

struct View {
    projection: mat4x4<f32>,
    viewport: vec2<f32>,      // pixels
    line_width: f32,          // pixels
    eye: f32,                 // distance of the eye from the origin of the view, 0: infinitely far
    line_color: vec4<f32>,    // linear; opacity 0: the face's own
    fill: vec4<f32>,          // linear; opacity 1: in place of every colour, without light
    depth: vec4<f32>,         // x: length that a pixel covers at the origin of the view; y: 1 where exact faces have a normal of each pixel's own
    section: vec4<f32>,       // of view space: what lies where dot(normal, p) > offset is cut away; 0: nothing
}

// One placement of a part: part to view, and the colour in place of its own where that is not 0 in opacity.
struct Placement {
    view: mat4x4<f32>,
    normal: mat3x3<f32>,
    color: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> placements: array<Placement>;

fn linear_of(srgb: vec3<f32>) -> vec3<f32> {
    let low = srgb / 12.92;
    let high = pow((srgb + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, low, srgb <= vec3<f32>(0.04045));
}

fn towards_eye(p: vec3<f32>) -> vec3<f32> {
    if view.eye > 0.0 {
        return normalize(vec3<f32>(0.0, 0.0, view.eye) - p);
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn is_cut(p: vec3<f32>) -> bool {
    return dot(view.section.xyz, p) > view.section.w && dot(view.section.xyz, view.section.xyz) > 0.0;
}

// A key light over the left shoulder, a weak one from below right, sky and ground; both sides of a face are
// lit.
fn lit(color: vec3<f32>, direction: vec3<f32>, p: vec3<f32>) -> vec3<f32> {
    let e = towards_eye(p);
    // On the very tip of a cone there is no normal.
    let size = length(direction);
    let normal = select(e, direction / size, size > 0.0);
    let n = normal * select(-1.0, 1.0, dot(normal, e) >= 0.0);
    let key = normalize(vec3<f32>(-0.45, 0.65, 0.75));
    let fill = normalize(vec3<f32>(0.7, -0.25, 0.45));
    let sky = mix(0.20, 0.36, 0.5 + 0.5 * n.y);
    let diffuse = 0.62 * max(dot(n, key), 0.0) + 0.16 * max(dot(n, fill), 0.0);
    let shine = 0.10 * pow(max(dot(n, normalize(key + e)), 0.0), 40.0);
    return color * (sky + diffuse) + vec3<f32>(shine);
}

// Which of a pixel's four samples a face of this opacity covers: stochastic transparency (Enderton, Sintorn,
// Shirley, Luebke 2010) with patterns of 4 × 4 pixels in place of noise, so that the order of drawing does
// not matter. From pixel to pixel the samples turn by one of 16 patterns: over two faces of
// different patterns, as over front and back of one, about every choice of one meets every choice of the
// other.
fn veil(opacity: f32, at: vec4<f32>, front: bool, seed: u32) -> u32 {
    if opacity >= 1.0 {
        return 15u;
    }
    let x = u32(at.x);
    let y = u32(at.y);
    let z = x ^ y;
    let rank = ((z & 1u) << 3u) | ((y & 1u) << 2u) | (z & 2u) | ((y >> 1u) & 1u);
    let count = min(u32(4.0 * opacity + (f32(rank) + 0.5) / 16.0), 4u);
    let pattern = (7u * seed) ^ select(1u, 0u, front);
    let first = ((pattern & 3u) * x + ((pattern >> 2u) & 3u) * y + (pattern >> 4u)) & 3u;
    let samples = (1u << count) - 1u;
    return ((samples << first) | (samples >> (4u - first))) & 15u;
}

// The clip position of a point of view space with the depth of the one that lies so many pixels nearer to the
// eye.
fn nearer(clip: vec4<f32>, p: vec3<f32>, pixels: f32) -> vec4<f32> {
    let scale = select(1.0, (view.eye - p.z) / view.eye, view.eye > 0.0);
    let moved = view.projection * vec4<f32>(p + towards_eye(p) * (pixels * view.depth.x * scale), 1.0);
    return vec4<f32>(clip.xy, moved.z / moved.w * clip.w, clip.w);
}
