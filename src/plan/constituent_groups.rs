//! Constituents in the order in which the shaders loop over them: what scatters first, and within that by profile.

use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

use super::PlanError;

/// Where each group of constituents ends in the sorted list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ConstituentGroups {
    /// Exponential profiles that scatter.
    pub scattering_exponential_end: u32,
    /// Then tents that scatter.
    pub scattering_tent_end: u32,
    /// Then layers that scatter: all that scatter end here.
    pub scatterer_count: u32,
    /// Exponential profiles that only absorb.
    pub absorbing_exponential_end: u32,
    /// Then tents that only absorb.
    pub absorbing_tent_end: u32,
    /// Then layers that only absorb: all end here.
    pub count: u32,
}

impl ConstituentGroups {
    /// The groups of constituents that are sorted by [`group_of`].
    pub(super) fn of(sorted: &[&Constituent]) -> Self {
        let end_of = |group: (bool, u8)| sorted.partition_point(|constituent| group_of(constituent) <= group) as u32;
        Self {
            scattering_exponential_end: end_of((false, 0)),
            scattering_tent_end: end_of((false, 1)),
            scatterer_count: end_of((false, 2)),
            absorbing_exponential_end: end_of((true, 0)),
            absorbing_tent_end: end_of((true, 1)),
            count: end_of((true, 2)),
        }
    }

    /// Whether some constituent's density is a layer.
    pub fn has_layers(&self) -> bool {
        self.scatterer_count > self.scattering_tent_end || self.count > self.absorbing_tent_end
    }
}

/// Whether it does something to light that passes.
pub(super) fn weakens_light(constituent: &Constituent) -> bool {
    constituent.extinction_per_m().iter().any(|&c| c > 0.0)
}

/// The shaders' order of profiles.
pub(super) fn profile_rank(profile: &DensityProfile) -> u8 {
    match profile {
        DensityProfile::Exponential { .. } => 0,
        DensityProfile::Tent { .. } => 1,
        DensityProfile::Layer { .. } => 2,
    }
}

/// Sort key: scattering before absorbing, then by profile.
pub(super) fn group_of(constituent: &Constituent) -> (bool, u8) {
    (!constituent.scatters(), profile_rank(&constituent.profile))
}

/// The number of each constituent's profile, counted in the order in which new ones appear.
pub(super) fn profile_groups(scatterers: &[&Constituent]) -> Vec<u32> {
    let mut profiles: Vec<DensityProfile> = Vec::new();
    let mut number_of = |profile: &DensityProfile| {
        let known = profiles.iter().position(|other| other == profile);
        known.unwrap_or_else(|| {
            profiles.push(*profile);
            profiles.len() - 1
        }) as u32
    };
    scatterers.iter().map(|constituent| number_of(&constituent.profile)).collect()
}

/// Refuses what the shaders cannot evaluate.
pub(super) fn check_supported(constituent: &Constituent) -> Result<(), PlanError> {
    let unsupported =
        |what: &str| Err(PlanError::Unsupported { what: format!("constituent '{}' {what}", constituent.name) });
    if constituent.scatters() && matches!(constituent.phase, PhaseFunction::Tabulated(_)) {
        return unsupported("has a tabulated phase function");
    }
    Ok(())
}
