//! What walks bring home: radiance by order of scattering.

use welkin_lut::Bands;

use super::spectrum;

/// Orders that are counted one by one; the last bin holds all higher ones.
pub const ORDER_BINS: usize = 16;

/// Radiance by order, W·m⁻²·sr⁻¹·nm⁻¹. Every scattering and every reflection by the ground is one order; order 0 is
/// unscattered light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    /// By order, the last bin for all orders from there on.
    pub orders: [Bands; ORDER_BINS],
    /// Light scattered exactly once in the medium: order 1 without the ground.
    pub single: Bands,
}

impl Default for Tally {
    fn default() -> Self {
        Self { orders: [spectrum::ZERO; ORDER_BINS], single: spectrum::ZERO }
    }
}

impl Tally {
    /// Adds light of an order; `ground` tells whether the ground had a part in it.
    pub fn add(&mut self, order: usize, ground: bool, value: Bands) {
        spectrum::accumulate(&mut self.orders[order.min(ORDER_BINS - 1)], 1.0, value);
        if order == 1 && !ground {
            spectrum::accumulate(&mut self.single, 1.0, value);
        }
    }

    /// Adds another tally times a factor.
    pub fn add_scaled(&mut self, other: &Self, factor: f64) {
        for (mine, theirs) in self.orders.iter_mut().zip(&other.orders) {
            spectrum::accumulate(mine, factor, *theirs);
        }
        spectrum::accumulate(&mut self.single, factor, other.single);
    }

    /// All orders together.
    pub fn total(&self) -> Bands {
        std::array::from_fn(|j| self.orders.iter().map(|order| order[j]).sum())
    }
}
