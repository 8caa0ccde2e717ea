//! Matter that depends on altitude alone: a planet's air, or a layer over a plane.

use welkin_lut::{Bands, Constituent, DensityProfile};

use super::column::{Columns, Weighted};
use super::line::Line;
use super::matter::{Local, Matter};
use super::shape::Shape;
use super::spectrum;

/// Largest optical depth, seen vertically, by which a shell's majorant may exceed its matter.
const SHELL_EXCESS: f64 = 0.01;
/// Tentative collisions of a walk that crosses all emitting matter once, at least: those are where it finds emission, and matter
/// that glows may hardly weaken light, or not at all.
pub const EMITTING_DEPTH: f64 = 1.0;
/// Shells are halved until the least that their matter emits is this share of the most, or they are this share of the air's height.
const GLOW_LEAST: f64 = 0.5;
const GLOW_THINNEST: f64 = 1e-3;

/// Constituents over one shape, with what is needed to walk through them and to integrate along rays.
#[derive(Debug, Clone)]
pub struct Air {
    matter: Vec<Matter>,
    profiles: Vec<DensityProfile>,
    columns: Columns,
    /// Shells from the ground up: (lower altitude m, majorant 1/m).
    shells: Vec<(f64, f64)>,
    height_m: f64,
    emits: bool,
}

/// A place at which a walk may collide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tentative {
    /// Distance along the line, m.
    pub t_m: f64,
    /// Rate of tentative collisions there, 1/m.
    pub majorant_per_m: f64,
}

impl Air {
    /// The constituents between the ground and the top of `shape`.
    pub fn new(shape: &Shape, constituents: &[Constituent]) -> Self {
        let matter: Vec<Matter> = constituents.iter().map(Matter::from).collect();
        let profiles: Vec<DensityProfile> = constituents.iter().map(|c| c.profile).collect();
        let weighted: Vec<Weighted> = profiles
            .iter()
            .zip(&matter)
            .map(|(&profile, m)| Weighted { profile, coefficient_per_m: spectrum::largest(m.extinction_per_m) })
            .collect();
        let height_m = match *shape {
            Shape::Sphere { height_m, .. } | Shape::Plane { height_m } => height_m,
            Shape::Box { min_m, max_m } => max_m.z - min_m.z,
        };
        let columns = Columns::new(shape.radius_m(), height_m, &weighted);
        let emits = constituents.iter().any(Constituent::emits);
        let mut air = Self { matter, profiles, columns, shells: Vec::new(), height_m, emits };
        air.shells = air.cut_shells();
        air.raise_where_it_emits();
        air
    }

    /// Whether it holds nothing at all.
    pub fn is_empty(&self) -> bool {
        self.matter.is_empty()
    }

    /// Whether any constituent emits.
    pub fn emits(&self) -> bool {
        self.emits
    }

    /// The constituents, in the order of the densities.
    pub fn matter(&self) -> &[Matter] {
        &self.matter
    }

