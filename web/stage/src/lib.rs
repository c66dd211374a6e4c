//! The canvas module: heads in the browser, built once for WebGPU and once for WebGL2.
//!
//! Avatar packs and weights in, frames on a canvas out. It knows no clock, no network and no
//! answers; `static/stage/host.js` drives it.
#![cfg(target_arch = "wasm32")]

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use js_sys::Uint8Array;
use mimique_avatar::{Image, MOST_TEXTURE_SIDE};
use mimique_stage::wgpu;
use mimique_stage::{Head, Look, Renderer, View};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;
use wgpu::CurrentSurfaceTexture as Frame;

#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    let backend = if cfg!(feature = "webgl") { "webgl2" } else { "webgpu" };
    mimique_web_panics::report_panics("stage", backend);
}

/// Why the canvas shows nothing any more, written by the browser's callbacks.
type Lost = Arc<Mutex<Option<String>>>;

/// A canvas that draws heads.
#[wasm_bindgen]
pub struct Canvas {
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    /// A few at most, by their keys.
    heads: Vec<(String, Head)>,
    adapter: String,
    lost: Lost,
    /// Frames given to the graphics adapter that it has not finished.
    in_flight: Arc<AtomicU32>,
}

/// Frames that may wait at the graphics adapter. More would be shown long after their time.
const MOST_IN_FLIGHT: u32 = 2;

#[wasm_bindgen]
impl Canvas {
    /// Opens a canvas of `width` x `height` device pixels. `background` is `#rrggbb`; `variant` is
    /// `stimulus` or `reference`.
    ///
    /// # Errors
    /// When the browser gives no adapter, device or surface for this canvas, or a word is unknown.
    pub async fn open(
        canvas: HtmlCanvasElement,
        width: u32,
        height: u32,
        background: String,
        variant: String,
    ) -> Result<Canvas, JsError> {
        let look = look(&background, &variant)?;
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = if cfg!(feature = "webgl") {
            wgpu::Backends::GL
        } else {
            wgpu::Backends::BROWSER_WEBGPU
        };
        let instance = wgpu::Instance::new(descriptor);
        let surface =
            instance.create_surface(wgpu::SurfaceTarget::Canvas(canvas)).map_err(error)?;
        let adapter = instance
            .request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                compatible_surface: Some(&surface),
                ..Default::default()
            })
            .await
            .map_err(error)?;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("stage"),
                required_limits: wgpu::Limits::downlevel_webgl2_defaults()
                    .using_resolution(adapter.limits()),
                ..Default::default()
            })
            .await
            .map_err(error)?;
        let lost = watch(&device);

        let (width, height) = (width.max(1), height.max(1));
        let mut configuration =
            surface.get_default_config(&adapter, width, height).ok_or_else(|| {
                JsError::new("canvas: the graphics adapter cannot draw on it; try another browser")
            })?;
        let formats = surface.get_capabilities(&adapter).formats;
        configuration.format = formats
            .iter()
            .copied()
            .find(wgpu::TextureFormat::is_srgb)
            .unwrap_or(configuration.format);
        configuration.alpha_mode = wgpu::CompositeAlphaMode::Opaque;
        surface.configure(&device, &configuration);
        let renderer = Renderer::new(&device, &queue, configuration.format, [width, height], look);
        let info = adapter.get_info();
        Ok(Self {
            surface,
            configuration,
            device,
            queue,
            renderer,
            heads: Vec::new(),
            adapter: info.name,
            lost,
            in_flight: Arc::default(),
        })
    }

    /// Unpacks an avatar pack and keeps the head under `key`. Answers its number of blendshapes.
    /// `pixels`: the pack's pictures decoded, RGBA from the top; `widths` of their rows.
    ///
    /// # Errors
    /// When the pack is damaged, the avatar too large for this machine, or a picture is missing.
    #[wasm_bindgen(js_name = loadAvatar)]
    pub fn load_avatar(
        &mut self,
        key: String,
        pack: &[u8],
        widths: &[u32],
        pixels: Vec<Uint8Array>,
    ) -> Result<usize, JsError> {
        let avatar = mimique_avatar::pack::decode_pack(pack).map_err(error)?;
        let pictures = widths.iter().zip(&pixels).enumerate().map(|(index, (width, rgba))| {
            Image::of_pixels(*width as usize, rgba.to_vec()).ok_or_else(|| {
                JsError::new(&format!(
                    "avatar {key}, texture {index}: {} bytes in rows of {width} pixels; make the \
                     picture {MOST_TEXTURE_SIDE} pixels wide and high at most",
                    rgba.length()
                ))
            })
        });
        let pictures = pictures.collect::<Result<_, JsError>>()?;
        let head = self.renderer.load_with(&avatar, pictures).map_err(error)?;
        let count = head.shape_count();
        self.drop_avatar(&key);
        self.heads.push((key, head));
        Ok(count)
    }

    /// Whether a head is kept under `key`.
    #[wasm_bindgen(js_name = hasAvatar)]
    pub fn has_avatar(&self, key: &str) -> bool {
        self.heads.iter().any(|(own, _)| own == key)
    }

    /// Draws one frame of the head under `key`; `yaw` and `pitch` in radians, `zoom` 1 for the
    /// standard portrait. Answers false when nothing was drawn, because the adapter is still busy with
    /// earlier frames or the browser has no frame to draw on just now.
    ///
    /// # Errors
    /// When there is no such head, or the device or the surface is lost: open the canvas anew.
    pub fn draw(
        &mut self,
        key: &str,
        weights: &[f32],
        yaw: f32,
        pitch: f32,
        zoom: f32,
    ) -> Result<bool, JsError> {
        if let Some(why) = self.lost() {
            return Err(JsError::new(&why));
        }
        let head = head(&self.heads, key)?;
        // WebGL2 tells of finished work only when asked.
        let _ = self.device.poll(wgpu::PollType::Poll);
        if self.in_flight.load(Ordering::Relaxed) >= MOST_IN_FLIGHT {
            return Ok(false);
        }
        let frame = match self.surface.get_current_texture() {
            Frame::Success(frame) | Frame::Suboptimal(frame) => frame,
            Frame::Outdated => {
                self.surface.configure(&self.device, &self.configuration);
                return Ok(false);
            }
            Frame::Timeout | Frame::Occluded => return Ok(false),
            Frame::Lost | Frame::Validation => {
                return Err(JsError::new("canvas: its surface is lost; open the stage again"));
            }
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.renderer.render(&view, head, View { yaw, pitch, zoom }, weights);
        self.in_flight.fetch_add(1, Ordering::Relaxed);
        let in_flight = self.in_flight.clone();
        self.queue.on_submitted_work_done(move || {
            in_flight.fetch_sub(1, Ordering::Relaxed);
        });
        self.queue.present(frame);
        Ok(true)
    }

    /// The camera's clip-from-world matrix for the head under `key`, 16 numbers, column by column.
    ///
    /// # Errors
    /// When there is no such head.
    pub fn camera(&self, key: &str, yaw: f32, pitch: f32, zoom: f32) -> Result<Vec<f32>, JsError> {
        let head = head(&self.heads, key)?;
        Ok(self.renderer.camera(head, View { yaw, pitch, zoom }).to_vec())
    }

    /// Gives a head back.
    #[wasm_bindgen(js_name = dropAvatar)]
    pub fn drop_avatar(&mut self, key: &str) {
        self.heads.retain(|(own, _)| own != key);
    }

    /// Changes the size in device pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        let (width, height) = (width.max(1), height.max(1));
        (self.configuration.width, self.configuration.height) = (width, height);
        self.surface.configure(&self.device, &self.configuration);
        self.renderer.resize([width, height]);
    }

    /// Changes backdrop and variant, as in [`Canvas::open`].
    ///
    /// # Errors
    /// When a word is unknown.
    #[wasm_bindgen(js_name = setLook)]
    pub fn set_look(&mut self, background: &str, variant: &str) -> Result<(), JsError> {
        self.renderer.set_look(look(background, variant)?);
        Ok(())
    }

    /// Why the canvas can show nothing any more, if so.
    pub fn lost(&self) -> Option<String> {
        self.lost.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The graphics adapter's name, as far as the browser tells it.
    pub fn adapter(&self) -> String {
        self.adapter.clone()
    }

    /// Destroys the device, as a driver's reset does: for tests of the recovery.
    pub fn lose(&self) {
        self.device.destroy();
        note(&self.lost, "graphics device: destroyed");
    }
}

