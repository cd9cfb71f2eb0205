// Knots "unpacked": every row carries a copy of its parameter and its knots.

alias value = real;

@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(3) var<storage, read> spans: array<Span>;
@group(0) @binding(4) var<storage, read> windows: array<value>;

fn degree_of(row: Row) -> u32 {
    return spans[row.span].degree;
}

fn parameter_of(index: u32, row: Row) -> value {
    return windows[row.window];
}

fn first_knot(row: Row) -> u32 {
    return row.window + 1u;
}
