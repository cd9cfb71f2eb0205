// One Bézier net, summed by Horner's rule for Bernstein polynomials: no knots, no memory of its own, only
// positive terms. `net`, which the text after this one binds, holds the control points, line by line along v.

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

// One span of a surface: its first control point, its degrees, and a place in it.
struct Cell { at: u32, p: u32, q: u32, t_u: real, t_v: real }

// Two sums of one degree less over neighbouring terms: between them lies the value, and from one to the other
// goes the derivative.
struct Pair { low: real4, high: real4, term: real }

fn start_pair() -> Pair {
    let zero = real4(real(0), real(0), real(0), real(0));
    return Pair(zero, zero, real(1));
}

// The terms i and i + 1 of n.
fn pair(h: Pair, low: real4, high: real4, i: u32, n: u32, t: real) -> Pair {
    let s = real(1) - t;
    let term = h.term * t * real(n - 1u - i) / real(i + 1u);
    return Pair(h.low * s + low * h.term, h.high * s + high * h.term, term);
}

fn value_of(h: Pair, t: real) -> real4 {
    return h.low * (real(1) - t) + h.high * t;
}

// One line of a net along v: value and derivative.
struct Slope { d0: real4, d1: real4 }

fn slope_of(start: u32, q: u32, t: real) -> Slope {
    var last = net[start];
    if q == 0u {
        return Slope(last, real4(real(0), real(0), real(0), real(0)));
    }
    var h = start_pair();
    for (var j = 0u; j < q; j++) {
        let next = net[start + j + 1u];
        h = pair(h, last, next, j, q, t);
        last = next;
    }
    return Slope(value_of(h, t), (h.high - h.low) * real(q));
}

// Point and first derivatives by the span's parameters. A net has at least two lines.
fn tangents_at(cell: Cell) -> Tangents {
    let t = cell.t_u;
    var h0 = start_pair();
    var h1 = start_pair();
    var last = slope_of(cell.at, cell.q, cell.t_v);
    for (var i = 0u; i < cell.p; i++) {
        let next = slope_of(cell.at + (i + 1u) * (cell.q + 1u), cell.q, cell.t_v);
        h0 = pair(h0, last.d0, next.d0, i, cell.p, t);
        h1 = pair(h1, last.d1, next.d1, i, cell.p, t);
        last = next;
    }
    return tangents_of(value_of(h0, t), (h0.high - h0.low) * real(cell.p), value_of(h1, t));
}
