//! Flying: from the ground to orbit in one motion, as speed grows with altitude.

use glam::{DQuat, DVec3};
use toml::{Table, Value};

use super::document::{as_number, set};
use crate::scene::{Direction, Light, Scene};

/// Metres a second on the ground, and the share of the altitude that is flown in a second above it.
const GROUND_SPEED_M_PER_S: f64 = 8.0;
const SPEED_PER_ALTITUDE: f64 = 0.5;

/// Eye height that one does not sink below, and the end of the way up, m.
const LOWEST_M: f64 = 0.5;
const HIGHEST_M: f64 = 1e9;

/// Radians that the view turns in a second with a key held.
const TURN_PER_S: f64 = 0.9;

/// What the keys ask for: each component in [-1, 1].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// To the right, forward and up.
    pub along: DVec3,
    /// Turning right and up.
    pub turn: [f64; 2],
    /// Factor on the speed.
    pub haste: f64,
}

impl Motion {
    /// Whether it moves anything.
    pub fn is_still(&self) -> bool {
        self.along == DVec3::ZERO && self.turn == [0.0; 2]
    }
}

/// Metres a second at an altitude.
pub fn speed_m_per_s(altitude_m: f64) -> f64 {
    GROUND_SPEED_M_PER_S + SPEED_PER_ALTITUDE * altitude_m.max(0.0)
}

/// Moves the camera of a scene for some seconds. The camera's place is the origin of the scene: lights without a date turn
/// about it as the ground passes below, dates keep their place's latitude and longitude up to date, and terrain is shifted.
pub fn fly(table: &mut Table, scene: &Scene, motion: Motion, seconds: f64) {
    let camera = &scene.camera;
    let turned = [motion.turn[0] * TURN_PER_S * seconds, motion.turn[1] * TURN_PER_S * seconds];
    look(table, scene, turned);
    let [right, up, forward] = camera.basis();
    let wanted = motion.along.x * right + motion.along.y * forward + motion.along.z * up;
    let step = wanted.normalize_or_zero() * speed_m_per_s(camera.altitude_m) * motion.haste * seconds;
    if step == DVec3::ZERO {
        return;
    }
    // On a sphere the way straight ahead rises: sqrt((R+h+z)² + s²) - R, without losing digits.
    let from_centre = scene.planet.radius_m + camera.altitude_m;
    let across = step.truncate().length();
    let along = from_centre + step.z;
    let rise = step.z + across * across / (along.hypot(across) + along);
    let altitude_m = (camera.altitude_m + rise).clamp(LOWEST_M, HIGHEST_M);
    set(table, "camera.altitude_m", Some(rounded(altitude_m).into()));
    if across > 0.0 {
        pass_ground(table, scene, step.truncate() / across, across.atan2(along));
    }
}

/// Turns the camera to the right and up by angles, rad.
pub fn look(table: &mut Table, scene: &Scene, [right, up]: [f64; 2]) {
    if [right, up] == [0.0; 2] {
        return;
    }
    let Direction { elevation_rad, azimuth_rad } = scene.camera.direction;
    let elevation_deg = (elevation_rad + up).to_degrees().clamp(-90.0, 90.0);
    let azimuth_deg = (azimuth_rad + right).to_degrees().rem_euclid(360.0);
    set(table, "camera.elevation_deg", Some(rounded(elevation_deg).into()));
    set(table, "camera.azimuth_deg", Some(rounded(azimuth_deg).into()));
}

/// The ground passes below the camera by an angle of the planet towards `heading` (east, north).
fn pass_ground(table: &mut Table, scene: &Scene, heading: glam::DVec2, angle: f64) {
    // Up tilts towards the heading about the horizontal axis to the left of it, and what is fixed in space turns back.
    let axis = DVec3::new(-heading.y, heading.x, 0.0);
    let turned = DQuat::from_axis_angle(axis, -angle);
    let mut directional = 0;
    for light in scene.lights.iter() {
        let Light::Directional(light) = light else { continue };
        let path = match light.name.as_str() {
            "sun" => "sun".to_owned(),
            "moon" => "moon".to_owned(),
            _ => {
                directional += 1;
                format!("light.directional[{}]", directional - 1)
            }
        };
        let says_angles = at(table, &path).is_some_and(|light| light.get("elevation_deg").is_some());
        if says_angles {
            point(table, &path, turned * light.direction.to_vector());
        }
    }
    for place in ["sun.when", "moon.when"] {
        move_place(table, place, heading, angle);
    }
    if table.contains_key("terrain") {
        let way = heading * angle * scene.planet.radius_m;
        let before = at(table, "terrain.position_m").and_then(Value::as_array);
        let before = before.map_or([0.0; 2], |list| {
            let number = |index: usize| list.get(index).and_then(as_number).unwrap_or(0.0);
            [number(0), number(1)]
        });
        let position = vec![Value::from(rounded(before[0] + way.x)), Value::from(rounded(before[1] + way.y))];
        set(table, "terrain.position_m", Some(Value::Array(position)));
    }
}

fn at<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut parts = path.split('.');
    let first = parts.next()?;
    let start = match first.split_once('[') {
        Some(_) => return None,
        None => table.get(first)?,
    };
    parts.try_fold(start, |value, part| match part.split_once('[') {
        Some((key, index)) => value.get(key)?.get(index.trim_end_matches(']').parse::<usize>().ok()?),
        None => value.get(part),
    })
}

