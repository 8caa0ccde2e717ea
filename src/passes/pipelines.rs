//! Pipelines that are compiled, and for how long they are kept.

use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use welkin_shaders::{Definitions, ShaderError};

use super::ShaderSources;

/// Pipelines that are kept. A picture takes some ten in clear air and some thirty with everything in it; every quality, a few
/// sizes of the window and a few scenes are compiled once. Fewer would have drivers compile the same again and again, and what
/// their compilers leave between what is in use costs more memory than the pipelines.
pub const MOST_KEPT: usize = 256;

/// The pipelines of all passes, each by the definitions that make a difference to it. When a recording begins and there are
/// more than [`MOST_KEPT`], those that were used longest ago are let go, but never one that the recording before has used.
/// `P` is a pipeline.
pub struct Pipelines<P = crate::gpu::Pipeline> {
    kept: HashMap<(&'static str, Definitions), Kept<P>>,
    /// For each pass, whether its text mentions a definition.
    mentioned: HashMap<&'static str, BTreeMap<String, bool>>,
    recording: u64,
    /// How many have been compiled so far.
    pub compiled: u64,
}

struct Kept<P> {
    pipeline: P,
    /// All definitions of the frame that had it compiled: other shaders may mention others of them.
    asked: Definitions,
    /// The last recording that asked for it; 0 where none has yet.
    used: u64,
}

impl<P> Default for Pipelines<P> {
    fn default() -> Self {
        Self { kept: HashMap::new(), mentioned: HashMap::new(), recording: 0, compiled: 0 }
    }
}

impl<P: Clone> Pipelines<P> {
    /// Begins a recording, and lets go what has not been used for long.
    pub fn begin_recording(&mut self) {
        let before = self.recording;
        self.recording += 1;
        let Some(surplus) = self.kept.len().checked_sub(MOST_KEPT).filter(|surplus| *surplus > 0) else { return };
        let mut uses: Vec<u64> = self.kept.values().map(|kept| kept.used).collect();
        uses.sort_unstable();
        // Those of one recording go together: they would be needed together.
        let last_gone = uses[surplus - 1];
        self.kept.retain(|_, kept| kept.used > last_gone || kept.used == before);
    }

    /// The pipeline of a pass with a frame's definitions, compiled with those that make a difference to it unless it is kept.
    ///
    /// # Errors
    /// Those of `compile`, and of [`ShaderSources::relevant`].
    pub fn get<E: From<ShaderError>>(
        &mut self,
        shaders: &ShaderSources,
        pass: &'static str,
        definitions: &Definitions,
        compile: impl FnOnce(&Definitions) -> Result<P, E>,
    ) -> Result<P, E> {
        let key = (pass, self.relevant(shaders, pass, definitions)?);
        if let Some(kept) = self.kept.get_mut(&key) {
            kept.used = self.recording;
            return Ok(kept.pipeline.clone());
        }
        let pipeline = compile(&key.1)?;
        self.compiled += 1;
        let (asked, used) = (definitions.clone(), self.recording);
        self.kept.insert(key, Kept { pipeline: pipeline.clone(), asked, used });
        Ok(pipeline)
    }

