//! Rendering by the path tracer.

use std::time::Instant;

use welkin::output::display;
use welkin::plan::Outputs;
use welkin::reference::Solver;
use welkin::reference::picture::{CameraView, Film, Outcome, Sampling, Shard, expose};
use welkin::scene::Scene;

use super::{Arguments, Rendered};
use crate::cli::Failure;
use crate::cli::watch::Watch;

/// The seed of pictures that nobody asks another seed for.
const SEED: u64 = 0;

pub fn render(arguments: &Arguments, scene: &Scene, outputs: Outputs) -> Result<Rendered, Failure> {
    let sampling = Sampling::new(arguments.samples, None);
    let view = CameraView::new(scene, Solver::Path, SEED, sampling.walks_per_batch)?;
    let mut film = Film::with_room(Shard::WHOLE, view.pixels())?;
    let watch = Watch::new(&film, &sampling, Solver::Path.samples_name(), None)?;
    let started = Instant::now();
    if expose(&&view, &mut film, &sampling.stop(), &watch)? == Outcome::Interrupted {
        return Err(Failure::Interrupted(None));
    }
    watch.finish();
    let (seconds, error) = (started.elapsed().as_secs_f64(), film.relative_error());
    let walks = sampling.most_walks();
    let frame = view.develop(&film);
    let shown = || display::picture(&frame, display::exposed_srgb(scene), scene.display.tone_map);
    let picture = outputs.picture.then(shown);
    let name = &scene.name;
    Ok(Rendered {
        frame,
        picture,
        text: format!("{name} by the path tracer: {walks} walks a pixel in {seconds:.1} s, relative error {error:.2e}"),
        json: format!(
            "{:#}",
            serde_json::json!({
                "scene": name,
                "backend": "reference",
                "solver": Solver::Path.name(),
                "walks_per_pixel": walks,
                "seconds": seconds,
                "relative_error": error,
            })
        ),
    })
}
