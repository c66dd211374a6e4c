//! The passes' pipelines and what is bound to them.

use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, CompareFunction, DepthBiasState,
    DepthStencilState, Device, Face, RenderPipeline, ShaderModule, ShaderStages, TextureFormat,
    TextureSampleType, TextureViewDimension,
};

use crate::geometry::Layer;

/// A shader module as `build.rs` wrote it: its text.
#[cfg(feature = "wgsl")]
macro_rules! source {
    ($name:literal) => {
        wgpu::ShaderSource::Wgsl(include_str!(concat!(env!("OUT_DIR"), "/", $name, ".wgsl")).into())
    };
}

/// A shader module as `build.rs` wrote it: parsed.
#[cfg(not(feature = "wgsl"))]
macro_rules! source {
    ($name:literal) => {
        parsed(include_bytes!(concat!(env!("OUT_DIR"), "/", $name, ".naga")))
    };
}

/// Samples per pixel.
pub(crate) const SAMPLES: u32 = 4;
/// Depth of the picture and of the key light's view.
pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// Sums over directions of the sky; a half float takes 24 of them without loss that could be seen.
pub(crate) const OCCLUSION_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// Strains, from -1 to 1: a half float holds them to a thousandth.
pub(crate) const STRAIN_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// Blending that adds.
const ADD: wgpu::BlendState = wgpu::BlendState {
    color: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    },
    alpha: wgpu::BlendComponent::REPLACE,
};

/// What is bound to each pass, as its shader declares it.
pub(crate) struct Layouts {
    pub deform: BindGroupLayout,
    pub surface: BindGroupLayout,
    pub soften: BindGroupLayout,
    pub strain: BindGroupLayout,
    pub occlusion: BindGroupLayout,
    pub shade: BindGroupLayout,
    pub light: BindGroupLayout,
    /// A surface's picture, as `shade.wgsl` reads it.
    pub picture: BindGroupLayout,
}

pub(crate) struct Pipelines {
    pub layouts: Layouts,
    pub deform: RenderPipeline,
    pub light: RenderPipeline,
    pub surface: RenderPipeline,
    pub soften: RenderPipeline,
    pub strain: RenderPipeline,
    pub occlusion: RenderPipeline,
    closed: RenderPipeline,
    sheet: RenderPipeline,
    blended: RenderPipeline,
}

impl Layouts {
    fn new(device: &Device) -> Self {
        let (float, integer) =
            (TextureSampleType::Float { filterable: false }, TextureSampleType::Uint);
        let (vertex, fragment) = (ShaderStages::VERTEX, ShaderStages::FRAGMENT);
        let both = ShaderStages::VERTEX_FRAGMENT;
        let sampler = |binding, kind| entry(binding, fragment, BindingType::Sampler(kind));
        let comparison = wgpu::SamplerBindingType::Comparison;
        let layout = |label, entries: &[BindGroupLayoutEntry]| layout(device, label, entries);
        let deform = [
            uniform(0, fragment),
            table(1, fragment, float),
            table(2, fragment, integer),
            table(3, fragment, float),
        ];
        let surface = [
            uniform(0, fragment),
            table(1, fragment, integer),
            table(2, fragment, integer),
            table(3, fragment, float),
            table(4, fragment, TextureSampleType::Depth),
            sampler(5, comparison),
        ];
        let soften =
            [table(0, fragment, integer), table(1, fragment, integer), table(2, fragment, float)];
        let strain = [
            table(0, fragment, integer),
            table(1, fragment, integer),
            table(2, fragment, float),
            table(3, fragment, float),
        ];
        let occlusion = [
            uniform(0, fragment),
            table(1, fragment, float),
            table(2, fragment, TextureSampleType::Depth),
            sampler(3, comparison),
            table(4, fragment, float),
        ];
        let shade = [
            uniform(0, both),
            table(1, vertex, float),
            table(2, vertex, float),
            table(3, vertex, float),
            table(4, vertex, float),
            table(5, vertex, float),
        ];
        let picture = [
            table(0, fragment, TextureSampleType::Float { filterable: true }),
            sampler(1, wgpu::SamplerBindingType::Filtering),
        ];
        Self {
            deform: layout("deform", &deform),
            surface: layout("surface", &surface),
            soften: layout("soften", &soften),
            strain: layout("strain", &strain),
            occlusion: layout("occlusion", &occlusion),
            shade: layout("shade", &shade),
            light: layout("light", &[uniform(0, both), table(1, vertex, float)]),
            picture: layout("picture", &picture),
        }
    }
}

