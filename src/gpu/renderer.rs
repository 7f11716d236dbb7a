//! A rendering on the device: submits batches, a slice of time each, and folds what they sum up into a film.

use super::kernels::{Kernels, Layouts};
use super::memory::{MOST_BATCHES, Memory, STRIDE};
use super::params::{Batch, Control, Params, Task};
use super::scene::SceneBuffers;
use super::tiles::{FILM_BUDGET, Need, Tiles, rows_of};
use super::{Gpu, GpuError, HEADER};
use crate::bdpt::render::Counts;
use crate::film::Film;
use crate::task::{self, Bell};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// Most passes that are summed on the device before they are folded into the film.
pub const MOST_PASSES: u32 = 1024;
/// Pairs of the first pass's batches, whose speed nobody knows yet: on a graphics adapter, and on one that runs on the processor.
const FIRST_PAIRS: [u32; 2] = [8192, 1024];
/// Invocations of a workgroup.
const WORKGROUP: u32 = 64;

/// When a submission ended; `None` until it has.
type Done = Arc<Mutex<Option<Instant>>>;

/// Work that the device has not finished, or had not when last looked at.
#[derive(Debug)]
struct InFlight {
    pairs: u64,
    batches: usize,
    began: Instant,
    done: Done,
    bell: Bell,
    index: wgpu::SubmissionIndex,
}

/// A rendering on the device.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    kernels: Kernels,
    memory: Memory,
    tiles: Tiles,
    params: Params,
    batches: Vec<(usize, Batch)>,
    runs: Runs,
    /// Pass and batch that come next.
    pass: u32,
    next: usize,
    in_flight: VecDeque<InFlight>,
    /// Samples of each row that are not in the film yet.
    rows: Vec<u32>,
    pairs_per_second: f64,
    seconds_per_batch: f64,
    slice: Duration,
}

/// Which kernels have anything to do.
#[derive(Clone, Copy, Debug)]
struct Runs {
    light: bool,
    /// Light subpaths for each eye subpath.
    light_subpaths: u32,
    eye: bool,
    splats: bool,
}

impl Runs {
    /// Numbers of its own that a batch tells the kernels: splats go to every tile, those of each of several light subpaths anew.
    fn controls(&self, tiles: &Tiles) -> usize {
        let tiles = tiles.list().len();
        (1 + if self.splats && tiles > 1 { tiles } else { 0 }) * self.light_subpaths as usize
    }
}

impl Renderer {
    /// Uploads a task, to be rendered by kernels that fit its scene; one submission is to take about `slice`.
    ///
    /// # Errors
    /// If something does not fit the device.
    pub async fn with_kernels(
        gpu: &Gpu,
        task: &Task<'_>,
        (layouts, kernels): (Layouts, Kernels),
        quantum: f32,
        slice: Duration,
    ) -> Result<Self, GpuError> {
        let plan = task.plan;
        let splats = plan.strategies().filter(|x| !x.stays_in_pixel()).count() as u64;
        let need = Need { size: task.view.size, layers: plan.layers, light_vertices: plan.light_vertices() as u64, splats };
        let binding = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
        let tiles = Tiles::new(&need, binding, FILM_BUDGET)?;
        let scene = SceneBuffers::new(gpu, task.scene, plan, task.settings.max_edges).await?;
        let params = Params::new(task, &scene.places, quantum);

        let memory = Memory::new(gpu, &layouts, &need, &tiles, &scene).await?;
        let runs = Runs {
            light: plan.light_vertices() > 0,
            light_subpaths: plan.light_subpaths(),
            eye: plan.strategies().any(|x| x.stays_in_pixel()),
            splats: splats > 0 && !task.scene.lights.list.is_empty(),
        };
        let controls = runs.controls(&tiles) as u64;
        if controls > MOST_BATCHES as u64 {
            return Err(GpuError::TooLarge { what: "what a batch is told", need: controls * STRIDE, have: MOST_BATCHES as u64 * STRIDE });
        }
        let batches = tiles.batches((FIRST_PAIRS[usize::from(gpu.is_software())] / task.view.size[0]).max(1));
        Ok(Self {
            gpu: gpu.clone(),
            kernels,
            memory,
            rows: vec![0; task.view.size[1] as usize],
            tiles,
            params,
            batches,
            runs,
            pass: 0,
            next: 0,
            in_flight: VecDeque::new(),
            pairs_per_second: 0.0,
            seconds_per_batch: 0.0,
            slice,
        })
    }

    /// The device it renders on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Goes on with other kernels, which must fit the scene.
    pub fn swap_kernels(&mut self, kernels: Kernels) {
        self.kernels = kernels;
    }

    /// Passes whose batches have all been submitted.
    pub fn passes(&self) -> u32 {
        self.pass
    }

