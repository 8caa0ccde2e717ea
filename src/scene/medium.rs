//! From what a file says of the air and what its preset says to a [`Medium`].

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use welkin_lut::phase::TabulatedPhase;
use welkin_lut::{BAND_COUNT, Constituent, DensityProfile, Medium, PhaseFunction};

use super::file::{ConstituentChange, ConstituentFile, MediumFile, PhaseFile, ProfileFile};
use super::{Preset, Problem};

/// Joins file and preset; `directory` is where tables are looked for.
pub fn assemble_medium(file: Option<&MediumFile>, preset: Preset, directory: &Path) -> Result<Medium, Problem> {
    let medium = match file {
        None => preset.medium(),
        Some(MediumFile::Complete(list)) => complete(list, directory)?,
        Some(MediumFile::Changes(changes)) => change(preset, changes, directory)?,
    };
    medium.validate().map_err(|error| Problem::new("medium", error.to_string()))?;
    Ok(medium)
}

fn complete(list: &[ConstituentFile], directory: &Path) -> Result<Medium, Problem> {
    let mut constituents: Vec<Constituent> = Vec::new();
    for (index, file) in list.iter().enumerate() {
        let path = format!("medium[{index}]");
        if constituents.iter().any(|other| other.name == file.name) {
            let message = format!("invalid value: `{}`, expected a name that no other constituent has", file.name);
            return Err(Problem::new(format!("{path}.name"), message));
        }
        let change = ConstituentChange {
            density_factor: None,
            scattering_per_m: file.scattering_per_m.clone(),
            absorption_per_m: file.absorption_per_m.clone(),
            emission_per_m: file.emission_per_m.clone(),
            profile: Some(file.profile),
            phase: file.phase.clone(),
        };
        let change = Change { path: &path, file: &change, directory };
        constituents.push(change.make(&file.name, "")?);
    }
    Ok(Medium { constituents })
}

fn change(preset: Preset, changes: &BTreeMap<String, ConstituentChange>, directory: &Path) -> Result<Medium, Problem> {
    let mut medium = preset.medium();
    let names = medium.constituents.iter().map(|constituent| format!("`{}`", constituent.name)).collect::<Vec<_>>();
    let note = format!(" for a constituent that preset `{}` lacks; it has {}", preset.name(), names.join(", "));
    for (name, file) in changes {
        let path = format!("medium.{name}");
        let change = Change { path: &path, file, directory };
        if let Some(constituent) = medium.constituents.iter_mut().find(|constituent| constituent.name == *name) {
            change.apply(constituent)?;
        } else if let Some(mut constituent) = preset.optional().into_iter().find(|optional| optional.name == *name) {
            change.apply(&mut constituent)?;
            medium.constituents.push(constituent);
        } else {
            medium.constituents.push(change.make(name, &note)?);
        }
    }
    // A constituent that neither takes nor gives light would only cost time.
    medium.constituents.retain(|constituent| {
        constituent.extinction_per_m().iter().chain(&constituent.emission_per_m).any(|&value| value > 0.0)
    });
    Ok(medium)
}

/// What a file says of one constituent, and where.
struct Change<'a> {
    path: &'a str,
    file: &'a ConstituentChange,
    directory: &'a Path,
}

impl Change<'_> {
    /// A constituent from the change alone; `note` says, where a field is missing, why no preset fills it in.
    fn make(&self, name: &str, note: &str) -> Result<Constituent, Problem> {
        let missing = |field: &str| Problem::new(self.path, format!("missing field `{field}`, required{note}"));
        let mut constituent = Constituent {
            name: name.to_owned(),
            scattering_per_m: [0.0; BAND_COUNT],
            absorption_per_m: [0.0; BAND_COUNT],
            emission_per_m: [0.0; BAND_COUNT],
            profile: self.profile(self.file.profile.ok_or_else(|| missing("profile"))?)?,
            phase: PhaseFunction::Isotropic,
        };
        self.apply(&mut constituent)?;
        if constituent.scatters() && self.file.phase.is_none() {
            return Err(missing("phase"));
        }
        Ok(constituent)
    }

    fn apply(&self, constituent: &mut Constituent) -> Result<(), Problem> {
        let Constituent { scattering_per_m, absorption_per_m, emission_per_m, .. } = constituent;
        let factor = self.file.density_factor.map_or(1.0, |factor| factor.get());
        let coefficients = [
            (scattering_per_m, &self.file.scattering_per_m),
            (absorption_per_m, &self.file.absorption_per_m),
            (emission_per_m, &self.file.emission_per_m),
        ];
        for (bands, file) in coefficients {
            let values = file.as_ref().map_or(*bands, |file| file.get());
            *bands = values.map(|value| value * factor);
        }
        if let Some(profile) = self.file.profile {
            constituent.profile = self.profile(profile)?;
        }
        if let Some(phase) = &self.file.phase {
            constituent.phase = assemble_phase(phase, self.path, self.directory)?;
        }
        Ok(())
    }

    fn profile(&self, file: ProfileFile) -> Result<DensityProfile, Problem> {
        Ok(match file {
            ProfileFile::Exponential { scale_height_m } => {
                DensityProfile::Exponential { scale_height_m: scale_height_m.get() }
            }
            ProfileFile::Tent { centre_m, half_width_m } => {
                DensityProfile::Tent { centre_m: centre_m.get(), half_width_m: half_width_m.get() }
            }
            ProfileFile::Layer { bottom_m, top_m } => {
                let (bottom_m, top_m) = (bottom_m.get(), top_m.get());
                if top_m <= bottom_m {
                    let message = format!("invalid value: `{top_m}`, expected a number above bottom_m, {bottom_m}");
                    return Err(Problem::new(format!("{}.profile.layer.top_m", self.path), message));
                }
                DensityProfile::Layer { bottom_m, top_m }
            }
        })
    }
}

/// The phase function of what stands at `path`; `directory` is where tables are looked for.
pub fn assemble_phase(file: &PhaseFile, path: &str, directory: &Path) -> Result<PhaseFunction, Problem> {
    Ok(match file {
        PhaseFile::Isotropic => PhaseFunction::Isotropic,
        PhaseFile::Rayleigh => PhaseFunction::Rayleigh,
        PhaseFile::HenyeyGreenstein { g } => PhaseFunction::HenyeyGreenstein { g: g.get() },
        PhaseFile::DoubleHenyeyGreenstein { weight, g1, g2 } => {
            PhaseFunction::DoubleHenyeyGreenstein { weight: weight.get(), g1: g1.get(), g2: g2.get() }
        }
        PhaseFile::Schlick { k } => PhaseFunction::Schlick { k: k.get() },
        PhaseFile::CornetteShanks { g } => PhaseFunction::CornetteShanks { g: g.get() },
        PhaseFile::Draine { g, alpha } => PhaseFunction::Draine { g: g.get(), alpha: alpha.get() },
        PhaseFile::HenyeyGreensteinDraine { droplet_diameter_um } => {
            PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: droplet_diameter_um.get() }
        }
        PhaseFile::Table { file } => PhaseFunction::Tabulated(Arc::new(table(file, path, directory)?)),
    })
}

fn table(file: &Path, field: &str, directory: &Path) -> Result<TabulatedPhase, Problem> {
    let path = directory.join(file);
    let problem = |reason: String| {
        Problem::new(format!("{field}.phase.table.file"), format!("table '{}': {reason}", path.display()))
    };
    let text = std::fs::read_to_string(&path).map_err(|error| problem(format!("cannot read it: {error}")))?;
    TabulatedPhase::from_csv(&text).map_err(|error| problem(error.to_string()))
}
