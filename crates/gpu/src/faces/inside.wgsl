// Whether a point of a face's unit square lies inside its loops: crossings of the ray towards +x with pieces
// of cubic curves that rise in y, found through bands of y. Even and odd: holes within holes need no
// direction.

@group(0) @binding(5) var<storage, read> pieces: array<vec4<f32>>;
// Per face: the side of its map, the map (two bits a cell: 0 outside, 1 inside, 2 to be tested), bands + 1
// offsets into the list of pieces, then that list.
@group(0) @binding(6) var<storage, read> lists: array<u32>;

// One coordinate of a cubic by its control values, at four parameters.
fn cubic(p: vec4<f32>, t: vec4<f32>) -> vec4<f32> {
    let s = 1.0 - t;
    return ((p.x * s + 3.0 * p.y * t) * s + 3.0 * p.z * t * t) * s + p.w * t * t * t;
}

// The parameters at which a rising piece has four heights: Newton's steps kept within a bracket, halves where
// they leave it.
fn at_heights(ys: vec4<f32>, heights: vec4<f32>) -> vec4<f32> {
    var low = vec4<f32>(0.0);
    var high = vec4<f32>(1.0);
    var t = clamp((heights - ys.x) / (ys.w - ys.x), low, high);
    for (var step = 0u; step < 12u; step++) {
        let off = cubic(ys, t) - heights;
        if all(abs(off) <= vec4<f32>(1e-7)) {
            break;
        }
        low = select(low, t, off <= vec4<f32>(0.0));
        high = select(high, t, off > vec4<f32>(0.0));
        let s = 1.0 - t;
        let slope = 3.0 * ((ys.y - ys.x) * s * s + 2.0 * (ys.z - ys.y) * s * t + (ys.w - ys.z) * t * t);
        let next = t - off / slope;
        t = select(0.5 * (low + high), next, next >= low & next <= high);
    }
    return t;
}

// What the map knows of a place.
fn known_of(at: u32, side: u32, x: f32, y: f32) -> u32 {
    let most = f32(side) - 1.0;
    let cell = u32(clamp(y * f32(side), 0.0, most)) * side + u32(clamp(x * f32(side), 0.0, most));
    return (lists[at + 1u + cell / 16u] >> (2u * (cell % 16u))) & 3u;
}

// Which of four near places are inside; `bands` 0: the face fills its square.
fn inside(at: u32, bands: u32, x: vec4<f32>, y: vec4<f32>) -> vec4<bool> {
    if bands == 0u {
        return vec4<bool>(true);
    }
    let side = lists[at];
    let known = vec4<u32>(
        known_of(at, side, x.x, y.x),
        known_of(at, side, x.y, y.y),
        known_of(at, side, x.z, y.z),
        known_of(at, side, x.w, y.w),
    );
    let asked = known > vec4<u32>(1u);
    var odd = known == vec4<u32>(1u);
    if !any(asked) {
        return odd;
    }
    let first = at + 1u + (side * side + 15u) / 16u;
    let band = vec4<u32>(clamp(y * f32(bands), vec4<f32>(0.0), vec4<f32>(f32(bands) - 1.0)));
    let lowest = min(min(band.x, band.y), min(band.z, band.w));
    let highest = max(max(band.x, band.y), max(band.z, band.w));
    for (var b = lowest; b <= highest; b++) {
        let mine = asked & (band == vec4<u32>(b));
        for (var k = lists[first + b]; k < lists[first + b + 1u]; k++) {
            let xs = pieces[2u * lists[k]];
            let ys = pieces[2u * lists[k] + 1u];
            let most = max(max(xs.x, xs.y), max(xs.z, xs.w));
            let beside = mine & (y >= vec4<f32>(ys.x)) & (y < vec4<f32>(ys.w)) & (x < vec4<f32>(most));
            if !any(beside) {
                continue;
            }
            var crossed = x < vec4<f32>(min(min(xs.x, xs.y), min(xs.z, xs.w)));
            if any(beside & !crossed) {
                crossed |= cubic(xs, at_heights(ys, y)) > x;
            }
            odd = odd != (beside & crossed);
        }
    }
    return odd;
}
