//! Whatever the text of a table of rays is, it is refused with a reason or becomes rays within their ranges, whose rows come
//! back with the answers.
#![no_main]

use std::f64::consts::{PI, TAU};
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use welkin::probe::{RayRadiance, RayTable};

const RADIUS_M: f64 = 6_360_000.0;

fuzz_target!(|text: &str| {
    let path = Path::new("rays.csv");
    let table = match RayTable::parse(text, path, RADIUS_M) {
        Ok(table) => table,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    for ray in table.rays() {
        assert!((-RADIUS_M..=1e10).contains(&ray.altitude_m) && ray.distance_m > 0.0, "{ray:?}");
        assert!([ray.view_zenith_rad, ray.sun_zenith_rad].iter().all(|angle| (0.0..=PI).contains(angle)), "{ray:?}");
        assert!([ray.view_azimuth_rad, ray.sun_azimuth_rad].iter().all(|angle| angle.abs() <= TAU), "{ray:?}");
    }
    let nothing = RayRadiance { radiance: [0.0; 3], transmittance: [1.0; 3], standard_error: [0.0; 3] };
    let answered = table.with_answers(&vec![nothing; table.rays().len()]).expect("a row for every answer");
    let answered = String::from_utf8(answered).expect("text stays text");
    // Its header now holds the columns of an answer, which a table of rays may not have.
    assert!(RayTable::parse(&answered, path, RADIUS_M).is_err());
});
