//! Where the sun stands at a time and place on Earth.

use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};
use toml::value::{Datetime, Offset};

use super::Direction;

const MINUTES_PER_DAY: f64 = 1440.0;

/// Why a time says nothing of the sun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SunPositionError {
    /// A part of the date and time is missing.
    #[error("invalid value: `{0}`, expected a date, a time and an offset from UTC, as in 2026-06-21T12:00:00Z")]
    Incomplete(Datetime),
    /// The ephemeris does not know the date.
    #[error("invalid value: `{date_time}`, expected a year from 0000 to 6000 ({source})")]
    OutOfRange {
        /// The date and time refused.
        date_time: Datetime,
        /// What the ephemeris says.
        source: solar_positioning::Error,
    },
}

/// Direction to the centre of the sun from sea level, without refraction (Reda and Andreas 2004, ±0.0003°).
///
/// Latitude in [-90, 90], north positive; longitude in [-180, 180], east positive; degrees.
pub fn sun_direction(
    date_time: Datetime,
    latitude_deg: f64,
    longitude_deg: f64,
) -> Result<Direction, SunPositionError> {
    let time = julian_date(date_time)?;
    let location = Location { latitude: latitude_deg, longitude: longitude_deg };
    let position = SolarPositions::new().at_from_julian(time, location, 0.0, None);
    let position = position.map_err(|source| SunPositionError::OutOfRange { date_time, source })?;
    Ok(Direction {
        elevation_rad: position.elevation_angle().to_radians(),
        azimuth_rad: position.azimuth().to_radians(),
    })
}

/// The instant of a date and time with its offset.
pub(super) fn julian_date(date_time: Datetime) -> Result<JulianDate, SunPositionError> {
    let Datetime { date: Some(date), time: Some(time), offset: Some(offset) } = date_time else {
        return Err(SunPositionError::Incomplete(date_time));
    };
    let minutes_ahead = match offset {
        Offset::Z => 0.0,
        Offset::Custom { minutes } => f64::from(minutes),
    };
    // A leap second counts as the end of the second before it; the sun moves 0.004° in it.
    let whole = time.second.unwrap_or(0).min(59);
    let second = f64::from(whole) + f64::from(time.nanosecond.unwrap_or(0)) * 1e-9;
    let (year, month, day) = (i32::from(date.year), u32::from(date.month), u32::from(date.day));
    let out_of_range = |source| SunPositionError::OutOfRange { date_time, source };
    let delta_t = delta_t::estimate_from_date(year, month).map_err(out_of_range)?;
    let local = JulianDate::from_utc(year, month, day, time.hour.into(), time.minute.into(), second, delta_t);
    let local = local.map_err(out_of_range)?;
    JulianDate::new(local.julian_date() - minutes_ahead / MINUTES_PER_DAY, delta_t).map_err(out_of_range)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The worked example of Reda and Andreas 2004 (NREL/TP-560-34302): 17 October 2003, 12:30:30 local time seven hours
    /// behind UTC, 39.742476° N, 105.1786° W. The report's elevation without refraction is 39.872046°, its azimuth
    /// 194.340241°, for a site at 1830.14 m, which changes the sun's parallax by less than 1e-6°.
    #[test]
    fn the_sun_stands_where_nrel_computed_it() {
        let date_time = "2003-10-17T12:30:30-07:00".parse().unwrap();
        let sun = sun_direction(date_time, 39.742_476, -105.178_6).unwrap();
        // ΔT is estimated here (64.5 s) and given there (67 s): 2.5 s of the Earth's path, below 2e-5°.
        assert!((sun.elevation_rad.to_degrees() - 39.872_046).abs() < 1e-4, "{}", sun.elevation_rad.to_degrees());
        assert!((sun.azimuth_rad.to_degrees() - 194.340_241).abs() < 1e-4, "{}", sun.azimuth_rad.to_degrees());
    }

    #[test]
    fn the_same_instant_in_another_time_zone_is_the_same_sun() {
        let here = sun_direction("2026-06-21T12:00:00+02:00".parse().unwrap(), 48.0, 16.0).unwrap();
        let utc = sun_direction("2026-06-21T10:00:00Z".parse().unwrap(), 48.0, 16.0).unwrap();
        let later = sun_direction("2026-06-21T10:01:00Z".parse().unwrap(), 48.0, 16.0).unwrap();
        assert!((here.elevation_rad - utc.elevation_rad).abs() < 1e-9);
        assert!((later.elevation_rad - utc.elevation_rad).abs() > 1e-5);
    }

    #[test]
    fn a_time_without_offset_is_refused() {
        let error = sun_direction("2026-06-21T12:00:00".parse().unwrap(), 48.0, 16.0).unwrap_err();
        assert!(error.to_string().contains("2026-06-21T12:00:00`, expected"), "{error}");
    }
}
