//! Settings between the presets, so that a price between theirs can be paid.

use std::fmt;
use std::str::FromStr;

use super::{CloudSettings, Directions, MultipleScattering, Quality, Settings, SourceGrid, Treatment, VolumeSettings};

/// Parts into which the way from one preset to the next is divided.
const PARTS: u32 = 4;

/// A place on the way from the preset `low` to `ultra`, in quarters of the way from one to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rung(u32);

impl Rung {
    /// From the cheapest to the dearest. They stand closer where presets differ more in price.
    pub const ALL: [Self; 12] =
        [Self(0), Self(2), Self(3), Self(4), Self(5), Self(6), Self(7), Self(8), Self(9), Self(10), Self(11), Self(12)];

    /// The preset's.
    pub fn of(quality: Quality) -> Self {
        Self(PARTS * Quality::ALL.iter().position(|other| *other == quality).unwrap_or(0) as u32)
    }

    /// The preset that it is, if it is one.
    pub fn quality(self) -> Option<Quality> {
        self.0.is_multiple_of(PARTS).then(|| self.below())
    }

    /// As in `medium` or `medium+1/2`: half of the way from medium to the next preset.
    pub fn name(self) -> String {
        let fraction = ["", "+1/4", "+1/2", "+3/4"][(self.0 % PARTS) as usize];
        format!("{}{fraction}", self.below())
    }

    /// The rung of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rung| rung.name() == name)
    }

    /// What it means in numbers: sizes and counts on the geometric mean of those of the presets on both sides, methods of
    /// the nearer one (of the better one in the middle).
    pub fn settings(self) -> Settings {
        let below = Settings::of(self.below());
        let next = Quality::ALL.into_iter().find(|quality| *quality > self.below());
        match (self.0 % PARTS, next) {
            (0, _) | (_, None) => below,
            (part, Some(next)) => between(&below, &Settings::of(next), f64::from(part) / f64::from(PARTS)),
        }
    }

    fn below(self) -> Quality {
        Quality::ALL[((self.0 / PARTS) as usize).min(Quality::ALL.len() - 1)]
    }
}

impl fmt::Display for Rung {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name())
    }
}

/// There is no rung of that name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("quality is '{0}'; it must be one of {known}", known = Rung::ALL.map(Rung::name).join(", "))]
pub struct UnknownRung(String);

impl FromStr for Rung {
    type Err = UnknownRung;

    fn from_str(name: &str) -> Result<Self, UnknownRung> {
        Self::from_name(name).ok_or_else(|| UnknownRung(name.to_owned()))
    }
}

/// A rung with a treatment of multiply scattered light: settings that can be measured, and chosen by their name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LadderStep {
    /// Sizes and counts.
    pub rung: Rung,
    /// What is done about light of the second and later orders.
    pub treatment: Treatment,
}

impl LadderStep {
    /// All of them. The isotropic series has an error that finer tables do not lessen: two rungs of it are enough.
    pub fn all() -> Vec<Self> {
        let coarse = [Rung::of(Quality::Low), Rung::of(Quality::Medium)];
        let mut steps: Vec<_> =
            coarse.into_iter().map(|rung| Self { rung, treatment: Treatment::IsotropicSeries }).collect();
        for treatment in [Treatment::Harmonics, Treatment::SourceFunction] {
            steps.extend(Rung::ALL.into_iter().map(|rung| Self { rung, treatment }));
        }
        steps
    }

    /// What it means in numbers.
    pub fn settings(self) -> Settings {
        Settings { multiple_scattering: asked_for(self.treatment), ..self.rung.settings() }
    }

    /// The step of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|step| step.to_string() == name)
    }
}

/// As in `medium+1/2 harmonics`.
impl fmt::Display for LadderStep {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {}", self.rung.name(), asked_for(self.treatment).name())
    }
}

fn asked_for(treatment: Treatment) -> MultipleScattering {
    match treatment {
        Treatment::IsotropicSeries => MultipleScattering::IsotropicSeries,
        Treatment::Harmonics => MultipleScattering::Harmonics,
        Treatment::SourceFunction => MultipleScattering::SourceFunction,
    }
}

