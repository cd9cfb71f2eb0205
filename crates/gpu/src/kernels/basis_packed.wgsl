// Knots "packed": four parameter values of one direction of one surface, each with its own copy of its knots,
// are the four lanes of a vector. A row is such a pack: `span` is its degree, `window` and `basis` count
// vectors.

alias value = real4;

@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(4) var<storage, read> windows: array<value>;

fn degree_of(row: Row) -> u32 {
    return row.span;
}

fn parameter_of(index: u32, row: Row) -> value {
    return windows[row.window];
}

fn first_knot(row: Row) -> u32 {
    return row.window + 1u;
}
