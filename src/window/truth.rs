//! The truth of a view, traced in the background.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::DVec3;
use welkin_lut::Bands;

use crate::frame::Frame;
use crate::output::{OutputError, display};
use crate::reference::picture::{CameraView, Film, Observer, Shard, Stop, expose};
use crate::reference::{Solver, SolverError};
use crate::scene::Scene;

/// Walks of a pixel after which nobody sees a difference any more.
const MOST_WALKS: u64 = 4096;

/// Time between two pictures of an exposure.
const BETWEEN: Duration = Duration::from_millis(1500);

/// Linear light of agreement.
const GREY: f64 = 0.216;

/// Relative difference that is shown in full colour.
const FULL_COLOUR: f64 = 0.1;

/// How far an exposure has come, as linear sRGB that a screen shows.
pub struct Exposed {
    /// The truth.
    pub truth: Vec<Bands>,
    /// How much brighter (red) or darker (blue) the real-time frame is; none before that frame is there.
    pub difference: Option<Vec<Bands>>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// In words.
    pub state: String,
}

/// An exposure, which ends when this is dropped.
pub struct Truth {
    stop: Arc<AtomicBool>,
    real_time: Arc<Mutex<Option<Frame>>>,
    thread: Option<JoinHandle<()>>,
}

impl Truth {
    /// Starts to trace what a scene's camera sees, for a screen that shows so many whites; `tell` is called on other threads, with [`SolverError`] for a scene that
    /// the path tracer cannot trace.
    pub fn start(
        scene: Scene,
        headroom: f64,
        tell: impl Fn(Result<Exposed, SolverError>) + Send + Sync + 'static,
    ) -> Self {
        let (stop, real_time) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(None)));
        let (stopped, compared) = (stop.clone(), real_time.clone());
        let thread = std::thread::Builder::new().name("truth".to_owned()).spawn(move || {
            // Preparing a scene takes its time, too.
            let view = match CameraView::new(&scene, Solver::Path, 0, 1) {
                Ok(view) => view,
                Err(error) => return tell(Err(error)),
            };
            let watch =
                Watch { scene, headroom, stop: stopped, real_time: compared, tell, shown: Mutex::new(None), view };
            // One core is left to the window and the sky.
            let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
            let pool = rayon::ThreadPoolBuilder::new().num_threads(cores.saturating_sub(1).max(1)).build();
            let mut film = Film::new(Shard::WHOLE, watch.view.pixels());
            let enough = Stop { most_batches: MOST_WALKS, relative_error: None };
            if let Ok(pool) = pool {
                // Nothing that the watch does can fail.
                let _ = pool.install(|| expose(&&watch.view, &mut film, &enough, &watch));
            }
        });
        Self { stop, real_time, thread: thread.ok() }
    }

    /// What the renderer makes of the same view, which the truth is compared with. Shared with whoever brings it.
    pub fn real_time(&self) -> Arc<Mutex<Option<Frame>>> {
        self.real_time.clone()
    }
}

impl Drop for Truth {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // It ends with the walk at hand; nobody waits for it.
        drop(self.thread.take());
    }
}

struct Watch<T> {
    scene: Scene,
    headroom: f64,
    view: CameraView,
    stop: Arc<AtomicBool>,
    real_time: Arc<Mutex<Option<Frame>>>,
    tell: T,
    shown: Mutex<Option<Instant>>,
}

impl<T: Fn(Result<Exposed, SolverError>) + Send + Sync> Observer for Watch<T> {
    fn advanced(&self, _: u64) {}

    fn paused(&self, film: &Film, level: bool) -> Result<(), OutputError> {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let due = shown.is_none_or(|at| at.elapsed() > BETWEEN);
        let done = level && film.goal >= MOST_WALKS;
        if film.goal == 0 || !(due || done) || self.stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let frame = self.view.develop(film);
        let exposed = display::exposed_srgb(&self.scene);
        let curve = self.scene.display.tone_map;
        let shown_as = |radiance: &[f32; 3]| {
            let linear = exposed * DVec3::from_array(radiance.map(f64::from));
            display::tone_map_up_to(self.headroom, curve, linear.to_array())
        };
        let real_time = self.real_time.lock().unwrap_or_else(PoisonError::into_inner);
        let walks = film.pixels.iter().map(|pixel| pixel.batches).min().unwrap_or(0);
        let state = match level {
            true => format!("truth: {walks} walks a pixel, relative error {:.1} %", 100.0 * film.relative_error()),
            false => format!("truth: {walks} walks a pixel so far"),
        };
        tracing::info!("{state}");
        (self.tell)(Ok(Exposed {
            truth: frame.radiance.iter().map(shown_as).collect(),
            difference: real_time.as_ref().map(|real_time| difference(real_time, &frame)),
            size: [frame.width, frame.height],
            state,
        }));
        *shown = Some(Instant::now());
        Ok(())
    }

    fn interrupted(&self) -> &AtomicBool {
        &self.stop
    }
}

/// By how much a frame differs from the truth, relative to the truth's mean over the bands: grey where they agree, full red
/// where it is 10 % or more too bright, full blue where it is as much too dark; black where nothing is traced yet.
fn difference(frame: &Frame, truth: &Frame) -> Vec<Bands> {
    let mean = |radiance: &[f32; 3]| radiance.iter().map(|&band| f64::from(band)).sum::<f64>() / 3.0;
    let pixel = |(frame, truth): (&[f32; 3], &[f32; 3])| {
        let (frame, truth) = (mean(frame), mean(truth));
        if truth <= 0.0 {
            return [0.0; 3];
        }
        let share = ((frame / truth - 1.0) / FULL_COLOUR).clamp(-1.0, 1.0);
        let towards = |full: f64| GREY + share.abs() * (full - GREY);
        let (warm, cold) = (towards(1.0), towards(0.01));
        if share >= 0.0 { [warm, cold, cold] } else { [cold, cold, warm] }
    };
    frame.radiance.iter().zip(&truth.radiance).map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agreement_is_grey_and_too_much_light_is_red() {
        let mut frame = Frame::new(4, 1);
        let mut truth = Frame::new(4, 1);
        frame.radiance = vec![[1.0; 3], [1.2; 3], [0.8; 3], [1.0; 3]];
        truth.radiance = vec![[1.0; 3], [1.0; 3], [1.0; 3], [0.0; 3]];
        let shown = difference(&frame, &truth);
        let expected = [[GREY; 3], [1.0, 0.01, 0.01], [0.01, 0.01, 1.0], [0.0; 3]];
        let off = shown.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{shown:?}");
        frame.radiance[0] = [1.05; 3];
        let [red, green, ..] = difference(&frame, &truth)[0];
        assert!(red > 0.6 && green < 0.12, "half of the way: {red}, {green}");
    }
}
