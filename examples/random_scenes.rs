//! Random scene files, read, planned and rendered with small tables until one breaks a law or all are done. The long form of
//! `tests/random_scenes.rs`.
//!
//! `cargo run --release --example random_scenes -- COUNT [ONE_IN]`: one in `ONE_IN` of those that can be planned is rendered,
//! by default all.

#[path = "../tests/hard_cases/laws.rs"]
#[allow(dead_code)]
mod laws;
#[path = "../tests/scene_strategy/mod.rs"]
mod scene_strategy;

use proptest::test_runner::{Config, TestRng};
use scene_strategy::trial::try_scenes;
use welkin::gpu::DeviceRequest;
use welkin::renderer::Renderer;

fn main() {
    let mut words =
        std::env::args().skip(1).map(|word| word.parse::<u32>().unwrap_or_else(|error| panic!("{word}: {error}")));
    let (count, one_in) = (words.next().expect("how many scenes"), words.next().unwrap_or(1));
    let renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let random = TestRng::from_seed(Config::default().rng_algorithm, &std::process::id().to_le_bytes().repeat(8));
    match try_scenes(renderer, count, one_in as usize, random) {
        Ok(fates) => println!("{fates:?}"),
        Err(failure) => {
            eprintln!("{failure}");
            std::process::exit(1);
        }
    }
}
