//! Which settings of the sky pay: a walk from cheap settings to dear ones that always refines the group of settings which lowers the
//! error most for the time that it adds; prints Markdown.
//!
//! `cargo run --release --example preset_search -- [--most-ms MS] [--random FIRST..LAST] [SCENES...]`
//!
//! SCENES are files or folders of them. Pictures by the source function are held against one by far finer settings of the renderer
//! itself, not against truths: presets that are chosen from this walk have seen neither the path tracer's pictures nor the tables of
//! other codes. Means over scenes are geometric. Every row is a step of the walk, with what each refinement that it might take next
//! would change.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};

use welkin::gpu::DeviceRequest;
use welkin::plan::{MultipleScattering, Outputs, Quality, Settings, SourceGrid};
use welkin::renderer::Renderer;
use welkin::report::{SampleGrid, distance, random_scene};
use welkin::scene::Scene;
use welkin_lut::spectrum::Channels;

/// Values of one group of settings, from coarse to fine.
struct Group {
    name: &'static str,
    count: usize,
    /// Takes one of the values.
    take: fn(&mut Settings, usize),
    /// A value in words.
    value: fn(&Settings) -> String,
}

const DIRECTIONS: [[u32; 4]; 4] = [[4, 4, 4, 8], [4, 5, 5, 8], [5, 6, 5, 10], [6, 8, 6, 12]];
const SUNS: [u32; 5] = [32, 40, 48, 64, 80];
const ALTITUDES: [u32; 5] = [12, 14, 18, 24, 32];
const ORDERS: [u32; 4] = [3, 4, 5, 6];

const GROUPS: [Group; 4] = [
    Group {
        name: "directions",
        count: DIRECTIONS.len(),
        take: |settings, value| {
            let [ground, low, high, azimuths] = DIRECTIONS[value];
            settings.source_grid = SourceGrid { ground, low, high, azimuths };
        },
        value: |settings| {
            let SourceGrid { ground, low, high, azimuths } = settings.source_grid;
            format!("({ground} + {low} + {high}) x {azimuths}")
        },
    },
    Group {
        name: "suns",
        count: SUNS.len(),
        take: |settings, value| settings.source_size[0] = SUNS[value],
        value: |settings| settings.source_size[0].to_string(),
    },
    Group {
        name: "altitudes",
        count: ALTITUDES.len(),
        take: |settings, value| settings.source_size[1] = ALTITUDES[value],
        value: |settings| settings.source_size[1].to_string(),
    },
    Group {
        name: "orders",
        count: ORDERS.len(),
        take: |settings, value| settings.source_orders = ORDERS[value],
        value: |settings| settings.source_orders.to_string(),
    },
];

/// A value of each group.
type Place = [usize; GROUPS.len()];

/// The cheapest place; the walk begins here.
const START: Place = [0; GROUPS.len()];

/// Mean over the scenes.
#[derive(Clone, Copy)]
struct Price {
    error: f64,
    worst: f64,
    milliseconds: f64,
}

struct Search {
    renderer: Renderer,
    /// Scenes, what is left out of their pictures, and the finest picture.
    scenes: Vec<(SampleGrid, Vec<bool>, Vec<[f32; 3]>)>,
    known: HashMap<Place, Price>,
}

fn settings(place: Place) -> Settings {
    let mut settings =
        Settings { multiple_scattering: MultipleScattering::SourceFunction, ..Settings::of(Quality::High) };
    for (group, value) in GROUPS.iter().zip(place) {
        (group.take)(&mut settings, value);
    }
    settings
}

/// Finer than anything that is tried.
fn finest() -> Settings {
    let ultra = Settings::of(Quality::Ultra);
    Settings {
        multiple_scattering: MultipleScattering::SourceFunction,
        nodes_per_leg: 20,
        optical_depth_size: [1024, 256],
        source_grid: SourceGrid { ground: 7, low: 11, high: 7, azimuths: 14 },
        source_size: [80, 32],
        source_orders: 6,
        sky_view_size: [144, 288],
        lattice_tolerance: 1e-4,
        ..ultra
    }
}

impl Search {
    fn new(scenes: Vec<Scene>) -> Self {
        let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
        let prepared = scenes.into_iter().map(|scene| {
            let grid = SampleGrid::new(&scene);
            let (picture, _) = once(&mut renderer, &grid, finest());
            eprintln!("finest of {}", scene.name);
            let left_out = grid.left_out();
            (grid, left_out, picture)
        });
        let scenes = prepared.collect();
        Self { renderer, scenes, known: HashMap::new() }
    }

