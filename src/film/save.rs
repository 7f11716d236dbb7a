//! Pictures into files: EXR with named float channels, PNG with eight bits.
//!
//! A file is complete or it is not there: it is encoded in memory, written beside its destination under a temporary name,
//! and renamed. [`check_writable`] finds a bad destination before the hours of rendering that would be lost to it.

use super::Rect;
use crate::math::Vec3;
use ::exr::prelude as exr;
use exr::WritableImage;
use std::fmt;
use std::fs;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

/// A file that could not be written.
#[derive(Debug)]
pub struct SaveError {
    path: PathBuf,
    reason: String,
}

impl SaveError {
    fn new(path: &Path, reason: impl fmt::Display) -> Self {
        Self { path: path.to_owned(), reason: reason.to_string() }
    }
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reason = self.reason.split_whitespace().collect::<Vec<_>>().join(" ");
        write!(f, "cannot write '{}': {reason}", self.path.display())
    }
}

impl std::error::Error for SaveError {}

/// Which pixels of the film a file holds: all of them, or a crop window. An EXR keeps its place on the film (data window
/// inside display window); a PNG is just the rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Size of the full film.
    pub film: [u32; 2],
    /// The part of it.
    pub rect: Rect,
}

impl Window {
    /// The full film.
    pub fn full(film: [u32; 2]) -> Self {
        Self { film, rect: Rect::full(film) }
    }

    /// The window's width and height.
    pub fn size(&self) -> [u32; 2] {
        [self.rect.width, self.rect.height]
    }

    /// The window's pixels out of the film's, row by row from the top.
    pub fn pick<'a>(&self, film: &'a [Vec3]) -> impl Iterator<Item = Vec3> + 'a {
        let Rect { x, y, width, height } = self.rect;
        let stride = self.film[0] as usize;
        (y..y + height).flat_map(move |y| film[y as usize * stride + x as usize..][..width as usize].iter().copied())
    }
}

/// An RGB layer of an EXR file.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    /// "" for the plain channels R, G, B; "weighted.s2t1" for weighted.s2t1.R, …
    pub name: &'a str,
    /// The full film's pixels, linear radiance.
    pub pixels: &'a [Vec3],
}

