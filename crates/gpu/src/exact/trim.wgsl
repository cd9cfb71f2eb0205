// Whether a point of a face's unit square lies inside its loops: crossings of the ray towards +x with pieces of cubic
// curves that rise in y, found through bands of y. Even and odd: holes within holes need no direction.

@group(0) @binding(5) var<storage, read> pieces: array<vec4<f32>>;
// Per face from `bands`: bands + 1 offsets into the list of pieces, then that list.
@group(0) @binding(6) var<storage, read> lists: array<u32>;

// One coordinate of a cubic by its control values.
fn cubic(a: f32, b: f32, c: f32, d: f32, t: f32) -> f32 {
    let s = 1.0 - t;
    return ((a * s + 3.0 * b * t) * s + 3.0 * c * t * t) * s + d * t * t * t;
}

fn inside(at: u32, bands: u32, p: vec2<f32>) -> bool {
    if bands == 0u {
        return true;
    }
    let band = u32(clamp(p.y * f32(bands), 0.0, f32(bands) - 1.0));
    var odd = false;
    for (var k = lists[at + band]; k < lists[at + band + 1u]; k++) {
        let xs = pieces[2u * lists[k]];
        let ys = pieces[2u * lists[k] + 1u];
        if p.y < ys.x || p.y >= ys.w {
            continue;
        }
        if p.x >= max(max(xs.x, xs.y), max(xs.z, xs.w)) {
            continue;
        }
        if p.x < min(min(xs.x, xs.y), min(xs.z, xs.w)) {
            odd = !odd;
            continue;
        }
        // The parameter at this height: secants kept within a bracket that halves at least every second step.
        var low = 0.0;
        var high = 1.0;
        var t = (p.y - ys.x) / (ys.w - ys.x);
        for (var step = 0u; step < 12u; step++) {
            let y = cubic(ys.x, ys.y, ys.z, ys.w, t);
            if y <= p.y {
                low = t;
            } else {
                high = t;
            }
            let s = 1.0 - t;
            let slope = 3.0 * ((ys.y - ys.x) * s * s + 2.0 * (ys.z - ys.y) * s * t + (ys.w - ys.z) * t * t);
            let next = t + (p.y - y) / slope;
            t = select(0.5 * (low + high), next, next >= low && next <= high);
        }
        if cubic(xs.x, xs.y, xs.z, xs.w, t) > p.x {
            odd = !odd;
        }
    }
    return odd;
}
