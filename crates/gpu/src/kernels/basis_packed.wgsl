// One pass of the paper's basis evaluation, "packed": four parameter values of one direction of one surface, each with
// its own copy of its knots, are the four lanes of a vector. Thread: one column of one pack.

@group(0) @binding(2) var<storage, read> packs: array<Row>;
@group(0) @binding(4) var<storage, read> windows: array<real4>;
@group(0) @binding(7) var<storage, read_write> basis: array<real4>;

// Of a pack: `span` is its degree, `window` and `basis` count vectors.
fn lower(pack: Row, plane: u32, column: u32) -> real4 {
    let zero = real4(real(0), real(0), real(0), real(0));
    if column > pack.span {
        return zero;
    }
    if params.level == 1u {
        let one = real4(real(1), real(1), real(1), real(1));
        return select(zero, one, plane == 0u && column == pack.span);
    }
    let from_half = select(0u, params.half, params.level % 2u == 0u);
    return basis[from_half + pack.basis + plane * (pack.span + 1u) + column];
}

// 0/0 of repeated knots is 0, in each lane by itself.
fn quotient(a: real4, b: real4) -> real4 {
    let zero = real4(real(0), real(0), real(0), real(0));
    return select(zero, a / b, b != zero);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let column = group.x * 8u + local.x;
    let index = (group.z * params.groups + group.y) * 8u + local.y;
    if index >= params.rows {
        return;
    }
    let pack = packs[index];
    let degree = pack.span;
    let level = params.level;
    if column > degree || level > degree {
        return;
    }
    let t = windows[pack.window];
    let knot = pack.window + 1u + column;
    let left = windows[knot + level] - windows[knot];
    let right = windows[knot + level + 1u] - windows[knot + 1u];
    let to_half = select(0u, params.half, level % 2u == 1u);
    let at = to_half + pack.basis + column;
    let a = quotient(t - windows[knot], left);
    let b = quotient(windows[knot + level + 1u] - t, right);
    basis[at] = a * lower(pack, 0u, column) + b * lower(pack, 0u, column + 1u);
    for (var order = 1u; order < params.planes; order++) {
        if order + level <= degree {
            continue;
        }
        let plane = select(order, 0u, order + level == degree + 1u);
        let slope_a = quotient(lower(pack, plane, column), left);
        let slope_b = quotient(lower(pack, plane, column + 1u), right);
        basis[at + order * (degree + 1u)] = (slope_a - slope_b) * real(level);
    }
}
