//! Times of day: the sun's path over a place, and dates that advance.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use toml::value::{Date, Datetime, Offset, Time};

use crate::scene::Direction;

/// Latitude over which a sun without a date moves, rad.
const LATITUDE_RAD: f64 = 45.0 * PI / 180.0;

/// The circle on which a sun moves in a day: its declination, over 45° north.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DayPath {
    declination_rad: f64,
}

impl DayPath {
    /// The path that passes through where the sun stands, and its time there: hours of solar time in [0, 24[.
    pub fn through(sun: Direction) -> (Self, f64) {
        let (sin_latitude, cos_latitude) = LATITUDE_RAD.sin_cos();
        let (sin_elevation, cos_elevation) = sun.elevation_rad.sin_cos();
        let (sin_azimuth, cos_azimuth) = sun.azimuth_rad.sin_cos();
        let sin_declination = sin_latitude * sin_elevation + cos_latitude * cos_elevation * cos_azimuth;
        let declination_rad = sin_declination.clamp(-1.0, 1.0).asin();
        let angle = (-sin_azimuth * cos_elevation)
            .atan2(cos_latitude * sin_elevation - sin_latitude * cos_elevation * cos_azimuth);
        (Self { declination_rad }, (12.0 + angle * 24.0 / TAU).rem_euclid(24.0))
    }

    /// Where the sun stands at an hour of solar time.
    pub fn at(&self, hour: f64) -> Direction {
        let (sin_latitude, cos_latitude) = LATITUDE_RAD.sin_cos();
        let (sin_declination, cos_declination) = self.declination_rad.sin_cos();
        let (sin_angle, cos_angle) = ((hour - 12.0) * TAU / 24.0).sin_cos();
        let sin_elevation = sin_latitude * sin_declination + cos_latitude * cos_declination * cos_angle;
        let north = cos_latitude * sin_declination - sin_latitude * cos_declination * cos_angle;
        Direction {
            elevation_rad: sin_elevation.clamp(-1.0, 1.0).asin().clamp(-FRAC_PI_2, FRAC_PI_2),
            azimuth_rad: (-cos_declination * sin_angle).atan2(north).rem_euclid(TAU),
        }
    }
}

/// A date and time some seconds later, in the same offset from UTC; `None` without date or time, or beyond the years
/// 0 to 9999.
pub fn later(date_time: Datetime, seconds: f64) -> Option<Datetime> {
    let (date, time) = (date_time.date?, date_time.time?);
    let second = f64::from(time.second.unwrap_or(0)) + f64::from(time.nanosecond.unwrap_or(0)) * 1e-9;
    let of_day = f64::from(time.hour) * 3600.0 + f64::from(time.minute) * 60.0 + second + seconds;
    let day = days_from_civil(date) + (of_day / 86_400.0).floor() as i64;
    // In whole milliseconds, so that a second is never written as 60.
    let milliseconds = ((of_day.rem_euclid(86_400.0) * 1e3).round() as u64).min(86_399_999);
    let (whole, rest) = (milliseconds / 1000, milliseconds % 1000);
    let time = Time {
        hour: (whole / 3600) as u8,
        minute: (whole / 60 % 60) as u8,
        second: Some((whole % 60) as u8),
        nanosecond: (rest > 0).then_some(rest as u32 * 1_000_000),
    };
    Some(Datetime { date: Some(civil_from_days(day)?), time: Some(time), offset: date_time.offset })
}

/// Hours since midnight.
pub fn hour_of(date_time: &Datetime) -> Option<f64> {
    let time = date_time.time?;
    Some(f64::from(time.hour) + f64::from(time.minute) / 60.0 + f64::from(time.second.unwrap_or(0)) / 3600.0)
}

/// Noon of a day at the equinox, for a scene that had no date.
pub fn equinox() -> Datetime {
    let date = Date { year: 2026, month: 3, day: 20 };
    let time = Time { hour: 12, minute: 0, second: Some(0), nanosecond: None };
    Datetime { date: Some(date), time: Some(time), offset: Some(Offset::Z) }
}

/// Days since 1 March of year 0 (Hinnant 2014, chrono-compatible low-level date algorithms).
fn days_from_civil(date: Date) -> i64 {
    let (month, day) = (i64::from(date.month), i64::from(date.day));
    let year = i64::from(date.year) - i64::from(month <= 2);
    let (era, of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year
}

fn civil_from_days(days: i64) -> Option<Date> {
    let (era, of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * of_year + 2) / 153;
    let (day, month) = (of_year - (153 * shifted + 2) / 5 + 1, (shifted + 2) % 12 + 1);
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    Some(Date { year: u16::try_from(year).ok().filter(|year| *year <= 9999)?, month: month as u8, day: day as u8 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_through_a_sun_passes_through_it_at_its_time() {
        for (elevation, azimuth) in [(60.0_f64, 180.0_f64), (4.0, 270.0), (-4.0, 270.0), (25.0, 90.0), (-40.0, 20.0)] {
            let sun = Direction { elevation_rad: elevation.to_radians(), azimuth_rad: azimuth.to_radians() };
            let (path, hour) = DayPath::through(sun);
            let again = path.at(hour);
            assert!((again.to_vector() - sun.to_vector()).length() < 1e-12, "{again:?}");
        }
    }

    #[test]
    fn a_sun_in_the_west_sinks_and_is_due_south_at_noon() {
        let sun = Direction { elevation_rad: 0.1, azimuth_rad: 270_f64.to_radians() };
        let (path, hour) = DayPath::through(sun);
        assert!(hour > 12.0 && path.at(hour + 0.5).elevation_rad < sun.elevation_rad);
        assert!((path.at(12.0).azimuth_rad - PI).abs() < 1e-9);
    }

    #[test]
    fn seconds_later_cross_days_months_and_leap_years() {
        let add = |text: &str, seconds: f64| later(text.parse().unwrap(), seconds).unwrap().to_string();
        assert_eq!(add("2026-06-21T23:59:30+02:00", 45.0), "2026-06-22T00:00:15+02:00");
        assert_eq!(add("2024-02-28T12:00:00Z", 86_400.0), "2024-02-29T12:00:00Z");
        assert_eq!(add("2025-02-28T12:00:00Z", 86_400.0), "2025-03-01T12:00:00Z");
        assert_eq!(add("2026-01-01T00:00:00Z", -1.0), "2025-12-31T23:59:59Z");
        assert_eq!(add("2026-01-01T00:00:00Z", 0.25), "2026-01-01T00:00:00.25Z");
        assert_eq!(later("9999-12-31T23:59:59Z".parse().unwrap(), 10.0), None);
    }
}
