//! Trim textures against the exact test of the same loops.

use super::*;
use crate::error::Resource;
use crate::evaluate::read_back;
use crate::faces::inside::{TrimTable, inside};
use crate::test_support::{gpu, no_gpu};
use chordal_nurbs::math;
use glam::DVec2;

/// A circle of four quarters.
fn circle(middle: DVec2, radius: f64) -> Vec<Cubic> {
    let k = 0.552_284_749_831 * radius;
    let axis = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    (0..4)
        .map(|i| {
            let (a, b) = (axis[i], axis[(i + 1) % 4]);
            Cubic::new([a * radius, a * radius + b * k, b * radius + a * k, b * radius].map(|p| middle + p))
        })
        .collect()
}

fn polygon(corners: &[[f64; 2]]) -> Vec<Cubic> {
    let n = corners.len();
    (0..n).map(|i| Cubic::line(DVec2::from(corners[i]), DVec2::from(corners[(i + 1) % n]))).collect()
}

/// Holes within holes, a concave polygon with a notch that reaches past the others, a star that crosses
/// itself, and circles in a row: what GLU gets wrong among them.
fn zoo() -> Vec<Vec<Cubic>> {
    let middle = DVec2::splat(0.5);
    let star: Vec<[f64; 2]> = (0..5)
        .map(|k| {
            (middle + 0.48 * math::direction(4.0 * std::f64::consts::PI * f64::from(k) / 5.0)).to_array()
        })
        .collect();
    let mut found = vec![
        [0.48, 0.3, 0.1].into_iter().flat_map(|r| circle(middle, r)).collect(),
        polygon(&[[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.5, 0.3], [0.5, 0.7], [0.3, 0.3], [0.1, 0.9]]),
        polygon(&star),
        (0..3).flat_map(|k| circle(DVec2::new(0.2 + 0.3 * f64::from(k), 0.4), 0.12)).collect(),
    ];
    for k in 0..20 {
        found.push(circle(middle, 0.02 * f64::from(k + 1)));
    }
    found
}

/// Every texel that no curve comes near is what the exact test says, in every channel and on every layer.
#[test]
fn textures_hold_what_the_exact_test_says() {
    if no_gpu() {
        return;
    }
    let gpu = gpu();
    let loops = zoo();
    let mut first = 0;
    let mut cubics: Vec<[f32; 4]> = Vec::new();
    let mut faces = Vec::new();
    for (k, of_face) in loops.iter().enumerate() {
        let texels = [200.0 - 7.0 * k as f64, 150.0 + 3.0 * k as f64];
        faces.push(Trimmed { texels, loops: of_face, first });
        first += of_face.len() as u32;
        cubics.extend(of_face.iter().flat_map(Cubic::as_f32));
    }
    let cubics = storage(gpu, Resource::Loops, &cubics).unwrap();
    let drawn = TrimTextures::new(gpu).draw(gpu, &faces, &cubics).unwrap();
    let layers = drawn.texture.depth_or_array_layers();
    assert!(drawn.slots.iter().map(|s| s.channel).max() == Some(3));
    let texels: Vec<Vec<u8>> = (0..layers).map(|layer| texels_of(gpu, &drawn.texture, layer)).collect();
    let mut asked = 0;
    for (slot, of_face) in drawn.slots.iter().zip(&loops) {
        let mut table = TrimTable::default();
        let range = table.push(of_face);
        let [w, h] = slot.size.map(f64::from);
        let is_in = |x: f64, y: f64| inside(&table, range, [(x / w) as f32, (y / h) as f32]);
        for y in 0..slot.size[1] {
            for x in 0..slot.size[0] {
                let (cx, cy) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let near = |k: i32| f64::from(k) / 4.0;
                let answers: Vec<bool> =
                    (0..81).map(|k| is_in(cx + near(k % 9 - 4), cy + near(k / 9 - 4))).collect();
                if answers.iter().any(|a| *a != answers[0]) {
                    continue;
                }
                asked += 1;
                let at = 4 * ((slot.at[1] + y) * drawn.page + slot.at[0] + x) + slot.channel;
                let found = texels[slot.layer as usize][at as usize];
                assert_eq!(found, if answers[0] { 255 } else { 0 }, "{x} {y} of {slot:?}");
            }
        }
    }
    assert!(asked > 100_000, "{asked}");
}

fn texels_of(gpu: &Gpu, texture: &wgpu::Texture, layer: u32) -> Vec<u8> {
    let (width, height) = (texture.width(), texture.height());
    let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = u64::from(row) * u64::from(height);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            ..texture.as_image_copy()
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    let read = read_back(gpu, &buffer, bytes).unwrap();
    read.chunks_exact(row as usize).flat_map(|line| line[..4 * width as usize].to_vec()).collect()
}

#[test]
fn rectangles_share_no_texel_and_stay_on_their_page() {
    let sizes: Vec<[u32; 2]> = (0..300).map(|k| [1 + 37 * k % 90, 1 + 53 * k % 70]).collect();
    let (planes, slots) = pack(&sizes, 128);
    let mut taken = vec![false; (planes * 128 * 128) as usize];
    for (slot, size) in slots.iter().zip(&sizes) {
        assert_eq!(slot.size, *size);
        for y in slot.at[1]..slot.at[1] + size[1] {
            for x in slot.at[0]..slot.at[0] + size[0] {
                let cell = &mut taken[(((4 * slot.layer + slot.channel) * 128 + y) * 128 + x) as usize];
                assert!(x < 128 && y < 128 && !std::mem::replace(cell, true));
            }
        }
    }
}

#[test]
fn too_much_is_packed_at_lower_resolution() {
    let (page, layers, slots) = pack_within(&vec![[2000.0, 2000.0]; 100], 2048, 4);
    assert!(page <= 2048 && layers <= 4 && slots.iter().all(|s| s.size[0] >= 500));
}
