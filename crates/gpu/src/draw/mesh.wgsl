// Triangles with exact normals.

struct FaceOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec3<f32>,
    @location(3) @interpolate(flat) opacity: f32,
    @location(4) @interpolate(flat) seed: u32,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
    @location(3) face: u32,
    @builtin(instance_index) instance: u32,
) -> FaceOut {
    let placement = placements[instance];
    var out: FaceOut;
    let p = placement.view * vec4<f32>(position, 1.0);
    out.clip = view.projection * p;
    out.p = p.xyz;
    out.normal = placement.normal * normal;
    // Opacity 0 marks colours that stand for measured values, which no assembly overrides.
    let overridden = placement.color.a > 0.0 && color.a > 0.0;
    out.color = select(linear_of(color.rgb), placement.color.rgb, overridden);
    out.opacity = select(select(1.0, color.a, color.a > 0.0), placement.color.a, overridden);
    out.seed = face + instance;
    return out;
}

struct Covered {
    @location(0) color: vec4<f32>,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn fragment(in: FaceOut, @builtin(front_facing) front: bool) -> Covered {
    if is_cut(in.p) {
        discard;
    }
    if view.fill.a > 0.0 {
        return Covered(vec4<f32>(view.fill.rgb, 1.0), 15u);
    }
    let samples = veil(in.opacity, in.clip, front, in.seed);
    return Covered(vec4<f32>(lit(in.color, in.normal, in.p), 1.0), samples);
}
