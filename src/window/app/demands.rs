//! What the window demands of other threads: pictures, settings for a goal, and the truth.

use std::sync::Arc;
use std::time::Instant;

use super::{Event, Open};
use crate::gpu::ScreenEncoding;
use crate::plan::{Outputs, Settings};
use crate::scene::Scene;
use crate::window::aim::Chooser;
use crate::window::comparison::Comparison;
use crate::window::sky::View;

/// What is measured of the device: a picture to look at.
const MEASURED: Outputs = Outputs { capture: false, picture: true };

/// Everything that a view depends on.
#[derive(PartialEq)]
pub(super) struct Asked {
    scene: Arc<Scene>,
    settings: Settings,
    size: [u32; 2],
    scale: f64,
    encoding: ScreenEncoding,
}

impl Open {
    /// Chooses settings for what is aimed at, once nothing moves.
    pub(super) fn choose(&mut self, now: Instant) {
        let (size, session) = (self.window.inner_size().into(), &mut self.session);
        let Some(goal) = session.goal().filter(|_| session.resolution.is_at_rest(now)) else { return };
        let before = session.chosen().cloned();
        let scene = session.document.scene();
        let measured = session.chooser.choose(goal, scene, size);
        if let Some(load) = measured {
            let scene = session.scene_of_size(size, 1.0);
            for step in Chooser::steps() {
                let (scene, proxy) = (scene.clone(), self.proxy.clone());
                self.sky.between(move |renderer| {
                    let times = renderer.step_times(&scene, step, MEASURED);
                    let times = times.map_err(|error| tracing::warn!("{step} cannot be measured: {error}")).ok();
                    drop(proxy.send_event(Event::Measured(load, step, times)));
                });
            }
        }
        if let Some(chosen) = session.chosen().filter(|chosen| before.as_ref() != Some(*chosen)) {
            tracing::info!("settings for {goal}: {}", chosen.words);
            self.window.request_redraw();
        }
    }

    /// Asks the sky for what is to be seen, unless it was asked for that already.
    pub(super) fn ask(&mut self, now: Instant) {
        let size = self.size();
        if self.hidden || size.contains(&0) {
            return;
        }
        let session = &self.session;
        let still = session.resolution.is_at_rest(now);
        let at_rest = still && session.resolution.fixed.is_none();
        let scale = if at_rest { 1.0 } else { session.resolution.scale() };
        let settings = if still { session.settings() } else { session.settings_in_motion() };
        let (scene, encoding) = (session.document.scene().clone(), session.encoding);
        // A scale that has only been found anew is no reason for another picture of the same.
        let same = self.asked.as_ref().is_some_and(|asked| {
            (&asked.scene, asked.settings, asked.size, asked.encoding) == (&scene, settings, size, encoding)
                && (asked.scale == scale || (!at_rest && session.resolution.fixed.is_none()))
        });
        if same {
            return;
        }
        let view = View { scene: session.scene_of_size(size, scale), settings, scale, encoding, may_stop: at_rest };
        self.sky.show(view);
        self.asked = Some(Asked { scene, settings, size, scale, encoding });
    }

    /// Begins to trace the view when it has come to rest, and gives up on one that is no longer seen.
    pub(super) fn compare(&mut self, now: Instant) {
        if self.session.truth.is_none() {
            return;
        }
        let (scene, size) = (self.session.document.scene(), self.window.inner_size().into());
        let settings = self.session.settings();
        let encoding = self.session.encoding;
        let seen = |comparison: &Comparison| comparison.is_of(scene, size, settings) && comparison.encoding == encoding;
        if self.comparison.as_ref().is_some_and(seen) {
            return;
        }
        self.comparison = None;
        if self.hidden || !self.session.resolution.is_at_rest(now) {
            return;
        }
        self.session.truth = Some("truth: the path tracer begins".to_owned());
        self.comparison = Some(Comparison::start(&self.session, size, &self.sky, &self.proxy));
        self.window.request_redraw();
    }
}
