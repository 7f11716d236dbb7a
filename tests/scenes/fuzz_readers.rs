//! The other readers with random changes: environments and pictures (.hdr, .exr), films with sums (.exr), links. As in `fuzz`, some
//! thousands always, many on demand by the same command.

use super::environment::{exr, hdr};
use super::fuzz::{Change, PATIENCE, change, for_long};
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::film::picture::Picture;
use bdpt_explorer::film::runs::Runs;
use bdpt_explorer::film::save::Window;
use bdpt_explorer::film::sums::{About, Sums};
use bdpt_explorer::scene::builtin;
use bdpt_explorer::scene::environment::Environment;
use bdpt_explorer::ui::link::Link;
use proptest::collection::vec;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is read, and what is wrong with what came of it, if anything is.
struct Reader {
    name: &'static str,
    originals: Vec<Vec<u8>>,
    read: fn(&[u8]) -> Result<(), String>,
}

/// A message that people can read: one line that ends.
fn sentence(message: &str) -> Result<(), String> {
    if message.is_empty() || message.contains('\n') || message.len() > 2000 { Err(format!("no sentence: {message:?}")) } else { Ok(()) }
}

fn environment(bytes: &[u8]) -> Result<(), String> {
    let mut notes = Vec::new();
    match Environment::decode(bytes, 30.0, &mut notes) {
        Ok(map) => {
            notes.iter().try_for_each(|note| sentence(note))?;
            let good = |x: f32| x.is_finite() && x >= 0.0;
            let finite = map.texels.iter().all(|texel| texel.radiance.to_array().into_iter().all(good) && good(texel.pdf_sa));
            if finite { Ok(()) } else { Err("radiance that is no radiance".to_owned()) }
        }
        Err(message) => sentence(&message),
    }
}

fn picture(bytes: &[u8]) -> Result<(), String> {
    match Picture::decode(bytes) {
        Ok(picture) if picture.pixels.len() as u64 == u64::from(picture.size[0]) * u64::from(picture.size[1]) => Ok(()),
        Ok(picture) => Err(format!("{:?} with {} pixels", picture.size, picture.pixels.len())),
        Err(message) => sentence(&message),
    }
}

fn sums_file() -> PathBuf {
    // A file each thread may write over.
    std::env::temp_dir().join(format!("bdpt-fuzz-{}-{:?}.exr", std::process::id(), std::thread::current().id()))
}

fn sums(bytes: &[u8]) -> Result<(), String> {
    let path = sums_file();
    std::fs::write(&path, bytes).map_err(|error| error.to_string())?;
    let found = Sums::open(&path);
    std::fs::remove_file(&path).map_err(|error| error.to_string())?;
    match found {
        Ok(sums) if sums.values.len() as u64 == u64::from(sums.about.window.rect.width) * u64::from(sums.about.window.rect.height) => {
            Ok(())
        }
        Ok(sums) => Err(format!("{:?} with {} values", sums.about.window, sums.values.len())),
        Err(error) => sentence(&error.to_string()),
    }
}

/// What a link says is either understood, and then said again in the same words, or told.
fn link(bytes: &[u8]) -> Result<(), String> {
    let text = String::from_utf8_lossy(bytes);
    let Ok((link, _)) = Link::parse(&text) else { return Ok(()) };
    let said = link.to_text();
    let (again, ignored) = Link::parse(&said).map_err(|bytes| format!("its own words are {bytes} bytes"))?;
    if !ignored.iter().all(|x| x.piece.starts_with("v=") || x.piece.starts_with("est=")) {
        return Err(format!("it does not understand itself: {said}: {ignored:?}"));
    }
    if again.to_text() == said { Ok(()) } else { Err(format!("{said}\n{}", again.to_text())) }
}