    /// The part of the current pass that has been submitted, 0…1.
    pub fn pass_fraction(&self) -> f64 {
        self.next as f64 / self.batches.len() as f64
    }

    /// Mean time of a batch, s; 0 if none has ended yet.
    pub fn seconds_per_batch(&self) -> f64 {
        self.seconds_per_batch
    }

    /// Begins at this pass: for a rendering whose first passes are in the film already.
    pub fn start_at(&mut self, pass: u32) {
        (self.pass, self.next) = (pass, 0);
    }

    /// Begins anew with another seed; what is summed up stays.
    pub fn restart(&mut self, seed: u32) {
        self.params.seed = seed;
        self.start_at(0);
    }

    /// Submits work for about `budget`, up to the end of pass `limit`, and waits until all but the last slice of it is done. At
    /// most [`MOST_PASSES`] can wait to be collected.
    ///
    /// # Errors
    /// If the device is lost or refuses something.
    pub async fn step(&mut self, budget: Duration, limit: u32) -> Result<(), GpuError> {
        let start = Instant::now();
        let limit = limit.min((self.pass + MOST_PASSES).saturating_sub(self.uncollected()));
        while self.pass < limit {
            self.submit(limit)?;
            while self.in_flight.len() > 1 {
                self.wait().await?;
            }
            // Whoever has little time to give still sees passes end.
            let enough = if self.next == 0 { budget / 2 } else { budget };
            if start.elapsed() >= enough {
                break;
            }
        }
        Ok(())
    }

    /// Passes that are not in the film yet.
    pub fn uncollected(&self) -> u32 {
        self.rows.iter().copied().max().unwrap_or(0)
    }

    /// Is there as much to collect as may be?
    pub fn is_full(&self) -> bool {
        self.uncollected() >= MOST_PASSES
    }

    /// Submits one slice of work.
    fn submit(&mut self, limit: u32) -> Result<(), GpuError> {
        self.gpu.check()?;
        if self.next == 0 {
            self.cut();
        }
        let typical = f64::from(self.batches[0].1.pairs);
        let wanted = (self.pairs_per_second * self.slice.as_secs_f64() / typical).floor().clamp(1.0, MOST_BATCHES as f64) as usize;
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (mut pairs, mut batches, mut controls) = (0, 0, Vec::new());
        while batches < wanted && self.pass < limit {
            let (tile, batch) = self.batches[self.next];
            let batch = Batch { pass_number: self.pass, ..batch };
            if controls.len() + self.runs.controls(&self.tiles) > MOST_BATCHES {
                break;
            }
            self.encode(&mut encoder, tile, &batch, &mut controls);
            rows_of(&batch, self.tiles.size[0]).for_each(|row| self.rows[row as usize] += 1);
            pairs += u64::from(batch.pairs);
            batches += 1;
            self.next += 1;
            if self.next == self.batches.len() {
                (self.pass, self.next) = (self.pass + 1, 0);
                break;
            }
        }
        let mut bytes = vec![0u8; controls.len() * STRIDE as usize];
        for (slot, batch) in bytes.chunks_mut(STRIDE as usize).zip(&controls) {
            let control = Control { batch: *batch, params: self.params };
            slot[..size_of::<Control>()].copy_from_slice(bytemuck::bytes_of(&control));
        }
        self.gpu.queue.write_buffer(&self.memory.control, 0, &bytes);
        let began = Instant::now();
        let index = self.gpu.queue.submit([encoder.finish()]);
        let (done, bell) = (Done::default(), Bell::default());
        let (ended, rope) = (Arc::clone(&done), bell.clone());
        self.gpu.queue.on_submitted_work_done(move || {
            *ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
            rope.ring();
        });
        self.in_flight.push_back(InFlight { pairs, batches, began, done, bell, index });
        Ok(())
    }

    /// One batch: light walks, eye walks and connections, splats. Of several light walks the last is the one that the eye walks meet.
    /// Samples are numbered by the settings' light subpaths, also where no strategy needs more than the first of a pass.
    fn encode(&self, encoder: &mut wgpu::CommandEncoder, tile: usize, batch: &Batch, controls: &mut Vec<Batch>) {
        let first = batch.pass_number.wrapping_mul(self.params.light_subpaths as u32);
        for number in (0..self.runs.light_subpaths).rev() {
            let batch = Batch { sample: first.wrapping_add(number), ..*batch };
            self.encode_walks(encoder, tile, &batch, self.runs.eye && number == 0, controls);
        }
    }