/// Saves linear f32 layers as one EXR file, compressed without loss.
pub fn save_exr(path: &Path, window: Window, layers: &[Layer<'_>]) -> Result<(), SaveError> {
    save_bytes(path, &exr_bytes(window, layers).map_err(|error| SaveError::new(path, error))?)
}

/// The bytes of such a file.
///
/// # Errors
/// The encoder's sentence.
pub fn exr_bytes(window: Window, layers: &[Layer<'_>]) -> Result<Vec<u8>, String> {
    let channels = layers.iter().flat_map(|layer| {
        ["R", "G", "B"].into_iter().enumerate().map(move |(index, letter)| {
            let name = if layer.name.is_empty() { letter.to_owned() } else { format!("{}.{letter}", layer.name) };
            (name, window.pick(layer.pixels).map(|pixel| pixel[index]).collect())
        })
    });
    encode(window, channels, None)
}

/// The bytes of an EXR file of one channel, Y, row by row from the top.
///
/// # Errors
/// The encoder's sentence.
pub fn exr_grey_bytes(size: [u32; 2], values: Vec<f32>) -> Result<Vec<u8>, String> {
    encode(Window::full(size), std::iter::once(("Y".to_owned(), values)), None)
}

/// An EXR of these channels, named, each with the window's values row by row from the top; `label` is the name and the value of
/// a text in its header.
pub(super) fn encode(
    window: Window,
    channels: impl Iterator<Item = (String, Vec<f32>)>,
    label: Option<(&str, &str)>,
) -> Result<Vec<u8>, String> {
    let channels = channels.map(|(name, values)| exr::AnyChannel::new(name.as_str(), exr::FlatSamples::F32(values))).collect();
    let encoding =
        exr::Encoding { compression: exr::Compression::ZIP16, blocks: exr::Blocks::ScanLines, line_order: exr::LineOrder::Increasing };
    let rect = window.rect;
    let pair = |x: u32, y: u32| exr::Vec2(x as usize, y as usize);
    let mut attributes = exr::LayerAttributes { layer_position: pair(rect.x, rect.y).to_i32(), ..Default::default() };
    if let Some((name, text)) = label {
        // A header is bytes: UTF-8, whatever is in it.
        attributes.other.insert(exr::Text::from(name), exr::AttributeValue::Text(exr::Text::from_slice_unchecked(text.as_bytes())));
    }
    let layer = exr::Layer::new(pair(rect.width, rect.height), attributes, encoding, exr::AnyChannels::sort(channels));
    let display = exr::IntegerBounds::new((0, 0), pair(window.film[0], window.film[1]));
    let image = exr::Image::new(exr::ImageAttributes::new(display), layer);
    let mut bytes = Vec::new();
    image.write().to_buffered(Cursor::new(&mut bytes)).map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// Saves eight-bit sRGB as PNG.
pub fn save_png(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<(), SaveError> {
    save_bytes(path, &png_bytes(size, rgb).map_err(|error| SaveError::new(path, error))?)
}

/// The bytes of such a file.
///
/// # Errors
/// The encoder's sentence.
pub fn png_bytes(size: [u32; 2], rgb: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    image::write_buffer_with_format(&mut bytes, rgb, size[0], size[1], image::ExtendedColorType::Rgb8, image::ImageFormat::Png)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Saves `bytes` as a whole or not at all.
pub fn save_bytes(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    if is_device(path) {
        let append = || fs::OpenOptions::new().append(true).open(path)?.write_all(bytes);
        return append().map_err(|error| SaveError::new(path, error));
    }
    let write = || {
        let mut file = Temporary::beside(path)?;
        file.file.write_all(bytes)?;
        file.file.sync_all()?;
        file.rename()
    };
    write().map_err(|error: io::Error| SaveError::new(path, error))
}

/// Fails now if [`save_bytes`] would fail later. Leaves nothing behind.
pub fn check_writable(path: &Path) -> Result<(), SaveError> {
    let folder = folder_of(path);
    if path.is_dir() || path.file_name().is_none() {
        return Err(SaveError::new(path, "it is a folder; name a file in it"));
    }
    if !folder.is_dir() {
        return Err(SaveError::new(path, format!("there is no folder '{}'; create it first", folder.display())));
    }
    if is_device(path) {
        return Ok(());
    }
    Temporary::beside(path)
        .map(drop)
        .map_err(|error| SaveError::new(path, format!("the folder takes no new file ({error}); choose another")))
}

/// Something like /dev/stdout (also where that is a file by redirection): added to, never replaced.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|what| !what.is_dir() && (!what.is_file() || path.starts_with("/dev")))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file under a temporary name in the folder of its destination; removed again unless it is renamed.
struct Temporary {
    file: fs::File,
    name: PathBuf,
    destination: PathBuf,
}

impl Temporary {
    fn beside(path: &Path) -> io::Result<Self> {
        // Through a symbolic link, so that the link survives and its target is replaced.
        let destination = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let mut name = std::ffi::OsString::from(".");
        name.push(destination.file_name().unwrap_or_default());
        name.push(format!(".{}.tmp", std::process::id()));
        let name = folder_of(&destination).join(name);
        Ok(Self { file: fs::File::create(&name)?, name, destination })
    }

    fn rename(self) -> io::Result<()> {
        fs::rename(&self.name, &self.destination)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After `rename` there is nothing under this name; before it, this is the clean-up, and nobody could be told more.
        let _ = fs::remove_file(&self.name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::traits::*;

    fn gradient(size: [u32; 2]) -> Vec<Vec3> {
        (0..size[0] * size[1]).map(|i| Vec3::new(i as f32, 1e-20 * i as f32, -0.5)).collect()
    }

    #[test]
    fn an_exr_holds_every_channel_bit_for_bit_at_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let pixels = gradient([5, 4]);
        let window = Window { film: [5, 4], rect: Rect { x: 2, y: 1, width: 3, height: 2 } };
        save_exr(&path, window, &[Layer { name: "", pixels: &pixels }, Layer { name: "raw.s2t1", pixels: &pixels }]).unwrap();
        let image = exr::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .unwrap();
        assert_eq!(image.layer_data.attributes.layer_position, exr::Vec2(2, 1));
        assert_eq!(image.attributes.display_window.size, exr::Vec2(5, 4));
        let channels = &image.layer_data.channel_data.list;
        let names: Vec<_> = channels.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R", "raw.s2t1.B", "raw.s2t1.G", "raw.s2t1.R"]);
        let red: Vec<_> = channels[5].sample_data.values_as_f32().collect();
        assert_eq!(red, [7.0, 8.0, 9.0, 12.0, 13.0, 14.0]);
        assert!(channels.iter().all(|c| matches!(c.sample_data, exr::FlatSamples::F32(_))));
    }

    #[test]
    fn a_failed_save_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none/a.png");
        assert!(check_writable(&missing).unwrap_err().to_string().contains("there is no folder"));
        assert!(save_png(&missing, [1, 1], &[0, 0, 0]).is_err());
        assert!(check_writable(folder.path()).unwrap_err().to_string().contains("name a file in it"));
        assert!(save_bytes(folder.path(), b"x").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_save_replaces_the_old_file_and_nothing_else_remains() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        fs::write(&path, "old").unwrap();
        check_writable(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        save_png(&path, [2, 1], &[1, 2, 3, 4, 5, 6]).unwrap();
        assert_eq!(image::open(&path).unwrap().to_rgb8().into_raw(), [1, 2, 3, 4, 5, 6]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
