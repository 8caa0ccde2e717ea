//! A scene at more wavelengths than three: the same problem in groups of three wavelengths, and what each adds to colour.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use welkin_lut::spectrum::{
    Channels, ColourSpace, SpectralNode, SpectralRule, adaptation, between_bands, cie, scaled_between_bands, solar,
    three_bands,
};
use welkin_lut::volume::Volume;
use welkin_lut::{BAND_COUNT, BAND_WAVELENGTHS_NM, Bands};

use super::preset::Quantity;
use super::{Light, Preset, Scene};

/// Wavelengths that light is computed at and the colours it becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// How many wavelengths, 3 to 40. Three are the bands; more are a Gauss rule for sunlight and the eye.
    pub wavelengths: usize,
    /// What the channels of a frame hold; bands only where there are three wavelengths.
    pub channels: Channels,
    /// What is white.
    pub white: White,
    pub(super) sources: Sources,
}

/// What is white in a picture; the linear Bradford transform brings it to the white of the colour space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum White {
    /// The first directional light that shines, above the air: as a camera set to daylight sees it. Where there is none,
    /// or none that an eye could take for white, as `D65`.
    Sun,
    /// The CIE's daylight of 6500 K: absolute colours.
    D65,
}

/// Where spectra come from when a scene has only three values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sources {
    pub preset: Preset,
    /// Whether the air is the preset's, with changes.
    pub presets_air: bool,
    /// Whether the terrain has a reflectance of its own.
    pub terrain_has_albedo: bool,
    /// Spectra that the scene file lists, by field; (wavelength in nm, value), rising.
    pub listed: BTreeMap<String, Vec<[f64; 2]>>,
}

/// Three wavelengths that are computed together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WavelengthGroup {
    /// The wavelengths, nm.
    pub wavelengths_nm: Bands,
    /// From spectral radiance at them to their share of X, Y and Z.
    pub to_xyz: DMat3,
}

/// What a group's radiance and transmittance add to the channels of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroupColour {
    /// From spectral radiance.
    pub radiance: DMat3,
    /// From transmittance: in colour, what is left of white light. Over all groups, 1 becomes 1.
    pub transmittance: DMat3,
}

impl Spectrum {
    /// The wavelengths in groups of three, longest first. A last group that is not full repeats its last wavelength
    /// without weight.
    pub fn groups(&self) -> Vec<WavelengthGroup> {
        if self.wavelengths == BAND_COUNT {
            return vec![WavelengthGroup { wavelengths_nm: BAND_WAVELENGTHS_NM, to_xyz: three_bands::to_xyz() }];
        }
        let group = |nodes: &[SpectralNode]| {
            let last = nodes[nodes.len() - 1];
            let idle = SpectralNode { xyz: [0.0; 3], ..last };
            let nodes: [SpectralNode; BAND_COUNT] = std::array::from_fn(|i| nodes.get(i).copied().unwrap_or(idle));
            let [x, y, z] = nodes.map(|node| DVec3::from_array(node.xyz));
            WavelengthGroup { wavelengths_nm: nodes.map(|node| node.wavelength_nm), to_xyz: DMat3::from_cols(x, y, z) }
        };
        SpectralRule::gauss(self.wavelengths).nodes.chunks(BAND_COUNT).map(group).collect()
    }

    /// How many groups there are.
    pub fn group_count(&self) -> usize {
        self.wavelengths.div_ceil(BAND_COUNT)
    }
}

