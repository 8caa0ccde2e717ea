//! Where the moon stands at a time and place on Earth, to about a hundredth of a degree.
//!
//! The largest terms of the lunar theory ELP-2000/82 as Meeus 1998 ("Astronomical Algorithms", 2nd edition, chapter 47)
//! lists them, without nutation, brought to the observer on an ellipsoid.

use glam::DVec3;

use super::Direction;

/// Terms: multiples of D, M, M' and F; sine of longitude in 1e-6 degrees; cosine of distance in metres.
const LONGITUDE_AND_DISTANCE: [([i8; 4], f64, f64); 36] = [
    ([0, 0, 1, 0], 6_288_774.0, -20_905_355.0),
    ([2, 0, -1, 0], 1_274_027.0, -3_699_111.0),
    ([2, 0, 0, 0], 658_314.0, -2_955_968.0),
    ([0, 0, 2, 0], 213_618.0, -569_925.0),
    ([0, 1, 0, 0], -185_116.0, 48_888.0),
    ([0, 0, 0, 2], -114_332.0, -3_149.0),
    ([2, 0, -2, 0], 58_793.0, 246_158.0),
    ([2, -1, -1, 0], 57_066.0, -152_138.0),
    ([2, 0, 1, 0], 53_322.0, -170_733.0),
    ([2, -1, 0, 0], 45_758.0, -204_586.0),
    ([0, 1, -1, 0], -40_923.0, -129_620.0),
    ([1, 0, 0, 0], -34_720.0, 108_743.0),
    ([0, 1, 1, 0], -30_383.0, 104_755.0),
    ([2, 0, 0, -2], 15_327.0, 10_321.0),
    ([0, 0, 1, 2], -12_528.0, 0.0),
    ([0, 0, 1, -2], 10_980.0, 79_661.0),
    ([4, 0, -1, 0], 10_675.0, -34_782.0),
    ([0, 0, 3, 0], 10_034.0, -23_210.0),
    ([4, 0, -2, 0], 8_548.0, -21_636.0),
    ([2, 1, -1, 0], -7_888.0, 24_208.0),
    ([2, 1, 0, 0], -6_766.0, 30_824.0),
    ([1, 0, -1, 0], -5_163.0, -8_379.0),
    ([1, 1, 0, 0], 4_987.0, -16_675.0),
    ([2, -1, 1, 0], 4_036.0, -12_831.0),
    ([2, 0, 2, 0], 3_994.0, -10_445.0),
    ([4, 0, 0, 0], 3_861.0, -11_650.0),
    ([2, 0, -3, 0], 3_665.0, 14_403.0),
    ([0, 1, -2, 0], -2_689.0, -7_003.0),
    ([2, 0, -1, 2], -2_602.0, 0.0),
    ([2, -1, -2, 0], 2_390.0, 10_056.0),
    ([1, 0, 1, 0], -2_348.0, 6_322.0),
    ([2, -2, 0, 0], 2_236.0, -9_884.0),
    ([0, 1, 2, 0], -2_120.0, 5_751.0),
    ([0, 2, 0, 0], -2_069.0, 0.0),
    ([2, -2, -1, 0], 2_048.0, -4_950.0),
    ([2, 0, 1, -2], -1_773.0, 4_130.0),
];

/// Terms: multiples of D, M, M' and F; sine of latitude in 1e-6 degrees.
const LATITUDE: [([i8; 4], f64); 22] = [
    ([0, 0, 0, 1], 5_128_122.0),
    ([0, 0, 1, 1], 280_602.0),
    ([0, 0, 1, -1], 277_693.0),
    ([2, 0, 0, -1], 173_237.0),
    ([2, 0, -1, 1], 55_413.0),
    ([2, 0, -1, -1], 46_271.0),
    ([2, 0, 0, 1], 32_573.0),
    ([0, 0, 2, 1], 17_198.0),
    ([2, 0, 1, -1], 9_266.0),
    ([0, 0, 2, -1], 8_822.0),
    ([2, -1, 0, -1], 8_216.0),
    ([2, 0, -2, -1], 4_324.0),
    ([2, 0, 1, 1], 4_200.0),
    ([2, 1, 0, -1], -3_359.0),
    ([2, -1, -1, 1], 2_463.0),
    ([2, -1, 0, 1], 2_211.0),
    ([2, -1, -1, -1], 2_065.0),
    ([0, 1, -1, -1], -1_870.0),
    ([4, 0, -1, -1], 1_828.0),
    ([0, 1, 0, 1], -1_794.0),
    ([0, 0, 0, 3], -1_749.0),
    ([0, 1, -1, 1], -1_565.0),
];

/// Equatorial radius and flattening of the Earth (WGS 84), m.
const EQUATOR_M: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Geocentric ecliptic position of the date.
struct Ecliptic {
    longitude_rad: f64,
    latitude_rad: f64,
    distance_m: f64,
}

