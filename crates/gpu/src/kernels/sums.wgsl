// Sums control points times basis functions. Thread: one point.
//
// The text after this one defines where functions come from: `prepare` finds those of a sample, `along_u` and
// `along_v` give the function, or its derivative of order `plane`, of one column.

@compute @workgroup_size(64)
fn points(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let head = heads[sample.head];
    let span_u = spans[rows[sample.row_u].span];
    let span_v = spans[rows[sample.row_v].span];
    prepare(sample, span_u, span_v);
    let zero = real4(real(0));
    var sum = zero;
    for (var i = 0u; i <= span_u.degree; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line = zero;
        for (var j = 0u; j <= span_v.degree; j++) {
            line = line + net[start + j] * along_v(sample, span_v.degree, 0u, j);
        }
        sum = sum + line * along_u(sample, span_u.degree, 0u, i);
    }
    write_point(sample, sum);
}

// The derivatives that `planes` selects.
fn jet_of(sample: Sample) -> Jet {
    let head = heads[sample.head];
    let span_u = spans[rows[sample.row_u].span];
    let span_v = spans[rows[sample.row_v].span];
    let p = span_u.degree;
    let q = span_v.degree;
    let second = params.planes == 3u;
    prepare(sample, span_u, span_v);
    let zero = real4(real(0));
    var jet = Jet(zero, zero, zero, zero, zero, zero);
    for (var i = 0u; i <= p; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line0 = zero;
        var line1 = zero;
        var line2 = zero;
        for (var j = 0u; j <= q; j++) {
            let h = net[start + j];
            line0 = line0 + h * along_v(sample, q, 0u, j);
            line1 = line1 + h * along_v(sample, q, 1u, j);
            if second {
                line2 = line2 + h * along_v(sample, q, 2u, j);
            }
        }
        let u0 = along_u(sample, p, 0u, i);
        let u1 = along_u(sample, p, 1u, i);
        jet.h00 = jet.h00 + line0 * u0;
        jet.h01 = jet.h01 + line1 * u0;
        jet.h10 = jet.h10 + line0 * u1;
        if second {
            jet.h02 = jet.h02 + line2 * u0;
            jet.h11 = jet.h11 + line1 * u1;
            jet.h20 = jet.h20 + line0 * along_u(sample, p, 2u, i);
        }
    }
    return jet;
}

@compute @workgroup_size(64)
fn normals(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let jet = jet_of(sample);
    write_normal(sample, tangents_of(jet.h00, jet.h10, jet.h01));
}

@compute @workgroup_size(64)
fn jets(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    write_jet(sample, jet_of(sample));
}
