// Finds the knot span of every parameter value on the device, by bisection, and the place within it.
// Thread: one row. `window` of an incoming row is its direction.

// One direction of one surface: its distinct knots, the first of its spans, and their number.
struct Direction { breaks: u32, span: u32, count: u32, spare: u32 }

@group(0) @binding(0) var<storage, read> directions: array<Direction>;
@group(0) @binding(1) var<storage, read> breaks: array<real>;
@group(0) @binding(2) var<storage, read_write> rows: array<Row>;
@group(0) @binding(5) var<storage, read> parameters: array<real>;
@group(0) @binding(7) var<storage, read_write> ts: array<real>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * params.groups + group.x) * 64u + local;
    if index >= params.rows {
        return;
    }
    let direction = directions[rows[index].window];
    let t = parameters[index];
    var low = 0u;
    var high = direction.count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if breaks[direction.breaks + middle] <= t {
            low = middle;
        } else {
            high = middle;
        }
    }
    let start = breaks[direction.breaks + low];
    let end = breaks[direction.breaks + low + 1u];
    rows[index].span = direction.span + low;
    ts[index] = min(max((t - start) / (end - start), real(0)), real(1));
}
