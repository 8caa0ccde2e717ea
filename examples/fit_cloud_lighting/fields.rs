//! Voxel clouds made of hashed noise: what the lighting is fitted on, and what the fit is tested on.

use glam::{DVec3, UVec3};

/// Voxels along x, y, z.
pub const SIZE: [usize; 3] = [64, 64, 32];
/// Side of a voxel, m.
pub const VOXEL_M: f64 = 40.0;

/// The shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// One fair-weather cumulus, optical depth about 30.
    Cumulus,
    /// Several small cumuli.
    Broken,
    /// A layer with a bumpy top.
    Stratocumulus,
    /// A tower, optical depth about 100.
    Tower,
    /// Blobs stacked at random. Not fitted.
    Congestus,
    /// A thin veil in streaks, optical depth below 1. Not fitted.
    Cirrus,
    /// A homogeneous sphere of optical diameter 32. Not fitted.
    Sphere,
}

/// A cloud: extinction at the centres of voxels, x first, in a box whose lowest corner is the origin.
#[derive(Debug, Clone)]
pub struct Cloud {
    /// Its shape.
    pub kind: Kind,
    /// Seed of its noise.
    pub seed: u32,
    /// Extinction of each voxel, 1/m.
    pub extinction_per_m: Vec<f64>,
}

/// The box's highest corner, m.
pub fn extent_m() -> DVec3 {
    UVec3::from_array(SIZE.map(|n| n as u32)).as_dvec3() * VOXEL_M
}

impl Cloud {
    /// The cloud of a shape and seed.
    pub fn new(kind: Kind, seed: u32) -> Self {
        let mut extinction_per_m = Vec::with_capacity(SIZE.iter().product());
        for k in 0..SIZE[2] {
            for j in 0..SIZE[1] {
                for i in 0..SIZE[0] {
                    let p = (DVec3::new(i as f64, j as f64, k as f64) + 0.5) * VOXEL_M;
                    // Clear air at the faces, so that the box is seen nowhere.
                    let at_face = [(i, 0), (j, 1), (k, 2)].iter().any(|&(n, axis)| n == 0 || n + 1 == SIZE[axis]);
                    extinction_per_m.push(if at_face { 0.0 } else { extinction(kind, seed, p) });
                }
            }
        }
        Self { kind, seed, extinction_per_m }
    }

    /// A name for tables and files.
    pub fn name(&self) -> String {
        format!("{:?}-{}", self.kind, self.seed).to_lowercase()
    }
}

fn extinction(kind: Kind, seed: u32, p: DVec3) -> f64 {
    let centre = 0.5 * extent_m();
    // From -1 to 1, nearly; details down to two voxels.
    let noise = fractal(seed, p / 500.0, 3);
    let flat = |length_m: f64| fractal(seed ^ 0x51ed, DVec3::new(p.x, p.y, 0.0) / length_m, 2);
    let density = match kind {
        Kind::Cumulus => {
            let d = (p - DVec3::new(centre.x, centre.y, 400.0))
                / DVec3::new(800.0, 650.0, if p.z > 400.0 { 700.0 } else { 320.0 });
            0.06 * smooth((1.0 - d.length() + 0.5 * noise) / 0.25)
                * smooth((p.z - 140.0) / 60.0)
                * (0.6 + 0.4 * (p.z / 900.0).min(1.0))
        }
        Kind::Broken => {
            let cover = 1.6 * flat(650.0);
            let top = 300.0 + 700.0 * (cover - 0.1).clamp(0.0, 1.0);
            0.05 * smooth((cover - 0.1 + 0.6 * noise) / 0.4)
                * smooth((p.z - 200.0) / 60.0)
                * smooth((top + 150.0 - p.z) / 150.0)
        }
        Kind::Stratocumulus => {
            let top = 720.0 + 200.0 * flat(600.0) + 120.0 * noise;
            0.05 * smooth((top - p.z) / 60.0)
                * smooth((p.z - 300.0 + 60.0 * noise) / 60.0)
                * ((p.z - 150.0) / 600.0).clamp(0.1, 1.0)
        }
        Kind::Tower => {
            let radius = if p.z < 400.0 {
                500.0
            } else {
                420.0 + 160.0 * (std::f64::consts::PI * (p.z - 200.0) / 1100.0).sin().powi(2)
            };
            let across = DVec3::new(p.x - centre.x - 0.12 * (p.z - 600.0), p.y - centre.y, 0.0).length() / radius;
            0.1 * smooth((1.0 - across + 0.45 * noise) / 0.2)
                * smooth((p.z - 80.0) / 60.0)
                * smooth((1180.0 + 80.0 * noise - p.z) / 90.0)
        }
        Kind::Congestus => {
            let mut inside = -1.0_f64;
            for n in 0..9 {
                let random = |salt| 0.5 + 0.5 * corner(seed ^ 0xb10b, n, salt, 0);
                let radius = 180.0 + 240.0 * random(1);
                let at = DVec3::new(700.0 + 1150.0 * random(2), 700.0 + 1150.0 * random(3), 200.0 + 750.0 * random(4));
                inside = inside.max(1.0 - (p - at).length() / radius);
            }
            0.08 * smooth((inside + 0.35 * noise) / 0.2) * smooth((p.z - 120.0) / 60.0)
        }
        Kind::Cirrus => {
            let streak = fractal(seed ^ 0xc1, DVec3::new(p.x / 1800.0, p.y / 250.0, p.z / 300.0), 3);
            0.002 * smooth((streak + 0.3) / 0.8) * smooth((p.z - 600.0) / 100.0) * smooth((1100.0 - p.z) / 100.0)
        }
        Kind::Sphere => {
            if (p - centre).length() < 480.0 {
                32.0 / 960.0
            } else {
                0.0
            }
        }
    };
    if density < 2e-4 * f64::from(kind != Kind::Cirrus) { 0.0 } else { density }
}

fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Octaves of value noise, each half as strong and half as wide as the one before.
fn fractal(seed: u32, p: DVec3, octaves: u32) -> f64 {
    (0..octaves).map(|o| value_noise(seed.wrapping_add(o), p * f64::from(1 << o)) * 0.5_f64.powi(o as i32)).sum()
}

/// Random values at whole numbers, in [-1, 1], joined smoothly.
fn value_noise(seed: u32, p: DVec3) -> f64 {
    let low = p.floor();
    let share = (p - low).to_array().map(smooth);
    let [x, y, z] = low.to_array().map(|v| v as i32);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let along_x = |y, z| mix(corner(seed, x, y, z), corner(seed, x + 1, y, z), share[0]);
    let along_y = |z| mix(along_x(y, z), along_x(y + 1, z), share[1]);
    mix(along_y(z), along_y(z + 1), share[2])
}

/// A hash of whole numbers, in [-1, 1] (the finaliser of MurmurHash3 over a sum of products with primes).
fn corner(seed: u32, x: i32, y: i32, z: i32) -> f64 {
    let mut h = seed
        .wrapping_mul(0x9e37_79b1)
        .wrapping_add((x as u32).wrapping_mul(0x85eb_ca77))
        .wrapping_add((y as u32).wrapping_mul(0xc2b2_ae3d))
        .wrapping_add((z as u32).wrapping_mul(0x27d4_eb2f));
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    2.0 * f64::from(h ^ (h >> 16)) / f64::from(u32::MAX) - 1.0
}
