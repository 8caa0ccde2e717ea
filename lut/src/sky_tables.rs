//! The sky from tables: what the shaders' `pack.wgsl` does, in f64. The measure that importers compare themselves with.
//!
//! All light is for unit irradiance of the sun above the air. Arguments are an altitude in m, which may lie above the air,
//! and cosines: μ of the view's zenith angle, μ_s of the sun's, ν of the angle between the two.

use std::f64::consts::PI;

use crate::bake::{Air, ScatteringSize};
use crate::geometry::{air_length_m, distance_to_shell_from_above, grazing_distance_m, horizon_mu};
use crate::mapping::{MultipleScatteringMapping, OpticalDepthMapping, SkyHalf, SkyViewMapping, inside_tile};
use crate::phase::PhaseLobe;
use crate::table::{Table, mix};
use crate::{BAND_COUNT, Bands, Planet};

/// The tables of one air. docs/notation.md has their mappings.
#[derive(Debug, Clone, PartialEq)]
pub struct TableSet {
    /// Optical depth to the top: (direction, altitude).
    pub transmittance: Table,
    /// ln of the sky's irradiance on a horizontal plane: (sun, altitude).
    pub irradiance: Table,
    /// (sun, altitude, value): ln I_00, I_lm / I_00 in the order of (l, m), then ln of the irradiance.
    pub multiple_scattering: Table,
    /// ln of scattered light over the length of air: (azimuth, sun; elevation; half, layer, altitude).
    pub scattering: Table,
}

/// Tables with what is needed to read them.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyTables {
    planet: Planet,
    /// Of each scatterer.
    phases: Vec<Vec<PhaseLobe>>,
    layout: ScatteringSize,
    set: TableSet,
}

/// Where a view ray's way through the air begins.
struct AirEntry {
    altitude_m: f64,
    mu: f64,
    mu_s: f64,
    hits_ground: bool,
}

impl SkyTables {
    /// The tables of an air.
    pub fn new(air: &Air, layout: ScatteringSize, set: TableSet) -> Self {
        Self::from_parts(air.planet().clone(), air.phase_lobes(), layout, set)
    }

    /// The same from what a pack says.
    pub fn from_parts(planet: Planet, phases: Vec<Vec<PhaseLobe>>, layout: ScatteringSize, set: TableSet) -> Self {
        Self { planet, phases, layout, set }
    }

    /// The tables themselves.
    pub fn set(&self) -> &TableSet {
        &self.set
    }

    /// The planet.
    pub fn planet(&self) -> &Planet {
        &self.planet
    }

    /// The lobes of each scatterer's phase function.
    pub fn phases(&self) -> &[Vec<PhaseLobe>] {
        &self.phases
    }

    /// Sides of the table of scattered light.
    pub fn layout(&self) -> ScatteringSize {
        self.layout
    }

    /// The same with other tables: as they come back from files.
    #[must_use]
    pub fn with_set(&self, set: TableSet) -> Self {
        Self { set, ..self.clone() }
    }

    fn top_m(&self) -> f64 {
        self.planet.atmosphere_height_m
    }

    /// `None` for a ray from space that misses the air.
    fn entry(&self, altitude_m: f64, [mu, mu_s, nu]: [f64; 3]) -> Option<AirEntry> {
        let (radius_m, top_m) = (self.planet.radius_m, self.top_m());
        let h = altitude_m.max(0.0);
        let hits_ground = mu < horizon_mu(radius_m, h);
        if h <= top_m {
            return Some(AirEntry { altitude_m: h, mu, mu_s, hits_ground });
        }
        let (r, r_top) = (radius_m + h, radius_m + top_m);
        let sine = r / r_top * (1.0 - mu * mu).max(0.0).sqrt();
        if mu >= 0.0 || sine >= 1.0 {
            return None;
        }
        let distance_m = distance_to_shell_from_above(radius_m, h, mu, top_m)?;
        let mu_s = ((r * mu_s + distance_m * nu) / r_top).clamp(-1.0, 1.0);
        Some(AirEntry { altitude_m: top_m, mu: -(1.0 - sine * sine).max(0.0).sqrt(), mu_s, hits_ground })
    }

    fn optical_depth_to_space(&self, altitude_m: f64, mu: f64) -> Bands {
        let mapping = OpticalDepthMapping { radius_m: self.planet.radius_m, top_m: self.top_m() };
        self.set.transmittance.at_unit(mapping.unit(altitude_m, mu), 0)
    }

    /// Share of light that comes from space, from the direction μ, to a point; 0 where the planet is in the way.
    pub fn transmittance_to_space(&self, altitude_m: f64, mu: f64) -> Bands {
        let h = altitude_m.clamp(0.0, self.top_m());
        match mu < horizon_mu(self.planet.radius_m, h) {
            true => [0.0; BAND_COUNT],
            false => self.optical_depth_to_space(h, mu).map(|tau| (-tau).exp()),
        }
    }

