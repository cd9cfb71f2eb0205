//! The header: which schema the file follows.

use super::text;
use memchr::memmem;

/// "STEP AP214 …" from FILE_SCHEMA, as far as it is known.
pub(crate) fn schema(head: &[u8]) -> String {
    let name = memmem::find(head, b"FILE_SCHEMA").and_then(|at| {
        let rest = &head[at..];
        let start = rest.iter().position(|&b| b == b'\'')? + 1;
        let length = rest[start..].iter().position(|&b| b == b'\'')?;
        Some(text::decode(&rest[start..start + length]))
    });
    let Some(name) = name else { return "STEP".to_owned() };
    let upper = name.to_ascii_uppercase();
    let protocol = if upper.starts_with("AP242") {
        "AP242 "
    } else if upper.starts_with("AUTOMOTIVE_DESIGN") {
        "AP214 "
    } else if upper.starts_with("CONFIG_CONTROL_DESIGN")
        || upper.starts_with("AP203")
        || upper.starts_with("CCD_CLA")
    {
        "AP203 "
    } else {
        ""
    };
    format!("STEP {protocol}{}", name.trim())
}