    /// Altitudes at which a profile has a kink, and others at which quadrature does well to split, m.
    pub fn cuts_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.cuts_m()
    }

    /// Lower altitudes of the shells of constant majorant, m, ascending.
    pub fn shell_bounds_m(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        self.shells.iter().map(|shell| shell.0)
    }

    /// The matter at an altitude; `density` receives the densities.
    pub fn local<'a>(&'a self, altitude_m: f64, density: &'a mut Vec<f64>) -> Local<'a> {
        density.clear();
        density.extend(self.profiles.iter().map(|profile| profile.density(altitude_m)));
        Local { matter: &self.matter, density }
    }

    /// Optical depth between two distances along a line, by [`Columns`].
    pub fn optical_depth(&self, line: &Line, from_m: f64, to_m: f64) -> Bands {
        let mut buffer = [0.0; 16];
        let mut heap = Vec::new();
        let columns = if self.profiles.len() <= buffer.len() {
            &mut buffer[..self.profiles.len()]
        } else {
            heap.resize(self.profiles.len(), 0.0);
            &mut heap
        };
        self.columns.add(line, from_m, to_m, columns);
        Local { matter: &self.matter, density: columns }.extinction()
    }

    /// The next tentative collision between two distances: a Poisson process whose rate is constant in each shell
    /// and nowhere below the extinction of any band.
    pub fn tentative(&self, line: &Line, from_m: f64, to_m: f64, unit_exponential: f64) -> Option<Tentative> {
        let mut remaining = unit_exponential;
        let mut t = from_m;
        let mut falling = t < line.lowest();
        let mut shell = self.shell_at(line.altitude(t));
        loop {
            let (low, majorant) = self.shells[shell];
            let fall = if falling { line.fall(low) } else { None };
            let leaves = match fall {
                Some(distance) => distance,
                None => {
                    falling = false;
                    line.rise(self.shells.get(shell + 1).map_or(self.height_m, |s| s.0)).unwrap_or(t)
                }
            };
            let depth = (leaves.min(to_m) - t).max(0.0) * majorant;
            if depth > remaining {
                return Some(Tentative { t_m: t + remaining / majorant, majorant_per_m: majorant });
            }
            remaining -= depth;
            t = leaves.max(t);
            let next = if falling { shell.checked_sub(1) } else { Some(shell + 1) };
            match next {
                Some(next) if next < self.shells.len() && t < to_m => shell = next,
                _ => return None,
            }
        }
    }

    fn shell_at(&self, altitude_m: f64) -> usize {
        self.shells.partition_point(|s| s.0 <= altitude_m).saturating_sub(1)
    }

    /// Halves shells until the majorant is close to the matter, and to what it emits.
    fn cut_shells(&self) -> Vec<(f64, f64)> {
        let cuts: Vec<f64> = self.cuts_m().collect();
        let mut pending: Vec<(f64, f64)> = cuts.windows(2).map(|ends| (ends[0], ends[1])).rev().collect();
        let mut shells = Vec::new();
        while let Some((low, high)) = pending.pop() {
            let bounds = |of: fn(&Matter) -> Bands| {
                [DensityProfile::majorant, DensityProfile::minorant].map(|density| self.bound(density, (low, high), of))
            };
            let [most, least] = bounds(|matter| matter.extinction_per_m);
            let [brightest, darkest] = bounds(|matter| matter.emission_per_m);
            let close = (most - least) * (high - low) <= SHELL_EXCESS || least >= 0.9 * most;
            let close_to_glow = darkest >= GLOW_LEAST * brightest || high - low < GLOW_THINNEST * self.height_m;
            if (close && close_to_glow) || high - low < 1e-6 * self.height_m {
                shells.push((low, most));
            } else {
                let middle = 0.5 * (low + high);
                pending.push((middle, high));
                pending.push((low, middle));
            }
        }
        shells
    }

    /// Sums over the matter, the largest of the bands: of a bound of the density between two altitudes, times a coefficient.
    fn bound(
        &self,
        of: fn(&DensityProfile, f64, f64) -> f64,
        (low, high): (f64, f64),
        coefficient: fn(&Matter) -> Bands,
    ) -> f64 {
        let mut total = spectrum::ZERO;
        for (matter, profile) in self.matter.iter().zip(&self.profiles) {
            spectrum::accumulate(&mut total, of(profile, low, high), coefficient(matter));
        }
        spectrum::largest(total)
    }

    /// Raises majorants where matter emits, in proportion to what it emits.
    fn raise_where_it_emits(&mut self) {
        let ends = self.shells.iter().skip(1).map(|shell| shell.0).chain([self.height_m]);
        let brightest = |(&(low, _), high): (&(f64, f64), f64)| {
            (high - low, self.bound(DensityProfile::majorant, (low, high), |matter| matter.emission_per_m))
        };
        let shells: Vec<(f64, f64)> = self.shells.iter().zip(ends).map(brightest).collect();
        let emitted: f64 = shells.iter().map(|(thickness_m, brightest)| thickness_m * brightest).sum();
        for (shell, (_, brightest)) in self.shells.iter_mut().zip(shells) {
            if brightest > 0.0 {
                shell.1 = shell.1.max(EMITTING_DEPTH * brightest / emitted);
            }
        }
    }
}
