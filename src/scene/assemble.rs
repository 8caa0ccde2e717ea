//! From what a file says and what its preset says to a [`Scene`].

use std::path::Path;

use glam::DVec3;
use welkin_lut::height_field::HeightField;
use welkin_lut::spectrum::{Channels, ColourSpace};
use welkin_lut::{BAND_COUNT, BAND_WAVELENGTHS_NM, Planet};

use super::clouds::assemble_clouds;
use super::file::{
    CameraFile, ChannelsFile, DisplayFile, FlashFile, LightsFile, MediumFile, PlanetFile, SceneFile, SunFile,
    TerrainFile, ToneMapFile, WhenFile, WhiteFile, listed,
};
use super::medium::assemble_medium;
use super::moon::assemble_moon;
use super::read::SpectrumRequest;
use super::spectrum::{Sources, Spectrum, White};
use super::sun_position::sun_direction;
use super::volumes::assemble_volumes;
use super::{
    Camera, Cone, Direction, DirectionalLight, Display, EnvironmentLight, Flash, Light, PointLight, Preset, Problem,
    Scene, Terrain, ToneMap,
};

const DEFAULT_FIELD_OF_VIEW_DEG: f64 = 60.0;
const DEFAULT_WIDTH: u32 = 1280;
const DEFAULT_HEIGHT: u32 = 720;

/// Joins file and preset; every range is already checked by the file's types, so only what fields say together is left.
pub fn assemble(file: &SceneFile, path: &Path, request: SpectrumRequest) -> Result<Scene, Problem> {
    let planet = assemble_planet(&file.planet, file.preset);
    planet.validate().map_err(|error| Problem::new("planet", error.to_string()))?;
    let medium = assemble_medium(file.medium.as_ref(), file.preset, path.parent().unwrap_or(Path::new("")))?;
    let directory = path.parent().unwrap_or(Path::new(""));
    let clouds = assemble_clouds(&file.clouds, planet.atmosphere_height_m, directory)?;
    let volumes = assemble_volumes(&file.fog, &file.volumes, directory)?;
    let time_s = file.time_s.map_or(0.0, |time| time.get());
    let sun = assemble_sun(&file.sun, file.preset)?;
    let moon = file.moon.as_ref().map(|moon| assemble_moon(moon, &file.sun, &sun, file.preset)).transpose()?;
    let mut lights: Vec<_> = [sun].into_iter().chain(moon).map(Light::Directional).collect();
    add_lights(&file.light, &mut lights)?;
    let camera = assemble_camera(&file.camera);
    if camera.altitude_m <= -planet.radius_m {
        let (altitude, radius) = (camera.altitude_m, planet.radius_m);
        let message = format!("invalid value: `{altitude}`, expected a number above {}, the planet's centre", -radius);
        return Err(Problem::new("camera.altitude_m", message));
    }
    let stem = || path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let name = file.name.clone().unwrap_or_else(stem);
    let terrain = file.terrain.as_ref().map(|file| assemble_terrain(file, &planet)).transpose()?;
    let spectrum = assemble_spectrum(file, request)?;
    Ok(Scene {
        name,
        planet,
        medium,
        clouds,
        volumes,
        time_s,
        lights,
        terrain,
        camera,
        spectrum,
        display: assemble_display(&file.display),
    })
}

/// A command's request goes before the file. Bands are what channels hold where nobody speaks of spectra or colour.
fn assemble_spectrum(file: &SceneFile, request: SpectrumRequest) -> Result<Spectrum, Problem> {
    let section = file.spectrum.as_ref();
    let said = section.and_then(|section| section.wavelengths).map(|count| count.get());
    let wavelengths = request.wavelengths.or(said).unwrap_or(BAND_COUNT);
    let named = section.and_then(|section| section.colour_space).map(|channels| match channels {
        ChannelsFile::Bands => Channels::Bands,
        ChannelsFile::LinearSrgb => Channels::Colour(ColourSpace::LinearSrgb),
        ChannelsFile::Rec2020 => Channels::Colour(ColourSpace::Rec2020),
        ChannelsFile::AcesCg => Channels::Colour(ColourSpace::AcesCg),
    });
    let silent = section.is_none() && request.wavelengths.is_none();
    let default = if silent { Channels::Bands } else { Channels::Colour(ColourSpace::LinearSrgb) };
    let channels = request.channels.or(named).unwrap_or(default);
    if channels == Channels::Bands && wavelengths != BAND_COUNT {
        let message = format!("invalid value: `bands`, expected a colour space for {wavelengths} wavelengths");
        return Err(Problem::new("spectrum.colour_space", message));
    }
    let white = match section.and_then(|section| section.white) {
        None | Some(WhiteFile::Sun) => White::Sun,
        Some(WhiteFile::D65) => White::D65,
    };
    let presets_air = !matches!(file.medium, Some(MediumFile::Complete(_)));
    let terrain_has_albedo = file.terrain.as_ref().is_some_and(|terrain| terrain.albedo.is_some());
    let sources = Sources { preset: file.preset, presets_air, terrain_has_albedo, listed: listed(file) };
    Ok(Spectrum { wavelengths, channels, white, sources })
}

