//! Objects: a class by its UUID, and the class' data.

use super::bytes::{Bytes, Res};

const CLASS: u32 = 0x0002_7ffa;
const CLASS_UUID: u32 = 0x0002_fffb;
const CLASS_DATA: u32 = 0x0002_fffc;

/// The classes that are understood, and those that are known to have no shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Brep,
    NurbsCurve,
    LineCurve,
    ArcCurve,
    PolylineCurve,
    PolyCurve,
    NurbsSurface,
    PlaneSurface,
    RevSurface,
    SumSurface,
    Extrusion,
    Mesh,
    SubD,
    InstanceDefinition,
    InstanceRef,
    Layer,
    Point,
    PointCloud,
    Other,
}

/// A UUID as it is written: three little-endian numbers, then eight bytes.
const fn uuid(a: u32, b: u16, c: u16, d: u64) -> [u8; 16] {
    let (a, b, c, d) = (a.to_le_bytes(), b.to_le_bytes(), c.to_le_bytes(), d.to_be_bytes());
    [a[0], a[1], a[2], a[3], b[0], b[1], c[0], c[1], d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7]]
}

const TAIL: u64 = 0xbfe5_0010_8301_22f0;
const OLD: u64 = 0x8000_0010_8301_22f0;

/// Each class with the UUIDs it has had.
const CLASSES: &[([u8; 16], Class)] = &[
    (uuid(0x60b5_dbc5, 0xe660, 0x11d3, 0xbfe4_0010_8301_22f0), Class::Brep),
    (uuid(0x0705_fdef, 0x3e2a, 0x11d4, 0x800e_0010_8301_22f0), Class::Brep),
    (uuid(0x2d4c_fedb, 0x3e2a, 0x11d4, 0x800e_0010_8301_22f0), Class::Brep),
    (uuid(0xf06f_c243, 0xa32a, 0x4608, 0x9dd8_a7d2_c4ce_2a36), Class::Brep),
    (uuid(0x4ed7_d4dd, 0xe947, 0x11d3, TAIL), Class::NurbsCurve),
    (uuid(0x5eaf_1119, 0x0b51, 0x11d4, 0xbffe_0010_8301_22f0), Class::NurbsCurve),
    (uuid(0x76a7_09d5, 0x1550, 0x11d4, OLD), Class::NurbsCurve),
    (uuid(0x4ed7_d4db, 0xe947, 0x11d3, TAIL), Class::LineCurve),
    (uuid(0xcf33_be2a, 0x09b4, 0x11d4, 0xbffb_0010_8301_22f0), Class::ArcCurve),
    (uuid(0x4ed7_d4e6, 0xe947, 0x11d3, TAIL), Class::PolylineCurve),
    (uuid(0x4ed7_d4e0, 0xe947, 0x11d3, TAIL), Class::PolyCurve),
    (uuid(0xef63_8317, 0x154b, 0x11d4, OLD), Class::PolyCurve),
    (uuid(0x4ed7_d4de, 0xe947, 0x11d3, TAIL), Class::NurbsSurface),
    (uuid(0x4760_c817, 0x0be3, 0x11d4, 0xbffe_0010_8301_22f0), Class::NurbsSurface),
    (uuid(0xfa4f_d4b5, 0x1613, 0x11d4, OLD), Class::NurbsSurface),
    (uuid(0x4ed7_d4df, 0xe947, 0x11d3, TAIL), Class::PlaneSurface),
    (uuid(0xa162_20d3, 0x163b, 0x11d4, OLD), Class::RevSurface),
    (uuid(0x0a84_01b6, 0x4d34, 0x4b99, 0x8615_1b4e_723d_c4e5), Class::RevSurface),
    (uuid(0xc4cd_5359, 0x446d, 0x4690, 0x9ff5_2905_9732_472b), Class::SumSurface),
    (uuid(0x665f_6331, 0x2a66, 0x4cce, 0x81d0_b5ee_bd9b_5417), Class::SumSurface),
    (uuid(0x36f5_3175, 0x72b8, 0x4d47, 0xbf1f_b4e6_fc24_f4b9), Class::Extrusion),
    (uuid(0x4ed7_d4e4, 0xe947, 0x11d3, TAIL), Class::Mesh),
    (uuid(0xf09b_a4d9, 0x455b, 0x42c3, 0xba3b_e6cc_acef_853b), Class::SubD),
    (uuid(0x26f8_bff6, 0x2618, 0x417f, 0xa158_153d_64a9_4989), Class::InstanceDefinition),
    (uuid(0xf9cf_b638, 0xb9d4, 0x4340, 0x87e3_c56e_7865_d96a), Class::InstanceRef),
    (uuid(0x9580_9813, 0xe985, 0x11d3, TAIL), Class::Layer),
    (uuid(0xc310_1a1d, 0xf157, 0x11d3, 0xbfe7_0010_8301_22f0), Class::Point),
    (uuid(0x2488_f347, 0xf8fa, 0x11d3, 0xbfec_0010_8301_22f0), Class::PointCloud),
];

impl Class {
    pub(super) fn is_curve(self) -> bool {
        matches!(
            self,
            Class::NurbsCurve | Class::LineCurve | Class::ArcCurve | Class::PolylineCurve | Class::PolyCurve
        )
    }

    pub(super) fn is_surface(self) -> bool {
        matches!(self, Class::NurbsSurface | Class::PlaneSurface | Class::RevSurface | Class::SumSurface)
    }
}

/// Reads an object's class and the bytes of its data; user data behind them is passed over.
pub(super) fn object<'a>(bytes: &mut Bytes<'a>) -> Res<(Class, Bytes<'a>)> {
    let mut body = bytes.chunk_of(CLASS)?;
    let id = body.chunk_of(CLASS_UUID)?.uuid()?;
    let data = body.chunk_of(CLASS_DATA)?;
    let class = CLASSES.iter().find(|(known, _)| *known == id).map_or(Class::Other, |&(_, class)| class);
    Ok((class, data))
}
