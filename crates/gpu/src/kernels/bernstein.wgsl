// Every span's Bézier net, summed by Horner's rule for Bernstein polynomials: no knots, no memory of its own, only
// positive terms. `net` holds the Bézier control points, cell by cell. Thread: one point.

@group(0) @binding(6) var<storage, read> ts: array<real>;

// The terms of one difference of order k: its running sum and C(n-k, i) t^i.
struct Horner { sum: real4, term: real }

fn horner(h: Horner, value: real4, i: u32, n: u32, t: real) -> Horner {
    let sum = h.sum * (real(1) - t) + value * h.term;
    return Horner(sum, h.term * t * real(n - i) / real(i + 1u));
}

fn start_horner() -> Horner {
    return Horner(real4(real(0), real(0), real(0), real(0)), real(1));
}

// One line of a net along v: value and first two derivatives.
struct Line { d0: real4, d1: real4, d2: real4 }

fn line_of(start: u32, q: u32, t: real, planes: u32) -> Line {
    var h0 = start_horner();
    var h1 = start_horner();
    var h2 = start_horner();
    var last = real4(real(0), real(0), real(0), real(0));
    var before = last;
    for (var j = 0u; j <= q; j++) {
        let b = net[start + j];
        h0 = horner(h0, b, j, q, t);
        if planes > 1u && j > 0u {
            h1 = horner(h1, b - last, j - 1u, q - 1u, t);
        }
        if planes > 2u && j > 1u {
            h2 = horner(h2, (b - last) - (last - before), j - 2u, q - 2u, t);
        }
        before = last;
        last = b;
    }
    // Unsigned: at degree 0 the product below is of nothing.
    let second = select(real(0), real(q) * real(max(q, 1u) - 1u), q > 1u);
    return Line(h0.sum, h1.sum * real(q), h2.sum * second);
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
    let p = span_u.degree;
    let q = span_v.degree;
    let t = ts[sample.row_u];
    let cell = head.bezier + (span_u.cell * head.cells_v + span_v.cell) * (p + 1u) * (q + 1u);
    var sum = start_horner();
    for (var i = 0u; i <= p; i++) {
        let line = line_of(cell + i * (q + 1u), q, ts[sample.row_v], 1u);
        sum = horner(sum, line.d0, i, p, t);
    }
    write_point(sample, sum.sum);
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
    let p = span_u.degree;
    let q = span_v.degree;
    let t = ts[sample.row_u];
    let cell = head.bezier + (span_u.cell * head.cells_v + span_v.cell) * (p + 1u) * (q + 1u);
    let zero = real4(real(0), real(0), real(0), real(0));
    var h00 = start_horner();
    var h01 = start_horner();
    var h02 = start_horner();
    var h10 = start_horner();
    var h11 = start_horner();
    var h20 = start_horner();
    var last = Line(zero, zero, zero);
    var before = last;
    for (var i = 0u; i <= p; i++) {
        let line = line_of(cell + i * (q + 1u), q, ts[sample.row_v], params.planes);
        h00 = horner(h00, line.d0, i, p, t);
        h01 = horner(h01, line.d1, i, p, t);
        h02 = horner(h02, line.d2, i, p, t);
        if i > 0u {
            h10 = horner(h10, line.d0 - last.d0, i - 1u, p - 1u, t);
            h11 = horner(h11, line.d1 - last.d1, i - 1u, p - 1u, t);
        }
        if i > 1u {
            h20 = horner(h20, (line.d0 - last.d0) - (last.d0 - before.d0), i - 2u, p - 2u, t);
        }
        before = last;
        last = line;
    }
    let first = real(p);
    let second = select(real(0), real(p) * real(max(p, 1u) - 1u), p > 1u);
    write_jet(sample, Jet(h00.sum, h01.sum, h02.sum, h10.sum * first, h11.sum * first, h20.sum * second));
}
