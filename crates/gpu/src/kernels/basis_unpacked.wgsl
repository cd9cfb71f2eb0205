// One pass of the paper's basis evaluation, "unpacked": every row carries a copy of its parameter and its knots.
// Thread: one column of one row.

@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(3) var<storage, read> spans: array<Span>;
@group(0) @binding(4) var<storage, read> windows: array<real>;
@group(0) @binding(7) var<storage, read_write> basis: array<real>;

fn lower(row: Row, degree: u32, plane: u32, column: u32) -> real {
    if column > degree {
        return real(0);
    }
    if params.level == 1u {
        return select(real(0), real(1), plane == 0u && column == degree);
    }
    let from_half = select(0u, params.half, params.level % 2u == 0u);
    return basis[from_half + row.basis + (plane * (degree + 1u) + column) * row.step];
}

// 0/0 of repeated knots is 0.
fn quotient(a: real, b: real) -> real {
    return select(real(0), a / b, b != real(0));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let column = group.x * 8u + local.x;
    let index = (group.z * params.groups + group.y) * 8u + local.y;
    if index >= params.rows {
        return;
    }
    let row = rows[index];
    let span = spans[row.span];
    let degree = span.degree;
    let level = params.level;
    if column > degree || level > degree {
        return;
    }
    let t = windows[row.window];
    let knot = row.window + 1u + column;
    let left = windows[knot + level] - windows[knot];
    let right = windows[knot + level + 1u] - windows[knot + 1u];
    let to_half = select(0u, params.half, level % 2u == 1u);
    let at = to_half + row.basis + column * row.step;
    let a = quotient(t - windows[knot], left);
    let b = quotient(windows[knot + level + 1u] - t, right);
    basis[at] = a * lower(row, degree, 0u, column) + b * lower(row, degree, 0u, column + 1u);
    for (var order = 1u; order < params.planes; order++) {
        if order + level <= degree {
            continue;
        }
        // The plane starts as a copy of the functions themselves, as many levels before the last as its order.
        let plane = select(order, 0u, order + level == degree + 1u);
        let slope_a = quotient(lower(row, degree, plane, column), left);
        let slope_b = quotient(lower(row, degree, plane, column + 1u), right);
        basis[at + order * (degree + 1u) * row.step] = real(level) * (slope_a - slope_b);
    }
}