    /// Compiles those of some pipelines that are not kept, as many at once as there are cores. What does not compile is left to
    /// [`Pipelines::get`], which says why.
    pub fn compile_ahead<E>(
        &mut self,
        shaders: &ShaderSources,
        expected: &[(&'static str, Definitions)],
        compile: impl Fn(&'static str, &Definitions) -> Result<P, E> + Sync,
    ) where
        P: Send,
    {
        let mut missing: Vec<((&'static str, Definitions), &Definitions)> = Vec::new();
        for (pass, asked) in expected {
            let Ok(relevant) = self.relevant(shaders, pass, asked) else { continue };
            let key = (*pass, relevant);
            if !self.kept.contains_key(&key) && missing.iter().all(|(other, _)| *other != key) {
                missing.push((key, asked));
            }
        }
        let threads = thread::available_parallelism().map_or(1, usize::from).min(missing.len());
        if threads < 2 {
            return;
        }
        let start = Instant::now();
        let next = AtomicUsize::new(0);
        let work = || {
            let mut done = Vec::new();
            while let Some(((pass, relevant), asked)) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                if let Ok(pipeline) = compile(pass, relevant) {
                    done.push(((*pass, relevant.clone()), Kept { pipeline, asked: (*asked).clone(), used: 0 }));
                }
            }
            done
        };
        let compiled: Vec<_> = thread::scope(|scope| {
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            let joined = |worker: thread::ScopedJoinHandle<'_, _>| {
                worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            workers.into_iter().flat_map(joined).collect()
        });
        let (count, milliseconds) = (compiled.len(), 1e3 * start.elapsed().as_secs_f64());
        tracing::debug!("{count} pipelines compiled by {threads} threads in {milliseconds:.0} ms");
        self.compiled += compiled.len() as u64;
        self.kept.extend(compiled);
    }

    /// How many of the kept ones were compiled ahead and never asked for.
    pub fn idle(&self) -> usize {
        self.kept.values().filter(|kept| kept.used == 0).count()
    }

    /// The same pipelines from other shaders.
    ///
    /// # Errors
    /// As [`Pipelines::get`].
    pub fn compiled_anew<E: From<ShaderError>>(
        &self,
        shaders: &ShaderSources,
        compile: impl Fn(&str, &Definitions) -> Result<P, E>,
    ) -> Result<Self, E> {
        let mut anew = Self::default();
        let mut oldest_first: Vec<_> = self.kept.iter().collect();
        oldest_first.sort_by_key(|(_, kept)| kept.used);
        for (&(pass, _), kept) in oldest_first {
            anew.recording = kept.used;
            anew.get(shaders, pass, &kept.asked, |definitions| compile(pass, definitions))?;
        }
        anew.recording = self.recording;
        anew.compiled += self.compiled;
        Ok(anew)
    }

    /// Those definitions that make a difference to a pass: most are nothing to most passes.
    fn relevant(
        &mut self,
        shaders: &ShaderSources,
        pass: &'static str,
        definitions: &Definitions,
    ) -> Result<Definitions, ShaderError> {
        let mentioned = self.mentioned.entry(pass).or_default();
        if !definitions.keys().all(|name| mentioned.contains_key(name)) {
            let relevant = shaders.relevant(pass, definitions)?;
            mentioned.extend(definitions.keys().map(|name| (name.clone(), relevant.contains_key(name))));
        }
        let relevant = definitions.iter().filter(|(name, _)| mentioned.get(*name) == Some(&true));
        Ok(relevant.map(|(name, definition)| (name.clone(), *definition)).collect())
    }
}

#[cfg(test)]
mod tests {
    use welkin_shaders::Definition;

    use super::*;

    /// Asks for one pipeline, which is a number, and says whether it was compiled.
    fn asks(pipelines: &mut Pipelines<u32>, name: &str, number: u32) -> bool {
        let definitions = Definitions::from([(name.to_owned(), Definition::U32(number))]);
        let mut compiled = false;
        let compile = |_: &Definitions| -> Result<u32, ShaderError> {
            compiled = true;
            Ok(number)
        };
        let shaders = ShaderSources::embedded();
        pipelines.get(&shaders, "compose", &definitions, compile).unwrap();
        compiled
    }

    fn numbered(number: u32) -> (&'static str, Definitions) {
        ("compose", Definitions::from([("LIGHT_COUNT".to_owned(), Definition::U32(number))]))
    }

    #[test]
    fn what_is_compiled_ahead_is_compiled_once_and_not_again() {
        let mut pipelines = Pipelines::default();
        pipelines.begin_recording();
        assert!(asks(&mut pipelines, "LIGHT_COUNT", 3));
        let times = AtomicUsize::new(0);
        let compile = |_: &str, definitions: &Definitions| -> Result<u32, ShaderError> {
            times.fetch_add(1, Ordering::Relaxed);
            let Some(Definition::U32(number)) = definitions.get("LIGHT_COUNT") else { panic!("it is relevant") };
            Ok(*number)
        };
        // One is kept already, and one is expected twice.
        let expected: Vec<_> = (0..20).chain([7]).map(numbered).collect();
        pipelines.compile_ahead(&ShaderSources::embedded(), &expected, compile);
        // With one core nothing is.
        let ahead = if thread::available_parallelism().map_or(1, usize::from) > 1 { 19 } else { 0 };
        assert_eq!((times.into_inner(), pipelines.compiled, pipelines.idle()), (ahead, 1 + ahead as u64, ahead));
        for number in 0..20 {
            assert_eq!(asks(&mut pipelines, "LIGHT_COUNT", number), ahead == 0 && number != 3, "{number}");
        }
        assert_eq!(pipelines.idle(), 0);
    }

    #[test]
    fn what_does_not_compile_ahead_is_left_to_who_asks_for_it() {
        let mut pipelines = Pipelines::<u32>::default();
        pipelines.begin_recording();
        let error = || ShaderError::NoEntryPoint { file: "compose.wgsl".to_owned() };
        let expected: Vec<_> = (0..4).map(numbered).collect();
        pipelines.compile_ahead(&ShaderSources::embedded(), &expected, |_, _| Err(error()));
        assert_eq!((pipelines.compiled, pipelines.idle()), (0, 0));
        let (pass, definitions) = &expected[0];
        let asked = pipelines.get(&ShaderSources::embedded(), pass, definitions, |_| Err::<u32, _>(error()));
        assert_eq!(asked.unwrap_err().to_string(), error().to_string());
    }

    #[test]
    fn what_was_used_longest_ago_is_let_go_and_nothing_that_is_in_use() {
        let mut pipelines = Pipelines::default();
        let most = MOST_KEPT as u32;
        for number in 0..3 * most {
            pipelines.begin_recording();
            assert!(asks(&mut pipelines, "LIGHT_COUNT", number), "{number} was never compiled before");
            assert!(!asks(&mut pipelines, "LIGHT_COUNT", 0), "0 is in every recording");
            assert!(pipelines.kept.len() <= MOST_KEPT + 2);
        }
        pipelines.begin_recording();
        assert_eq!(pipelines.kept.len(), MOST_KEPT);
        assert!(!asks(&mut pipelines, "LIGHT_COUNT", 3 * most - 1) && asks(&mut pipelines, "LIGHT_COUNT", 1));
    }

    #[test]
    fn one_recording_may_use_more_than_are_kept() {
        let mut pipelines = Pipelines::default();
        for recording in 0..3 {
            pipelines.begin_recording();
            for number in 0..2 * MOST_KEPT as u32 {
                assert_eq!(asks(&mut pipelines, "LIGHT_COUNT", number), recording == 0);
            }
        }
    }

    #[test]
    fn a_definition_that_no_text_mentions_compiles_nothing_anew() {
        let mut pipelines = Pipelines::default();
        assert!(asks(&mut pipelines, "NOBODY_MENTIONS_IT", 1));
        assert!(!asks(&mut pipelines, "NOBODY_MENTIONS_IT", 2));
        // Control.
        assert!(asks(&mut pipelines, "LIGHT_COUNT", 1) && asks(&mut pipelines, "LIGHT_COUNT", 2));
    }
}
