//! What is measured on a scene: the ladder of settings, and what one group of settings alone changes.

use crate::plan::{Facts, LadderStep, Outputs, PlanError, Quality, Rung, Settings, SourceGrid, TableFormat, Treatment};
use crate::probe::Orders;
use crate::scene::Scene;

/// Settings under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// As in `medium+1/2 harmonics`, or `medium, but nodes of high`.
    pub name: String,
    /// In numbers.
    pub settings: Settings,
    /// The preset that does the same to this scene.
    pub preset: Option<Quality>,
    /// Whether it is a step of the ladder; else one group of a preset's settings is another's.
    pub on_ladder: bool,
}

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Breadth {
    /// The dearest rung.
    pub dearest: Rung,
    /// Whether groups of settings are varied alone, around which presets.
    pub vary: &'static [Quality],
}

/// What a scene does not use is not varied.
struct Uses {
    treatment: Treatment,
    clouds: bool,
    surface: bool,
}

/// A group of settings that go together: its name, whether a scene uses it, and how it is taken from another preset.
type Group = (&'static str, fn(&Uses) -> bool, fn(&mut Settings, &Settings));

const GROUPS: [Group; 12] = [
    ("nodes along rays", |_| true, |to, of| to.nodes_per_leg = of.nodes_per_leg),
    ("optical depth", |_| true, |to, of| to.optical_depth_size = of.optical_depth_size),
    ("sky view", |_| true, |to, of| to.sky_view_size = of.sky_view_size),
    ("field's texels", harmonics, |to, of| to.multiple_scattering_size = of.multiple_scattering_size),
    ("field's directions and degrees", harmonics, |to, of| {
        (to.directions, to.degree_count) = (of.directions, of.degree_count);
    }),
    ("field's orders", harmonics, |to, of| to.orders = of.orders),
    ("source's texels", source, |to, of| to.source_size = of.source_size),
    ("source's directions", source, |to, of| to.source_grid = SourceGrid { ..of.source_grid }),
    ("source's orders", source, |to, of| to.source_orders = of.source_orders),
    ("froxels", |uses| uses.surface, |to, of| to.froxel_size = of.froxel_size),
    (
        "steps through clouds",
        |uses| uses.clouds,
        |to, of| {
            let clouds = &mut to.clouds;
            (clouds.step_m, clouds.step_permille) = (of.clouds.step_m, of.clouds.step_permille);
            (clouds.max_steps, clouds.near_samples) = (of.clouds.max_steps, of.clouds.near_samples);
        },
    ),
    (
        "light in clouds",
        |uses| uses.clouds,
        |to, of| {
            let clouds = &mut to.clouds;
            (clouds.scattering, clouds.sweeps) = (of.clouds.scattering, of.clouds.sweeps);
            clouds.warm_sweeps = of.clouds.warm_sweeps;
            (clouds.ordinate_cells, clouds.ordinate_cell_m) = (of.clouds.ordinate_cells, of.clouds.ordinate_cell_m);
        },
    ),
];

fn harmonics(uses: &Uses) -> bool {
    uses.treatment == Treatment::Harmonics
}

fn source(uses: &Uses) -> bool {
    uses.treatment == Treatment::SourceFunction
}

/// What the plan does with multiply scattered light of a scene at some settings.
///
/// # Errors
/// [`PlanError::Unsupported`] for scenes that only the reference renders.
pub fn treatment(scene: &Scene, settings: Settings) -> Result<Treatment, PlanError> {
    Ok(Facts::new(scene, settings, Orders::All, Outputs::default())?.treatment)
}

/// All that is measured on a scene.
///
/// # Errors
/// [`PlanError::Unsupported`] as above.
pub fn candidates(scene: &Scene, breadth: &Breadth) -> Result<Vec<Candidate>, PlanError> {
    let clouds = scene.clouds.iter().any(|layer| !layer.is_empty());
    let mut all = Vec::new();
    for step in LadderStep::all().into_iter().filter(|step| step.rung <= breadth.dearest) {
        let own = treatment(scene, step.rung.settings())?;
        // Among clouds the sky's treatment is the least of errors, and the dearest thing to vary.
        if clouds && step.treatment != own {
            continue;
        }
        let preset = step.rung.quality().filter(|_| step.treatment == own);
        all.push(Candidate { name: step.to_string(), settings: step.settings(), preset, on_ladder: true });
    }
    for &quality in breadth.vary {
        all.extend(variations(scene, quality, clouds)?);
    }
    Ok(all)
}

/// A preset with one group of settings taken from a preset beside it.
fn variations(scene: &Scene, quality: Quality, clouds: bool) -> Result<Vec<Candidate>, PlanError> {
    let base = Settings::of(quality);
    let uses = Uses { treatment: treatment(scene, base)?, clouds, surface: scene.terrain.is_some() };
    let place = Quality::ALL.iter().position(|other| *other == quality).unwrap_or(0);
    let beside = [place.checked_sub(1), place.checked_add(1)].into_iter().flatten();
    let beside: Vec<Quality> = beside.filter_map(|place| Quality::ALL.get(place).copied()).collect();
    let mut all = Vec::new();
    for (group, used, take) in GROUPS.iter().filter(|(_, used, _)| used(&uses)) {
        let _ = used;
        for other in &beside {
            let mut settings = base;
            take(&mut settings, &Settings::of(*other));
            if settings != base {
                let name = format!("{quality}, but {group} of {other}");
                all.push(Candidate { name, settings, preset: None, on_ladder: false });
            }
        }
    }
    let settings = Settings { table_format: TableFormat::Float16, ..base };
    if settings != base {
        all.push(Candidate { name: format!("{quality}, but half floats"), settings, preset: None, on_ladder: false });
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(more: &str) -> Scene {
        let text = format!(
            "preset = \"hillaire2020\"\n{more}\n[sun]\nelevation_deg = 30\nazimuth_deg = 0\n[camera]\naltitude_m = 2\n\
             elevation_deg = 10\nazimuth_deg = 0\n"
        );
        Scene::parse(&text, "candidates.toml".as_ref()).unwrap()
    }

    const ALL: Breadth = Breadth { dearest: Rung::ALL[11], vary: &[Quality::Medium] };

    #[test]
    fn every_preset_is_measured_once_and_no_settings_twice() {
        for more in ["", "clouds = [{ kind = \"cumulus\" }]", "terrain.height_m = 900\nterrain.wavelength_m = 7000"] {
            let all = candidates(&scene(more), &ALL).unwrap();
            for quality in Quality::ALL {
                assert_eq!(
                    all.iter().filter(|candidate| candidate.preset == Some(quality)).count(),
                    1,
                    "{quality} {more}"
                );
            }
            for (index, candidate) in all.iter().enumerate() {
                assert!(all[..index].iter().all(|other| other.settings != candidate.settings), "{}", candidate.name);
            }
        }
    }

    #[test]
    fn only_what_a_scene_uses_is_varied() {
        let named = |more: &str, words: &str| {
            candidates(&scene(more), &ALL).unwrap().iter().any(|candidate| candidate.name.contains(words))
        };
        assert!(named("", "field's orders") || named("", "field's texels"));
        assert!(!named("", "clouds") && !named("", "froxels") && !named("", "source's"));
        assert!(named("clouds = [{ kind = \"cumulus\" }]", "steps through clouds"));
        assert!(named("terrain.height_m = 900\nterrain.wavelength_m = 7000", "froxels"));
    }
}