/// `t`: Julian centuries of dynamical time since J2000.
fn ecliptic(t: f64) -> Ecliptic {
    let mean_longitude = 218.316_447_7 + 481_267.881_234_21 * t - 0.001_578_6 * t * t;
    let arguments = [
        297.850_192_1 + 445_267.111_403_4 * t - 0.001_881_9 * t * t,
        357.529_109_2 + 35_999.050_290_9 * t - 0.000_153_6 * t * t,
        134.963_396_4 + 477_198.867_505_5 * t + 0.008_741_4 * t * t,
        93.272_095_0 + 483_202.017_523_3 * t - 0.003_653_9 * t * t,
    ];
    // The Earth's orbit becomes rounder, and terms of the sun's anomaly weaker.
    let eccentricity = 1.0 - 0.002_516 * t - 0.000_007_4 * t * t;
    let argument = |multiples: &[i8; 4]| -> f64 {
        multiples.iter().zip(arguments).map(|(&n, angle)| f64::from(n) * angle).sum::<f64>().to_radians()
    };
    let weight = |multiples: &[i8; 4]| eccentricity.powi(i32::from(multiples[1].abs()));
    let (mut longitude, mut distance_m) = (0.0, 385_000_560.0);
    for (multiples, sine, cosine) in &LONGITUDE_AND_DISTANCE {
        longitude += weight(multiples) * sine * argument(multiples).sin();
        distance_m += weight(multiples) * cosine * argument(multiples).cos();
    }
    let latitude: f64 = LATITUDE.iter().map(|(m, sine)| weight(m) * sine * argument(m).sin()).sum();
    // Venus, Jupiter and the flattening of the Earth.
    let a1 = (119.75 + 131.849 * t).to_radians();
    let (l, f) = (mean_longitude.to_radians(), arguments[3].to_radians());
    longitude += 3958.0 * a1.sin() + 1962.0 * (l - f).sin() + 318.0 * (53.09 + 479_264.29 * t).to_radians().sin();
    Ecliptic {
        longitude_rad: (mean_longitude + 1e-6 * longitude).to_radians(),
        latitude_rad: (1e-6 * (latitude - 2235.0 * l.sin())).to_radians(),
        distance_m,
    }
}

/// Direction from the observer to the moon's centre without refraction, and its distance from there, m.
///
/// `julian_date` in universal time, `julian_ephemeris_century` in dynamical time; latitude north, longitude east, degrees.
pub fn moon_position(
    julian_date: f64,
    julian_ephemeris_century: f64,
    latitude_deg: f64,
    longitude_deg: f64,
) -> (Direction, f64) {
    let moon = ecliptic(julian_ephemeris_century);
    let obliquity_rad = (23.439_291 - 0.013_004_2 * julian_ephemeris_century).to_radians();
    let (sin_b, cos_b) = moon.latitude_rad.sin_cos();
    let (sin_l, cos_l) = moon.longitude_rad.sin_cos();
    let (sin_e, cos_e) = obliquity_rad.sin_cos();
    let equatorial = moon.distance_m
        * DVec3::new(cos_b * cos_l, cos_e * cos_b * sin_l - sin_e * sin_b, sin_e * cos_b * sin_l + cos_e * sin_b);
    // Mean sidereal time (Meeus, eq. 12.4).
    let days = julian_date - 2_451_545.0;
    let sidereal_deg = 280.460_618_37 + 360.985_647_366_29 * days + longitude_deg;
    let (sin_s, cos_s) = sidereal_deg.to_radians().sin_cos();
    let (sin_lat, cos_lat) = latitude_deg.to_radians().sin_cos();
    let east = DVec3::new(-sin_s, cos_s, 0.0);
    let north = DVec3::new(-sin_lat * cos_s, -sin_lat * sin_s, cos_lat);
    let up = DVec3::new(cos_lat * cos_s, cos_lat * sin_s, sin_lat);
    let squared = FLATTENING * (2.0 - FLATTENING);
    let normal_m = EQUATOR_M / (1.0 - squared * sin_lat * sin_lat).sqrt();
    let observer = normal_m * DVec3::new(up.x, up.y, (1.0 - squared) * up.z);
    let offset = equatorial - observer;
    let distance_m = offset.length();
    let elevation_rad = (offset.dot(up) / distance_m).clamp(-1.0, 1.0).asin();
    let azimuth_rad = offset.dot(east).atan2(offset.dot(north)).rem_euclid(std::f64::consts::TAU);
    (Direction { elevation_rad, azimuth_rad }, distance_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_moon_stands_where_meeus_computed_it() {
        // Example 47.a: 12 April 1992, 0 h dynamical time: 133.162655°, -3.229126°, 368 409.7 km.
        let moon = ecliptic(-0.077_221_081_451);
        let off = |value: f64, exact: f64| (value.to_degrees() - exact + 180.0).rem_euclid(360.0) - 180.0;
        assert!(off(moon.longitude_rad, 133.162_655).abs() < 0.01, "{}", off(moon.longitude_rad, 133.162_655));
        assert!(off(moon.latitude_rad, -3.229_126).abs() < 0.01, "{}", off(moon.latitude_rad, -3.229_126));
        assert!((moon.distance_m / 368_409_700.0 - 1.0).abs() < 3e-4, "{}", moon.distance_m);
    }
}
