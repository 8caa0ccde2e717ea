//! What becomes of random scene files.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fs;
use std::panic::AssertUnwindSafe;
use std::path::{Path, PathBuf};

use proptest::test_runner::{Config, TestCaseError, TestError, TestRng, TestRunner};
use welkin::frame::Frame;
use welkin::passes::RenderError;
use welkin::plan::{CloudSettings, Directions, Outputs, Quality, Settings, SourceGrid, VolumeSettings};
use welkin::renderer::Renderer;
use welkin::scene::{Scene, SceneError};

use super::scene_file;
use crate::laws;

/// What became of a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// It is no scene, and the message says where and why.
    Refused,
    /// It is a scene that the renderer cannot do, and says so.
    Unsupported,
    /// It was planned.
    Planned,
    /// It was rendered, and all numbers are what they must be.
    Rendered,
}

/// How often each.
pub type Fates = BTreeMap<Fate, usize>;

/// Everything that a picture has.
const CAPTURE: Outputs = Outputs { capture: true, picture: true };

/// Tables so small that a frame costs next to nothing; all passes are the same.
fn tiny() -> Settings {
    let low = Settings::of(Quality::Low);
    Settings {
        nodes_per_leg: 4,
        optical_depth_size: [16, 8],
        multiple_scattering_size: [6, 4],
        directions: Directions { below: 2, band: 2, above: 2, azimuths: 2 },
        source_grid: SourceGrid { ground: 2, low: 2, high: 2, azimuths: 2 },
        source_size: [4, 4],
        source_orders: 3,
        sky_view_size: [8, 8],
        froxel_size: [4, 4, 4],
        clouds: CloudSettings {
            sweeps: 3,
            ordinate_cells: 8,
            max_steps: 64,
            grid_size: 8,
            grid_slices: 4,
            ..low.clouds
        },
        volumes: VolumeSettings { max_steps: 64, cells: 6, beam_samples: 4, ..low.volumes },
        ..low
    }
}

/// Reads and plans a scene file.
fn read(text: &str) -> Result<(Fate, Option<Scene>), String> {
    let parsed = std::panic::catch_unwind(|| Scene::parse(text, Path::new("random.toml")));
    let scene = match parsed.map_err(|_| "the reader panics".to_owned())? {
        Ok(scene) => scene,
        Err(SceneError::Invalid(invalid)) if invalid.problem.is_empty() => {
            return Err(format!("no reason: {invalid:?}"));
        }
        // Where a table is missing altogether, the message names it and there is no field to point at.
        Err(SceneError::Invalid(invalid)) if invalid.field.is_none() && !invalid.problem.contains('`') => {
            return Err(format!("no field: {invalid:?}"));
        }
        Err(SceneError::Invalid(_)) => return Ok((Fate::Refused, None)),
        Err(SceneError::Read { .. }) => return Err("nothing was to be read".to_owned()),
    };
    let plan = std::panic::catch_unwind(|| Renderer::plan(&scene, tiny(), CAPTURE));
    match plan.map_err(|_| "the plan panics".to_owned())? {
        Ok(_) => Ok((Fate::Planned, Some(scene))),
        Err(error) if error.to_string().is_empty() => Err("no reason".to_owned()),
        Err(_) => Ok((Fate::Unsupported, None)),
    }
}

/// Reads, plans and, if asked to, renders a scene file.
///
/// # Errors
/// What is not as it must be, in words.
pub fn fate(renderer: &mut Renderer, text: &str, is_rendered: bool) -> Result<Fate, String> {
    let (fate, scene) = read(text)?;
    let Some(scene) = scene.filter(|_| is_rendered) else { return Ok(fate) };
    let frame = match rendered(renderer, &scene)? {
        Ok(frame) => frame,
        // Beyond the device: it says so.
        Err(RenderError::Gpu(_) | RenderError::Plan(_)) => return Ok(Fate::Unsupported),
        Err(error) => return Err(error.to_string()),
    };
    if let Some(broken) = laws::broken(&scene, &frame).first() {
        return Err(broken.to_string());
    }
    renderer.forget();
    let anew = rendered(renderer, &scene)?.map_err(|error| error.to_string())?;
    match laws::differs(&scene, &frame, &anew) {
        Some(broken) => Err(broken.to_string()),
        None => Ok(Fate::Rendered),
    }
}

fn rendered(renderer: &mut Renderer, scene: &Scene) -> Result<Result<Frame, RenderError>, String> {
    let rendered = std::panic::catch_unwind(AssertUnwindSafe(|| renderer.render(scene, tiny(), CAPTURE)));
    Ok(rendered.map_err(|_| "the renderer panics".to_owned())?.map(|rendered| rendered.frame))
}

/// Where scenes are kept that failed.
pub fn regressions() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/regressions")
}

/// Keeps a scene that failed, with why in its first line; says where, and why in full.
pub fn keep(table: &toml::Table, words: &str) -> String {
    let text = table.to_string();
    let path = regressions().join(format!("{:08x}.toml", crc32fast::hash(text.as_bytes())));
    let first_line = words.lines().next().unwrap_or_default();
    let kept = fs::write(&path, format!("# {first_line}\n{text}"));
    format!("{} ({kept:?}): {words}\n{text}", path.display())
}

/// Tries so many random scene files and renders one in `one_in` of those that can be planned.
///
/// # Errors
/// The first that fails, shrunk: why, its text, and the file that it is kept in.
pub fn try_scenes(renderer: Renderer, count: u32, one_in: usize, random: TestRng) -> Result<Fates, String> {
    let renderer = RefCell::new(renderer);
    let (fates, planned, failing) = (RefCell::new(Fates::new()), Cell::new(0), Cell::new(false));
    let config = Config { cases: count, failure_persistence: None, max_shrink_iters: 400, ..Config::default() };
    let result = TestRunner::new_with_rng(config, random).run(&scene_file(), |table| {
        // While it shrinks, everything is rendered.
        let is_rendered = failing.get() || planned.get() % one_in == 0;
        match fate(&mut renderer.borrow_mut(), &table.to_string(), is_rendered) {
            Ok(fate) => {
                planned.set(planned.get() + usize::from(fate > Fate::Unsupported));
                *fates.borrow_mut().entry(fate).or_default() += 1;
                Ok(())
            }
            Err(words) => {
                failing.set(true);
                Err(TestCaseError::fail(words))
            }
        }
    });
    match result {
        Ok(()) => Ok(fates.into_inner()),
        Err(TestError::Abort(reason)) => Err(reason.to_string()),
        Err(TestError::Fail(reason, table)) => {
            Err(format!("{} after {:?}", keep(&table, reason.message()), fates.borrow()))
        }
    }
}
