// Every span's Bézier net, cell by cell. Thread: one point.

@group(0) @binding(6) var<storage, read> ts: array<real>;

fn cell_of(sample: Sample) -> Cell {
    let head = heads[sample.head];
    let span_u = spans[rows[sample.row_u].span];
    let span_v = spans[rows[sample.row_v].span];
    let p = span_u.degree;
    let q = span_v.degree;
    let at = head.bezier + (span_u.cell * head.cells_v + span_v.cell) * (p + 1u) * (q + 1u);
    return Cell(at, p, q, ts[sample.row_u], ts[sample.row_v]);
}

@compute @workgroup_size(64)
fn points(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let cell = cell_of(sample);
    var sum = start_horner();
    for (var i = 0u; i <= cell.p; i++) {
        let line = line_of(cell.at + i * (cell.q + 1u), cell.q, cell.t_v, 1u);
        sum = horner(sum, line.d0, i, cell.p, cell.t_u);
    }
    write_point(sample, sum.sum);
}

@compute @workgroup_size(64)
fn normals(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    write_normal(sample, tangents_at(cell_of(sample)));
}

@compute @workgroup_size(64)
fn jets(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let sample = sample_of(group, local);
    if !sample.valid {
        return;
    }
    let cell = cell_of(sample);
    if params.planes == 2u {
        write_first(sample, tangents_at(cell));
        return;
    }
    let p = cell.p;
    let t = cell.t_u;
    let zero = real4(real(0), real(0), real(0), real(0));
    var h00 = start_horner();
    var h01 = start_horner();
    var h02 = start_horner();
    var h10 = start_horner();
    var h11 = start_horner();
    var h20 = start_horner();
    var last = Line(zero, zero, zero);
    var before = last;
    for (var i = 0u; i <= p; i++) {
        let line = line_of(cell.at + i * (cell.q + 1u), cell.q, cell.t_v, 3u);
        h00 = horner(h00, line.d0, i, p, t);
        h01 = horner(h01, line.d1, i, p, t);
        h02 = horner(h02, line.d2, i, p, t);
        if i > 0u {
            h10 = horner(h10, line.d0 - last.d0, i - 1u, p - 1u, t);
            h11 = horner(h11, line.d1 - last.d1, i - 1u, p - 1u, t);
        }
        if i > 1u {
            h20 = horner(h20, (line.d0 - last.d0) - (last.d0 - before.d0), i - 2u, p - 2u, t);
        }
        before = last;
        last = line;
    }
    let first = real(p);
    let second = select(real(0), real(p) * real(max(p, 1u) - 1u), p > 1u);
    write_jet(sample, Jet(h00.sum, h01.sum, h02.sum, h10.sum * first, h11.sum * first, h20.sum * second));
}
