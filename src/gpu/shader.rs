//! The WGSL source: an ordered list of files, joined, with a map from its lines back to theirs.

use super::{Gpu, GpuError};
use crate::scene::bvh::{SMALL_STACK, STACK_SIZE};

/// A file of the source: its path below shaders/ and its text.
pub type File = (&'static str, &'static str);

macro_rules! files {
    ($($path:literal),* $(,)?) => { &[$(($path, include_str!(concat!("../../shaders/", $path)))),*] };
}

/// All files, what is used before what uses it (WGSL does not care, readers do).
pub const FILES: &[File] = files![
    "types.wgsl",
    "math.wgsl",
    "rng.wgsl",
    "rng/sobol.wgsl",
    "bindings.wgsl",
    "load.wgsl",
    "scene/alias.wgsl",
    "scene/material.wgsl",
    "scene/attributes.wgsl",
    "scene/texture.wgsl",
    "scene/surface.wgsl",
    "scene/alpha.wgsl",
    "scene/bvh.wgsl",
    "scene/bsdf/ggx.wgsl",
    "scene/bsdf/lambert.wgsl",
    "scene/bsdf/coat.wgsl",
    "scene/bsdf/mirror.wgsl",
    "scene/bsdf/dielectric.wgsl",
    "scene/bsdf.wgsl",
    "scene/environment.wgsl",
    "scene/light.wgsl",
    "scene/sphere.wgsl",
    "scene/camera.wgsl",
    "bdpt/vertex.wgsl",
    "bdpt/context.wgsl",
    "bdpt/visibility.wgsl",
    "bdpt/ends.wgsl",
    "bdpt/walk.wgsl",
    "bdpt/path.wgsl",
    "bdpt/mis.wgsl",
    "bdpt/connect.wgsl",
    "bdpt/crossing.wgsl",
    "bdpt/render.wgsl",
    "film.wgsl",
];

/// The joined source.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its text.
    pub text: String,
    /// Name and first line (from 1) of each part.
    parts: Vec<(String, u32)>,
}

impl Source {
    /// The kernels for trees of this depth. Stacks have one of two sizes, so that scenes share compiled kernels.
    pub fn kernels(depth: u32) -> Self {
        Self::of(FILES, depth)
    }

    /// The same out of other files: for tests.
    pub fn of(files: &[File], depth: u32) -> Self {
        let mut source = Self { text: String::new(), parts: Vec::new() };
        let stack = if depth <= SMALL_STACK { SMALL_STACK } else { STACK_SIZE as u32 };
        source.push("prelude", &format!("const STACK_SIZE: u32 = {stack}u;\n"));
        files.iter().for_each(|(name, text)| source.push(name, text));
        source
    }

    /// Appends a part.
    pub fn push(&mut self, name: &str, text: &str) {
        self.parts.push((name.to_owned(), self.text.lines().count() as u32 + 1));
        self.text.push_str(text);
        if !text.ends_with('\n') {
            self.text.push('\n');
        }
    }

    /// The file and its line at a line of the joined text (from 1).
    pub fn place(&self, line: u32) -> (&str, u32) {
        let part = self.parts.iter().rev().find(|(_, first)| *first <= line);
        part.map_or(("prelude", line), |(name, first)| (name, line - first + 1))
    }

    /// Compiles the source.
    ///
    /// # Errors
    /// The first message of the compiler, with the file and its line.
    pub async fn compile(&self, gpu: &Gpu) -> Result<wgpu::ShaderModule, GpuError> {
        let descriptor =
            wgpu::ShaderModuleDescriptor { label: Some("kernels"), source: wgpu::ShaderSource::Wgsl(self.text.as_str().into()) };
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = gpu.device.create_shader_module(descriptor);
        let error = scope.pop().await;
        gpu.check()?;
        let Some(error) = error else { return Ok(module) };
        let info = module.get_compilation_info().await;
        let first = info.messages.iter().find(|message| message.message_type == wgpu::CompilationMessageType::Error);
        let place = first.and_then(|message| message.location).map(|location| self.place(location.line_number));
        let text = first.map_or_else(|| error.to_string(), |message| message.message.clone());
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        Err(GpuError::Shader(place.map_or_else(|| text.clone(), |(file, line)| format!("shaders/{file}:{line}: {text}"))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_those_of_the_files() {
        let source = Source::kernels(10);
        let lines: Vec<_> = source.text.lines().collect();
        for (name, text) in FILES {
            for (i, line) in text.lines().enumerate().step_by(7) {
                let at = (1..=lines.len() as u32).find(|&n| source.place(n) == (name, i as u32 + 1));
                assert_eq!(at.map(|n| lines[n as usize - 1]), Some(line), "{name}:{}", i + 1);
            }
        }
    }
}
