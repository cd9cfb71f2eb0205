// Lines of a width in pixels: six vertices a segment, two triangles along it on the screen.

struct Segment { ax: f32, ay: f32, az: f32, bx: f32, by: f32, bz: f32 }

@group(0) @binding(2) var<storage, read> segments: array<Segment>;

struct LineOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> LineOut {
    let segment = segments[index / 6u];
    let placement = placements[instance];
    let a = placement.view * vec4<f32>(segment.ax, segment.ay, segment.az, 1.0);
    let b = placement.view * vec4<f32>(segment.bx, segment.by, segment.bz, 1.0);
    let ca = view.projection * a;
    let cb = view.projection * b;
    let along = (cb.xy / cb.w - ca.xy / ca.w) * view.viewport;
    let length = max(length(along), 1e-6);
    let direction = along / length;
    let corner = index % 6u;
    let at_b = corner == 1u || corner == 2u || corner == 4u;
    let side = select(-1.0, 1.0, corner == 2u || corner == 4u || corner == 5u);
    // Half a width beyond both ends, so that joints close.
    let across = vec2<f32>(-direction.y, direction.x) * side;
    let shift = across + direction * select(-1.0, 1.0, at_b);
    var out: LineOut;
    out.p = select(a.xyz, b.xyz, at_b);
    var clip = select(ca, cb, at_b);
    clip = vec4<f32>(clip.xy + shift * view.line_width / view.viewport * clip.w, clip.zw);
    // In front of the faces that meet along the line, also where those fall away steeply.
    out.clip = nearer(clip, out.p, 2.0 + view.line_width);
    return out;
}

@fragment
fn fragment(in: LineOut) -> @location(0) vec4<f32> {
    if is_cut(in.p) {
        discard;
    }
    return vec4<f32>(view.line_color.rgb, 1.0);
}
