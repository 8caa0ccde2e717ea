//! From what a file says of the air and what its preset says to a [`Medium`].

use std::collections::BTreeMap;

use welkin_lut::{BAND_COUNT, Constituent, DensityProfile, Medium, PhaseFunction};

use super::file::{ConstituentChange, ConstituentFile, MediumFile, PhaseFile, ProfileFile};
use super::{Preset, Problem};

/// Joins file and preset.
pub fn assemble_medium(file: Option<&MediumFile>, preset: Preset) -> Result<Medium, Problem> {
    let medium = match file {
        None => preset.medium(),
        Some(MediumFile::Complete(list)) => complete(list)?,
        Some(MediumFile::Changes(changes)) => change(preset, changes)?,
    };
    medium.validate().map_err(|error| Problem::new("medium", error.to_string()))?;
    Ok(medium)
}

fn complete(list: &[ConstituentFile]) -> Result<Medium, Problem> {
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
            phase: file.phase,
        };
        constituents.push(new_constituent(&path, &file.name, &change, "")?);
    }
    Ok(Medium { constituents })
}

fn change(preset: Preset, changes: &BTreeMap<String, ConstituentChange>) -> Result<Medium, Problem> {
    let mut medium = preset.medium();
    let names = medium.constituents.iter().map(|constituent| format!("`{}`", constituent.name)).collect::<Vec<_>>();
    let note = format!(" for a constituent that preset `{}` lacks; it has {}", preset.name(), names.join(", "));
    for (name, change) in changes {
        let path = format!("medium.{name}");
        match medium.constituents.iter_mut().find(|constituent| constituent.name == *name) {
            Some(constituent) => apply(&path, change, constituent)?,
            None => medium.constituents.push(new_constituent(&path, name, change, &note)?),
        }
    }
    // A constituent that neither takes nor gives light would only cost time.
    medium.constituents.retain(|constituent| {
        constituent.extinction_per_m().iter().chain(&constituent.emission_per_m).any(|&value| value > 0.0)
    });
    Ok(medium)
}

/// `note` says, where a field is missing, why the preset does not fill it in.
fn new_constituent(path: &str, name: &str, file: &ConstituentChange, note: &str) -> Result<Constituent, Problem> {
    let missing = |field: &str| Problem::new(path, format!("missing field `{field}`, required{note}"));
    let profile = file.profile.ok_or_else(|| missing("profile"))?;
    let mut constituent = Constituent {
        name: name.to_owned(),
        scattering_per_m: [0.0; BAND_COUNT],
        absorption_per_m: [0.0; BAND_COUNT],
        emission_per_m: [0.0; BAND_COUNT],
        profile: density_profile(path, profile)?,
        phase: PhaseFunction::Isotropic,
    };
    apply(path, file, &mut constituent)?;
    if constituent.scatters() && file.phase.is_none() {
        return Err(missing("phase"));
    }
    Ok(constituent)
}

fn apply(path: &str, change: &ConstituentChange, constituent: &mut Constituent) -> Result<(), Problem> {
    let Constituent { scattering_per_m, absorption_per_m, emission_per_m, .. } = constituent;
    let factor = change.density_factor.map_or(1.0, |factor| factor.get());
    let coefficients = [
        (scattering_per_m, &change.scattering_per_m),
        (absorption_per_m, &change.absorption_per_m),
        (emission_per_m, &change.emission_per_m),
    ];
    for (bands, file) in coefficients {
        if let Some(file) = file {
            *bands = file.get();
        }
        *bands = bands.map(|value| value * factor);
    }
    if let Some(profile) = change.profile {
        constituent.profile = density_profile(path, profile)?;
    }
    if let Some(phase) = change.phase {
        constituent.phase = phase_function(phase);
    }
    Ok(())
}

fn density_profile(path: &str, file: ProfileFile) -> Result<DensityProfile, Problem> {
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
                return Err(Problem::new(format!("{path}.profile.layer.top_m"), message));
            }
            DensityProfile::Layer { bottom_m, top_m }
        }
    })
}

fn phase_function(file: PhaseFile) -> PhaseFunction {
    match file {
        PhaseFile::Isotropic => PhaseFunction::Isotropic,
        PhaseFile::Rayleigh => PhaseFunction::Rayleigh,
        PhaseFile::HenyeyGreenstein { g } => PhaseFunction::HenyeyGreenstein { g: g.get() },
        PhaseFile::CornetteShanks { g } => PhaseFunction::CornetteShanks { g: g.get() },
    }
}