impl Pipelines {
    /// For pictures of the given colour format.
    pub fn new(device: &Device, format: TextureFormat) -> Self {
        let module = |label, source| shader(device, label, source);
        let deform_module = module("deform.wgsl", source!("deform"));
        let surface_module = module("surface.wgsl", source!("surface"));
        let soften_module = module("soften.wgsl", source!("soften"));
        let occlusion_module = module("occlusion.wgsl", source!("occlusion"));
        let strain_module = module("strain.wgsl", source!("strain"));
        let shade_module = module("shade.wgsl", source!("shade"));

        let layouts = Layouts::new(device);
        let float32 = TextureFormat::Rgba32Float.into();
        let groups = [&layouts.shade, &layouts.picture];
        let summed = wgpu::ColorTargetState {
            format: OCCLUSION_FORMAT,
            blend: Some(ADD),
            write_mask: wgpu::ColorWrites::ALL,
        };
        let cover =
            |module, layout, entries, target| table_pass(device, module, layout, entries, target);
        let picture = |layer| picture_pass(device, &shade_module, groups, format, layer);
        Self {
            deform: cover(&deform_module, &layouts.deform, ["cover_positions", "deform"], &float32),
            surface: cover(
                &surface_module,
                &layouts.surface,
                ["cover_surface", "surface"],
                &float32,
            ),
            soften: cover(&soften_module, &layouts.soften, ["cover_softened", "soften"], &float32),
            strain: cover(
                &strain_module,
                &layouts.strain,
                ["cover_strain", "strain"],
                &STRAIN_FORMAT.into(),
            ),
            occlusion: cover(
                &occlusion_module,
                &layouts.occlusion,
                ["cover_occlusion", "occlusion"],
                &summed,
            ),
            light: light_pass(device, &shade_module, &layouts.light),
            closed: picture(Layer::Closed),
            sheet: picture(Layer::Sheet),
            blended: picture(Layer::Blended),
            layouts,
        }
    }

    /// The picture's pipeline for a mesh of that layer.
    pub fn picture(&self, layer: Layer) -> &RenderPipeline {
        match layer {
            Layer::Closed => &self.closed,
            Layer::Sheet => &self.sheet,
            Layer::Blended => &self.blended,
        }
    }
}

/// What [`encode_pass`] reads.
pub(crate) fn encode_layout(device: &Device) -> BindGroupLayout {
    let float = TextureSampleType::Float { filterable: false };
    layout(device, "encode", &[table(0, ShaderStages::FRAGMENT, float)])
}

/// The pass from a picture in linear light to a target of `format`, which stores bytes as they are.
pub(crate) fn encode_pass(
    device: &Device,
    group: &BindGroupLayout,
    format: TextureFormat,
) -> RenderPipeline {
    let module = shader(device, "encode.wgsl", source!("encode"));
    table_pass(device, &module, group, ["cover_picture", "encode"], &format.into())
}

fn shader(device: &Device, label: &str, source: wgpu::ShaderSource<'_>) -> ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
}

/// A shader module that `build.rs` parsed.
#[cfg(not(feature = "wgsl"))]
fn parsed(bytes: &[u8]) -> wgpu::ShaderSource<'static> {
    let module = postcard::from_bytes(bytes).expect("written by the same version of naga");
    wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module))
}

/// A pass of one triangle over every texel of a table.
fn table_pass(
    device: &Device,
    module: &ShaderModule,
    group: &BindGroupLayout,
    entries: [&str; 2],
    target: &wgpu::ColorTargetState,
) -> RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entries[1]),
        layout: Some(&pipeline_layout(device, &[group])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(entries[0]),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entries[1]),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(target.clone())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn light_pass(device: &Device, module: &ShaderModule, group: &BindGroupLayout) -> RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("light"),
        layout: Some(&pipeline_layout(device, &[group])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("depth_from_light"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            // Steep surfaces would shade themselves within a texel of the map.
            bias: DepthBiasState { constant: 0, slope_scale: 2.0, clamp: 0.0 },
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

fn picture_pass(
    device: &Device,
    module: &ShaderModule,
    groups: [&BindGroupLayout; 2],
    format: TextureFormat,
    layer: Layer,
) -> RenderPipeline {
    let blended = layer == Layer::Blended;
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("picture"),
        layout: Some(&pipeline_layout(device, &groups)),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("project"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                Some(wgpu::VertexBufferLayout {
                    array_stride: 4,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Unorm8x4],
                }),
                Some(wgpu::VertexBufferLayout {
                    array_stride: 8,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![1 => Float32x2],
                }),
            ],
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: (layer == Layer::Closed).then_some(Face::Back),
            ..wgpu::PrimitiveState::default()
        },
        depth_stencil: Some(DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(!blended),
            depth_compare: Some(CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..wgpu::MultisampleState::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shade"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                // Sheets of hair thin out over the skin, which is drawn before them.
                blend: (layer != Layer::Closed).then_some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn pipeline_layout(device: &Device, groups: &[&BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<Option<&BindGroupLayout>> = groups.iter().copied().map(Some).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

fn layout(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

fn uniform(binding: u32, visibility: ShaderStages) -> BindGroupLayoutEntry {
    let buffer = BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    entry(binding, visibility, buffer)
}

fn table(
    binding: u32,
    visibility: ShaderStages,
    sample_type: TextureSampleType,
) -> BindGroupLayoutEntry {
    let texture = BindingType::Texture {
        sample_type,
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    entry(binding, visibility, texture)
}

fn entry(binding: u32, visibility: ShaderStages, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}
