//! Films with sums, read from files. Whatever a file holds, the answer is a film that is complete, or one sentence.

use super::super::runs::Runs;
use super::super::save::Window;
use super::{About, FORMAT, LABEL, LAYERS, Label, Sums, SumsError, UNNAMED, facts_of};
use crate::film::Rect;
use ::exr::block::reader::Reader;
use ::exr::meta::header::Header;
use ::exr::prelude as exr;
use ::exr::prelude::traits::*;
use serde::Deserialize;
use std::fmt;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;

/// Most pixels of a film that is read.
const MOST_PIXELS: u64 = 1 << 26;
/// Longest side.
const MOST_SIDE: usize = 1 << 15;
/// The first bytes of an EXR file.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// lo is at most this part of hi: a unit in its last place.
const LAST_PLACE: f32 = f32::EPSILON;

/// What can be wrong with a file that could be opened.
enum Flaw {
    NoSums,
    Other(String),
}

impl Flaw {
    fn damaged(error: impl fmt::Display) -> Self {
        Self::Other(format!("cannot be decoded ({error}); it is damaged or cut short: render it again"))
    }

    fn of(self, path: &Path) -> SumsError {
        match self {
            Self::NoSums => SumsError::NoSums(path.to_owned()),
            Self::Other(reason) => SumsError::Unreadable(path.to_owned(), reason),
        }
    }
}

/// See [`About::open`].
pub fn about(path: &Path) -> Result<About, SumsError> {
    let reader = open(path)?;
    about_of(reader.headers()).map_err(|flaw| flaw.of(path))
}

/// See [`Sums::open`].
pub fn sums(path: &Path) -> Result<Sums, SumsError> {
    let reader = open(path)?;
    let about = about_of(reader.headers()).map_err(|flaw| flaw.of(path))?;
    values(reader, &about).map(|values| Sums { about, values }).map_err(|flaw| flaw.of(path))
}

/// Opens a file and reads its header.
fn open(path: &Path) -> Result<Reader<BufReader<File>>, SumsError> {
    let failed = |reason: String| SumsError::Unreadable(path.to_owned(), reason);
    let cannot = |error: std::io::Error| {
        failed(match error.kind() {
            _ if path.is_dir() => "is a folder; name the .exr files in it".to_owned(),
            ErrorKind::NotFound => "is not there".to_owned(),
            ErrorKind::UnexpectedEof => "is no .exr file".to_owned(),
            _ => format!("cannot be read ({error})"),
        })
    };
    let mut file = BufReader::new(File::open(path).map_err(cannot)?);
    let mut first = [0; 4];
    file.read_exact(&mut first).and_then(|()| file.rewind()).map_err(cannot)?;
    if first != MAGIC {
        return Err(failed("is no .exr file".to_owned()));
    }
    ::exr::block::read(file, false).map_err(|error| Flaw::damaged(error).of(path))
}

/// What a header says.
fn about_of(headers: &[Header]) -> Result<About, Flaw> {
    let name = exr::Text::from(LABEL);
    let [header] = headers else { return Err(Flaw::NoSums) };
    let Some(exr::AttributeValue::Text(text)) = header.own_attributes.other.get(&name) else { return Err(Flaw::NoSums) };
    let label = label(text.as_slice())?;
    let runs = Runs::parse(&label.seeds).filter(|runs| runs.samples() == label.samples);
    let runs = runs.ok_or_else(|| Flaw::damaged("its seeds and its number of samples contradict each other"))?;
    let window = window(header)?;
    if facts_of(window).iter().any(|(name, value)| label.settings.get(name) != Some(value)) {
        return Err(Flaw::Other("is not as it was written: its picture was cropped or scaled; render it again".to_owned()));
    }
    let names = LAYERS.iter().flat_map(|layer| ["R", "G", "B"].map(|letter| format!("{layer}.{letter}")));
    for name in names {
        let channel = header.channels.list.iter().find(|channel| channel.name == *name.as_str());
        if !channel.is_some_and(|channel| channel.sample_type == exr::SampleType::F32 && channel.sampling == exr::Vec2(1, 1)) {
            return Err(Flaw::Other(format!("is not as it was written: {name} is missing, or no longer 32-bit floats; render it again")));
        }
    }
    let mut facts = label.settings;
    for (name, value) in UNNAMED {
        facts.entry(name.to_owned()).or_insert_with(|| value.to_owned());
    }
    Ok(About { scene: label.scene, window, facts, runs })
}

