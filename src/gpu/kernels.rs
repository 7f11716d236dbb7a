//! The compiled kernels and the layouts of what they are bound to.

use super::shader::Source;
use super::{Gpu, GpuError};
use crate::scene::{General, Matte, Opaque, SceneFeatures, Shape};

/// What kernels are compiled for: the shapes of `scene::features`, as constants of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Specialisation {
    alpha: bool,
    textures: bool,
    glossy: bool,
}

impl Specialisation {
    /// Kernels for every scene.
    pub const GENERAL: Self = Self::of::<General>();

    const fn of<F: Shape>() -> Self {
        Self { alpha: F::ALPHA, textures: F::TEXTURES, glossy: F::GLOSSY }
    }

    /// The narrowest that fits a scene.
    pub fn fitting(features: &SceneFeatures) -> Self {
        if features.fit::<Matte>() {
            Self::of::<Matte>()
        } else if features.fit::<Opaque>() {
            Self::of::<Opaque>()
        } else {
            Self::GENERAL
        }
    }

    fn constants(self) -> [(&'static str, f64); 3] {
        let number = |x: bool| f64::from(u8::from(x));
        [("HAS_ALPHA", number(self.alpha)), ("HAS_TEXTURES", number(self.textures)), ("HAS_GLOSSY", number(self.glossy))]
    }
}

/// The layouts of the bind groups.
#[derive(Clone, Debug)]
pub struct Layouts {
    /// Group 0 of trace_light and trace_eye.
    pub trace: wgpu::BindGroupLayout,
    /// Group 0 of resolve.
    pub resolve: wgpu::BindGroupLayout,
    /// Group 1 of resolve.
    pub splats: wgpu::BindGroupLayout,
}

impl Layouts {
    /// The layouts of the list in `gpu`.
    pub fn new(gpu: &Gpu) -> Self {
        let entry = |binding: u32, read_only: bool, has_dynamic_offset: bool| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset,
                min_binding_size: None,
            },
            count: None,
        };
        let (control, read, write) = (entry(0, true, true), |binding| entry(binding, true, false), |binding| entry(binding, false, false));
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        Self {
            trace: layout("trace", &[control, read(1), read(2), read(3), read(4), write(5), write(6), write(7)]),
            resolve: layout("resolve", &[control, read(3), write(7)]),
            splats: layout("splats", &[write(0)]),
        }
    }
}

/// The kernels.
#[derive(Clone, Debug)]
pub struct Kernels {
    /// Light subpaths, t ≤ 1.
    pub light: wgpu::ComputePipeline,
    /// Eye subpaths, t ≥ 2.
    pub eye: wgpu::ComputePipeline,
    /// Adds splats.
    pub resolve: wgpu::ComputePipeline,
}

impl Kernels {
    /// Compiles the kernels; this may take seconds.
    ///
    /// # Errors
    /// If the source does not compile, or the device refuses it.
    pub async fn compile(gpu: &Gpu, layouts: &Layouts, source: &Source, specialisation: Specialisation) -> Result<Self, GpuError> {
        let module = source.compile(gpu).await?;
        let constants = specialisation.constants();
        let pipeline = |entry, groups: &[Option<&wgpu::BindGroupLayout>]| {
            let descriptor = wgpu::PipelineLayoutDescriptor { label: Some(entry), bind_group_layouts: groups, immediate_size: 0 };
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&gpu.device.create_pipeline_layout(&descriptor)),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                cache: None,
            })
        };
        let trace = [Some(&layouts.trace)];
        gpu.guarded("the kernels", || Self {
            light: pipeline("trace_light", &trace),
            eye: pipeline("trace_eye", &trace),
            resolve: pipeline("resolve", &[Some(&layouts.resolve), Some(&layouts.splats)]),
        })
        .await
    }
}
