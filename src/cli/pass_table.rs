//! What became of each pass, as a table for people and as JSON for programs.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;
use welkin::gpu::{Clock, DeviceInfo};
use welkin::plan::Decision;
use welkin::renderer::{Price, Timings};

use super::goal::{Chosen, ChosenFor};

/// One run of a plan.
#[derive(Debug, Serialize)]
pub struct Statistics {
    scene: String,
    /// A quality, or the step of the ladder that a goal has led to.
    quality: String,
    /// Where an error or a time was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    goal: Option<ChosenFor>,
    /// Name of the device; absent when nothing ran.
    device: Option<String>,
    /// Its driver with version.
    driver: Option<String>,
    /// What times were taken with: "timestamps" of the device, the "host" clock or the "processor" time around each dispatch.
    clock: Option<&'static str>,
    passes: Vec<PassStatistics>,
}

#[derive(Debug, Serialize)]
struct PassStatistics {
    name: &'static str,
    decision: Decision,
    reason: String,
    /// Time on the device; null when nothing was measured, 0 when nothing ran.
    milliseconds: Option<f64>,
    bytes: u64,
    /// Of a skipped pass, where somebody has asked: what it would cost if it ran.
    #[serde(skip_serializing_if = "Option::is_none")]
    would_cost: Option<WouldCost>,
}

#[derive(Debug, Serialize)]
struct WouldCost {
    /// What calls for the pass.
    with: String,
    /// Time on the device; null when nothing was measured.
    milliseconds: Option<f64>,
    bytes: u64,
}

impl Statistics {
    /// What a plan's execution took, on a device or on none.
    pub fn new(scene: &str, chosen: Chosen, device: Option<&DeviceInfo>, timings: &Timings) -> Self {
        let passes = timings.plan.passes.iter().map(|pass| PassStatistics {
            name: pass.name,
            decision: pass.decision,
            reason: pass.reason.clone(),
            milliseconds: device.map(|_| timings.milliseconds.get(pass.name).copied().unwrap_or(0.0)),
            bytes: pass.bytes,
            would_cost: None,
        });
        Self {
            scene: scene.to_owned(),
            quality: chosen.name,
            goal: chosen.goal,
            device: device.map(|info| info.name.clone()),
            driver: device.map(|info| format!("{} {}", info.driver, info.driver_version)),
            clock: timings.clock.map(|clock| match clock {
                Clock::Timestamps => "timestamps",
                Clock::Host => "host",
                Clock::Processor => "processor",
            }),
            passes: passes.collect(),
        }
    }

    /// With what skipped passes would cost.
    pub fn with_prices(mut self, prices: &BTreeMap<&'static str, Price>) -> Self {
        for pass in &mut self.passes {
            pass.would_cost = prices.get(pass.name).map(|price| WouldCost {
                with: price.with.clone(),
                milliseconds: price.milliseconds,
                bytes: price.bytes,
            });
        }
        self
    }

    /// JSON over several lines.
    pub fn to_json(&self) -> String {
        // Strings and numbers always have a JSON form.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A table with one line for each pass.
    pub fn to_text(&self) -> String {
        let device = self.device.as_deref().unwrap_or("no device");
        let mut text = format!("{} at quality {} on {device}\n", self.scene, self.quality);
        let _ = writeln!(text, "{:<20} {:<6} {:>10} {:>12}  reason", "pass", "", "ms", "bytes");
        for pass in &self.passes {
            let decision = match pass.decision {
                Decision::Run => "run",
                Decision::Reuse => "reuse",
                Decision::Skip => "skip",
            };
            let milliseconds = match pass.milliseconds {
                Some(time) if pass.decision == Decision::Run => format!("{time:.2}"),
                _ => "-".to_owned(),
            };
            let would_cost = pass.would_cost.as_ref().map(WouldCost::to_text).unwrap_or_default();
            let _ = writeln!(
                text,
                "{:<20} {decision:<6} {milliseconds:>10} {:>12}  {}{would_cost}",
                pass.name, pass.bytes, pass.reason
            );
        }
        let total: f64 = self.passes.iter().filter_map(|pass| pass.milliseconds).sum();
        let bytes: u64 = self.passes.iter().map(|pass| pass.bytes).sum();
        let _ = write!(text, "{:<20} {:<6} {total:>10.2} {bytes:>12}", "all", "");
        text
    }
}

impl WouldCost {
    fn to_text(&self) -> String {
        let milliseconds = self.milliseconds.map(|time| format!("{time:.2} ms, ")).unwrap_or_default();
        format!("; with {}: {milliseconds}{} bytes", self.with, self.bytes)
    }
}