/// The text in the header.
fn label(text: &[u8]) -> Result<Label, Flaw> {
    #[derive(Deserialize)]
    struct Format {
        format: u32,
    }
    let Format { format } = serde_json::from_slice(text).map_err(Flaw::damaged)?;
    if format != FORMAT {
        return Err(Flaw::Other(format!(
            "was written by another version of this program (format {format}, this one reads {FORMAT}); merge it with that"
        )));
    }
    serde_json::from_slice(text).map_err(Flaw::damaged)
}

/// The film and the part of it, if they are of a sensible size.
fn window(header: &Header) -> Result<Window, Flaw> {
    let (whole, size) = (header.shared_attributes.display_window, header.layer_size);
    let corner = header.own_attributes.layer_position;
    let side = |side: usize| u32::try_from(side).ok().filter(|_| (1..=MOST_SIDE).contains(&side));
    let found = || {
        let film = [side(whole.size.0)?, side(whole.size.1)?];
        let (width, height) = (side(size.0)?, side(size.1)?);
        let place = |corner: i32, whole: i32| u32::try_from(i64::from(corner) - i64::from(whole)).ok();
        let (x, y) = (place(corner.0, whole.position.0)?, place(corner.1, whole.position.1)?);
        let fits = x.checked_add(width)? <= film[0] && y.checked_add(height)? <= film[1];
        let window = Window { film, rect: Rect { x, y, width, height } };
        (fits && u64::from(width) * u64::from(height) <= MOST_PIXELS && !header.deep).then_some(window)
    };
    found().ok_or_else(|| Flaw::damaged("its size makes no sense"))
}

/// The sums of all pixels.
fn values(reader: Reader<BufReader<File>>, about: &About) -> Result<Vec<[f64; 3]>, Flaw> {
    let [width, height] = about.window.size().map(|side| side as usize);
    let channel = |layer: usize, letter: &str| format!("{}.{letter}", LAYERS[layer]);
    type Pixel = (f32, f32, f32, f32, f32, f32);
    // What is not there in the end was not in the file.
    let image = exr::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required(&*channel(0, "R"))
        .required(&*channel(0, "G"))
        .required(&*channel(0, "B"))
        .required(&*channel(1, "R"))
        .required(&*channel(1, "G"))
        .required(&*channel(1, "B"))
        .collect_pixels(
            move |_, _| vec![[f64::NAN; 3]; width * height],
            move |values: &mut Vec<[f64; 3]>, exr::Vec2(x, y), pixel: Pixel| {
                let (r, g, b, r_lo, g_lo, b_lo) = pixel;
                if let Some(value) = values.get_mut(y * width + x).filter(|_| x < width) {
                    *value = [join(r, r_lo), join(g, g_lo), join(b, b_lo)];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(Flaw::damaged)?;
    let values = image.layer_data.channel_data.pixels;
    if let Some(at) = values.iter().position(|sum| !sum.iter().all(|sum| sum.is_finite())) {
        let (x, y) = (about.window.rect.x as usize + at % width, about.window.rect.y as usize + at / width);
        return Err(Flaw::damaged(format!("pixel {x},{y} has no sum")));
    }
    Ok(values)
}

/// A pair's number; none, if it is no pair.
fn join(hi: f32, lo: f32) -> f64 {
    let is_pair = lo.abs() <= hi.abs() * LAST_PLACE + f32::MIN_POSITIVE;
    if is_pair { f64::from(hi) + f64::from(lo) } else { f64::NAN }
}