    fn encode_walks(&self, encoder: &mut wgpu::CommandEncoder, tile: usize, batch: &Batch, eye: bool, controls: &mut Vec<Batch>) {
        let offset = |controls: &[Batch]| (controls.len() as u64 * STRIDE) as u32;
        encoder.clear_buffer(&self.memory.output, 0, Some(4));
        let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        let groups = batch.pairs.div_ceil(WORKGROUP);
        let mut own = offset(controls);
        controls.push(*batch);
        compute.set_bind_group(0, &self.memory.bound.trace[tile], &[own]);
        if self.runs.light {
            compute.set_pipeline(&self.kernels.light);
            compute.dispatch_workgroups(groups, 1, 1);
        }
        if eye {
            compute.set_pipeline(&self.kernels.eye);
            compute.dispatch_workgroups(groups, 1, 1);
        }
        if self.runs.splats {
            let tiles = self.tiles.list();
            compute.set_pipeline(&self.kernels.resolve);
            for (target, &(first, rows)) in tiles.iter().enumerate() {
                if tiles.len() > 1 {
                    own = offset(controls);
                    controls.push(Batch { tile_row: first, tile_pixels: self.tiles.pixels(rows), ..*batch });
                }
                compute.set_bind_group(0, &self.memory.bound.resolve, &[own]);
                compute.set_bind_group(1, &self.memory.bound.splats[target], &[]);
                compute.dispatch_workgroups(groups, 1, 1);
            }
        }
    }

    /// Cuts the next pass so that a batch takes about a slice.
    fn cut(&mut self) {
        if self.pairs_per_second > 0.0 {
            let pairs = self.pairs_per_second * self.slice.as_secs_f64();
            self.batches = self.tiles.batches((pairs / f64::from(self.tiles.size[0])) as u32);
        }
    }

    /// Waits for the oldest submission.
    async fn wait(&mut self) -> Result<(), GpuError> {
        let Some(oldest) = self.in_flight.pop_front() else { return Ok(()) };
        let ended = loop {
            self.gpu.wait(Some(oldest.index.clone()), &oldest.bell).await?;
            let ended = *oldest.done.lock().unwrap_or_else(PoisonError::into_inner);
            // A thread that was woken by the device may hear of it a little earlier.
            if ended.is_some() || task::THREADS {
                break ended.unwrap_or_else(Instant::now);
            }
        };
        let seconds = ended.saturating_duration_since(oldest.began).as_secs_f64().max(1e-6);
        // The next one has been waiting for this one: its own time begins now.
        if let Some(next) = self.in_flight.front_mut() {
            next.began = next.began.max(ended);
        }
        let blend = |old: f64, new: f64| if old > 0.0 { 0.7 * old + 0.3 * new } else { new };
        self.pairs_per_second = blend(self.pairs_per_second, oldest.pairs as f64 / seconds);
        self.seconds_per_batch = blend(self.seconds_per_batch, seconds / oldest.batches.max(1) as f64);
        Ok(())
    }

    /// Waits until everything submitted is done.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn finish(&mut self) -> Result<(), GpuError> {
        while !self.in_flight.is_empty() {
            self.wait().await?;
        }
        Ok(())
    }

    /// Moves everything summed up on the device into the film.
    ///
    /// # Errors
    /// If the device is lost, or what it summed up is not to be trusted; the film is then as it was.
    pub async fn collect(&mut self, film: &mut Film) -> Result<Counts, GpuError> {
        self.finish().await?;
        let header =
            self.memory.take(&self.gpu, &self.memory.output, HEADER, |bytes| bytemuck::cast_slice::<u8, u32>(bytes).to_vec()).await?;
        let wide = |i: usize| u64::from(header[i]) | u64::from(header[i + 1]) << 32;
        if header[7] > 0 {
            return Err(GpuError::WrongResult("a ray needed a deeper stack than the hierarchy's depth"));
        }
        if header[8] > 0 {
            return Err(GpuError::WrongResult("its driver ended a loop too early; choose fewer edges"));
        }
        // Everything is fetched before anything is added: a device may be lost between two buffers.
        let (mut pixels, mut splats): (Vec<Vec<f32>>, Vec<Vec<u32>>) = Default::default();
        for buffer in self.memory.pixel_layers.iter().filter(|_| self.runs.eye) {
            pixels.push(self.memory.take(&self.gpu, buffer, buffer.size(), |bytes| bytemuck::cast_slice(bytes).to_vec()).await?);
        }
        for buffer in self.memory.splat_layers.iter().filter(|_| self.runs.splats) {
            splats.push(self.memory.take(&self.gpu, buffer, buffer.size(), |bytes| bytemuck::cast_slice(bytes).to_vec()).await?);
        }
        let tiles = self.tiles.list();
        tiles.iter().zip(&pixels).for_each(|(&(first, rows), sums)| film.absorb_pixels(first, rows, sums));
        tiles.iter().zip(&splats).for_each(|(&(first, rows), words)| film.absorb_splats(first, rows, words));
        film.count_samples(&self.rows);
        self.rows.fill(0);
        Ok(Counts { rays_closest: wide(1), rays_shadow: wide(3), non_finite: header[5].into(), saturated: header[6].into() })
    }
}
