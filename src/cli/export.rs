//! `export`: a scene's files for another renderer.

use super::args::ViewArgs;
use super::job::{say_notes, view};
use super::render::create_folder;
use super::values::positive;
use super::{Failure, print};
use crate::film::save::{check_writable, save_bytes};
use crate::report::mitsuba::{Exported, Options, export};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct ExportArgs {
    /// A built-in scene (see `scenes`), or a .gltf or .glb file
    pub scene: String,
    #[command(flatten)]
    pub view: ViewArgs,
    /// For whom: mitsuba is Mitsuba 3 (scene.xml, meshes as .ply, pictures as .exr)
    #[arg(long, value_name = "NAME", value_parser = ["mitsuba"])]
    pub format: String,
    /// Folder for the files
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Samples per pixel that the scene asks for
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true, default_value = "64")]
    pub spp: u32,
    /// Materials that Mitsuba lacks are ours, in a Python file to be imported first, not Mitsuba's nearest
    #[arg(long)]
    pub plugins: bool,
}

/// Carries out `export`.
pub fn run(args: &ExportArgs) -> Result<(), Failure> {
    let job = view(&args.scene, &args.view)?;
    job.check()?;
    let made = export(&job, &Options { spp: args.spp, plugins: args.plugins });
    let Exported { files, notes } = made.map_err(|reason| Failure(format!("{}: {reason}", args.scene)))?;
    create_folder(&args.output)?;
    for (name, bytes) in &files {
        let path = args.output.join(name);
        path.parent().map_or(Ok(()), create_folder)?;
        check_writable(&path)?;
        save_bytes(&path, bytes)?;
    }
    say_notes(&job.scene);
    notes.iter().for_each(|note| eprintln!("note: {note}"));
    let bytes: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    let size = if bytes < 1_000_000 { format!("{} kB", bytes.div_ceil(1000)) } else { format!("{:.1} MB", bytes as f64 * 1e-6) };
    print(&format!("wrote {} and {} more files, {size}\n", args.output.join("scene.xml").display(), files.len() - 1));
    Ok(())
}
