// Functions that passes have left in a buffer.

@group(0) @binding(6) var<storage, read> basis: array<real>;

// A direction without degree (the second of a curve) has one function, 1.
fn function_of(row: Row, degree: u32, plane: u32, column: u32) -> real {
    if degree == 0u {
        return select(real(0), real(1), plane == 0u);
    }
    let half = select(0u, params.half, degree % 2u == 1u);
    return basis[half + row.basis + (plane * (degree + 1u) + column) * row.step];
}

fn prepare(sample: Sample, span_u: Span, span_v: Span) {
}

fn along_u(sample: Sample, degree: u32, plane: u32, column: u32) -> real {
    return function_of(rows[sample.row_u], degree, plane, column);
}

fn along_v(sample: Sample, degree: u32, plane: u32, column: u32) -> real {
    return function_of(rows[sample.row_v], degree, plane, column);
}
