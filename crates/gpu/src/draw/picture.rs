//! Pictures: sRGB pixels with opacity, to PNG and back, and how different two look.

use crate::error::GpuError;
use std::io::Cursor;

/// Rows of pixels from the top, red, green, blue and opacity, not premultiplied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The pixels, row by row.
    pub pixels: Vec<[u8; 4]>,
}

impl Picture {
    /// As a PNG file.
    ///
    /// # Errors
    /// [`GpuError::Png`] for a picture without pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, GpuError> {
        let fail = |e: png::EncodingError| GpuError::Png(e.to_string());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let opaque = self.pixels.iter().all(|p| p[3] == 255);
        encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
        let mut writer = encoder.write_header().map_err(fail)?;
        let data: Vec<u8> = match opaque {
            true => self.pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect(),
            false => self.pixels.iter().flatten().copied().collect(),
        };
        writer.write_image_data(&data).map_err(fail)?;
        writer.finish().map_err(fail)?;
        Ok(bytes)
    }

    /// From a PNG file as [`Self::to_png`] writes it.
    ///
    /// # Errors
    /// [`GpuError::Png`] and [`GpuError::PixelFormat`] for other bytes.
    pub fn from_png(bytes: &[u8]) -> Result<Self, GpuError> {
        let fail = |e: png::DecodingError| GpuError::Png(e.to_string());
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(fail)?;
        let size = reader.output_buffer_size().ok_or(GpuError::Png("too large".into()))?;
        let mut data = vec![0; size];
        let info = reader.next_frame(&mut data).map_err(fail)?;
        data.truncate(info.buffer_size());
        let pixels = match (info.color_type, info.bit_depth) {
            (png::ColorType::Rgb, png::BitDepth::Eight) => {
                data.chunks_exact(3).map(|p| [p[0], p[1], p[2], 255]).collect()
            }
            (png::ColorType::Rgba, png::BitDepth::Eight) => {
                data.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect()
            }
            _ => return Err(GpuError::PixelFormat),
        };
        Ok(Self { width: info.width, height: info.height, pixels })
    }

    /// How different two pictures of one size look: for every pixel the smallest difference of colour
    /// (largest channel, 0..=255) to any pixel of the other within one pixel, both ways. What moved by a
    /// pixel is the same.
    ///
    /// Returns the share of pixels that differ by more than `threshold`; 1 where the sizes differ.
    pub fn difference(&self, other: &Self, threshold: u8) -> f64 {
        if (self.width, self.height) != (other.width, other.height) || self.pixels.is_empty() {
            return 1.0;
        }
        let off = self.unlike(other, threshold).max(other.unlike(self, threshold));
        off as f64 / self.pixels.len() as f64
    }

    fn unlike(&self, other: &Self, threshold: u8) -> usize {
        let (w, h) = (self.width as i64, self.height as i64);
        let near = |x: i64, y: i64| {
            let pixel = self.pixels[(y * w + x) as usize];
            (-1..=1).any(|dy| {
                (-1..=1).any(|dx| {
                    let (x, y) = (x + dx, y + dy);
                    x >= 0
                        && y >= 0
                        && x < w
                        && y < h
                        && pixel
                            .iter()
                            .zip(other.pixels[(y * w + x) as usize])
                            .all(|(a, b)| a.abs_diff(b) <= threshold)
                })
            })
        };
        (0..h).map(|y| (0..w).filter(|&x| !near(x, y)).count()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_keeps_every_pixel() {
        for opaque in [true, false] {
            let pixels = (0..35_u8).map(|i| [i, 3 * i, 255 - i, if opaque { 255 } else { 7 * i }]).collect();
            let picture = Picture { width: 7, height: 5, pixels };
            assert_eq!(Picture::from_png(&picture.to_png().unwrap()).unwrap(), picture);
        }
        assert!(Picture::from_png(b"no picture").is_err());
    }

    /// A line moved by one pixel is no difference, by two it is; a missing line is one.
    #[test]
    fn differences_are_seen_beyond_one_pixel() {
        let line = |at: u32| {
            let pixels = (0..400).map(|i| if i % 20 == at { [0, 0, 0, 255] } else { [255; 4] }).collect();
            Picture { width: 20, height: 20, pixels }
        };
        assert_eq!(line(5).difference(&line(6), 10), 0.0);
        assert!(line(5).difference(&line(8), 10) >= 0.05);
        assert!(line(5).difference(&line(99), 10) >= 0.05);
    }
}