fn readers() -> [Reader; 4] {
    let texels: Vec<[f32; 3]> = (0..64u8).map(|i| [f32::from(i) * 0.5, 1.0, 1e-3 * f32::from(i)]).collect();
    let channel = |c: usize| texels.iter().map(|texel| texel[c]).collect::<Vec<f32>>();
    let [r, g, b] = [0, 1, 2].map(channel);
    let maps = vec![hdr([16, 4], &texels), hdr([8, 8], &texels), exr([16, 4], &[&[("R", &r), ("G", &g), ("B", &b)]])];
    let job = Job { size: [12, 9], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) };
    let shown: Vec<_> = job.existence().active(&job.settings).collect();
    let mut session = Session::new(job.clone()).unwrap();
    while session.passes() < 2 {
        session.step(Duration::from_secs(1));
    }
    let path = std::env::temp_dir().join(format!("bdpt-fuzz-{}-film.exr", std::process::id()));
    let made = session.sums(&shown, Runs::parse("0:2").unwrap());
    let about = About::new("cornell".to_owned(), Window::full(job.size), made.about.facts.clone(), made.about.runs.clone());
    Sums { about, values: made.values }.save(&path).unwrap();
    let film = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let links = [
        "#v=1&est=3&lang=zh&scene=spots&env=0.5,0.25,0.001&turn=-12.5&cam=1&pose=0,1,2.5,1,0,0,0,1,0,0,0,-1,0.7&lens=0.03,inf&size=640x360",
        "#v=1&scene=cornell&k=8&seed=7&sampler=sobol&weights=balance&beta=1.5&cutoff=0.2&roulette=off&fresh=off&light=4&use=pt,s2t1&hide=none,s1t2",
        "https://example.org/#v=1&file=a%20b.glb&px=256,300&n=3&strategy=s2t2&ev=1.5&view=3,100,50.5&picture=s1t2.raw&whatif=power,3,0.1",
    ];
    let links = links.map(|text| text.as_bytes().to_vec()).to_vec();
    [
        Reader { name: "environment", originals: maps.clone(), read: environment },
        Reader { name: "picture", originals: maps.into_iter().chain([film.clone()]).collect(), read: picture },
        Reader { name: "sums", originals: vec![film], read: sums },
        Reader { name: "link", originals: links, read: link },
    ]
}

impl Reader {
    /// Reads bytes in time, without a panic.
    fn survives(&self, bytes: &[u8], what: &str) -> Result<(), String> {
        let start = Instant::now();
        let outcome = std::panic::catch_unwind(|| (self.read)(bytes)).unwrap_or_else(|_| Err("it panics".to_owned()));
        let late = start.elapsed() > PATIENCE;
        match outcome {
            Ok(()) if !late => Ok(()),
            _ => {
                let path = std::env::temp_dir().join(format!("bdpt-fuzz-failure.{}", self.name));
                let kept = std::fs::write(&path, bytes).map(|()| path.display().to_string()).unwrap_or_default();
                Err(format!("{} of {what}: {outcome:?}, late {late}; the bytes are in {kept}", self.name))
            }
        }
    }

    /// Reads `cases` changed files of each kind; the same every time for the same `seed`.
    fn run(&self, seed: u64, cases: u32) {
        for original in &self.originals {
            self.survives(original, "what nobody changed").unwrap();
            let config = Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(seed), ..Config::default() };
            let result = TestRunner::new(config).run(&vec(change(), 1..5), |changes: Vec<Change>| {
                let (mut bytes, whole) = (original.clone(), original.len());
                changes.iter().for_each(|change| change.apply(&mut bytes, whole));
                self.survives(&bytes, "a changed file").map_err(proptest::test_runner::TestCaseError::fail)
            });
            if let Err(error) = result {
                panic!("seed {seed}: {error}");
            }
        }
    }
}

#[test]
fn changed_pictures_films_and_links_are_told_and_do_no_harm() {
    readers().iter().for_each(|reader| reader.run(2, 1_000));
    // The control: a reader that believes a file's own word is found out.
    let broken = |bytes: &[u8]| if bytes[0] == 0x76 { Ok(()) } else { Err("believed".to_owned()) };
    let control = Reader { name: "control", originals: vec![vec![0x76; 40]], read: broken };
    assert!(std::panic::catch_unwind(|| control.run(2, 1_000)).is_err());
}

#[test]
#[ignore = "as long as BDPT_FUZZ_SECONDS says"]
fn changed_pictures_films_and_links_for_long() {
    let readers = readers();
    for_long(|seed| readers.iter().map(|reader| reader.run(seed, 2_000)).count() as u32 * 2_000);
}