fn assemble_planet(file: &PlanetFile, preset: Preset) -> Planet {
    let planet = preset.planet();
    Planet {
        radius_m: file.radius_m.map_or(planet.radius_m, |radius| radius.get()),
        atmosphere_height_m: file.atmosphere_height_m.map_or(planet.atmosphere_height_m, |height| height.get()),
        ground_albedo: file.ground_albedo.as_ref().map_or(planet.ground_albedo, |albedo| albedo.get()),
    }
}

/// Reflectance of fresh snow in visible light, about.
const SNOW_ALBEDO: f64 = 0.8;

fn assemble_terrain(file: &TerrainFile, planet: &Planet) -> Result<Terrain, Problem> {
    let (height_m, wavelength_m) = (file.height_m.get(), file.wavelength_m.get());
    let highest_m = (0.5 * wavelength_m).min(0.02 * planet.radius_m);
    if height_m > highest_m {
        let message = format!(
            "invalid value: `{height_m}`, expected at most {highest_m}: half of wavelength_m, and a fiftieth of the planet's radius"
        );
        return Err(Problem::new("terrain.height_m", message));
    }
    let position_m = file.position_m.map_or([0.0; 2], |position| position.map(|coordinate| coordinate.get()));
    Ok(Terrain {
        field: HeightField::new(height_m, wavelength_m, file.seed, position_m),
        albedo: file.albedo.as_ref().map_or(planet.ground_albedo, |albedo| albedo.get()),
        snow_line_m: file.snow_line_m.map_or(f64::INFINITY, |altitude| altitude.get()),
        snow_albedo: file.snow_albedo.as_ref().map_or([SNOW_ALBEDO; 3], |albedo| albedo.get()),
    })
}

fn assemble_sun(file: &SunFile, preset: Preset) -> Result<DirectionalLight, Problem> {
    let default = preset.sun();
    let direction = match (&file.when, file.elevation_deg, file.azimuth_deg) {
        (None, Some(elevation), Some(azimuth)) => direction(elevation.get(), azimuth.get()),
        (Some(when), None, None) => direction_when(when, preset)?,
        (None, _, _) => {
            let message = "missing fields, expected both elevation_deg and azimuth_deg, or [sun.when]";
            return Err(Problem::new("sun", message));
        }
        (Some(_), _, _) => {
            let message =
                "the sun's position is said twice, expected either elevation_deg and azimuth_deg or [sun.when]";
            return Err(Problem::new("sun.when", message));
        }
    };
    let angular_radius_rad = file.angular_radius_deg.map(|radius| radius.get().to_radians());
    Ok(DirectionalLight {
        name: "sun".to_owned(),
        direction,
        irradiance: file.irradiance.as_ref().map_or(default.irradiance, |irradiance| irradiance.get()),
        angular_radius_rad: angular_radius_rad.unwrap_or(default.angular_radius_rad),
        limb_darkening: file.limb_darkening.unwrap_or(default.limb_darkening),
        sphere: None,
        wavelengths_nm: BAND_WAVELENGTHS_NM,
    })
}

fn direction_when(when: &WhenFile, preset: Preset) -> Result<Direction, Problem> {
    if !preset.is_earth() {
        let message = format!(
            "a date says nothing of the sun over preset `{}`, expected elevation_deg and azimuth_deg in [sun]",
            preset.name()
        );
        return Err(Problem::new("sun.when", message));
    }
    sun_direction(when.date_time, when.latitude_deg.get(), when.longitude_deg.get())
        .map_err(|error| Problem::new("sun.when.date_time", error.to_string()))
}

