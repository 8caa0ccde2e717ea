//! What lies out of the picture: the altitudes that its rays reach, and what no ray comes near.
//!
//! The camera stands on the axis of the planet's shells, so that the altitudes along a ray follow from its zenith angle.

use welkin_lut::{Planet, geometry};

use super::{Facts, Surface};
use crate::scene::Camera;

/// The part of space that a picture's rays go through, as far as altitude tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenAltitudes {
    /// No ray comes lower, m ≥ 0.
    pub lowest_m: f64,
    /// No ray comes higher, m; infinite where one leaves upwards.
    pub highest_m: f64,
}

/// What of a scene is out of the picture, and why, in words and numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OutOfView {
    /// All air, and what hangs in it.
    pub air: Option<String>,
    /// Mountains.
    pub terrain: Option<String>,
    /// Clouds, and all that they shade.
    pub clouds: Option<String>,
}

impl OutOfView {
    /// Whether anything is.
    pub fn is_any(&self) -> bool {
        self.which().contains(&true)
    }

    /// Which of air, mountains and clouds are.
    pub fn which(&self) -> [bool; 3] {
        [&self.air, &self.terrain, &self.clouds].map(Option::is_some)
    }
}

/// Pixels around the picture that count as part of it: what touches its edge is blurred by one.
const MARGIN: f64 = 1.0;

/// Cosines of the zenith angle of a picture's rays: the least and the largest.
///
/// On the picture's plane, t to the right and s upwards from its centre, the cosine is (f + u s) / √(1 + t² + s²), f and u
/// the heights of the unit vectors forwards and upwards. At fixed s it is extreme at t = 0 or at the edge, and at fixed t at
/// an edge or where its derivative vanishes, s = u (1 + t²) / f.
fn zenith_cosines(camera: &Camera) -> [f64; 2] {
    let [_, up, forward] = camera.basis();
    let half_height = (0.5 * camera.vertical_field_of_view_rad).tan();
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let across = half_height * (width + 2.0 * MARGIN) / height;
    let upward = half_height * (height + 2.0 * MARGIN) / height;
    let mut cosines = [1.0_f64, -1.0];
    for t in [0.0, across] {
        let turning = up.z * (1.0 + t * t) / forward.z;
        let inside = (turning.abs() < upward).then_some(turning);
        for s in [Some(-upward), Some(upward), inside].into_iter().flatten() {
            let cosine = ((forward.z + up.z * s) / (1.0 + t * t + s * s).sqrt()).clamp(-1.0, 1.0);
            cosines = [cosines[0].min(cosine), cosines[1].max(cosine)];
        }
    }
    cosines
}

impl SeenAltitudes {
    /// Of a camera's picture.
    pub fn of(camera: &Camera, planet: &Planet) -> Self {
        let (radius_m, altitude_m) = (planet.radius_m, camera.altitude_m.max(0.0));
        let [lowest_mu, highest_mu] = zenith_cosines(camera);
        let horizon_mu = geometry::horizon_mu(radius_m, altitude_m);
        let lowest_m = if lowest_mu >= 0.0 {
            altitude_m
        } else if lowest_mu <= horizon_mu {
            0.0
        } else {
            // Where the ray is horizontal; written so that no radii are subtracted.
            let r = radius_m + altitude_m;
            (altitude_m - r * lowest_mu * lowest_mu / (1.0 + (1.0 - lowest_mu * lowest_mu).sqrt())).max(0.0)
        };
        let highest_m = if highest_mu >= horizon_mu { f64::INFINITY } else { altitude_m };
        Self { lowest_m, highest_m }
    }
}

impl<'a> Facts<'a> {
    /// For a picture of the scene's camera: leaves out what none of its rays comes near. Tables for rays of any direction
    /// do without this.
    pub fn in_picture(mut self) -> Self {
        let (camera, planet) = (&self.scene.camera, &self.scene.planet);
        let seen = SeenAltitudes::of(camera, planet);
        // `share` is 1; see `Skipping`.
        let share = self.settings.skipping.out_of_view_share;
        let top_m = planet.atmosphere_height_m;
        if self.has_air() && seen.lowest_m > share * top_m {
            self.out_of_view.air = Some(format!(
                "no ray comes below {:.0} km, and the air ends at {:.0} km",
                seen.lowest_m / 1e3,
                top_m / 1e3
            ));
            self.forget_air();
        }
        if let (Some(Surface::Terrain), Some(terrain)) = (self.surface, &self.scene.terrain) {
            let height_m = terrain.field.height_m;
            self.out_of_view.terrain =
                mountains_below_view(&seen, share, height_m).or_else(|| mountains_behind_air(&self, height_m));
            if self.out_of_view.terrain.is_some() {
                self.surface = None;
            }
        }
        self.out_of_view.clouds = clouds_below_view(&self, &seen, share).or_else(|| clouds_above_view(&self, &seen));
        if self.out_of_view.clouds.is_some() {
            self.clouds.clear();
        }
        self
    }

    fn forget_air(&mut self) {
        self.constituents.clear();
        self.emitters.clear();
        self.profile_groups.clear();
        self.groups = Default::default();
    }
}

/// Mountains under all rays.
fn mountains_below_view(seen: &SeenAltitudes, share: f64, height_m: f64) -> Option<String> {
    // From a camera as high as the highest summit one sees what one sees from there.
    (seen.lowest_m > share * height_m.max(f64::MIN_POSITIVE) + 1.0)
        .then(|| format!("no ray comes below {:.0} m, and no mountain is higher than {height_m:.0} m", seen.lowest_m))
}