    fn price(&mut self, place: Place) -> Price {
        if let Some(price) = self.known.get(&place) {
            return *price;
        }
        let (mut errors, mut times) = (Vec::new(), Vec::new());
        for (grid, left_out, finest) in &self.scenes {
            let (picture, milliseconds) = render(&mut self.renderer, grid, settings(place));
            let error = distance(&picture, finest, Channels::Bands, left_out);
            errors.push(error.unwrap_or_else(|| panic!("{} is black", grid.picture.name)));
            times.push(milliseconds);
        }
        let price = Price {
            error: geometric_mean(&errors),
            worst: errors.iter().copied().fold(0.0, f64::max),
            milliseconds: geometric_mean(&times),
        };
        eprintln!(
            "{place:?}: {:.3} %, worst {:.2} %, {:.0} ms",
            100.0 * price.error,
            100.0 * price.worst,
            price.milliseconds
        );
        self.known.insert(place, price);
        price
    }

    /// From the start until pictures take too long or nothing can be finer.
    fn walk(&mut self, most_ms: f64) {
        let names = GROUPS.map(|group| group.name).join(" | ");
        println!("| {names} | error % | worst % | ms | finer: error and time, over this |");
        println!("|{}", "---|".repeat(GROUPS.len() + 4));
        let mut place = START;
        loop {
            let here = self.price(place);
            let finer: Vec<Finer> = self.refinements(place, here);
            let words: Vec<String> = finer.iter().map(ToString::to_string).collect();
            let at = settings(place);
            let values = GROUPS.map(|group| (group.value)(&at)).join(" | ");
            let Price { error, worst, milliseconds } = here;
            let errors = format!("{:.3} | {:.2}", 100.0 * error, 100.0 * worst);
            println!("| {values} | {errors} | {milliseconds:.0} | {} |", words.join("; "));
            match finer.iter().max_by(|a, b| a.worth().total_cmp(&b.worth())) {
                Some(best) if best.time * milliseconds <= most_ms => place = best.place,
                _ => return,
            }
        }
    }

    /// One group finer, each in turn.
    fn refinements(&mut self, place: Place, here: Price) -> Vec<Finer> {
        let groups = (0..GROUPS.len()).filter(|&group| place[group] + 1 < GROUPS[group].count);
        let mut finer = |group| {
            let place = std::array::from_fn(|i| place[i] + usize::from(i == group));
            let Price { error, milliseconds, .. } = self.price(place);
            Finer { group, place, error: error / here.error, time: milliseconds / here.milliseconds }
        };
        groups.map(&mut finer).collect()
    }
}

/// A place where one group is finer; error and time over those of the place before.
struct Finer {
    group: usize,
    place: Place,
    error: f64,
    time: f64,
}

impl Finer {
    /// By how much the error falls for the time, in logarithms. What costs nothing that can be measured is worth any gain.
    fn worth(&self) -> f64 {
        -self.error.ln() / self.time.max(1.02).ln()
    }
}

impl fmt::Display for Finer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {:.3}, {:.2}", GROUPS[self.group].name, self.error, self.time)
    }
}

/// A picture at the grid's pixels, and the time of all passes, ms; with what drivers compile at a first dispatch.
fn once(renderer: &mut Renderer, grid: &SampleGrid, settings: Settings) -> (Vec<[f32; 3]>, f64) {
    renderer.forget();
    let rendered = renderer
        .render(&grid.picture, settings, Outputs::default())
        .unwrap_or_else(|error| panic!("{}: {error}", grid.picture.name));
    (grid.sample(&rendered.frame), rendered.timings.milliseconds.values().sum())
}

/// The same once all is compiled.
fn render(renderer: &mut Renderer, grid: &SampleGrid, settings: Settings) -> (Vec<[f32; 3]>, f64) {
    let compiled = renderer.compiled_pipelines();
    let rendered = once(renderer, grid, settings);
    if renderer.compiled_pipelines() > compiled { once(renderer, grid, settings) } else { rendered }
}

fn geometric_mean(values: &[f64]) -> f64 {
    (values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64).exp()
}

fn scenes_of(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_owned()];
    }
    let entries = std::fs::read_dir(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

fn main() {
    let mut words = std::env::args().skip(1);
    let (mut most_ms, mut scenes) = (f64::INFINITY, Vec::new());
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--most-ms" => most_ms = value().parse().expect("a number of milliseconds"),
            "--random" => {
                let range = value();
                let (first, last) = range.split_once("..").expect("as in 100..110");
                let numbers: [u64; 2] = [first, last].map(|number| number.parse().expect("a whole number"));
                scenes.extend(
                    (numbers[0]..numbers[1]).map(|n| random_scene(n).unwrap_or_else(|error| panic!("{error}"))),
                );
            }
            path => scenes.extend(
                scenes_of(path.as_ref()).iter().map(|file| Scene::read(file).unwrap_or_else(|error| panic!("{error}"))),
            ),
        }
    }
    assert!(!scenes.is_empty(), "no scenes: name files or folders, or --random");
    Search::new(scenes).walk(most_ms);
}