    fn entry_optical_depth(&self, entry: &AirEntry) -> Bands {
        let &AirEntry { altitude_m, mu, hits_ground, .. } = entry;
        if !hits_ground {
            return self.optical_depth_to_space(altitude_m, mu);
        }
        // The same ray walked upwards: from the ground to space, less the part above the observer.
        let radius_m = self.planet.radius_m;
        let length_m = grazing_distance_m(radius_m, altitude_m, mu, 0.0);
        let ground_mu = ((radius_m + altitude_m) * mu + length_m) / radius_m;
        let whole = self.optical_depth_to_space(0.0, (-ground_mu).clamp(0.0, 1.0));
        let above = self.optical_depth_to_space(altitude_m, -mu);
        std::array::from_fn(|band| (whole[band] - above[band]).max(0.0))
    }

    /// Transmittance of a view ray's air, to space or to the ground, whichever it meets.
    pub fn view_transmittance(&self, altitude_m: f64, mu: f64) -> Bands {
        let entry = self.entry(altitude_m, [mu, 0.0, 0.0]);
        entry.map_or([1.0; BAND_COUNT], |entry| self.entry_optical_depth(&entry).map(|tau| (-tau).exp()))
    }

    /// Irradiance of the sky, without the sun itself, on a horizontal plane that faces up.
    pub fn sky_irradiance(&self, altitude_m: f64, mu_s: f64) -> Bands {
        let unit = MultipleScatteringMapping::new(self.planet()).unit(altitude_m.max(0.0), mu_s);
        self.set.irradiance.at_unit(unit, 0).map(f64::exp)
    }

    /// Irradiance of the sun itself on a horizontal plane that faces up.
    pub fn sun_irradiance(&self, altitude_m: f64, mu_s: f64) -> Bands {
        self.transmittance_to_space(altitude_m, mu_s).map(|transmittance| mu_s.max(0.0) * transmittance)
    }

    /// One layer of scattered light over the length of air.
    fn layer(&self, entry: &AirEntry, nu: f64, layer: u32) -> Bands {
        let ScatteringSize { azimuths, suns, elevations, altitudes } = self.layout;
        let sines = ((1.0 - entry.mu * entry.mu) * (1.0 - entry.mu_s * entry.mu_s)).max(0.0).sqrt();
        let cos_phi = ((nu - entry.mu * entry.mu_s) / sines.max(1e-6)).clamp(-1.0, 1.0);
        let horizon_rad = horizon_mu(self.planet.radius_m, entry.altitude_m).acos();
        let half = if entry.hits_ground { SkyHalf::Ground } else { SkyHalf::Sky };
        let mapping = SkyViewMapping::within_air(horizon_rad);
        let view = mapping.unit(entry.mu.clamp(-1.0, 1.0).acos(), cos_phi.acos(), half);
        let light = MultipleScatteringMapping::new(self.planet()).unit(entry.altitude_m, entry.mu_s);
        let azimuth = view[0] * f64::from(azimuths - 1);
        let low = azimuth.floor().min(f64::from(azimuths - 2));
        let block = u32::from(entry.hits_ground) * (1 + self.phases.len() as u32) + layer;
        let y = view[1] * f64::from(elevations - 1);
        let z = f64::from(block * altitudes) + inside_tile(light[1], altitudes);
        let at =
            |tile: f64| self.set.scattering.trilinear([tile * f64::from(suns) + inside_tile(light[0], suns), y, z]);
        mix(at(low), at(low + 1.0), azimuth - low).map(f64::exp)
    }

    /// Radiance of the air along a view ray, to space or to the ground, 1/sr: without the sun's disc and without the
    /// ground behind the air.
    pub fn sky_radiance(&self, altitude_m: f64, directions: [f64; 3]) -> Bands {
        let Some(entry) = self.entry(altitude_m, directions) else { return [0.0; BAND_COUNT] };
        let nu = directions[2];
        let mut per_m = self.layer(&entry, nu, 0);
        for (index, lobes) in self.phases.iter().enumerate() {
            let phase: f64 = lobes.iter().map(|lobe| lobe.value(nu)).sum();
            let single = self.layer(&entry, nu, 1 + index as u32);
            (0..BAND_COUNT).for_each(|band| per_m[band] += phase * single[band]);
        }
        let AirEntry { altitude_m, mu, hits_ground, .. } = entry;
        let length_m = air_length_m(self.planet.radius_m, self.top_m(), altitude_m, mu, hits_ground);
        per_m.map(|light| light * length_m)
    }

    /// Radiance of the ground through the air before it, 1/sr; 0 along rays that do not meet the ground.
    pub fn ground_radiance(&self, altitude_m: f64, directions: [f64; 3]) -> Bands {
        let entry = self.entry(altitude_m, directions).filter(|entry| entry.hits_ground);
        let Some(entry) = entry else { return [0.0; BAND_COUNT] };
        let radius_m = self.planet.radius_m;
        let length_m = grazing_distance_m(radius_m, entry.altitude_m, entry.mu, 0.0);
        let mu_s = ((radius_m + entry.altitude_m) * entry.mu_s + length_m * directions[2]) / radius_m;
        let mu_s = mu_s.clamp(-1.0, 1.0);
        let (sun, sky) = (self.sun_irradiance(0.0, mu_s), self.sky_irradiance(0.0, mu_s));
        let optical_depth = self.entry_optical_depth(&entry);
        let albedo = self.planet.ground_albedo;
        std::array::from_fn(|i| (-optical_depth[i]).exp() * albedo[i] / PI * (sun[i] + sky[i]))
    }
}
