//! Scenes that are hard on numbers, and what must hold in each: the list behind `tests/stability.rs` and
//! `cargo run --release --example stability`.

#![allow(dead_code, reason = "the test and the command use different parts")]

mod cameras;
mod clouds;
mod lights;
mod media;
mod pictures;
mod planets;
mod volumes;

pub mod furnace;
pub mod judge;
pub mod laws;
pub mod truth;

use std::path::Path;

use welkin::plan::{Quality, Settings};
use welkin::scene::Scene;

/// A scene that is hard on numbers.
pub struct Case {
    /// What it is called in tables and messages.
    pub name: String,
    /// What differs from [`BASE`], as a scene file would say it.
    pub edit: String,
    /// What differs from the quality's settings.
    pub settings: fn(Settings) -> Settings,
    /// What its radiance is held to.
    pub bound: Bound,
    /// Whether it is one of the few that the quick form holds to the path tracer too.
    pub is_quick: bool,
    /// Whether only the command renders it, as its shaders take long to compile or to run.
    pub is_long: bool,
}

/// What holds for a case's radiance besides the laws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Within [`BY_DAY`] of the path tracer.
    Day,
    /// Within [`IN_TWILIGHT`] of the path tracer.
    Twilight,
    /// Nothing: why the path tracer has no answer.
    LawsOnly(&'static str),
}

/// The most that docs/accuracy.md finds by day against the tables of other codes, all views and altitudes, from `low` to
/// `ultra`, per cent: a hard case may be as hard as the hardest of those views, and not harder.
pub const BY_DAY: [f64; 4] = [9.1, 8.3, 7.8, 7.5];
/// The same with the sun below the horizon: the 99th percentile between 95° and 102°.
pub const IN_TWILIGHT: [f64; 4] = [37.8, 31.4, 31.5, 10.1];

/// The scene that all cases are changes to: the tables' clear Earth by day, irradiance 1, the sun in the picture.
pub const BASE: &str = r#"
preset = "hillaire2020"
[sun]
elevation_deg = 30
azimuth_deg = 200
irradiance = 1
angular_radius_deg = 0
limb_darkening = false
[camera]
altitude_m = 2
elevation_deg = 15
azimuth_deg = 150
vertical_field_of_view_deg = 100
width = 16
height = 9
"#;

impl Case {
    /// A case by day with the qualities' own settings.
    fn new(name: impl Into<String>, edit: impl Into<String>) -> Self {
        let (name, edit) = (name.into(), edit.into());
        Self { name, edit, settings: |settings| settings, bound: Bound::Day, is_quick: false, is_long: false }
    }

    fn bound(self, bound: Bound) -> Self {
        Self { bound, ..self }
    }

    /// One of the few that the quick form holds to the path tracer.
    fn quick(self) -> Self {
        Self { is_quick: true, ..self }
    }

    /// Left to the command.
    fn long(self) -> Self {
        Self { is_long: true, ..self }
    }

    /// The scene as a file.
    pub fn scene_file(&self) -> String {
        let parse = |text: &str| text.parse::<toml::Table>().unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let mut whole = parse(BASE);
        merge(&mut whole, parse(&self.edit));
        whole.to_string()
    }

    /// The scene.
    pub fn scene(&self) -> Scene {
        Scene::parse(&self.scene_file(), Path::new("case.toml"))
            .unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    /// The settings of a quality.
    pub fn settings_of(&self, quality: Quality) -> Settings {
        (self.settings)(Settings::of(quality))
    }
}

impl Bound {
    /// Per cent at a quality; none where there is nothing to hold to.
    pub fn percent(self, quality: Quality) -> Option<f64> {
        let index = Quality::ALL.iter().position(|other| *other == quality)?;
        match self {
            Self::Day => Some(BY_DAY[index]),
            Self::Twilight => Some(IN_TWILIGHT[index]),
            Self::LawsOnly(_) => None,
        }
    }
}

/// Cases of clouds, fog and volumes that the quick form renders too; all take seconds.
const IN_QUICK_FORM: [&str; 6] = [
    "clouds, camera on their base",
    "clouds of 15 000 /m",
    "clouds at 1e9 s in a storm",
    "fog that only absorbs",
    "a white ball of 1e6 /m",
    "a lamp at the camera",
];

/// Every case, in the order of the table.
pub fn all() -> Vec<Case> {
    let of_air = [cameras::cases(), lights::cases(), media::cases(), planets::cases(), pictures::cases()];
    let in_quick_form = |case: Case| if IN_QUICK_FORM.contains(&case.name.as_str()) { case } else { case.long() };
    let others = [clouds::cases(), volumes::cases()].into_iter().flatten().map(in_quick_form);
    of_air.into_iter().flatten().chain(others).collect()
}

/// The case of a name.
pub fn named(name: &str) -> Case {
    all().into_iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no hard case '{name}'"))
}

/// Tables are merged field by field, everything else is replaced.
fn merge(whole: &mut toml::Table, edit: toml::Table) {
    for (key, value) in edit {
        match (whole.get_mut(&key), value) {
            (Some(toml::Value::Table(old)), toml::Value::Table(new)) => merge(old, new),
            (_, value) => drop(whole.insert(key, value)),
        }
    }
}
