//! Draws the sky from a pack with wgpu: what an engine does that knows nothing of welkin but `docs/tables.md`.
//!
//! Three textures, a sampler and a uniform block from the pack's files, and its `sky.wgsl` before a shader of one's own.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, bail};
use bytemuck::{Pod, Zeroable};
use serde_json::Value;

/// A camera over a flat map, in axes of which y is up and which are right-handed.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// Above the ground, m.
    pub altitude_m: f32,
    /// Unit vectors to the picture's right, to its top and through its centre.
    pub right: [f32; 3],
    /// To its top.
    pub up: [f32; 3],
    /// Through its centre.
    pub forward: [f32; 3],
    /// tan of half the vertical field of view.
    pub half_height: f32,
    /// Unit vector to the sun.
    pub sun: [f32; 3],
}

impl Camera {
    /// From the ground towards north and `elevation_deg` up, the sun in the south; x is east and z south.
    pub fn towards_north(elevation_deg: f32, sun_elevation_deg: f32) -> Self {
        let (sine, cosine) = elevation_deg.to_radians().sin_cos();
        let (sun_sine, sun_cosine) = sun_elevation_deg.to_radians().sin_cos();
        Self {
            altitude_m: 2.0,
            right: [1.0, 0.0, 0.0],
            up: [0.0, cosine, sine],
            forward: [0.0, sine, -cosine],
            half_height: 30.0_f32.to_radians().tan(),
            sun: [0.0, sun_sine, sun_cosine],
        }
    }
}

/// WGSL `View`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct View {
    forward: [f32; 3],
    half_width: f32,
    right: [f32; 3],
    half_height: f32,
    up: [f32; 3],
    altitude_m: f32,
    sun: [f32; 3],
    padding: f32,
    irradiance: [f32; 3],
    padding_end: f32,
    size: [f32; 2],
    padding_size: [f32; 2],
}

/// Linear radiance of every pixel, W·m⁻²·sr⁻¹·nm⁻¹ at the pack's three wavelengths: rows from the top.
///
/// # Errors
/// When there is no device or the folder is no pack with raw half floats.
pub fn draw(pack: &Path, camera: &Camera, [width, height]: [u32; 2]) -> anyhow::Result<Vec<[f32; 3]>> {
    let manifest = fs::read(pack.join("manifest.json")).with_context(|| format!("no pack in '{}'", pack.display()))?;
    let manifest: Value = serde_json::from_slice(&manifest)?;
    let (device, queue) = open()?;
    let mut textures = Vec::new();
    for name in ["transmittance", "irradiance", "scattering"] {
        textures.push(texture(&device, &queue, pack, &manifest, name)?);
    }
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    });
    let sky = uniform(&device, &queue, &fs::read(pack.join("sky_parameters.bin"))?);
    let view = uniform(&device, &queue, bytemuck::bytes_of(&view(&manifest, camera, [width, height])?));

    let functions = fs::read_to_string(pack.join("shaders/wgsl/sky.wgsl")).context("the pack has no WGSL")?;
    let source = wgpu::ShaderSource::Wgsl((functions + include_str!("sky.wgsl")).into());
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("sky"), source });
    // Not filtered, not blended: 32-bit floats, so that the picture is what the functions answer.
    let format = wgpu::TextureFormat::Rgba32Float;
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sky"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: Some("cover"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: Some("draw"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    });
    let views: Vec<_> = textures.iter().map(|texture| texture.create_view(&Default::default())).collect();
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let of_pack = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("pack"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            entry(0, sky.as_entire_binding()),
            entry(1, wgpu::BindingResource::Sampler(&sampler)),
            entry(2, wgpu::BindingResource::TextureView(&views[0])),
            entry(3, wgpu::BindingResource::TextureView(&views[1])),
            entry(4, wgpu::BindingResource::TextureView(&views[2])),
        ],
    });
    let of_view = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout: &pipeline.get_bind_group_layout(1),
        entries: &[entry(0, view.as_entire_binding())],
    });

    let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let picture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut commands = device.create_command_encoder(&Default::default());
    let target = picture.create_view(&Default::default());
    let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("sky"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &of_pack, &[]);
    pass.set_bind_group(1, &of_view, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    read(&device, &queue, commands, &picture, extent)
}

fn open() -> anyhow::Result<(wgpu::Device, wgpu::Queue)> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    Ok(pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?)
}

/// A table as a texture of half floats: the raw file is the very bytes.
fn texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pack: &Path,
    manifest: &Value,
    name: &str,
) -> anyhow::Result<wgpu::Texture> {
    let tables = manifest["tables"].as_array().context("the manifest lists no tables")?;
    let table = tables.iter().find(|table| table["name"] == name).with_context(|| format!("no table '{name}'"))?;
    let side = |axis: usize| table["size"][axis].as_u64().map(|side| side as u32).context("a table has no size");
    let [width, height, depth] = [side(0)?, side(1)?, side(2)?];
    let file = pack.join(format!("{name}.f16.raw"));
    let texels = fs::read(&file).with_context(|| format!("'{}': bake with --format raw", file.display()))?;
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: depth };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: if depth > 1 { wgpu::TextureDimension::D3 } else { wgpu::TextureDimension::D2 },
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * width), rows_per_image: Some(height) };
    queue.write_texture(texture.as_image_copy(), &texels, layout, size);
    Ok(texture)
}

fn uniform(device: &wgpu::Device, queue: &wgpu::Queue, content: &[u8]) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: content.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, content);
    buffer
}

fn view(manifest: &Value, camera: &Camera, [width, height]: [u32; 2]) -> anyhow::Result<View> {
    let irradiance = |band: usize| manifest["sun"]["irradiance"][band].as_f64().map(|value| value as f32);
    let [Some(r), Some(g), Some(b)] = [0, 1, 2].map(irradiance) else { bail!("the pack's scene has no sun") };
    Ok(View {
        forward: camera.forward,
        half_width: camera.half_height * width as f32 / height as f32,
        right: camera.right,
        half_height: camera.half_height,
        up: camera.up,
        altitude_m: camera.altitude_m,
        sun: camera.sun,
        padding: 0.0,
        irradiance: [r, g, b],
        padding_end: 0.0,
        size: [width as f32, height as f32],
        padding_size: [0.0; 2],
    })
}

/// Submits the commands and reads the picture.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut commands: wgpu::CommandEncoder,
    picture: &wgpu::Texture,
    extent: wgpu::Extent3d,
) -> anyhow::Result<Vec<[f32; 3]>> {
    // Rows of copies begin at multiples of 256 bytes.
    let row_bytes = (16 * extent.width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("copy"),
        size: u64::from(row_bytes) * u64::from(extent.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes), rows_per_image: None };
    commands.copy_texture_to_buffer(
        picture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &copy, layout },
        extent,
    );
    queue.submit([commands.finish()]);
    copy.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let mapped = copy.slice(..).get_mapped_range()?;
    let bytes: Vec<u8> = mapped.to_vec();
    let texel = |texel: &[u8]| bytemuck::pod_read_unaligned::<[f32; 4]>(texel);
    let rows = bytes.chunks_exact(row_bytes as usize);
    let texels = rows.flat_map(|row| row[..16 * extent.width as usize].chunks_exact(16).map(texel));
    Ok(texels.map(|[r, g, b, _]| [r, g, b]).collect())
}
