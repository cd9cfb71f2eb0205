// From homogeneous derivatives to the point, its tangents and the normal between them.

struct Tangents { p: real3, du: real3, dv: real3 }

// Of a point and its first derivatives by the parameters of the span.
fn tangents_of(h00: real4, h10: real4, h01: real4) -> Tangents {
    let by_w = real(1) / h00.w;
    let p = h00.xyz * by_w;
    return Tangents(p, (h10.xyz - p * h10.w) * by_w, (h01.xyz - p * h01.w) * by_w);
}

// The unit vector along du × dv; 0 where its square is less than `least` of the longer one's fourth power: at
// a pole what should be 0 is rounding, and a direction made of that is none.
//
// Given by the span's parameters, no knot interval, however short, under- or overflows the product.
fn unit_normal(t: Tangents, least: real) -> real3 {
    let du = t.du;
    let dv = t.dv;
    let n = real3(du.y * dv.z - du.z * dv.y, du.z * dv.x - du.x * dv.z, du.x * dv.y - du.y * dv.x);
    let squared = n.x * n.x + n.y * n.y + n.z * n.z;
    let longest = max(du.x * du.x + du.y * du.y + du.z * du.z, dv.x * dv.x + dv.y * dv.y + dv.z * dv.z);
    if squared > least * longest * longest {
        return n * (real(1) / sqrt(squared));
    }
    return real3(real(0), real(0), real(0));
}
