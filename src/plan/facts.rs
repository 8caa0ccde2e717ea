//! What the plan and the passes know about a scene, sorted the way the shaders want it.

use welkin_lut::cloud::CloudLayer;
use welkin_lut::mapping::SkyViewMapping;
use welkin_lut::volume::Volume;
use welkin_lut::{Constituent, PhaseFunction, geometry};

use super::constituent_groups::{
    ConstituentGroups, check_supported, group_of, profile_groups, profile_rank, weakens_light,
};
use super::disc::is_wide;
use super::lights::{local_lights, shining_lights, sort_lights};
use super::seen_volumes::seen_volumes;
use super::thick;
use super::thin;
use super::{
    CloudScattering, FroxelGrid, OutOfView, PlanError, Sequence, Settings, SourceGrid, TableFormat, Treatment,
};
use crate::probe::Orders;
use crate::scene::{DirectionalLight, GroupColour, PointLight, Scene, WavelengthGroup};

/// What is to come out of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Outputs {
    /// Transmittance and distance beside radiance, for files and engines.
    pub capture: bool,
    /// An 8-bit picture to look at.
    pub picture: bool,
}

/// What stands before the camera, where the air has to be told from what is behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Surface {
    /// The scene's hills and mountains.
    Terrain,
    /// Distances and colours that the host gives, told from earlier ones by a number.
    Given(u64),
    /// Rays that end at a distance.
    Rays,
}

/// Where the camera stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Viewpoint {
    /// Not above the top of the atmosphere.
    InAir,
    /// Above the top.
    InSpace,
}

/// One of several groups of wavelengths that make up a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralPart {
    /// From 0, in the order in which groups are rendered.
    pub index: usize,
    /// How many groups there are.
    pub count: usize,
    /// Its wavelengths.
    pub wavelengths: WavelengthGroup,
    /// What it adds to the picture.
    pub colour: GroupColour,
}

impl SpectralPart {
    /// Whether the picture is whole after this one.
    pub fn is_last(&self) -> bool {
        self.index + 1 == self.count
    }
}

/// A scene, a quality and a request, with what follows from them.
#[derive(Debug, Clone)]
pub struct Facts<'a> {
    /// The scene itself.
    pub scene: &'a Scene,
    /// What the quality means.
    pub settings: Settings,
    /// Which orders of scattering are asked for.
    pub orders: Orders,
    /// What is to come out.
    pub outputs: Outputs,
    /// Which part of the picture this is; none where three wavelengths are all.
    pub part: Option<SpectralPart>,
    /// Constituents that do something to light, in the shaders' order.
    pub constituents: Vec<&'a Constituent>,
    /// The groups of that order.
    pub groups: ConstituentGroups,
    /// Constituents that give off light, by profile as above.
    pub emitters: Vec<&'a Constituent>,
    /// Layers in which there are clouds.
    pub clouds: Vec<&'a CloudLayer>,
    /// Fog, then local volumes, of which something can be seen; each by its name, as files may list them in any order.
    pub volumes: Vec<&'a Volume>,
    /// Numbers of the local volumes among them that may lie in the picture.
    pub seen_volumes: Vec<usize>,
    /// Point and spot lights that shine, as bright as they are at the scene's time.
    pub local_lights: Vec<PointLight>,
    /// Of each scatterer: the number of its density profile among those of all scatterers.
    pub profile_groups: Vec<u32>,
    /// How multiply scattered light is computed.
    pub treatment: Treatment,
    /// Why, in words and numbers.
    pub treatment_reason: String,
    /// Directional lights that shine.
    pub lights: Vec<&'a DirectionalLight>,
    /// Directional lights of which only the disc is seen.
    pub faint_discs: Vec<&'a DirectionalLight>,
    /// Why lights are in none or only the second of these lists.
    pub left_out: Vec<String>,
    /// Where the camera stands.
    pub viewpoint: Viewpoint,
    /// What stands before it besides the ground.
    pub surface: Option<Surface>,
    /// Where a host wants to know what lies before the camera; nowhere without one.
    pub froxels: Option<FroxelGrid>,
    /// Where this frame stands among others; none for one that stands alone.
    pub sequence: Option<Sequence>,
    /// Whether nobody reads the frame's radiance but the picture for a screen, for which half floats will do.
    pub for_screen: bool,
    /// What is left out because the picture does not show it.
    pub out_of_view: OutOfView,
    /// Why light scattered more than once does not show in air over smooth ground, if it does not.
    pub thin: Option<String>,
}