/// Settings at a share of the way.
fn between(a: &Settings, b: &Settings, share: f64) -> Settings {
    let count = |a, b| mean(a, b, share);
    let size = |a: [u32; 2], b: [u32; 2]| [count(a[0], b[0]), count(a[1], b[1])];
    let [x, y, z] = std::array::from_fn(|i| count(a.froxel_size[i], b.froxel_size[i]));
    let (da, db, ga, gb) = (&a.directions, &b.directions, &a.source_grid, &b.source_grid);
    Settings {
        nodes_per_leg: count(a.nodes_per_leg, b.nodes_per_leg),
        lattice_tolerance: a.lattice_tolerance.powf(1.0 - share) * b.lattice_tolerance.powf(share),
        optical_depth_size: size(a.optical_depth_size, b.optical_depth_size),
        multiple_scattering_size: size(a.multiple_scattering_size, b.multiple_scattering_size),
        directions: Directions {
            below: count(da.below, db.below),
            band: count(da.band, db.band),
            above: count(da.above, db.above),
            azimuths: count(da.azimuths, db.azimuths),
        },
        orders: count(a.orders, b.orders),
        ringing_limit: a.ringing_limit.powf(1.0 - share) * b.ringing_limit.powf(share),
        source_grid: SourceGrid {
            ground: count(ga.ground, gb.ground),
            low: count(ga.low, gb.low),
            high: count(ga.high, gb.high),
            azimuths: count(ga.azimuths, gb.azimuths),
        },
        source_size: size(a.source_size, b.source_size),
        source_orders: count(a.source_orders, b.source_orders),
        sky_view_size: size(a.sky_view_size, b.sky_view_size),
        froxel_size: [x, y, z],
        clouds: clouds_between(&a.clouds, &b.clouds, share),
        volumes: volumes_between(&a.volumes, &b.volumes, share),
        ..*nearer(a, b, share)
    }
}

fn clouds_between(a: &CloudSettings, b: &CloudSettings, share: f64) -> CloudSettings {
    let count = |a, b| mean(a, b, share);
    // Grids of ordinates and of light have sides and cells that depend on each other: methods, like grids, are of one side.
    CloudSettings {
        near_samples: count(a.near_samples, b.near_samples),
        step_m: count(a.step_m, b.step_m),
        step_permille: count(a.step_permille, b.step_permille),
        max_steps: count(a.max_steps, b.max_steps),
        ..*nearer(a, b, share)
    }
}

fn volumes_between(a: &VolumeSettings, b: &VolumeSettings, share: f64) -> VolumeSettings {
    let count = |a, b| mean(a, b, share);
    VolumeSettings {
        step_permille: count(a.step_permille, b.step_permille),
        max_steps: count(a.max_steps, b.max_steps),
        beam_samples: count(a.beam_samples, b.beam_samples),
        lamp_samples: count(a.lamp_samples, b.lamp_samples),
        lamp_share: count(a.lamp_share, b.lamp_share),
        lattice_permille: count(a.lattice_permille, b.lattice_permille),
        ..*nearer(a, b, share)
    }
}

fn nearer<'a, T>(a: &'a T, b: &'a T, share: f64) -> &'a T {
    if share < 0.5 { a } else { b }
}

/// The whole number next to the geometric mean; next to the arithmetic where one is 0.
fn mean(a: u32, b: u32, share: f64) -> u32 {
    let (x, y) = (f64::from(a), f64::from(b));
    let mean = if a == 0 || b == 0 { x + (y - x) * share } else { x.powf(1.0 - share) * y.powf(share) };
    mean.round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texels and directions of the tables of light scattered many times.
    fn work(settings: &Settings) -> [u32; 4] {
        let [view_width, view_height] = settings.sky_view_size;
        let [source_width, source_height] = settings.source_size;
        let [width, height] = settings.multiple_scattering_size;
        [
            view_width * view_height,
            source_width * source_height * settings.source_grid.count() * settings.source_orders,
            width * height * settings.directions.count() * settings.orders,
            settings.clouds.max_steps,
        ]
    }

    #[test]
    fn presets_are_rungs_and_every_rung_is_dearer_than_the_one_below() {
        for quality in Quality::ALL {
            assert_eq!(Rung::of(quality).settings(), Settings::of(quality));
            assert_eq!(Rung::of(quality).quality(), Some(quality));
        }
        for pair in Rung::ALL.windows(2) {
            let (low, high) = (work(&pair[0].settings()), work(&pair[1].settings()));
            assert!(low.iter().zip(&high).all(|(low, high)| low <= high), "{} {}", pair[0].name(), pair[1].name());
            assert!(low != high, "{} is no dearer than {}", pair[1].name(), pair[0].name());
        }
    }

    #[test]
    fn a_rung_is_known_by_its_name_and_fits_the_smallest_device() {
        for rung in Rung::ALL {
            assert_eq!(Rung::from_name(&rung.name()), Some(rung));
            let settings = rung.settings();
            assert!(
                settings.directions.count() <= 128 && 32 * settings.source_grid.count() <= 16384,
                "{}",
                rung.name()
            );
            assert!(settings.degree_count * (settings.degree_count + 1) / 2 <= settings.directions.count());
        }
        let unknown = "medium+2/3".parse::<Rung>().unwrap_err().to_string();
        assert!(
            unknown.contains("medium+2/3") && unknown.contains("low+1/2, low+3/4, medium, medium+1/4"),
            "{unknown}"
        );
        for step in LadderStep::all() {
            assert_eq!(LadderStep::from_name(&step.to_string()), Some(step));
        }
        assert_eq!(LadderStep::from_name("medium"), None);
    }
}
