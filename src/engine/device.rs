//! The one device that all sessions share, with its compiled kernels: opened and compiled on a thread of its own, so that
//! nobody waits; a session renders on the CPU until they come.

use crate::gpu::shader::Source;
use crate::gpu::{Gpu, GpuError, Kernels, Layouts, Specialisation};
use crate::scene::{Scene, bvh};
use pollster::block_on;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};

/// What the thread has ready.
pub enum Prepared {
    /// A device and kernels that can render the scene.
    Kernels(Box<(Gpu, Layouts, Kernels)>),
    /// Kernels that render it faster.
    Faster(Kernels),
    /// Nothing will come.
    Failed(GpuError),
}

/// The open device and what was compiled for it.
struct Shared {
    gpu: Gpu,
    layouts: Layouts,
    /// By the size of the stack and by what they are compiled for.
    kernels: Vec<((bool, Specialisation), Kernels)>,
}

static SHARED: Mutex<Option<Shared>> = Mutex::new(None);
/// Kernels are compiled by one thread at a time: whoever waited finds them ready.
static COMPILING: Mutex<()> = Mutex::new(());

/// The device that renders, if one does: for diagnostics, and for tests that take it away.
pub fn device_in_use() -> Option<Gpu> {
    SHARED.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|shared| shared.gpu.clone())
}

/// Prepares kernels for a scene: those for every scene first, then, if there are any, those for scenes such as this one.
/// `software`: an adapter that runs on the processor will do.
pub fn prepare(scene: &Scene, software: bool) -> Receiver<Prepared> {
    let (sender, receiver) = channel();
    let (deep, fitting) = (scene.bvh.depth > bvh::SMALL_STACK, Specialisation::fitting(&scene.features));
    let work = move || {
        let outcome = get(software, deep, fitting);
        // Whoever asked may have gone away: then nobody is told.
        match outcome {
            Err(error) => drop(sender.send(Prepared::Failed(error))),
            Ok((gpu, layouts, kernels, specialisation)) => {
                drop(sender.send(Prepared::Kernels(Box::new((gpu.clone(), layouts.clone(), kernels)))));
                if specialisation != fitting
                    && let Ok(kernels) = compile(&gpu, &layouts, deep, fitting)
                {
                    drop(sender.send(Prepared::Faster(kernels)));
                }
            }
        }
    };
    // A page has no threads to spare yet.
    if cfg!(target_arch = "wasm32") || std::thread::Builder::new().name("kernels".to_owned()).spawn(work).is_err() {
        let (sender, receiver) = channel();
        drop(sender.send(Prepared::Failed(GpuError::NoThread)));
        return receiver;
    }
    receiver
}

/// The device, opened anew if it was lost, and the best kernels there are; general ones are compiled if there are none.
fn get(software: bool, deep: bool, fitting: Specialisation) -> Result<(Gpu, Layouts, Kernels, Specialisation), GpuError> {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if shared.as_ref().is_none_or(|shared| shared.gpu.check().is_err()) {
        let gpu = block_on(Gpu::open(software))?;
        *shared = Some(Shared { layouts: Layouts::new(&gpu), gpu, kernels: Vec::new() });
    }
    let Some(Shared { gpu, layouts, kernels }) = shared.as_ref() else { return Err(GpuError::NoAdapter("none was opened".to_owned())) };
    if !software && gpu.is_software() {
        return Err(GpuError::SoftwareOnly(gpu.info.name.clone()));
    }
    let (gpu, layouts) = (gpu.clone(), layouts.clone());
    let known = |which| kernels.iter().find(|(key, _)| *key == (deep, which)).map(|(_, kernels)| (kernels.clone(), which));
    if let Some((kernels, which)) = known(fitting).or_else(|| known(Specialisation::GENERAL)) {
        return Ok((gpu, layouts, kernels, which));
    }
    drop(shared);
    let kernels = compile(&gpu, &layouts, deep, Specialisation::GENERAL)?;
    Ok((gpu, layouts, kernels, Specialisation::GENERAL))
}

/// Compiles kernels and keeps them for whoever comes next.
fn compile(gpu: &Gpu, layouts: &Layouts, deep: bool, which: Specialisation) -> Result<Kernels, GpuError> {
    let _turn = COMPILING.lock().unwrap_or_else(PoisonError::into_inner);
    let ready = |shared: &Shared| shared.kernels.iter().find(|(key, _)| *key == (deep, which)).map(|(_, kernels)| kernels.clone());
    let shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(kernels) = shared.as_ref().filter(|shared| shared.gpu.is(gpu)).and_then(ready) {
        return Ok(kernels);
    }
    drop(shared);
    let source = Source::kernels(if deep { bvh::STACK_SIZE as u32 } else { bvh::SMALL_STACK });
    let kernels = block_on(Kernels::compile(gpu, layouts, &source, which))?;
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(shared) = shared.as_mut().filter(|shared| shared.gpu.is(gpu)) {
        shared.kernels.push(((deep, which), kernels.clone()));
    }
    Ok(kernels)
}
