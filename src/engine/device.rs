//! The one device that all sessions share, with its compiled kernels: opened and compiled by a task of its own, so that
//! nobody waits; a session renders on the CPU until they come.

use crate::gpu::shader::Source;
use crate::gpu::{Gpu, GpuError, Kernels, Layouts, Specialisation};
use crate::scene::{Scene, bvh};
use crate::task::{self, Bell};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What the task has ready.
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
/// The device is opened, and kernels are compiled, by one task at a time: whoever waited finds them ready.
static PREPARING: async_lock::Mutex<()> = async_lock::Mutex::new(());

fn shared() -> MutexGuard<'static, Option<Shared>> {
    SHARED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The device that renders, if one does: for diagnostics, and for tests that take it away.
pub fn device_in_use() -> Option<Gpu> {
    shared().as_ref().map(|shared| shared.gpu.clone())
}

/// What is being prepared.
#[derive(Debug)]
pub struct Preparing {
    inbox: Receiver<Prepared>,
    bell: Bell,
}

impl Preparing {
    /// What is ready; `patience`: how long to wait for it.
    pub async fn next(&self, patience: Duration) -> Result<Prepared, TryRecvError> {
        let ready = self.inbox.try_recv();
        if !matches!(ready, Err(TryRecvError::Empty)) || patience.is_zero() {
            return ready;
        }
        self.bell.rest(Some(patience)).await;
        self.inbox.try_recv()
    }
}

/// Rings when it goes.
struct Ringer(Bell);

impl Drop for Ringer {
    fn drop(&mut self) {
        self.0.ring();
    }
}

/// Prepares kernels for a scene: those for every scene first, then, if there are any, those for scenes such as this one.
/// `software`: an adapter that runs on the processor will do.
pub fn prepare(scene: &Scene, software: bool) -> Preparing {
    let ((sender, inbox), bell) = (channel(), Bell::default());
    let (deep, fitting) = kind(scene);
    let ringer = Ringer(bell.clone());
    let failed = sender.clone();
    let work = move || async move {
        // Whoever asked may have gone away: then nobody is told.
        match get(software, deep, fitting).await {
            Err(error) => drop(sender.send(Prepared::Failed(error))),
            Ok((gpu, layouts, kernels, specialisation)) => {
                drop(sender.send(Prepared::Kernels(Box::new((gpu.clone(), layouts.clone(), kernels)))));
                ringer.0.ring();
                if specialisation != fitting
                    && let Ok(kernels) = compile(&gpu, &layouts, deep, fitting).await
                {
                    drop(sender.send(Prepared::Faster(kernels)));
                }
            }
        }
        drop(sender);
        drop(ringer);
    };
    if task::spawn("kernels", work).is_err() {
        drop(failed.send(Prepared::Failed(GpuError::NoThread)));
    }
    Preparing { inbox, bell }
}

/// The device and kernels that can render a scene, as far as they are ready; if not, they are made so.
///
/// # Errors
/// If no device can.
pub async fn ready(scene: &Scene, software: bool) -> Result<(Gpu, Layouts, Kernels), GpuError> {
    let (deep, fitting) = kind(scene);
    get(software, deep, fitting).await.map(|(gpu, layouts, kernels, _)| (gpu, layouts, kernels))
}

/// Does it need a deep stack, and which kernels fit it?
fn kind(scene: &Scene) -> (bool, Specialisation) {
    (scene.bvh.depth > bvh::SMALL_STACK, Specialisation::fitting(&scene.features))
}

/// The device, opened anew if it was lost, and the best kernels there are; general ones are compiled if there are none.
async fn get(software: bool, deep: bool, fitting: Specialisation) -> Result<(Gpu, Layouts, Kernels, Specialisation), GpuError> {
    let turn = PREPARING.lock().await;
    let open = shared().as_ref().map(|shared| (shared.gpu.clone(), shared.layouts.clone())).filter(|(gpu, _)| gpu.check().is_ok());
    let (gpu, layouts) = match open {
        Some(open) => open,
        None => {
            let gpu = Gpu::open(software).await?;
            let layouts = Layouts::new(&gpu);
            *shared() = Some(Shared { layouts: layouts.clone(), gpu: gpu.clone(), kernels: Vec::new() });
            (gpu, layouts)
        }
    };
    if !software && gpu.is_software() {
        return Err(GpuError::SoftwareOnly(gpu.info.name.clone()));
    }
    drop(turn);
    let best = |which| known(&gpu, deep, which).map(|kernels| (kernels, which));
    if let Some((kernels, which)) = best(fitting).or_else(|| best(Specialisation::GENERAL)) {
        return Ok((gpu, layouts, kernels, which));
    }
    let kernels = compile(&gpu, &layouts, deep, Specialisation::GENERAL).await?;
    Ok((gpu, layouts, kernels, Specialisation::GENERAL))
}

/// Kernels that have been compiled for this device.
fn known(gpu: &Gpu, deep: bool, which: Specialisation) -> Option<Kernels> {
    let shared = shared();
    let kernels = &shared.as_ref().filter(|shared| shared.gpu.is(gpu))?.kernels;
    kernels.iter().find(|(key, _)| *key == (deep, which)).map(|(_, kernels)| kernels.clone())
}

/// Compiles kernels and keeps them for whoever comes next.
async fn compile(gpu: &Gpu, layouts: &Layouts, deep: bool, which: Specialisation) -> Result<Kernels, GpuError> {
    let _turn = PREPARING.lock().await;
    if let Some(kernels) = known(gpu, deep, which) {
        return Ok(kernels);
    }
    let source = Source::kernels(if deep { bvh::STACK_SIZE as u32 } else { bvh::SMALL_STACK });
    let kernels = Kernels::compile(gpu, layouts, &source, which).await?;
    if let Some(shared) = shared().as_mut().filter(|shared| shared.gpu.is(gpu)) {
        shared.kernels.push(((deep, which), kernels.clone()));
    }
    Ok(kernels)
}
