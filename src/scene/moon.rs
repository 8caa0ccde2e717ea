//! From what a file says of the moon, and where the sun stands, to a light.

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::BAND_WAVELENGTHS_NM;

use super::file::{MoonFile, SunFile, WhenFile};
use super::lunar_photometry::{earthlit_share, sunlit_share};
use super::moon_position::moon_position;
use super::sun_position::julian_date;
use super::{Direction, DirectionalLight, LitSphere, Preset, Problem};

/// Radius and mean distance of the moon, and distance of the sun, m.
const RADIUS_M: f64 = 1_737_400.0;
const MEAN_DISTANCE_M: f64 = 384_400_000.0;
const SUN_DISTANCE_M: f64 = 149_597_870_700.0;

/// The moon under a sun. Without a direction or a time of its own it takes the sun's time.
pub fn assemble_moon(
    file: &MoonFile,
    sun_file: &SunFile,
    sun: &DirectionalLight,
    preset: Preset,
) -> Result<DirectionalLight, Problem> {
    let when = file.when.as_ref();
    let (direction, distance_m) = match (file.elevation_deg, file.azimuth_deg) {
        (Some(elevation), Some(azimuth)) if when.is_none() => {
            let (elevation_rad, azimuth_rad) = (elevation.get().to_radians(), azimuth.get().to_radians());
            (Direction { elevation_rad, azimuth_rad }, MEAN_DISTANCE_M)
        }
        (None, None) => match when.or(sun_file.when.as_ref()) {
            Some(when) => position_when(when, preset)?,
            None => {
                let message =
                    "missing fields, expected both elevation_deg and azimuth_deg, or [moon.when] or [sun.when]";
                return Err(Problem::new("moon", message));
            }
        },
        _ => {
            let message = "the moon's position is said in part or twice, expected either elevation_deg and azimuth_deg \
                           or [moon.when]";
            return Err(Problem::new("moon", message));
        }
    };
    let (toward, toward_sun) = (direction.to_vector(), sun.direction.to_vector());
    let phase_rad = match file.phase_angle_deg {
        Some(phase) => phase.get().to_radians(),
        None => phase_between(toward, toward_sun, distance_m),
    };
    let closeness = (MEAN_DISTANCE_M / distance_m).powi(2);
    let bright = |wavelength_nm: f64| closeness * sunlit_share(wavelength_nm, phase_rad);
    let dim = |wavelength_nm: f64| match file.earthshine.unwrap_or(true) {
        true => closeness * earthlit_share(wavelength_nm, phase_rad),
        false => 0.0,
    };
    let shares = BAND_WAVELENGTHS_NM.map(|wavelength_nm| bright(wavelength_nm) + dim(wavelength_nm));
    let computed = std::array::from_fn(|band| shares[band] * sun.irradiance[band]);
    let even_share = std::array::from_fn(|band| dim(BAND_WAVELENGTHS_NM[band]) / shares[band]);
    let radius_rad = file.angular_radius_deg.map_or((RADIUS_M / distance_m).asin(), |radius| radius.get().to_radians());
    Ok(DirectionalLight {
        name: "moon".to_owned(),
        direction,
        irradiance: file.irradiance.as_ref().map_or(computed, |irradiance| irradiance.get()),
        angular_radius_rad: radius_rad,
        limb_darkening: false,
        wavelengths_nm: BAND_WAVELENGTHS_NM,
        sphere: Some(LitSphere { toward_source: source_direction(toward, toward_sun, phase_rad), even_share }),
    })
}

fn position_when(when: &WhenFile, preset: Preset) -> Result<(Direction, f64), Problem> {
    if !preset.is_earth() {
        let message = format!(
            "a date says nothing of a moon over preset `{}`, expected elevation_deg and azimuth_deg",
            preset.name()
        );
        return Err(Problem::new("moon", message));
    }
    let time = julian_date(when.date_time).map_err(|error| Problem::new("moon.when.date_time", error.to_string()))?;
    let (latitude_deg, longitude_deg) = (when.latitude_deg.get(), when.longitude_deg.get());
    Ok(moon_position(time.julian_date(), time.julian_ephemeris_century(), latitude_deg, longitude_deg))
}

/// Phase angle of a moon at a distance, from the angle between it and the sun (Meeus 1998, eq. 48.3).
fn phase_between(toward: DVec3, toward_sun: DVec3, distance_m: f64) -> f64 {
    let elongation_rad = toward.angle_between(toward_sun);
    let (sine, cosine) = elongation_rad.sin_cos();
    (SUN_DISTANCE_M * sine).atan2(distance_m - SUN_DISTANCE_M * cosine).clamp(0.0, PI)
}

/// Unit vector from the moon to the sun: the lit limb faces the sun, and the phase is as asked.
fn source_direction(toward: DVec3, toward_sun: DVec3, phase_rad: f64) -> DVec3 {
    let across = (toward_sun - toward_sun.dot(toward) * toward).try_normalize();
    let across = across.unwrap_or_else(|| toward.any_orthonormal_vector());
    let (sine, cosine) = phase_rad.sin_cos();
    sine * across - cosine * toward
}
