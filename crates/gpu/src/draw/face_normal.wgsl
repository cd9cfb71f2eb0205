// The exact normal of a face at a place: found in every pixel from the Bézier net of the span that the place
// lies in.

@group(0) @binding(9) var<storage, read> net: array<vec4<f32>>;

// Below this square of the sine and of the ratio of the tangents' lengths a normal is rounding to a
// hundredth.
const POLE: f32 = 1e-8;

// A span among those of a face along one side, and the place in it.
struct Place { span: u32, t: f32 }

// `count` spans from record `first` of `places`: where each begins in the face's square, and one over its
// length there.
fn place_of(first: u32, count: u32, at: f32) -> Place {
    var low = 0u;
    var high = count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if places[first + middle].x <= at {
            low = middle;
        } else {
            high = middle;
        }
    }
    let span = places[first + low];
    return Place(low, clamp((at - span.x) * span.y, 0.0, 1.0));
}

// At a place of the face's square by its NURBS parameters; 0 where there is none.
fn face_normal(face: u32, spot: vec2<f32>) -> vec3<f32> {
    let p = faces[face].degrees & 0xffu;
    let q = faces[face].degrees >> 8u;
    let u = place_of(faces[face].spans_u, faces[face].count_u, spot.x);
    let v = place_of(faces[face].spans_v, faces[face].count_v, spot.y);
    let at = faces[face].net + (u.span * faces[face].cells_v + v.span) * (p + 1u) * (q + 1u);
    return unit_normal(tangents_at(Cell(at, p, q, u.t, v.t)), POLE);
}
