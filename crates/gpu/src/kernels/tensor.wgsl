// Sums control points times basis functions that passes have left in a buffer. Thread: one point.

@group(0) @binding(6) var<storage, read> basis: array<real>;

// A direction without degree (the second of a curve) has one function, 1.
fn function_of(row: Row, degree: u32, plane: u32, column: u32) -> real {
    if degree == 0u {
        return select(real(0), real(1), plane == 0u);
    }
    let half = select(0u, params.half, degree % 2u == 1u);
    return basis[half + row.basis + (plane * (degree + 1u) + column) * row.step];
}

@compute @workgroup_size(64)
fn points(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let head = heads[sample.head];
    let row_u = rows[sample.row_u];
    let row_v = rows[sample.row_v];
    let span_u = spans[row_u.span];
    let span_v = spans[row_v.span];
    let zero = real4(real(0), real(0), real(0), real(0));
    var sum = zero;
    for (var i = 0u; i <= span_u.degree; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line = zero;
        for (var j = 0u; j <= span_v.degree; j++) {
            line = line + net[start + j] * function_of(row_v, span_v.degree, 0u, j);
        }
        sum = sum + line * function_of(row_u, span_u.degree, 0u, i);
    }
    write_point(sample, sum);
}

@compute @workgroup_size(64)
fn jets(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let head = heads[sample.head];
    let row_u = rows[sample.row_u];
    let row_v = rows[sample.row_v];
    let span_u = spans[row_u.span];
    let span_v = spans[row_v.span];
    let p = span_u.degree;
    let q = span_v.degree;
    let second = params.planes == 3u;
    let zero = real4(real(0), real(0), real(0), real(0));
    var jet = Jet(zero, zero, zero, zero, zero, zero);
    for (var i = 0u; i <= p; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line0 = zero;
        var line1 = zero;
        var line2 = zero;
        for (var j = 0u; j <= q; j++) {
            let h = net[start + j];
            line0 = line0 + h * function_of(row_v, q, 0u, j);
            line1 = line1 + h * function_of(row_v, q, 1u, j);
            if second {
                line2 = line2 + h * function_of(row_v, q, 2u, j);
            }
        }
        let u0 = function_of(row_u, p, 0u, i);
        let u1 = function_of(row_u, p, 1u, i);
        jet.h00 = jet.h00 + line0 * u0;
        jet.h01 = jet.h01 + line1 * u0;
        jet.h10 = jet.h10 + line0 * u1;
        if second {
            jet.h02 = jet.h02 + line2 * u0;
            jet.h11 = jet.h11 + line1 * u1;
            jet.h20 = jet.h20 + line0 * function_of(row_u, p, 2u, i);
        }
    }
    write_jet(sample, jet);
}