impl<'a> Facts<'a> {
    /// Looks a scene over.
    ///
    /// # Errors
    /// [`PlanError::Unsupported`] for what the real-time renderer cannot do yet but the reference can.
    pub fn new(scene: &'a Scene, settings: Settings, orders: Orders, outputs: Outputs) -> Result<Self, PlanError> {
        let mut constituents: Vec<_> = scene.medium.constituents.iter().filter(|c| weakens_light(c)).collect();
        constituents.sort_by_key(|constituent| group_of(constituent));
        for constituent in &constituents {
            check_supported(constituent)?;
        }
        let mut emitters: Vec<_> = scene.medium.constituents.iter().filter(|c| c.emits()).collect();
        emitters.sort_by_key(|emitter| profile_rank(&emitter.profile));
        let clouds: Vec<_> = scene.clouds.iter().filter(|layer| !layer.is_empty()).collect();
        if let Some(layer) = clouds.iter().find(|layer| matches!(layer.phase, PhaseFunction::Tabulated(_))) {
            let what = format!("layer of clouds '{}' has a tabulated phase function", layer.name);
            return Err(PlanError::Unsupported { what });
        }
        let mut volumes: Vec<_> = scene.volumes.iter().filter(|volume| !volume.is_empty()).collect();
        volumes.sort_by(|a, b| {
            let is_local = |volume: &Volume| volume.altitudes_m().is_none();
            is_local(a).cmp(&is_local(b)).then_with(|| a.name.cmp(&b.name))
        });
        let tabulated = |volume: &&&Volume| volume.scatters() && matches!(volume.phase, PhaseFunction::Tabulated(_));
        if let Some(volume) = volumes.iter().find(tabulated) {
            let what = format!("'{}' has a tabulated phase function", volume.name);
            return Err(PlanError::Unsupported { what });
        }
        let camera = &scene.camera;
        let sorted = sort_lights(&shining_lights(scene)?, scene, &settings.skipping);
        let groups = ConstituentGroups::of(&constituents);
        let scatterers = &constituents[..groups.scatterer_count as usize];
        let settings = thick::settings(settings, &constituents, scene.planet.atmosphere_height_m);
        let (treatment, treatment_reason) = Treatment::choose(&settings, scatterers, scene.planet.atmosphere_height_m);
        let facts = Self {
            scene,
            thin: thin::reason(scene, scatterers, &sorted.lit, &settings.skipping),
            settings,
            orders,
            outputs,
            part: None,
            groups,
            profile_groups: profile_groups(scatterers),
            treatment,
            treatment_reason,
            constituents,
            emitters,
            clouds,
            seen_volumes: seen_volumes(
                camera,
                camera.altitude_m.max(0.0),
                &volumes,
                settings.skipping.out_of_view_share,
            ),
            volumes,
            local_lights: local_lights(scene),
            lights: sorted.lit,
            faint_discs: sorted.faint_discs,
            left_out: sorted.left_out,
            viewpoint: match camera.altitude_m {
                h if h <= scene.planet.atmosphere_height_m => Viewpoint::InAir,
                _ => Viewpoint::InSpace,
            },
            surface: None,
            froxels: None,
            sequence: None,
            for_screen: false,
            out_of_view: OutOfView::default(),
        };
        Ok(facts.with_surface(scene.terrain.as_ref().map(|_| Surface::Terrain)))
    }

    /// With something that stands before the camera.
    pub fn with_surface(self, surface: Option<Surface>) -> Self {
        Self { surface, ..self }
    }

    /// With froxels for a host.
    pub fn with_froxels(self, froxels: Option<FroxelGrid>) -> Self {
        Self { froxels, ..self }
    }

    /// As one of a sequence of frames.
    pub fn in_sequence(self, sequence: Option<Sequence>) -> Self {
        Self { sequence, ..self }
    }

    /// As a frame whose radiance stays on the device, where only its picture is looked at. Sums over groups of wavelengths,
    /// and what goes into files, need all digits.
    pub fn for_screen(self) -> Self {
        Self { for_screen: self.part.is_none() && !self.outputs.capture, ..self }
    }

    /// Whether frames of this sequence follow clouds, after the first. What the frame before has seen past the edge of a hill
    /// cannot be followed: before surfaces, and among local media, all pixels are marched.
    pub fn follows_clouds(&self) -> bool {
        let has_others = self.surface.is_some() || self.has_local_media();
        self.sequence.is_some() && self.settings.clouds.block > 1 && !has_others
    }

    /// Side of the blocks of pixels of which one is marched through the clouds; 1 where all are.
    pub fn cloud_block(&self) -> u32 {
        match self.sequence {
            Some(Sequence { before: Some(_), .. }) if self.follows_clouds() => self.settings.clouds.block,
            _ => 1,
        }
    }

    /// Whether distances of clouds are needed, by a file or by the next frame.
    pub fn keeps_cloud_distance(&self) -> bool {
        self.outputs.capture || self.cloud_block() > 1
    }

    /// With tables no wider than a device can interpolate.
    pub fn with_tables_up_to(mut self, widest: TableFormat) -> Self {
        if widest == TableFormat::Float16 {
            self.settings.table_format = TableFormat::Float16;
        }
        self
    }

    /// How light in clouds is found: as the settings say, but for one order alone.
    pub fn cloud_scattering(&self) -> CloudScattering {
        match self.orders {
            Orders::Single => CloudScattering::Single,
            Orders::All => self.settings.clouds.scattering,
        }
    }

    /// How many groups of directions light in clouds is solved for in: none without a light from outside that it could be.
    pub fn ordinate_groups(&self) -> u32 {
        if self.lights.is_empty() { 0 } else { self.cloud_scattering().ordinate_groups() }
    }

