// The paper's trim texture: of every trimming curve a fan of triangles from one corner of the face's square.
// Each triangle turns what it covers from 0 to 1 and back, so that 1 is left where a point lies within an odd
// number of loops. Blending does the turning; each face has a rectangle of one colour channel.

// Two vectors a piece: its four x, its four y.
@group(0) @binding(0) var<storage, read> cubics: array<vec4<f32>>;

struct Fan {
    piece: u32,
    slot: u32,
    step: u32,     // this triangle stands for the chord from step / steps to (step + 1) / steps
    steps: u32,
}

struct Slot {
    corner: vec2<f32>,     // clip coordinates of the square's (0, 0)
    size: vec2<f32>,
    color: vec4<f32>,      // 1 in one channel
}

@group(0) @binding(1) var<storage, read> fans: array<Fan>;
@group(0) @binding(2) var<storage, read> slots: array<Slot>;

struct FanOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
}

fn cubic(p: vec4<f32>, t: f32) -> f32 {
    let s = 1.0 - t;
    return ((p.x * s + 3.0 * p.y * t) * s + 3.0 * p.z * t * t) * s + p.w * t * t * t;
}

@vertex
fn fan_vertex(@builtin(vertex_index) index: u32) -> FanOut {
    let fan = fans[index / 3u];
    let slot = slots[fan.slot];
    var place = vec2<f32>(0.0, 0.0);
    let corner = index % 3u;
    if corner > 0u {
        // Chords share their ends to the bit, as pieces do.
        let t = f32(fan.step + corner - 1u) / f32(fan.steps);
        place = vec2<f32>(cubic(cubics[2u * fan.piece], t), cubic(cubics[2u * fan.piece + 1u], t));
    }
    var out: FanOut;
    out.clip = vec4<f32>(slot.corner + slot.size * place, 0.0, 1.0);
    out.color = slot.color;
    return out;
}

@fragment
fn fan_fragment(in: FanOut) -> @location(0) vec4<f32> {
    return in.color;
}