/// Notes the loss of the device and errors that nobody awaits.
fn watch(device: &wgpu::Device) -> Lost {
    let lost = Lost::default();
    let (on_loss, on_error) = (lost.clone(), lost.clone());
    device.set_device_lost_callback(move |reason, message| {
        note(&on_loss, &format!("graphics device: lost ({reason:?}) {message}"));
    });
    device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| {
        note(&on_error, &format!("graphics device: {e}"));
    }));
    lost
}

/// Keeps the first reason.
fn note(lost: &Lost, why: &str) {
    lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| why.to_owned());
}

fn head<'a>(heads: &'a [(String, Head)], key: &str) -> Result<&'a Head, JsError> {
    let found = heads.iter().find(|(own, _)| own == key);
    found
        .map(|(_, head)| head)
        .ok_or_else(|| JsError::new(&format!("avatar {key}: not loaded; load it first")))
}

fn look(background: &str, variant: &str) -> Result<Look, JsError> {
    let look = match variant {
        "stimulus" => Look::STIMULUS,
        "reference" => Look::REFERENCE,
        _ => {
            return Err(JsError::new(&format!(
                "look {variant}: unknown; use stimulus or reference"
            )));
        }
    };
    if background.is_empty() {
        return Ok(look);
    }
    let channel = |from: usize| {
        let digits = background.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii())?;
        u8::from_str_radix(&digits[from..from + 2], 16).ok()
    };
    match (channel(0), channel(2), channel(4)) {
        (Some(r), Some(g), Some(b)) => Ok(look.with_background_srgb([r, g, b])),
        _ => Err(JsError::new(&format!("background {background}: not a colour; write #rrggbb"))),
    }
}

fn error(e: impl std::fmt::Display) -> JsError {
    JsError::new(&e.to_string())
}