impl Scene {
    /// The scene at a group's wavelengths in place of the bands: the same bodies, lights and camera.
    ///
    /// Presets have spectra of their own; so have fields with a list of wavelengths. A field with three values that
    /// differ from its preset's scales the preset's spectrum by the ratios, linear between the bands. Other coefficients
    /// are powers of the wavelength between the bands; other lights have the sun's spectrum, scaled.
    pub fn at(&self, group: &WavelengthGroup) -> Cow<'_, Scene> {
        if self.spectrum.wavelengths == BAND_COUNT {
            return Cow::Borrowed(self);
        }
        let sources = &self.spectrum.sources;
        let wavelengths = group.wavelengths_nm;
        let mut scene = self.clone();
        for constituent in &mut scene.medium.constituents {
            let name = constituent.name.clone();
            for quantity in Quantity::ALL {
                let bands = quantity.of(constituent);
                *bands = sources.coefficient(&name, quantity, *bands, wavelengths);
            }
        }
        scene.planet.ground_albedo = sources.albedo("planet.ground_albedo", self.planet.ground_albedo, wavelengths);
        for cloud in &mut scene.clouds {
            let field = format!("clouds.{}.albedo", cloud.name);
            cloud.albedo = sources.albedo(&field, cloud.albedo, wavelengths);
        }
        for volume in &mut scene.volumes {
            sources.at_wavelengths(volume, wavelengths);
        }
        if let Some(terrain) = &mut scene.terrain {
            terrain.albedo = sources.albedo(sources.terrain_field(), terrain.albedo, wavelengths);
            terrain.snow_albedo = sources.albedo("terrain.snow_albedo", terrain.snow_albedo, wavelengths);
        }
        for light in &mut scene.lights {
            match light {
                Light::Directional(light) => {
                    light.irradiance = sources.light(&light.name, light.irradiance, wavelengths);
                    light.wavelengths_nm = wavelengths;
                    if let Some(sphere) = &mut light.sphere {
                        sphere.even_share = between_bands_linearly(sphere.even_share, wavelengths);
                    }
                }
                Light::Point(light) => light.intensity = sources.light(&light.name, light.intensity, wavelengths),
                Light::Environment(light) => light.radiance = sources.light("environment", light.radiance, wavelengths),
            }
        }
        Cow::Owned(scene)
    }

    /// What each group adds to the channels of a frame, in the order of [`Spectrum::groups`].
    pub fn colour(&self) -> Vec<GroupColour> {
        let Channels::Colour(space) = self.spectrum.channels else {
            return vec![GroupColour { radiance: DMat3::IDENTITY, transmittance: DMat3::IDENTITY }];
        };
        self.colour_in(space)
    }

    /// The same for another colour space than the scene's.
    pub fn colour_in(&self, space: ColourSpace) -> Vec<GroupColour> {
        let groups = self.spectrum.groups();
        let light: Vec<DVec3> = groups.iter().map(|group| self.white_light(group)).collect();
        let light_xyz: DVec3 = groups.iter().zip(&light).map(|(group, light)| group.to_xyz * *light).sum();
        let white = match self.spectrum.white {
            White::Sun if can_be_white(light_xyz) => light_xyz,
            _ => ColourSpace::LinearSrgb.white_xyz(),
        };
        let from_xyz = space.from_xyz() * adaptation(white, space.white_xyz() * white.y);
        let seen = from_xyz * light_xyz;
        let colour = |(group, light): (&WavelengthGroup, &DVec3)| {
            let radiance = from_xyz * group.to_xyz;
            let transmittance = DMat3::from_diagonal(seen.recip()) * radiance * DMat3::from_diagonal(*light);
            GroupColour { radiance, transmittance }
        };
        groups.iter().zip(&light).map(colour).collect()
    }

    /// Irradiance of the light that is white, at a group's wavelengths; sunlight where no light could be.
    fn white_light(&self, group: &WavelengthGroup) -> DVec3 {
        let first = self.lights.iter().find_map(|light| match light {
            Light::Directional(light) if light.irradiance.iter().all(|&e| e > 0.0) => Some(light),
            _ => None,
        });
        let three = self.spectrum.wavelengths == BAND_COUNT;
        DVec3::from_array(match first {
            Some(light) if three => light.irradiance,
            Some(light) => self.spectrum.sources.light(&light.name, light.irradiance, group.wavelengths_nm),
            None if three => three_bands::SOLAR_IRRADIANCE,
            None => group.wavelengths_nm.map(solar::irradiance),
        })
    }
}

/// Whether a light's colour lies well inside what an eye adapts to; the transform of other whites has no meaning.
fn can_be_white(xyz: DVec3) -> bool {
    (ColourSpace::LinearSrgb.from_xyz() * xyz).min_element() > 0.05 * xyz.y && xyz.y > 0.0
}

impl Sources {
    fn coefficient(&self, constituent: &str, quantity: Quantity, bands: Bands, wavelengths_nm: Bands) -> Bands {
        if let Some(known) = self.listed(&format!("medium.{constituent}.{}", quantity.field())) {
            return wavelengths_nm.map(|nm| scaled(known, bands, nm));
        }
        if self.presets_air
            && let Some((spectrum, known_bands)) = self.preset.spectrum(constituent, quantity)
        {
            return wavelengths_nm.map(|nm| scaled_between_bands(spectrum, known_bands, bands, nm));
        }
        wavelengths_nm.map(|nm| between_bands(bands, nm))
    }

