//! How many objects are alive on a device, for those who look for what is never given back.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The kinds of objects that are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Image,
    Buffer,
    Pipeline,
    DescriptorPool,
    CommandList,
    QueryPool,
}

const KINDS: usize = 6;

/// Objects that are alive on a device, and its memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Population {
    /// Images, without those of a window.
    pub images: u64,
    /// Buffers, those of parameters and copies included.
    pub buffers: u64,
    /// Pipelines.
    pub pipelines: u64,
    /// Pools of descriptors, one for each dispatch that is recorded or running.
    pub descriptor_pools: u64,
    /// Command buffers, each with a pool and a fence.
    pub command_lists: u64,
    /// Pools of timestamps.
    pub query_pools: u64,
    /// Bytes of images and buffers.
    pub used_bytes: u64,
    /// Bytes that are taken from the device for them: blocks, some of them partly free.
    pub reserved_bytes: u64,
}

/// Counts what is alive.
#[derive(Default)]
pub(crate) struct Census(Arc<[AtomicU64; KINDS]>);

impl Census {
    /// Counts one more of a kind for as long as what is returned lives.
    pub(crate) fn count(&self, kind: Kind) -> Counted {
        self.0[kind as usize].fetch_add(1, Ordering::Relaxed);
        Counted { counts: self.0.clone(), kind }
    }

    pub(crate) fn population(&self, [used_bytes, reserved_bytes]: [u64; 2]) -> Population {
        let alive = |kind: Kind| self.0[kind as usize].load(Ordering::Relaxed);
        Population {
            images: alive(Kind::Image),
            buffers: alive(Kind::Buffer),
            pipelines: alive(Kind::Pipeline),
            descriptor_pools: alive(Kind::DescriptorPool),
            command_lists: alive(Kind::CommandList),
            query_pools: alive(Kind::QueryPool),
            used_bytes,
            reserved_bytes,
        }
    }
}

/// One object of a kind; part of it.
pub(crate) struct Counted {
    counts: Arc<[AtomicU64; KINDS]>,
    kind: Kind,
}

impl Drop for Counted {
    fn drop(&mut self) {
        self.counts[self.kind as usize].fetch_sub(1, Ordering::Relaxed);
    }
}
