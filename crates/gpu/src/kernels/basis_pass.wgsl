// One pass of the paper's basis evaluation, from one degree to the next. Thread: one column of one row.
//
// The text after this one defines how rows store their knots: `value` is what one row holds in one column (a
// number, or a vector of four rows at once), `rows` and `windows` are its buffers, and `degree_of`,
// `parameter_of`, `first_knot` its access.

@group(0) @binding(7) var<storage, read_write> basis: array<value>;

fn lower(row: Row, degree: u32, plane: u32, column: u32) -> value {
    if column > degree {
        return value(real(0));
    }
    if params.level == 1u {
        return value(select(real(0), real(1), plane == 0u && column == degree));
    }
    let from_half = select(0u, params.half, params.level % 2u == 0u);
    return basis[from_half + row.basis + (plane * (degree + 1u) + column) * row.step];
}

// 0/0 of repeated knots is 0, in each lane by itself.
fn quotient(a: value, b: value) -> value {
    let zero = value(real(0));
    return select(zero, a / b, b != zero);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let column = group.x * 8u + local.x;
    let index = (group.z * params.groups + group.y) * 8u + local.y;
    if index >= params.rows {
        return;
    }
    let row = rows[index];
    let degree = degree_of(row);
    let level = params.level;
    if column > degree || level > degree {
        return;
    }
    let t = parameter_of(index, row);
    let knot = first_knot(row) + column;
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
        // The plane starts as a copy of the functions themselves, as many levels before the last as its
        // order.
        let plane = select(order, 0u, order + level == degree + 1u);
        let slope_a = quotient(lower(row, degree, plane, column), left);
        let slope_b = quotient(lower(row, degree, plane, column + 1u), right);
        basis[at + order * (degree + 1u) * row.step] = (slope_a - slope_b) * real(level);
    }
}
