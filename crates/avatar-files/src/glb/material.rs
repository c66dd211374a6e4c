//! Base-colour textures: which surface carries which picture, and where its vertices lie in it.

use std::collections::HashMap;
use std::path::Path;

use gltf_json::Material;
use gltf_json::material::AlphaMode;
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;

use super::container::{Container, load_uri};
use crate::ReadError;
use crate::pictures::{Picture, picture_of};
use mimique_avatar::{Image, Mesh, Part, Texture, Textured};

/// A surface's texture as the file names it.
pub(super) struct Paint {
    /// Index of the image, where the texture names one that can be read.
    image: Option<usize>,
    /// Index of the texture.
    texture: usize,
    /// Whether the image's alpha opens the surface.
    open: bool,
    uvs: Vec<[f32; 2]>,
}

impl Paint {
    /// The base-colour texture of a primitive's material.
    pub fn of(
        container: &Container,
        primitive: &Primitive,
        material: Option<&Material>,
        vertices: usize,
        place: &str,
    ) -> Result<Option<Self>, ReadError> {
        let Some(material) = material else { return Ok(None) };
        let Some(info) = &material.pbr_metallic_roughness.base_color_texture else {
            return Ok(None);
        };
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
        let texture = container.root.textures.get(info.index.value()).ok_or_else(|| {
            let what = format!("texture {} does not exist", info.index.value());
            ReadError::damaged(place, what)
        })?;
        let at = Checked::Valid(Semantic::TexCoords(set));
        let Some(uvs) = primitive.attributes.get(&at) else { return Ok(None) };
        let place = format!("{place}.attributes.TEXCOORD_{set}");
        let mut uvs = container.floats::<2>(*uvs, &place)?;
        if uvs.len() != vertices {
            let what = format!("{} places for {vertices} vertices", uvs.len());
            return Err(ReadError::damaged(place, what));
        }
        if let Some(transform) = transform {
            uvs.iter_mut().for_each(|uv| *uv = transformed(*uv, transform));
        }
        // Far outside the picture, single precision no longer finds a texel.
        let near = |x: &f32| x.abs() <= 1e4;
        if let Some(v) = uvs.iter().position(|uv| !uv.iter().all(near)) {
            let what = format!("vertex {v} lies at {:?} of a picture of 1 x 1", uvs[v]);
            return Err(ReadError::damaged(place, what));
        }
        let open = !matches!(material.alpha_mode, Checked::Valid(AlphaMode::Opaque));
        // A texture whose picture only an extension names (WebP, KTX2) has no source: gltf_json reads it as
        // the greatest index.
        let image = Some(texture.source.value()).filter(|&image| image != u32::MAX as usize);
        Ok(Some(Self { image, texture: info.index.value(), open, uvs }))
    }
}

/// KHR_texture_transform: scaled, turned, shifted.
fn transformed(uv: [f32; 2], t: &gltf_json::extensions::texture::TextureTransform) -> [f32; 2] {
    let ([x, y], [sx, sy], [ox, oy]) = (uv, t.scale.0, t.offset.0);
    let (sin, cos) = t.rotation.0.sin_cos();
    let (x, y) = (x * sx, y * sy);
    [cos * x + sin * y + ox, cos * y - sin * x + oy]
}

/// The file's images, each read once, when a surface wants it.
pub(super) struct Pictures<'a> {
    container: &'a Container,
    folder: Option<&'a Path>,
    /// By image and whether its alpha counts; nothing for an image that is neither PNG nor JPEG.
    found: HashMap<(usize, bool), Option<usize>>,
    /// Those that surfaces carry.
    pub textures: Vec<Texture>,
    /// What was not read.
    pub notes: Vec<String>,
}

impl<'a> Pictures<'a> {
    pub fn new(container: &'a Container, folder: Option<&'a Path>) -> Self {
        let (found, textures, notes) = Default::default();
        Self { container, folder, found, textures, notes }
    }

    /// Lays a picture on a mesh. An eye takes its colours vertex by vertex: the stage draws iris
    /// and cornea itself.
    pub fn lay_on(&mut self, mesh: &mut Mesh, paint: Paint) -> Result<(), ReadError> {
        let Some(image) = paint.image else {
            self.without_source(paint.texture);
            return Ok(());
        };
        let Some(texture) = self.texture(image, paint.open)? else { return Ok(()) };
        if matches!(mesh.part, Part::EyeLeft | Part::EyeRight) {
            let image = Image::decode(&self.textures[texture])
                .map_err(|e| ReadError::damaged(format!("images[{image}]"), e.to_string()))?;
            let colour = |uv: &[f32; 2]| {
                let seen = image.linear_at(*uv);
                std::array::from_fn(|c| seen[c] * mesh.base_colour[c])
            };
            mesh.vertex_colours = paint.uvs.iter().map(colour).collect();
            return Ok(());
        }
        mesh.uvs = paint.uvs;
        if !mesh.triangles.is_empty() {
            mesh.textured = vec![Textured { triangles: 0..mesh.triangles.len(), texture }];
        }
        Ok(())
    }

    /// Notes a texture whose picture is in a format that is not read, once.
    fn without_source(&mut self, texture: usize) {
        let extensions = self.container.root.textures[texture].extensions.as_ref();
        let names: Vec<&str> =
            extensions.map_or(Vec::new(), |e| e.others.keys().map(String::as_str).collect());
        let why = match names.is_empty() {
            true => "names no picture".to_owned(),
            false => format!("has its picture by {} alone, which is not read", names.join(", ")),
        };
        let note = format!("textures[{texture}] {why}: its surface keeps its plain colour");
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    fn texture(&mut self, image: usize, open: bool) -> Result<Option<usize>, ReadError> {
        if let Some(found) = self.found.get(&(image, open)) {
            return Ok(*found);
        }
        let place = format!("images[{image}]");
        let bytes = self.bytes(image, &place)?;
        let picture = picture_of(&bytes, open);
        let found = match picture.map_err(|what| ReadError::damaged(&place, what))? {
            Picture::Read(texture) => {
                self.textures.push(texture);
                Some(self.textures.len() - 1)
            }
            Picture::Unknown => {
                self.notes.push(format!(
                    "{place} is no PNG and no JPEG: its surface keeps its plain colour"
                ));
                None
            }
        };
        self.found.insert((image, open), found);
        Ok(found)
    }

    fn bytes(&self, image: usize, place: &str) -> Result<Vec<u8>, ReadError> {
        let Some(found) = self.container.root.images.get(image) else {
            return Err(ReadError::damaged(place, "the image does not exist"));
        };
        match (&found.uri, found.buffer_view) {
            (Some(uri), _) => load_uri(uri, self.folder, place),
            (None, Some(view)) => Ok(self.container.view_bytes(view.value(), place)?.to_vec()),
            (None, None) => Err(ReadError::damaged(place, "neither uri nor bufferView")),
        }
    }
}
