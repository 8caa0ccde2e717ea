//! Random scenes, rendered with small tables until so many have kept the laws. The long form of `tests/random_scenes.rs`.
//!
//! `cargo run --release --example random_scenes -- COUNT [VALUES] [SEED]`
//!
//! Nearly all of the time of a random scene is the compiling of its shaders. Few are drawn whole, therefore, and each of them
//! is rendered with VALUES other sets of numbers (by default 1000), or as many as a minute allows, which mostly need the same shaders. What
//! breaks a law is made small and kept in `tests/regressions/`.

#[path = "../tests/hard_cases/laws.rs"]
#[allow(dead_code)]
mod laws;
#[path = "../tests/scene_strategy/mod.rs"]
mod scene_strategy;

use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{fs, io};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use scene_strategy::shrink::shrunk;
use scene_strategy::trial::{Fate, Fates, fate, keep};
use scene_strategy::values::with_other_numbers;
use welkin::gpu::DeviceRequest;
use welkin::renderer::Renderer;

/// A scene whose numbers ask for ever new shaders is left after so many.
const MOST_PIPELINES: u64 = 60;
/// And after so long, so that the time is not all spent on the slowest.
const LONGEST: Duration = Duration::from_secs(60);
/// Trials of making a failing scene small.
const TRIALS: usize = 300;
/// Share of the fields of an example scene that a random one's take the place of.
const CROSSED: f64 = 0.25;

fn main() -> ExitCode {
    let mut words = std::env::args().skip(1).map(|word| word.parse().unwrap_or_else(|error| panic!("{word}: {error}")));
    let count = words.next().expect("how many scenes");
    let values = words.next().unwrap_or(1000);
    let seed = words.next().unwrap_or(std::process::id() as usize);
    let mut sweep = Sweep::new(seed);
    while sweep.rendered() < count {
        sweep.structure(count, values);
    }
    println!("{:?} of {} scenes drawn whole; {} broke a law", sweep.fates, sweep.structures, sweep.failures);
    if sweep.failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn new_renderer() -> Renderer {
    let request = DeviceRequest { poisons_memory: true, ..DeviceRequest::default() };
    Renderer::new(&request).unwrap_or_else(|error| panic!("{error}"))
}

struct Sweep {
    renderer: Renderer,
    /// What it has drawn before.
    earlier: toml::Table,
    runner: TestRunner,
    schema: serde_json::Value,
    /// The example scenes.
    known: Vec<toml::Table>,
    fates: Fates,
    structures: usize,
    failures: usize,
    began: Instant,
}

impl Sweep {
    fn new(seed: usize) -> Self {
        let random = TestRng::from_seed(RngAlgorithm::ChaCha, &seed.to_le_bytes().repeat(4));
        let mut known = Vec::new();
        collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"), &mut known).expect("the example scenes");
        Self {
            renderer: new_renderer(),
            earlier: toml::Table::new(),
            runner: TestRunner::new_with_rng(Config::default(), random),
            schema: welkin::scene::schema(),
            known,
            fates: Fates::new(),
            structures: 0,
            failures: 0,
            began: Instant::now(),
        }
    }

    fn rendered(&self) -> usize {
        self.fates.get(&Fate::Rendered).copied().unwrap_or(0)
    }

    fn draw<S: Strategy>(&mut self, strategy: S) -> S::Value {
        strategy.new_tree(&mut self.runner).expect("nothing is filtered").current()
    }

    /// A scene drawn whole: every second one an example with some fields of a random scene. All are of few pixels.
    fn whole(&mut self) -> toml::Table {
        let random = self.draw(scene_strategy::scene_file());
        if self.structures.is_multiple_of(2) {
            return of_few_pixels(random, false);
        }
        let index = self.draw(0..self.known.len());
        let mut table = self.known[index].clone();
        for (name, value) in random {
            if self.draw(prop::bool::weighted(CROSSED)) {
                table.insert(name, value);
            }
        }
        of_few_pixels(table, true)
    }

    /// One scene drawn whole, with many sets of numbers.
    fn structure(&mut self, count: usize, values: usize) {
        let (whole, began, compiled) = (self.whole(), Instant::now(), self.renderer.compiled_pipelines());
        self.structures += 1;
        if !matches!(fate(&mut self.renderer, &whole.to_string(), false), Ok(Fate::Planned)) {
            return;
        }
        let before = self.rendered();
        let mut table = whole.clone();
        for _ in 0..values {
            let pipelines = self.renderer.compiled_pipelines() - compiled;
            if self.rendered() == count || pipelines > MOST_PIPELINES || began.elapsed() > LONGEST {
                break;
            }
            match fate(&mut self.renderer, &table.to_string(), true) {
                Ok(fate) => *self.fates.entry(fate).or_default() += 1,
                Err(words) => {
                    self.fail(table, &words);
                    break;
                }
            }
            let next = with_other_numbers(&self.schema, &whole, &mut self.runner);
            self.earlier = std::mem::replace(&mut table, next);
        }
        eprintln!(
            "{} of {count} in {:.0} s: {} with {} pipelines in {:.1} s; {:?}",
            self.rendered(),
            self.began.elapsed().as_secs_f64(),
            self.rendered() - before,
            self.renderer.compiled_pipelines() - compiled,
            began.elapsed().as_secs_f64(),
            self.fates
        );
    }

    /// Keeps what breaks a law by itself, made small. Where only what was drawn before can have made it break one, both are printed whole:
    /// trials of making it small would change that.
    fn fail(&mut self, table: toml::Table, words: &str) {
        self.failures += 1;
        eprintln!("{words}");
        let renderer = &mut new_renderer();
        if fate(renderer, &table.to_string(), true).is_ok() {
            let earlier = &self.earlier;
            eprintln!(
                "A renderer that has drawn nothing before keeps the law. It was broken by\n{table}\ndrawn after\n{earlier}"
            );
            return;
        }
        let small = shrunk(table, TRIALS, |table| fate(renderer, &table.to_string(), true).is_err());
        let why = fate(renderer, &small.to_string(), true).err().unwrap_or_else(|| words.to_owned());
        eprintln!("{}", keep(&small, &why));
    }
}

/// The scene in three by three pixels: `always`, or where the file says nothing and pictures would be large.
fn of_few_pixels(mut table: toml::Table, always: bool) -> toml::Table {
    let camera = table.entry("camera").or_insert_with(|| toml::Value::Table(toml::Table::new()));
    if let toml::Value::Table(camera) = camera {
        for side in ["width", "height"] {
            if always || !camera.contains_key(side) {
                camera.insert(side.to_owned(), toml::Value::Integer(3));
            }
        }
    }
    table
}

/// All scene files below a folder.
fn collect(folder: &Path, tables: &mut Vec<toml::Table>) -> io::Result<()> {
    let mut paths: Vec<_> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, tables)?;
        } else if let Ok(table) = fs::read_to_string(&path)?.parse() {
            tables.push(table);
        }
    }
    Ok(())
}
