// From a thread to the point it evaluates.

@group(0) @binding(0) var<storage, read> heads: array<Head>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(3) var<storage, read> spans: array<Span>;
@group(0) @binding(4) var<storage, read> windows: array<real>;
@group(0) @binding(5) var<storage, read> net: array<real4>;
@group(0) @binding(7) var<storage, read_write> out: array<real>;

struct Sample { head: u32, row_u: u32, row_v: u32, at: u32, valid: bool }

fn sample_of(group: vec3<u32>, local: u32) -> Sample {
    let index = params.tile0 + group.y * params.groups + group.x;
    if index >= params.rows {
        return Sample(0u, 0u, 0u, 0u, false);
    }
    let tile = tiles[index];
    let head = heads[tile.head];
    if head.paired == 1u {
        let i = tile.i + local;
        return Sample(tile.head, head.row_u + i, head.row_v + i, head.first - params.out0 + i, i < head.width);
    }
    let i = tile.i + local / 8u;
    let j = tile.j + local % 8u;
    let at = head.first - params.out0 + i * head.height + j;
    return Sample(tile.head, head.row_u + i, head.row_v + j, at, i < head.width && j < head.height);
}

// The homogeneous derivatives of a surface by the parameters of its span, number of derivatives by u, then by
// v.
struct Jet { h00: real4, h01: real4, h02: real4, h10: real4, h11: real4, h20: real4 }

fn write3(at: u32, x: real3) {
    out[at] = x.x;
    out[at + 1u] = x.y;
    out[at + 2u] = x.z;
}

fn write_point(sample: Sample, h: real4) {
    write3(sample.at * 3u, h.xyz * (real(1) / h.w));
}

// Point and unit normal.
fn write_normal(sample: Sample, t: Tangents) {
    write3(sample.at * 6u, t.p);
    write3(sample.at * 6u + 3u, unit_normal(t, DEGENERATE));
}

// Point, first derivatives, unit normal (0 where the derivatives are parallel).
fn write_first(sample: Sample, t: Tangents) {
    let inverse_u = windows[spans[rows[sample.row_u].span].window];
    let inverse_v = windows[spans[rows[sample.row_v].span].window];
    let at = sample.at * select(12u, 21u, params.planes == 3u);
    write3(at, t.p);
    write3(at + 3u, t.du * inverse_u);
    write3(at + 6u, t.dv * inverse_v);
    write3(at + 9u, unit_normal(t, DEGENERATE));
}

// The same and, where `planes` is 3, second derivatives.
fn write_jet(sample: Sample, jet: Jet) {
    let t = tangents_of(jet.h00, jet.h10, jet.h01);
    write_first(sample, t);
    if params.planes == 3u {
        let inverse_u = windows[spans[rows[sample.row_u].span].window];
        let inverse_v = windows[spans[rows[sample.row_v].span].window];
        let at = sample.at * 21u;
        let by_w = real(1) / jet.h00.w;
        let duu = (jet.h20.xyz - t.du * (jet.h10.w + jet.h10.w) - t.p * jet.h20.w) * by_w;
        let duv = (jet.h11.xyz - t.du * jet.h01.w - t.dv * jet.h10.w - t.p * jet.h11.w) * by_w;
        let dvv = (jet.h02.xyz - t.dv * (jet.h01.w + jet.h01.w) - t.p * jet.h02.w) * by_w;
        write3(at + 12u, duu * (inverse_u * inverse_u));
        write3(at + 15u, duv * (inverse_u * inverse_v));
        write3(at + 18u, dvv * (inverse_v * inverse_v));
    }
}
