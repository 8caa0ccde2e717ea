//! Files that somebody edits while the window is open: the scene's and the shaders'.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

/// Time between two looks at the files.
const BETWEEN: Duration = Duration::from_millis(250);

/// What has changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// The scene's file.
    Scene,
    /// A shader in the folder.
    Shaders,
}

/// The thread that looks, which ends when this is dropped.
pub struct Watch {
    scene: Arc<Mutex<PathBuf>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Watch {
    /// Looks at a scene's file and, where there is one, a folder of shaders; `tell` is called on the thread.
    pub fn start(scene: &Path, shaders: Option<PathBuf>, tell: impl Fn(Changed) + Send + 'static) -> Self {
        let (scene, stop) = (Arc::new(Mutex::new(scene.to_owned())), Arc::new(AtomicBool::new(false)));
        let (watched, stopped) = (scene.clone(), stop.clone());
        let thread = std::thread::Builder::new().name("watch".to_owned()).spawn(move || {
            let (mut scene_path, mut scene_seen) = (PathBuf::new(), Seen::default());
            let mut shaders_seen = Seen::default();
            while !stopped.load(Ordering::Relaxed) {
                let path = watched.lock().unwrap_or_else(PoisonError::into_inner).clone();
                if path != scene_path {
                    (scene_path, scene_seen) = (path.clone(), Seen::default());
                }
                if scene_seen.has_changed(state(std::slice::from_ref(&path))) {
                    tell(Changed::Scene);
                }
                if let Some(folder) = &shaders
                    && shaders_seen.has_changed(state(&sources(folder)))
                {
                    tell(Changed::Shaders);
                }
                std::thread::park_timeout(BETWEEN);
            }
        });
        Self { scene, stop, thread: thread.ok() }
    }

    /// Looks at another scene's file from now on.
    pub fn follow(&self, scene: &Path) {
        *self.scene.lock().unwrap_or_else(PoisonError::into_inner) = scene.to_owned();
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            let _ = thread.join();
        }
    }
}

/// Names, sizes and times of files.
type State = Vec<(PathBuf, Option<(u64, SystemTime)>)>;

/// What was there at the last look, and what was told.
#[derive(Default)]
struct Seen {
    last: Option<State>,
    told: Option<State>,
}

impl Seen {
    /// Whether files differ from what was told, and have come to rest: a file that is being written is left alone until the
    /// next look. What is there at first is not a change.
    fn has_changed(&mut self, state: State) -> bool {
        let at_rest = self.last.as_ref() == Some(&state);
        self.last = Some(state.clone());
        match &self.told {
            None => {
                self.told = Some(state);
                false
            }
            Some(told) if *told != state && at_rest => {
                self.told = Some(state);
                true
            }
            Some(_) => false,
        }
    }
}

fn state(paths: &[PathBuf]) -> State {
    let of = |path: &PathBuf| {
        let metadata = std::fs::metadata(path).ok()?;
        Some((metadata.len(), metadata.modified().ok()?))
    };
    paths.iter().map(|path| (path.clone(), of(path))).collect()
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut paths: Vec<_> = entries.filter(|path| path.extension().is_some_and(|ending| ending == "wgsl")).collect();
    paths.sort();
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_told_once_when_it_has_come_to_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, "a").unwrap();
        let look = || state(std::slice::from_ref(&path));
        let mut seen = Seen::default();
        assert!(!seen.has_changed(look()) && !seen.has_changed(look()), "what is there is no change");
        std::fs::write(&path, "ab").unwrap();
        assert_eq!([look(), look(), look()].map(|state| seen.has_changed(state)), [false, true, false]);
        std::fs::remove_file(&path).unwrap();
        assert_eq!([look(), look()].map(|state| seen.has_changed(state)), [false, true]);
    }
}