/// Mountains under so much air that nothing of them is left. What is deepest inside the air is weakened by all of it from
/// the camera down to the highest summit, straight down at least; no slanting ray meets less.
fn mountains_behind_air(facts: &Facts, height_m: f64) -> Option<String> {
    let (top_m, camera_m) = (facts.scene.planet.atmosphere_height_m, facts.scene.camera.altitude_m.max(0.0));
    let between = |column_to: &dyn Fn(f64) -> f64| column_to(camera_m.min(top_m)) - column_to(height_m.min(top_m));
    let in_band = |band: usize| -> f64 {
        let depth = |constituent: &&welkin_lut::Constituent| {
            constituent.extinction_per_m()[band] * between(&|altitude_m| constituent.profile.column_m(altitude_m))
        };
        facts.constituents.iter().map(depth).sum()
    };
    let depth = (0..welkin_lut::BAND_COUNT).map(in_band).fold(f64::INFINITY, f64::min);
    (camera_m > height_m && depth > facts.settings.skipping.hidden_depth)
        .then(|| format!("the air between the camera and the highest summit has an optical depth of {depth:.1}"))
}

/// Clouds under all rays, where nothing is in view that could receive their light: no air, or no light at all. Lit clouds light
/// the air above them.
fn clouds_below_view(facts: &Facts, seen: &SeenAltitudes, share: f64) -> Option<String> {
    let top_m = facts.clouds.iter().map(|layer| layer.top_m).max_by(f64::total_cmp)?;
    if seen.lowest_m <= share * top_m || facts.has_local_media() {
        return None;
    }
    if facts.out_of_view.air.is_some() {
        return facts.out_of_view.air.clone();
    }
    let lowest_m = seen.lowest_m;
    facts
        .lights
        .is_empty()
        .then(|| format!("no ray comes below {lowest_m:.0} m, clouds end at {top_m:.0} m, and no light shines on them"))
}

/// Clouds over all rays, where no light shines that they could keep from what is seen.
fn clouds_above_view(facts: &Facts, seen: &SeenAltitudes) -> Option<String> {
    let base_m = facts.clouds.iter().map(|layer| layer.base_m).min_by(f64::total_cmp)?;
    let dark = facts.lights.is_empty() && facts.emitters.is_empty() && !facts.has_local_media();
    (dark && seen.highest_m < base_m).then(|| {
        let highest_m = seen.highest_m;
        format!(
            "no ray comes above {highest_m:.0} m, clouds begin at {base_m:.0} m, and without light they shade nothing"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Direction;

    fn camera(altitude_m: f64, elevation_deg: f64, field_deg: f64) -> Camera {
        Camera {
            altitude_m,
            direction: Direction { elevation_rad: elevation_deg.to_radians(), azimuth_rad: 1.0 },
            vertical_field_of_view_rad: field_deg.to_radians(),
            width: 64,
            height: 36,
        }
    }

    #[test]
    fn the_range_of_zenith_cosines_is_that_of_all_pixels() {
        for elevation_deg in [-90.0, -70.0, -20.0, 0.0, 5.0, 45.0, 80.0, 90.0] {
            for field_deg in [10.0, 60.0, 130.0] {
                let camera = camera(2.0, elevation_deg, field_deg);
                let [least, most] = zenith_cosines(&camera);
                let mut found = [1.0_f64, -1.0_f64];
                for y in 0..=38 {
                    for x in 0..=66 {
                        let z = camera.direction_through(f64::from(x) - 1.0, f64::from(y) - 1.0).z;
                        found = [found[0].min(z), found[1].max(z)];
                    }
                }
                assert!(least <= found[0] + 1e-12 && most >= found[1] - 1e-12, "{elevation_deg}° {field_deg}°");
                // No more than a pixel's worth beyond what was found.
                let pixel = field_deg.to_radians() / 18.0;
                assert!(
                    found[0] - least < pixel && most - found[1] < pixel,
                    "{elevation_deg}° {field_deg}°: {least} {most}"
                );
            }
        }
    }

    #[test]
    fn rays_upwards_never_come_lower_than_the_camera_and_rays_to_the_ground_never_higher() {
        let planet = Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.3; 3] };
        let up = SeenAltitudes::of(&camera(5000.0, 60.0, 40.0), &planet);
        assert_eq!((up.lowest_m, up.highest_m), (5000.0, f64::INFINITY));
        let down = SeenAltitudes::of(&camera(5000.0, -60.0, 40.0), &planet);
        assert_eq!((down.lowest_m, down.highest_m), (0.0, 5000.0));
        // From orbit a degree above the horizon: the tangent point is r sin z - R high.
        let horizon_deg = -geometry::horizon_mu(planet.radius_m, 400_000.0).asin().abs().to_degrees();
        let orbit = camera(400_000.0, horizon_deg + 6.0, 10.0 * 36.0 / 38.0);
        let lowest = zenith_cosines(&orbit)[0];
        let tangent_m = 6_760_000.0 * (1.0 - lowest * lowest).sqrt() - 6_360_000.0;
        assert!((SeenAltitudes::of(&orbit, &planet).lowest_m - tangent_m).abs() < 1e-3, "{tangent_m}");
    }
}
