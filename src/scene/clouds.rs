//! From what a file says of clouds to [`CloudLayer`]s.

use std::path::Path;

use welkin_lut::cloud::{CloudKind, CloudLayer};

use super::Problem;
use super::file::CloudFile;
use super::medium::assemble_phase;

/// Joins each layer with its kind's defaults; `directory` is where phase tables are looked for.
pub fn assemble_clouds(files: &[CloudFile], top_m: f64, directory: &Path) -> Result<Vec<CloudLayer>, Problem> {
    let mut layers: Vec<CloudLayer> = Vec::new();
    for (index, file) in files.iter().enumerate() {
        let path = format!("clouds[{index}]");
        let layer = assemble_layer(file, &path, directory)?;
        if layers.iter().any(|other| other.name == layer.name) {
            let message = format!("invalid value: `{}`, expected a name that no other layer of clouds has", layer.name);
            // A name that was left out stands where its kind does.
            let field = if file.name.is_some() { "name" } else { "kind" };
            return Err(Problem::new(format!("{path}.{field}"), message));
        }
        check_altitudes(&layer, file, &path, top_m)?;
        layers.push(layer);
    }
    Ok(layers)
}

fn assemble_layer(file: &CloudFile, path: &str, directory: &Path) -> Result<CloudLayer, Problem> {
    let kind = CloudKind::from(file.kind);
    let typical = CloudLayer::of_kind(kind);
    let base_m = file.base_m.map_or(typical.base_m, |altitude| altitude.get());
    let radius_um = file.effective_radius_um.map_or(typical.effective_radius_um, |radius| radius.get());
    let phase = match &file.phase {
        Some(phase) => assemble_phase(phase, path, directory)?,
        None => kind.phase(radius_um),
    };
    Ok(CloudLayer {
        name: file.name.clone().unwrap_or_else(|| kind.name().to_owned()),
        kind,
        base_m,
        // A base that is moved takes the typical thickness with it.
        top_m: file.top_m.map_or(base_m + typical.top_m - typical.base_m, |altitude| altitude.get()),
        coverage: file.coverage.map_or(typical.coverage, |share| share.get()),
        water_g_per_m3: file.water_g_per_m3.map_or(typical.water_g_per_m3, |water| water.get()),
        effective_radius_um: radius_um,
        albedo: file.albedo.as_ref().map_or(typical.albedo, |albedo| albedo.get()),
        phase,
        wind_m_per_s: file.wind_m_per_s.map_or(typical.wind_m_per_s, |wind| wind.map(|speed| speed.get())),
        evolution_m_per_s: file.evolution_m_per_s.map_or(typical.evolution_m_per_s, |speed| speed.get()),
        seed: file.seed,
    })
}

fn check_altitudes(layer: &CloudLayer, file: &CloudFile, path: &str, top_m: f64) -> Result<(), Problem> {
    let (base, top) = (layer.base_m, layer.top_m);
    let field = |name: &str, given: bool| format!("{path}.{}", if given { name } else { "kind" });
    if base < 0.0 || base > top_m {
        let message = format!("invalid value: `{base}`, expected an altitude from 0 to the air's top, {top_m}");
        return Err(Problem::new(field("base_m", file.base_m.is_some()), message));
    }
    if top < base || top > top_m {
        let message =
            format!("invalid value: `{top}`, expected an altitude from the base, {base}, to the air's top, {top_m}");
        return Err(Problem::new(field("top_m", file.top_m.is_some()), message));
    }
    Ok(())
}
