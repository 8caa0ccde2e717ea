//! What a run belongs to, so that parts and checkpoints of different pictures are never mixed.

use std::fmt;

use super::film::Shard;
use super::sampling::Sampling;
use crate::reference::solver::Solver;
use crate::scene::Scene;

/// Everything that decides about the bits of a picture.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Identity {
    /// Name of the scene, for messages.
    pub scene: String,
    /// Fingerprint of the scene's planet, medium, clouds, lights, camera and spectrum.
    pub fingerprint: Fingerprint,
    /// Version of the program, because a new one may walk differently.
    pub version: String,
    /// The solver and its settings.
    pub solver: String,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Walks in a batch.
    pub walks_per_batch: u64,
    /// Walks asked for, at most, for each pixel.
    pub most_walks: u64,
    /// Relative error asked for.
    pub max_error: Option<f64>,
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Which part, from 1.
    pub shard: u32,
    /// Of how many.
    pub shards: u32,
}

/// 64 bits that two different texts share with a chance of 5e-20.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// FNV-1a (Fowler, Noll & Vo 1991).
    pub fn of(text: &str) -> Self {
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        Self(text.bytes().fold(0xcbf2_9ce4_8422_2325, step))
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Identity {
    /// Of one part of a scene's picture.
    pub fn new(scene: &Scene, solver: &Solver, seed: u64, sampling: &Sampling, shard: Shard) -> Self {
        // Debug prints every number so that it reads back as the same bits. Name and display do not touch radiance.
        let Scene { planet, medium, clouds, time_s, lights, terrain, camera, spectrum, .. } = scene;
        let problem = format!("{:?}", (planet, medium, clouds, time_s, lights, terrain, camera, spectrum));
        Self {
            scene: scene.name.clone(),
            fingerprint: Fingerprint::of(&problem),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            solver: solver.to_string(),
            seed,
            walks_per_batch: sampling.walks_per_batch,
            most_walks: sampling.most_walks(),
            max_error: sampling.stop().relative_error,
            width: scene.camera.width,
            height: scene.camera.height,
            shard: shard.index + 1,
            shards: shard.count,
        }
    }

    /// The first thing in which another part was asked for other than this one; `None` for parts of one picture.
    pub fn difference_of_parts(&self, other: &Self) -> Option<String> {
        self.difference(other).or_else(|| {
            let asked = |identity: &Self| {
                let error = identity.max_error.map(|error| format!(" or relative error {error}")).unwrap_or_default();
                format!("{} walks a pixel{error}", identity.most_walks)
            };
            (asked(self) != asked(other)).then(|| format!("{}, not {}", asked(other), asked(self)))
        })
    }

    /// The first thing in which a checkpoint's picture differs from this one, whatever the part; `None` where walks
    /// of the one are walks of the other.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let scene = |identity: &Self| format!("scene '{}' ({})", identity.scene, identity.fingerprint);
        let size = |identity: &Self| format!("{}x{} pixels", identity.width, identity.height);
        let texts: [&dyn Fn(&Self) -> String; 6] = [
            &size,
            &|identity| format!("solver {}", identity.solver),
            &|identity| format!("seed {}", identity.seed),
            &|identity| format!("welkin {}", identity.version),
            &|identity| format!("{} walks in a batch", identity.walks_per_batch),
            &|identity| format!("{} parts", identity.shards),
        ];
        if self.fingerprint != other.fingerprint {
            return Some(format!("{}, not {}", scene(other), scene(self)));
        }
        let differs = texts.iter().find(|text| text(self) != text(other))?;
        Some(format!("{}, not {}", differs(other), differs(self)))
    }
}
