// Knots "indexed": rows point to the knots of their span, which all rows of the span share.

alias value = real;

@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(3) var<storage, read> spans: array<Span>;
@group(0) @binding(4) var<storage, read> windows: array<value>;
@group(0) @binding(6) var<storage, read> ts: array<value>;

fn degree_of(row: Row) -> u32 {
    return spans[row.span].degree;
}

fn parameter_of(index: u32, row: Row) -> value {
    return ts[index];
}

fn first_knot(row: Row) -> u32 {
    return spans[row.span].window + 1u;
}
