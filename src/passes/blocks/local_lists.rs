//! Which volumes may stand between a volume, or the reach of a local light, and the light.

use std::ops::Range;

use glam::DVec3;
use welkin_lut::volume::Volume;

use super::local_lights::Lamp;
use crate::plan::Facts;

/// Numbers of volumes, list after list; the first is that of the local volumes whose light is kept, in the order of their blocks.
pub struct LocalLists {
    indices: Vec<u32>,
    volumes: Vec<Range<usize>>,
    lights: Vec<Range<usize>>,
}

/// Middle and radius of a local volume.
fn sphere(volume: &Volume) -> Option<(DVec3, f64)> {
    volume.bounding_sphere().map(|(centre_m, radius_m)| (DVec3::from_array(centre_m), radius_m))
}

impl LocalLists {
    /// Of a scene, whose local lights reach so far.
    pub fn new(facts: &Facts, lamps: &[Lamp]) -> Self {
        let spheres: Vec<_> = facts.volumes.iter().map(|volume| sphere(volume)).collect();
        let local = || spheres.iter().enumerate().filter_map(|(index, sphere)| sphere.map(|sphere| (index, sphere)));
        let mut indices: Vec<_> = facts.seen_volumes.iter().map(|&index| index as u32).collect();
        let mut list = |of: &dyn Fn(usize, (DVec3, f64)) -> bool| {
            let first = indices.len();
            indices.extend(local().filter(|&(index, sphere)| of(index, sphere)).map(|(index, _)| index as u32));
            first..indices.len()
        };
        let toward: Vec<_> = facts.lights.iter().map(|light| light.direction.to_vector()).collect();
        let volumes = spheres.iter().enumerate().map(|(index, own)| {
            list(&|other, (centre, radius)| {
                let Some((from, size)) = *own else { return true };
                other == index
                    || toward.iter().any(|toward| {
                        let offset = centre - from;
                        let along = offset.dot(*toward).max(0.0);
                        (offset - *toward * along).length() <= radius + size
                    })
            })
        });
        let volumes = volumes.collect();
        let lights = lamps.iter().map(|lamp| {
            list(&|other, (centre, radius)| {
                Some(other) != lamp.own_volume && (centre - lamp.position_m).length() <= lamp.reach_m + radius
            })
        });
        let lights = lights.collect();
        Self { indices, volumes, lights }
    }

    /// Those that may shade a volume, itself among them.
    pub fn of_volume(&self, index: usize) -> Range<usize> {
        self.volumes[index].clone()
    }

    /// Those within a local light's reach, but for the volume that is the light.
    pub fn of_light(&self, index: usize) -> Range<usize> {
        self.lights[index].clone()
    }

    /// WGSL `array<u32>`; one where there is none.
    pub fn to_words(&self) -> Vec<u32> {
        if self.indices.is_empty() { vec![0] } else { self.indices.clone() }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::local_lights::lamps;
    use super::*;
    use crate::plan::{Outputs, Quality, Settings};
    use crate::probe::Orders;
    use crate::scene::Scene;

    #[test]
    fn a_glowing_volume_does_not_stand_before_its_own_light() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/fog/glowing-gas.toml");
        let scene = Scene::read(&path).unwrap();
        let facts = Facts::new(&scene, Settings::of(Quality::Low), Orders::All, Outputs::default()).unwrap();
        let lamps = lamps(&facts);
        let lists = LocalLists::new(&facts, &lamps);
        assert_eq!((lamps.len(), lists.of_light(0).len()), (1, 0));
        // Negative control: of the sun's light it does.
        assert_eq!(lists.of_volume(0).len(), 1);
    }
}