fn direction(elevation_deg: f64, azimuth_deg: f64) -> Direction {
    Direction { elevation_rad: elevation_deg.to_radians(), azimuth_rad: azimuth_deg.to_radians() }
}

fn add_lights(file: &LightsFile, lights: &mut Vec<Light>) -> Result<(), Problem> {
    let own = lights.iter().filter_map(|light| match light {
        Light::Directional(light) => Some(light.name.clone()),
        _ => None,
    });
    let mut names: Vec<_> = own.collect();
    let mut claim = |field: String, name: &String| {
        if names.contains(name) {
            let message = format!("invalid value: `{name}`, expected a name that no other light has");
            return Err(Problem::new(field, message));
        }
        names.push(name.clone());
        Ok(())
    };
    for (index, light) in file.directional.iter().enumerate() {
        claim(format!("light.directional[{index}].name"), &light.name)?;
        lights.push(Light::Directional(DirectionalLight {
            name: light.name.clone(),
            direction: direction(light.elevation_deg.get(), light.azimuth_deg.get()),
            irradiance: light.irradiance.get(),
            angular_radius_rad: light.angular_radius_deg.map_or(0.0, |radius| radius.get().to_radians()),
            limb_darkening: light.limb_darkening,
            sphere: None,
            wavelengths_nm: BAND_WAVELENGTHS_NM,
        }));
    }
    for (index, light) in file.point.iter().enumerate() {
        claim(format!("light.point[{index}].name"), &light.name)?;
        let position_m = DVec3::from_array(light.position_m.map(|coordinate| coordinate.get()));
        lights.push(Light::Point(PointLight {
            name: light.name.clone(),
            position_m,
            intensity: light.intensity.get(),
            cone: None,
            flash: light.flash.as_ref().map(assemble_flash),
        }));
    }
    for (index, light) in file.spot.iter().enumerate() {
        let path = format!("light.spot[{index}]");
        claim(format!("{path}.name"), &light.name)?;
        let (inner_deg, outer_deg) = (light.inner_deg.get(), light.outer_deg.get());
        if outer_deg <= inner_deg {
            let message = format!("invalid value: `{outer_deg}`, expected a number above inner_deg, {inner_deg}");
            return Err(Problem::new(format!("{path}.outer_deg"), message));
        }
        lights.push(Light::Point(PointLight {
            name: light.name.clone(),
            position_m: DVec3::from_array(light.position_m.map(|coordinate| coordinate.get())),
            intensity: light.intensity.get(),
            cone: Some(Cone {
                axis: direction(light.elevation_deg.get(), light.azimuth_deg.map_or(0.0, |azimuth| azimuth.get())),
                inner_cosine: inner_deg.to_radians().cos(),
                outer_cosine: outer_deg.to_radians().cos(),
            }),
            flash: light.flash.as_ref().map(assemble_flash),
        }));
    }
    let environment = file.environment.as_ref().map(|light| EnvironmentLight { radiance: light.radiance.get() });
    lights.extend(environment.map(Light::Environment));
    Ok(())
}

fn assemble_flash(file: &FlashFile) -> Flash {
    Flash { start_s: file.start_s.get(), decay_s: file.decay_s.get() }
}

fn assemble_camera(file: &CameraFile) -> Camera {
    let field_of_view_deg = file.vertical_field_of_view_deg.map_or(DEFAULT_FIELD_OF_VIEW_DEG, |angle| angle.get());
    Camera {
        altitude_m: file.altitude_m.get(),
        direction: direction(file.elevation_deg.get(), file.azimuth_deg.get()),
        vertical_field_of_view_rad: field_of_view_deg.to_radians(),
        width: file.width.map_or(DEFAULT_WIDTH, |width| width.get()),
        height: file.height.map_or(DEFAULT_HEIGHT, |height| height.get()),
    }
}

fn assemble_display(file: &DisplayFile) -> Display {
    let tone_map = match file.tone_map {
        None | Some(ToneMapFile::Filmic) => ToneMap::Filmic,
        Some(ToneMapFile::None) => ToneMap::None,
    };
    Display { exposure_ev: file.exposure_ev.map_or(0.0, |exposure| exposure.get()), tone_map }
}
