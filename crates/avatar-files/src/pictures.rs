//! Pictures of avatar files (PNG, JPEG) to the textures that travel: JPEG, at most 2048 pixels.

use mimique_avatar::{Image, MOST_TEXTURE_SIDE, Texture};

/// Longest side of a picture that is read.
const MOST_SIDE: usize = 16_384;
/// Quality of the JPEG files made here, and of the masks.
const QUALITY: u8 = 90;

/// What the bytes of a picture are.
pub(crate) enum Picture {
    /// A PNG or JPEG file.
    Read(Texture),
    /// Something else.
    Unknown,
}

/// Reads a picture; with `open` its alpha opens the surface. A JPEG file of moderate size travels
/// as it is.
pub(crate) fn picture_of(bytes: &[u8], open: bool) -> Result<Picture, String> {
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return texture_of(png(bytes)?, open).map(Picture::Read);
    }
    if !bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        return Ok(Picture::Unknown);
    }
    // The end marker, perhaps before some padding: decoders forgive its absence, and show grey.
    if !bytes.windows(2).rev().take(4096).any(|pair| pair == [0xff, 0xd9]) {
        return Err(format!("a JPEG picture that ends after {} bytes", bytes.len()));
    }
    let image = Image::of_jpeg(bytes, MOST_SIDE).map_err(|e| e.0)?;
    if image.width.max(image.height) <= MOST_TEXTURE_SIDE {
        return Ok(Picture::Read(Texture { jpeg: bare(bytes), mask_jpeg: Vec::new() }));
    }
    texture_of(image, false).map(Picture::Read)
}

/// A JPEG file without its camera's notes, thumbnails, colour profile and turn: what a browser might
/// heed and glTF does not. Samples are kept as they are.
fn bare(bytes: &[u8]) -> Vec<u8> {
    let mut out = bytes[..2].to_vec();
    let mut at = 2;
    while let Some(&[0xff, marker, high, low]) = bytes.get(at..at + 4) {
        let end = at + 2 + (usize::from(high) << 8 | usize::from(low));
        // SOS: the samples follow.
        if marker == 0xda || end > bytes.len() {
            break;
        }
        // APP0 is JFIF's, APP14 says how Adobe stored the colours.
        if !matches!(marker, 0xe1..=0xed | 0xef | 0xfe) {
            out.extend(&bytes[at..end]);
        }
        at = end;
    }
    out.extend(&bytes[at..]);
    out
}

/// A PNG file of any kind as 8-bit RGBA.
fn png(bytes: &[u8]) -> Result<Image, String> {
    let failed = |e: png::DecodingError| format!("a PNG picture that cannot be decoded: {e}");
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    decoder.set_limits(png::Limits { bytes: 1 << 30 });
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.max(height) > MOST_SIDE {
        return Err(format!("a PNG picture of {width} x {height}, {MOST_SIDE} at most"));
    }
    let size = reader.output_buffer_size().ok_or("a PNG picture beyond memory")?;
    if !Image::is_plausible(size, bytes.len()) {
        return Err(format!("a PNG picture of {width} x {height} in {} bytes", bytes.len()));
    }
    let mut samples = vec![0u8; size];
    reader.next_frame(&mut samples).map_err(failed)?;
    let rgba: Vec<u8> = match reader.output_color_type().0 {
        png::ColorType::Grayscale => samples.iter().flat_map(|&g| [g, g, g, 255]).collect(),
        png::ColorType::GrayscaleAlpha => {
            samples.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect()
        }
        png::ColorType::Rgb => {
            samples.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect()
        }
        png::ColorType::Rgba => samples,
        png::ColorType::Indexed => return Err("a PNG palette that was not resolved".to_owned()),
    };
    if width == 0 || height == 0 || rgba.len() < 4 * width * height {
        return Err(format!("{} bytes for {width} x {height} pixels", rgba.len()));
    }
    Ok(Image { width, height, rgba })
}

fn texture_of(mut image: Image, open: bool) -> Result<Texture, String> {
    while image.width.max(image.height) > MOST_TEXTURE_SIDE {
        image = image.half();
    }
    let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut texture = Texture::default();
    jpeg(&mut texture.jpeg, &rgb, &image, jpeg_encoder::ColorType::Rgb)?;
    if open && image.rgba.chunks_exact(4).any(|p| p[3] < 255) {
        let mask: Vec<u8> = image.rgba.chunks_exact(4).map(|p| p[3]).collect();
        jpeg(&mut texture.mask_jpeg, &mask, &image, jpeg_encoder::ColorType::Luma)?;
    }
    Ok(texture)
}

fn jpeg(
    out: &mut Vec<u8>,
    samples: &[u8],
    image: &Image,
    kind: jpeg_encoder::ColorType,
) -> Result<(), String> {
    let mut encoder = jpeg_encoder::Encoder::new(out, QUALITY);
    encoder.set_optimized_huffman_tables(true);
    let (width, height) = (image.width as u16, image.height as u16);
    encoder.encode(samples, width, height, kind).map_err(|e| e.to_string())
}