    /// Coefficients of a volume. What a file says of fog, extinction and albedo, is what has a spectrum.
    fn at_wavelengths(&self, volume: &mut Volume, wavelengths_nm: Bands) {
        let field = |name: &str| format!("volumes.{}.{name}", volume.name);
        let of = |name: &str, bands: Bands| match self.listed(&field(name)) {
            Some(known) => wavelengths_nm.map(|nm| scaled(known, bands, nm)),
            None => wavelengths_nm.map(|nm| between_bands(bands, nm)),
        };
        if volume.altitudes_m().is_some() {
            let extinction = volume.extinction_per_m();
            let share = |band: usize| {
                if extinction[band] > 0.0 { volume.scattering_per_m[band] / extinction[band] } else { 1.0 }
            };
            let albedo = self.albedo(&field("albedo"), std::array::from_fn(share), wavelengths_nm);
            let extinction = of("extinction_per_m", extinction);
            let scattering = std::array::from_fn(|band| albedo[band] * extinction[band]);
            volume.absorption_per_m = std::array::from_fn(|band| extinction[band] - scattering[band]);
            volume.scattering_per_m = scattering;
            return;
        }
        let scattering = of("scattering_per_m", volume.scattering_per_m);
        let absorption = of("absorption_per_m", volume.absorption_per_m);
        let emission = of("emission_per_m", volume.emission_per_m);
        (volume.scattering_per_m, volume.absorption_per_m, volume.emission_per_m) = (scattering, absorption, emission);
    }

    /// Linear between the bands and constant beyond, so that it stays within [0, 1].
    fn albedo(&self, field: &str, bands: Bands, wavelengths_nm: Bands) -> Bands {
        match self.listed(field) {
            Some(known) => wavelengths_nm.map(|nm| scaled(known, bands, nm)),
            None => between_bands_linearly(bands, wavelengths_nm),
        }
    }

    /// Mountains without a reflectance of their own have the planet's.
    fn terrain_field(&self) -> &'static str {
        if self.terrain_has_albedo { "terrain.albedo" } else { "planet.ground_albedo" }
    }

    fn light(&self, name: &str, bands: Bands, wavelengths_nm: Bands) -> Bands {
        match self.listed(&format!("light.{name}")) {
            Some(known) => wavelengths_nm.map(|nm| scaled(known, bands, nm)),
            None => wavelengths_nm
                .map(|nm| scaled_between_bands(solar::irradiance, three_bands::SOLAR_IRRADIANCE, bands, nm)),
        }
    }

    fn listed(&self, field: &str) -> Option<&[[f64; 2]]> {
        self.listed.get(field).map(Vec::as_slice)
    }
}

/// Shares of 0 to 1 stay so: linear between the bands, constant beyond.
fn between_bands_linearly(bands: Bands, wavelengths_nm: Bands) -> Bands {
    wavelengths_nm.map(|nm| scaled_between_bands(|_| 1.0, [1.0; BAND_COUNT], bands, nm))
}

fn scaled(known: &[[f64; 2]], bands: Bands, wavelength_nm: f64) -> f64 {
    let known_bands = BAND_WAVELENGTHS_NM.map(|nm| listed_value(known, nm));
    scaled_between_bands(|nm| listed_value(known, nm), known_bands, bands, wavelength_nm)
}

/// A listed spectrum at a wavelength: linear between its points, constant beyond.
pub(super) fn listed_value(points: &[[f64; 2]], wavelength_nm: f64) -> f64 {
    let after = points.partition_point(|[nm, _]| *nm <= wavelength_nm);
    match (after.checked_sub(1).map(|before| &points[before]), points.get(after)) {
        (None, Some([_, value])) | (Some([_, value]), None) => *value,
        (Some([from, low]), Some([to, high])) => low + (high - low) * (wavelength_nm - from) / (to - from),
        (None, None) => 0.0,
    }
}

/// Luminance of a colour whose Y is 1, cd/m².
pub const CANDELA_PER_M2: f64 = cie::CANDELA_PER_M2;
