//! From what a file says of fog and volumes to [`Volume`]s.

use std::path::Path;
use std::sync::Arc;

use welkin_lut::volume::{FogProfile, Volume, VolumeForm, VolumeGrid, VolumeNoise};
use welkin_lut::{BAND_COUNT, PhaseFunction};

use super::file::number::Coefficient;
use super::file::{FogFile, FogProfileFile, GridFile, NoiseFile, PerBand, VolumeFile, VolumeShapeFile};
use super::medium::assemble_phase;
use super::{Problem, npy};

/// Droplets of fog where a file does not say: the mode of mature radiation fog, µm.
const DROPLET_DIAMETER_UM: f64 = 16.0;

/// All local media, fog first; `directory` is where tables and grids are looked for.
pub fn assemble_volumes(fog: &[FogFile], files: &[VolumeFile], directory: &Path) -> Result<Vec<Volume>, Problem> {
    let mut volumes: Vec<Volume> = Vec::new();
    let mut add = |volume: Volume, field: String| {
        if volumes.iter().any(|other| other.name == volume.name) {
            let message = format!("invalid value: `{}`, expected a name that no other fog or volume has", volume.name);
            return Err(Problem::new(field, message));
        }
        volumes.push(volume);
        Ok(())
    };
    for (index, file) in fog.iter().enumerate() {
        let path = format!("fog[{index}]");
        add(assemble_fog(file, &path, directory)?, format!("{path}.name"))?;
    }
    for (index, file) in files.iter().enumerate() {
        let path = format!("volumes[{index}]");
        add(assemble_volume(file, &path, directory)?, format!("{path}.name"))?;
    }
    Ok(volumes)
}

fn assemble_fog(file: &FogFile, path: &str, directory: &Path) -> Result<Volume, Problem> {
    let bottom_m = file.bottom_m.map_or(0.0, |altitude| altitude.get());
    let (profile, edge) = match file.profile {
        FogProfileFile::Exponential { scale_height_m } => {
            (FogProfile::Exponential { scale_height_m: scale_height_m.get() }, 0.0)
        }
        FogProfileFile::Layer { top_m, edge } => {
            let top_m = top_m.get();
            if top_m <= bottom_m {
                let message = format!("invalid value: `{top_m}`, expected a number above bottom_m, {bottom_m}");
                return Err(Problem::new(format!("{path}.profile.layer.top_m"), message));
            }
            (FogProfile::Layer { top_m }, edge.map_or(0.0, |edge| edge.get()))
        }
    };
    let extinction_per_m = file.extinction_per_m.get();
    let albedo = file.albedo.as_ref().map_or([1.0; BAND_COUNT], |albedo| albedo.get());
    let scattering_per_m: [f64; BAND_COUNT] = std::array::from_fn(|band| albedo[band] * extinction_per_m[band]);
    Ok(Volume {
        name: file.name.clone().unwrap_or_else(|| "fog".to_owned()),
        form: VolumeForm::Fog { bottom_m, profile },
        edge,
        scattering_per_m,
        absorption_per_m: std::array::from_fn(|band| extinction_per_m[band] - scattering_per_m[band]),
        emission_per_m: [0.0; BAND_COUNT],
        phase: match &file.phase {
            Some(phase) => assemble_phase(phase, path, directory)?,
            None => PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: DROPLET_DIAMETER_UM },
        },
        noise: file.noise.as_ref().map(noise),
        grid: None,
    })
}

fn assemble_volume(file: &VolumeFile, path: &str, directory: &Path) -> Result<Volume, Problem> {
    let centre_m = file.centre_m.map(|coordinate| coordinate.get());
    let size_m = file.size_m.map(|length| length.get());
    let turn_rad = file.turn_deg.map_or(0.0, |turn| turn.get().to_radians());
    let bands = |value: &Option<PerBand<Coefficient>>| value.as_ref().map_or([0.0; BAND_COUNT], |value| value.get());
    let volume = Volume {
        name: file.name.clone(),
        form: match file.shape {
            VolumeShapeFile::Box => VolumeForm::Box { centre_m, size_m, turn_rad },
            VolumeShapeFile::Ellipsoid => VolumeForm::Ellipsoid { centre_m, size_m, turn_rad },
        },
        edge: file.edge.map_or(0.0, |edge| edge.get()),
        scattering_per_m: bands(&file.scattering_per_m),
        absorption_per_m: bands(&file.absorption_per_m),
        emission_per_m: bands(&file.emission_per_m),
        phase: match &file.phase {
            Some(phase) => assemble_phase(phase, path, directory)?,
            None => PhaseFunction::Isotropic,
        },
        noise: file.noise.as_ref().map(noise),
        grid: file.grid.as_ref().map(|file| grid(file, path, directory)).transpose()?.map(Arc::new),
    };
    if volume.scatters() && file.phase.is_none() {
        return Err(Problem::new(path, "missing field `phase`, required for a volume that scatters"));
    }
    Ok(volume)
}

fn noise(file: &NoiseFile) -> VolumeNoise {
    VolumeNoise {
        size_m: file.size_m.get(),
        strength: file.strength.map_or(1.0, |strength| strength.get()),
        seed: file.seed,
        wind_m_per_s: file.wind_m_per_s.map_or([0.0; 2], |wind| wind.map(|speed| speed.get())),
        evolution_m_per_s: file.evolution_m_per_s.map_or(0.0, |speed| speed.get()),
    }
}

fn grid(file: &GridFile, path: &str, directory: &Path) -> Result<VolumeGrid, Problem> {
    let source = directory.join(&file.file);
    read_npy(&source)
        .map_err(|reason| Problem::new(format!("{path}.grid.file"), format!("grid '{}': {reason}", source.display())))
}

/// An array of three axes [up, north, east]: east runs fastest.
fn read_npy(path: &Path) -> Result<VolumeGrid, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("cannot read it: {error}"))?;
    let npy::Array3 { shape: [up, north, east], values } = npy::read(&bytes)?;
    VolumeGrid::new([east, north, up], values).map_err(|error| error.to_string())
}
