// Triangles with exact normals.

struct FaceOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec3<f32>,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
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
    return out;
}

@fragment
fn fragment(in: FaceOut) -> @location(0) vec4<f32> {
    if is_cut(in.p) {
        discard;
    }
    if view.fill.a > 0.0 {
        return vec4<f32>(view.fill.rgb, 1.0);
    }
    return vec4<f32>(lit(in.color, in.normal, in.p), 1.0);
}
