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

// The homogeneous derivatives of a surface by the parameters of its span, number of derivatives by u, then by v.
struct Jet { h00: real4, h01: real4, h02: real4, h10: real4, h11: real4, h20: real4 }

fn write3(at: u32, x: real3) {
    out[at] = x.x;
    out[at + 1u] = x.y;
    out[at + 2u] = x.z;
}

fn write_point(sample: Sample, h: real4) {
    write3(sample.at * 3u, h.xyz * (real(1) / h.w));
}

// Point, first derivatives, unit normal (0 where the derivatives are parallel) and, where `planes` is 3, second derivatives.
fn write_jet(sample: Sample, jet: Jet) {
    let by_w = real(1) / jet.h00.w;
    let p = jet.h00.xyz * by_w;
    let du = (jet.h10.xyz - p * jet.h10.w) * by_w;
    let dv = (jet.h01.xyz - p * jet.h01.w) * by_w;
    // By the span's parameters, so that no knot interval, however short, under- or overflows the product.
    let n = real3(du.y * dv.z - du.z * dv.y, du.z * dv.x - du.x * dv.z, du.x * dv.y - du.y * dv.x);
    let squared = n.x * n.x + n.y * n.y + n.z * n.z;
    var normal = real3(real(0), real(0), real(0));
    let longest = max(du.x * du.x + du.y * du.y + du.z * du.z, dv.x * dv.x + dv.y * dv.y + dv.z * dv.z);
    // At a pole what should be 0 is rounding, and a direction made of that is none.
    if squared > DEGENERATE * longest * longest {
        normal = n * (real(1) / sqrt(squared));
    }
    let inverse_u = windows[spans[rows[sample.row_u].span].window];
    let inverse_v = windows[spans[rows[sample.row_v].span].window];
    let stride = select(12u, 21u, params.planes == 3u);
    let at = sample.at * stride;
    write3(at, p);
    write3(at + 3u, du * inverse_u);
    write3(at + 6u, dv * inverse_v);
    write3(at + 9u, normal);
    if params.planes == 3u {
        let duu = (jet.h20.xyz - du * (jet.h10.w + jet.h10.w) - p * jet.h20.w) * by_w;
        let duv = (jet.h11.xyz - du * jet.h01.w - dv * jet.h10.w - p * jet.h11.w) * by_w;
        let dvv = (jet.h02.xyz - dv * (jet.h01.w + jet.h01.w) - p * jet.h02.w) * by_w;
        write3(at + 12u, duu * (inverse_u * inverse_u));
        write3(at + 15u, duv * (inverse_u * inverse_v));
        write3(at + 18u, dvv * (inverse_v * inverse_v));
    }
}
