// Basis functions and sum in one kernel: every thread climbs from degree 0 in its own memory. Thread: one point.

@group(0) @binding(6) var<storage, read> ts: array<real>;

// Three planes (functions, first and second derivatives) of MAX_DEGREE + 1.
const PLANE: u32 = 101u;
alias Basis = array<real, 303>;

// The recursion in place; derivatives by differencing the last levels. Denominators hold the span, so none is 0.
fn fill(span: Span, t: real, planes: u32, basis: ptr<function, Basis>) {
    let p = span.degree;
    for (var j = 0u; j <= p; j++) {
        (*basis)[PLANE + j] = real(0);
        (*basis)[2u * PLANE + j] = real(0);
    }
    (*basis)[0] = real(1);
    for (var level = 1u; level <= p; level++) {
        for (var order = 1u; order < planes; order++) {
            if order + level == p + 1u {
                for (var j = 0u; j < level; j++) {
                    (*basis)[order * PLANE + j] = (*basis)[j];
                }
            }
        }
        var saved0 = real(0);
        var saved1 = real(0);
        var saved2 = real(0);
        for (var j = 0u; j < level; j++) {
            let low = windows[span.window + 2u + p - level + j];
            let width = windows[span.window + 2u + p + j] - low;
            let a = (t - low) / width;
            let n = (*basis)[j];
            (*basis)[j] = saved0 + (real(1) - a) * n;
            saved0 = a * n;
            let slope = real(level) / width;
            if planes > 1u && level == p {
                let step = slope * (*basis)[PLANE + j];
                (*basis)[PLANE + j] = saved1 - step;
                saved1 = step;
            }
            if planes > 2u && level + 1u >= p {
                let step = slope * (*basis)[2u * PLANE + j];
                (*basis)[2u * PLANE + j] = saved2 - step;
                saved2 = step;
            }
        }
        (*basis)[level] = saved0;
        (*basis)[PLANE + level] = saved1;
        (*basis)[2u * PLANE + level] = saved2;
    }
}

@compute @workgroup_size(64)
fn points(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let head = heads[sample.head];
    let span_u = spans[rows[sample.row_u].span];
    let span_v = spans[rows[sample.row_v].span];
    var bu: Basis;
    var bv: Basis;
    fill(span_u, ts[sample.row_u], 1u, &bu);
    fill(span_v, ts[sample.row_v], 1u, &bv);
    let zero = real4(real(0), real(0), real(0), real(0));
    var sum = zero;
    for (var i = 0u; i <= span_u.degree; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line = zero;
        for (var j = 0u; j <= span_v.degree; j++) {
            line = line + net[start + j] * bv[j];
        }
        sum = sum + line * bu[i];
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
    let span_u = spans[rows[sample.row_u].span];
    let span_v = spans[rows[sample.row_v].span];
    var bu: Basis;
    var bv: Basis;
    fill(span_u, ts[sample.row_u], params.planes, &bu);
    fill(span_v, ts[sample.row_v], params.planes, &bv);
    let zero = real4(real(0), real(0), real(0), real(0));
    var jet = Jet(zero, zero, zero, zero, zero, zero);
    for (var i = 0u; i <= span_u.degree; i++) {
        let start = head.net + (span_u.first + i) * head.stride + span_v.first;
        var line0 = zero;
        var line1 = zero;
        var line2 = zero;
        for (var j = 0u; j <= span_v.degree; j++) {
            let h = net[start + j];
            line0 = line0 + h * bv[j];
            line1 = line1 + h * bv[PLANE + j];
            line2 = line2 + h * bv[2u * PLANE + j];
        }
        jet.h00 = jet.h00 + line0 * bu[i];
        jet.h01 = jet.h01 + line1 * bu[i];
        jet.h02 = jet.h02 + line2 * bu[i];
        jet.h10 = jet.h10 + line0 * bu[PLANE + i];
        jet.h11 = jet.h11 + line1 * bu[PLANE + i];
        jet.h20 = jet.h20 + line0 * bu[2u * PLANE + i];
    }
    write_jet(sample, jet);
}
