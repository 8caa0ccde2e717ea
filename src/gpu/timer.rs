//! How long each dispatch took.

use std::sync::Arc;
use std::time::Instant;

use ash::vk;
use cpu_time::ProcessTime;

use super::census::{Counted, Kind};
use super::context::Context;
use super::device::DeviceInfo;
use super::error::{During, GpuError};

/// Dispatches that one query pool serves.
const POOL_DISPATCHES: usize = 64;

/// What times are taken with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// The device's own timestamps before and after each dispatch.
    Timestamps,
    /// The host's clock around a submission of each dispatch alone, waiting included.
    Host,
    /// What the process's threads have worked during a submission of each dispatch alone: with a driver that computes on
    /// the CPU the price of a dispatch, however busy others keep the machine.
    Processor,
}

impl Clock {
    /// Timestamps where the device's queue has them, else the host's clock.
    pub fn of(device: &DeviceInfo) -> Self {
        let has_timestamps = device.limits.timestamp_bits > 0 && device.limits.timestamp_period_ns > 0.0;
        if has_timestamps { Self::Timestamps } else { Self::Host }
    }
}

/// Time that a dispatch took.
#[derive(Debug, Clone, PartialEq)]
pub struct DispatchTime {
    /// The dispatch's label.
    pub label: String,
    /// Time on the device, or of all the processor's cores, ms.
    pub milliseconds: f64,
}

/// Takes the times of a recording's dispatches.
pub(crate) enum Timer {
    Off,
    Timestamps(Timestamps),
    Alone(Alone),
}

/// Takes the times of dispatches that are run one by one.
pub(crate) struct Alone {
    clock: Clock,
    started: Option<Stopwatch>,
    times: Vec<DispatchTime>,
}

enum Stopwatch {
    Wall(Instant),
    Processor(ProcessTime),
}

impl Alone {
    pub(crate) fn begin(&mut self) {
        self.started = Some(match self.clock {
            Clock::Processor => Stopwatch::Processor(ProcessTime::now()),
            _ => Stopwatch::Wall(Instant::now()),
        });
    }

    pub(crate) fn end(&mut self, label: &str) {
        let took = match self.started.take() {
            Some(Stopwatch::Wall(started)) => started.elapsed(),
            Some(Stopwatch::Processor(started)) => started.elapsed(),
            None => return,
        };
        self.times.push(DispatchTime { label: label.to_owned(), milliseconds: took.as_secs_f64() * 1e3 });
    }
}

impl Timer {
    pub(crate) fn new(context: &Arc<Context>, clock: Clock) -> Self {
        match clock {
            Clock::Timestamps => Self::Timestamps(Timestamps::new(context)),
            Clock::Host | Clock::Processor => Self::Alone(Alone { clock, started: None, times: Vec::new() }),
        }
    }

    /// The times of all dispatches, in order. The device must have done them.
    pub(crate) fn times(&self) -> Result<Vec<DispatchTime>, GpuError> {
        match self {
            Self::Off => Ok(Vec::new()),
            Self::Timestamps(timestamps) => timestamps.times(),
            Self::Alone(alone) => Ok(alone.times.clone()),
        }
    }
}

/// Pairs of timestamps.
pub(crate) struct Timestamps {
    context: Arc<Context>,
    pools: Vec<vk::QueryPool>,
    counted: Vec<Counted>,
    labels: Vec<String>,
}

impl Timestamps {
    fn new(context: &Arc<Context>) -> Self {
        Self { context: context.clone(), pools: Vec::new(), counted: Vec::new(), labels: Vec::new() }
    }

    /// Before a dispatch: when all commands before it are done.
    pub(crate) fn begin(&mut self, commands: vk::CommandBuffer, label: &str) -> Result<(), GpuError> {
        if self.labels.len() == self.pools.len() * POOL_DISPATCHES {
            let queries = 2 * POOL_DISPATCHES as u32;
            let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(queries);
            // SAFETY: the queue has timestamps, or there would be no timer of this kind.
            unsafe {
                let pool = self.context.device.create_query_pool(&info, None).during("vkCreateQueryPool")?;
                self.pools.push(pool);
                self.counted.push(self.context.census.count(Kind::QueryPool));
                self.context.device.cmd_reset_query_pool(commands, pool, 0, queries);
            }
        }
        self.labels.push(label.to_owned());
        self.stamp(commands, 0);
        Ok(())
    }

    /// After a dispatch: when it is done.
    pub(crate) fn end(&mut self, commands: vk::CommandBuffer) {
        self.stamp(commands, 1);
    }

    fn stamp(&self, commands: vk::CommandBuffer, which: u32) {
        let dispatch = self.labels.len() - 1;
        let pool = self.pools[dispatch / POOL_DISPATCHES];
        let query = 2 * (dispatch % POOL_DISPATCHES) as u32 + which;
        // SAFETY: the query has been reset in this command buffer and is written once.
        unsafe {
            let stage = vk::PipelineStageFlags2::COMPUTE_SHADER;
            self.context.device.cmd_write_timestamp2(commands, stage, pool, query);
        }
    }

    fn times(&self) -> Result<Vec<DispatchTime>, GpuError> {
        let limits = &self.context.info.limits;
        let mask = u64::MAX >> (64 - limits.timestamp_bits.clamp(1, 64));
        let mut times = Vec::with_capacity(self.labels.len());
        for (labels, &pool) in self.labels.chunks(POOL_DISPATCHES).zip(&self.pools) {
            let mut ticks = vec![0_u64; 2 * labels.len()];
            let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            // SAFETY: these queries were written by commands that are done.
            unsafe { self.context.device.get_query_pool_results(pool, 0, &mut ticks, flags) }
                .during("vkGetQueryPoolResults")?;
            times.extend(labels.iter().zip(ticks.chunks_exact(2)).map(|(label, pair)| {
                let elapsed = pair[1].wrapping_sub(pair[0]) & mask;
                let milliseconds = elapsed as f64 * f64::from(limits.timestamp_period_ns) * 1e-6;
                DispatchTime { label: label.clone(), milliseconds }
            }));
        }
        Ok(times)
    }
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        for &pool in &self.pools {
            // SAFETY: the recording that owns this has ended.
            unsafe { self.context.device.destroy_query_pool(pool, None) };
        }
    }
}
