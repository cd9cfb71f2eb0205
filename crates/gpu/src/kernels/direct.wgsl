// Functions in the kernel that sums: every thread climbs from degree 0 in its own memory.

@group(0) @binding(6) var<storage, read> ts: array<real>;

// Three planes (functions, first and second derivatives) of MAX_DEGREE + 1.
const PLANE: u32 = 101u;
alias Basis = array<real, 303>;

var<private> bu: Basis;
var<private> bv: Basis;

// The recursion in place; derivatives by differencing the last levels. Denominators hold the span, so none is
// 0.
fn fill(span: Span, t: real, planes: u32, basis: ptr<private, Basis>) {
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

fn prepare(sample: Sample, span_u: Span, span_v: Span) {
    fill(span_u, ts[sample.row_u], params.planes, &bu);
    fill(span_v, ts[sample.row_v], params.planes, &bv);
}

fn along_u(sample: Sample, degree: u32, plane: u32, column: u32) -> real {
    return bu[plane * PLANE + column];
}

fn along_v(sample: Sample, degree: u32, plane: u32, column: u32) -> real {
    return bv[plane * PLANE + column];
}