/// Writes a light's direction as angles.
pub fn point(table: &mut Table, path: &str, toward: DVec3) {
    let elevation_deg = toward.z.clamp(-1.0, 1.0).asin().to_degrees();
    let azimuth_deg = toward.x.atan2(toward.y).to_degrees().rem_euclid(360.0);
    set(table, &format!("{path}.elevation_deg"), Some(rounded(elevation_deg).into()));
    set(table, &format!("{path}.azimuth_deg"), Some(rounded(azimuth_deg).into()));
}

/// Moves a place on the sphere along a great circle. The heading is kept, which near the poles is not the great circle's.
fn move_place(table: &mut Table, path: &str, heading: glam::DVec2, angle: f64) {
    let number = |name: &str| at(table, &format!("{path}.{name}")).and_then(as_number);
    let (Some(latitude_deg), Some(longitude_deg)) = (number("latitude_deg"), number("longitude_deg")) else { return };
    let (sin_latitude, cos_latitude) = latitude_deg.to_radians().sin_cos();
    let (sin_angle, cos_angle) = angle.sin_cos();
    let sin_new = sin_latitude * cos_angle + cos_latitude * sin_angle * heading.y;
    let turned = (heading.x * sin_angle * cos_latitude).atan2(cos_angle - sin_latitude * sin_new);
    let longitude = (longitude_deg + turned.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    let latitude = sin_new.clamp(-1.0, 1.0).asin().to_degrees();
    set(table, &format!("{path}.latitude_deg"), Some(rounded(latitude).into()));
    set(table, &format!("{path}.longitude_deg"), Some(rounded(longitude).into()));
}

/// To nine digits after the point: files stay readable, and nothing is lost that can be seen.
pub fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::document::Document;
    use super::*;

    fn document(more: &str) -> Document {
        let text = format!(
            "preset = \"earth\"\n[camera]\naltitude_m = 2\nelevation_deg = 30\nazimuth_deg = 90\n[sun]\n{more}"
        );
        Document::new(&text, Path::new("scene.toml")).unwrap()
    }

    fn flown(document: &mut Document, along: DVec3, haste: f64, seconds: f64) {
        let (scene, steps) = (document.scene().clone(), (seconds / 0.016) as usize);
        let motion = Motion { along, turn: [0.0; 2], haste };
        let mut scene = scene;
        for _ in 0..steps {
            document.edit(|table| fly(table, &scene, motion, 0.016)).unwrap();
            scene = document.scene().clone();
        }
    }

    #[test]
    fn one_motion_leads_from_the_ground_to_orbit_in_less_than_a_minute() {
        let mut document = document("elevation_deg = 25\nazimuth_deg = 180\n");
        flown(&mut document, DVec3::Y, 1.0, 45.0);
        let altitude_m = document.scene().camera.altitude_m;
        assert!((400e3..4e7).contains(&altitude_m), "{altitude_m}");
        // Down again to the ground, not below it.
        flown(&mut document, -DVec3::Y, 4.0, 60.0);
        assert_eq!(document.scene().camera.altitude_m, 0.5);
    }

    #[test]
    fn the_sun_sinks_behind_one_who_flies_away_from_it() {
        // Level flight to the east at 400 km, away from a sun in the west.
        let mut document = document("elevation_deg = 25\nazimuth_deg = 270\n");
        document.set("camera.altitude_m", 400e3).unwrap();
        document.set("camera.elevation_deg", 0.0).unwrap();
        let before = document.scene().clone();
        let motion = Motion { along: DVec3::Y, turn: [0.0; 2], haste: 1.0 };
        document.edit(|table| fly(table, &before, motion, 1.0)).unwrap();
        let way_m = speed_m_per_s(400e3);
        let angle_deg = (way_m / (before.planet.radius_m + 400e3)).atan().to_degrees();
        let sun_deg = document.number("sun.elevation_deg").unwrap();
        assert!((25.0 - sun_deg - angle_deg).abs() < 1e-8, "{sun_deg}, {angle_deg}");
        // A tangent leads away from the sphere: by the square of the way over twice the distance from the centre.
        let risen_m = document.scene().camera.altitude_m - 400e3;
        let expected_m = way_m * way_m / (2.0 * (before.planet.radius_m + 400e3));
        assert!((risen_m / expected_m - 1.0).abs() < 1e-3, "{risen_m}, {expected_m}");
    }

    #[test]
    fn a_place_with_a_date_moves_on_the_map() {
        let when = "when = { date_time = 2026-06-21T12:00:00Z, latitude_deg = 60, longitude_deg = 179.9 }\n";
        let mut document = document(when);
        document.set("camera.elevation_deg", 0.0).unwrap();
        document.set("camera.altitude_m", 100e3).unwrap();
        let before = document.scene().clone();
        let motion = Motion { along: DVec3::Y, turn: [0.0; 2], haste: 1.0 };
        document.edit(|table| fly(table, &before, motion, 1.0)).unwrap();
        let angle_deg = (speed_m_per_s(100e3) / (before.planet.radius_m + 100e3)).atan().to_degrees();
        // East at 60° north: a degree of longitude is half as long, and the date line is crossed.
        let longitude_deg = document.number("sun.when.longitude_deg").unwrap();
        assert!((longitude_deg - (179.9 + 2.0 * angle_deg - 360.0)).abs() < 0.01, "{longitude_deg}");
        assert!((document.number("sun.when.latitude_deg").unwrap() - 60.0).abs() < 0.01);
    }
}