    /// Whether there is fog, a local volume or a local light.
    pub fn has_local_media(&self) -> bool {
        !self.volumes.is_empty() || !self.local_lights.is_empty()
    }

    /// Whether clouds or local media lie over the sky.
    pub fn has_overlay(&self) -> bool {
        !self.clouds.is_empty() || self.has_local_media()
    }

    /// How many of the volumes are fog; they come first.
    pub fn fog_count(&self) -> u32 {
        self.volumes.iter().filter(|volume| volume.altitudes_m().is_some()).count() as u32
    }

    /// Whether billows of some volume are made from the clouds' noise.
    pub fn has_volume_noise(&self) -> bool {
        self.volumes.iter().any(|volume| volume.noise.is_some_and(|noise| noise.strength > 0.0))
    }

    /// Whether there is anything in the air.
    pub fn has_air(&self) -> bool {
        !self.constituents.is_empty()
    }

    /// How many emitters have a profile of this rank or one before it: exponential 0, tent 1, layer 2.
    pub fn emitters_up_to(&self, rank: u8) -> u32 {
        self.emitters.partition_point(|emitter| profile_rank(&emitter.profile) <= rank) as u32
    }

    /// Constituents that scatter.
    pub fn scatterers(&self) -> &[&'a Constituent] {
        &self.constituents[..self.groups.scatterer_count as usize]
    }

    /// Whether a directional light shines on air that scatters.
    pub fn is_lit(&self) -> bool {
        !self.scatterers().is_empty() && !self.lights.is_empty()
    }

    /// Whether some disc is a sphere lit from one side.
    pub fn has_sphere(&self) -> bool {
        self.lights.iter().chain(&self.faint_discs).any(|light| light.sphere.is_some())
    }

    /// Whether a light's disc is so wide that pixels change when light is averaged over it.
    pub fn is_wide(&self, light: &DirectionalLight) -> bool {
        is_wide(light, &self.scene.planet, self.observer_altitude_m(), &self.settings.skipping)
    }

    /// Whether the observer stands in the planet's shadow from some light.
    pub fn is_in_shadow(&self) -> bool {
        let horizon_mu = geometry::horizon_mu(self.scene.planet.radius_m, self.observer_altitude_m());
        self.lights.iter().any(|light| light.direction.elevation_rad.sin() < horizon_mu)
    }

    /// Whether the edge of the planet's shadow from some light lies within the view of an observer whom that light reaches.
    pub fn sees_edge_of_shadow(&self) -> bool {
        let horizon_mu = geometry::horizon_mu(self.scene.planet.radius_m, self.observer_altitude_m());
        self.lights.iter().any(|light| (horizon_mu..=-horizon_mu).contains(&light.direction.elevation_rad.sin()))
    }

    /// Degrees of spherical harmonics that the field keeps: one where it counts as isotropic.
    pub fn degree_count(&self) -> u32 {
        if self.treatment == Treatment::IsotropicSeries { 1 } else { self.settings.degree_count }
    }

    /// Directions in which the source function is tabulated.
    pub fn source_grid(&self) -> SourceGrid {
        self.settings.source_grid.on(&self.scene.planet)
    }

    /// Coefficients (l, m), m ≥ 0, of the field.
    pub fn coefficient_count(&self) -> u32 {
        self.degree_count() * (self.degree_count() + 1) / 2
    }

    /// How many density profiles scatterers have.
    pub fn profile_group_count(&self) -> u32 {
        self.profile_groups.iter().max().map_or(0, |last| last + 1)
    }

    /// Whether light of the second and later orders, and the ground's, belongs in the picture.
    pub fn has_multiple_scattering(&self) -> bool {
        self.orders == Orders::All && self.is_lit() && self.thin_air().is_none()
    }

    /// Why light scattered more than once does not show, if it does not. Other matter than air may be lit by nothing else.
    pub fn thin_air(&self) -> Option<&str> {
        self.thin.as_deref().filter(|_| self.surface.is_none() && !self.has_overlay())
    }

    /// Lights that the shaders loop over; a dark scene keeps one slot.
    pub fn light_slots(&self) -> u32 {
        self.lights.len().max(1) as u32
    }

    /// Layers of the sky-view table.
    pub fn sky_view_layers(&self) -> u32 {
        2 * self.light_slots() * (1 + self.groups.scatterer_count)
    }

    /// How the sky-view table sees the sphere of directions.
    pub fn sky_view_mapping(&self) -> SkyViewMapping {
        SkyViewMapping::new(&self.scene.planet, self.observer_altitude_m(), self.settings.sky_view_size[1])
    }

    /// Where the air is seen from, m: a camera below the ground sees what one sees from the ground, and one inside a
    /// mountain what one sees standing on it.
    pub fn observer_altitude_m(&self) -> f64 {
        let altitude_m = self.scene.camera.altitude_m.max(0.0);
        match &self.scene.terrain {
            Some(terrain) if self.surface == Some(Surface::Terrain) => terrain.eye_altitude_m(altitude_m),
            _ => altitude_m,
        }
    }
}
