//! Recognises files of triangles, which no reader reads, for a message of their own.

/// The bytes of a binary STL before its triangles, and of each triangle.
const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;

/// The name of the mesh format that the content is of, if it is one.
pub(crate) fn format_of(bytes: &[u8]) -> Option<&'static str> {
    let text = bytes.trim_ascii_start();
    if bytes.starts_with(b"glTF") {
        Some("GLB")
    } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        Some("PLY")
    } else if is_binary_stl(bytes) || (text.starts_with(b"solid") && has(text, b"facet")) {
        Some("STL")
    } else if text.starts_with(b"<?xml") && has(text, b"schemas.openxmlformats.org") {
        // The first file of the archive that a 3MF file is.
        Some("3MF")
    } else {
        None
    }
}

fn is_binary_stl(bytes: &[u8]) -> bool {
    let Some(&[a, b, c, d]) = bytes.get(STL_HEADER - 4..STL_HEADER) else { return false };
    let triangles = u32::from_le_bytes([a, b, c, d]) as usize;
    triangles.checked_mul(STL_TRIANGLE).and_then(|n| n.checked_add(STL_HEADER)) == Some(bytes.len())
}

/// Whether a word occurs near the beginning.
fn has(text: &[u8], word: &[u8]) -> bool {
    text[..text.len().min(1024)].windows(word.len()).any(|found| found == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_are_told_from_other_files() {
        let mut stl = vec![0; STL_HEADER + 2 * STL_TRIANGLE];
        stl[STL_HEADER - 4] = 2;
        assert_eq!(format_of(&stl), Some("STL"));
        stl.push(0);
        assert_eq!(format_of(&stl), None);
        assert_eq!(format_of(b"solid a\n facet normal 0 0 1\n"), Some("STL"));
        assert_eq!(format_of(b"solid ground, no facts"), None);
        assert_eq!(format_of(b"ply\nformat ascii 1.0\n"), Some("PLY"));
        assert_eq!(format_of(b"glTF\x02\0\0\0"), Some("GLB"));
        assert_eq!(format_of(b""), None);
    }
}
