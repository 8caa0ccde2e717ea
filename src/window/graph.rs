//! Times of past frames.

use std::collections::VecDeque;

/// Frames that are remembered.
const MOST: usize = 240;

/// Milliseconds of past pictures of the sky and of the panel.
#[derive(Debug, Default)]
pub struct Graph {
    sky_ms: VecDeque<f32>,
    panel_ms: VecDeque<f32>,
}

impl Graph {
    /// A picture of the sky was done.
    pub fn add_sky(&mut self, milliseconds: f64) {
        add(&mut self.sky_ms, milliseconds);
    }

    /// A frame of the window was drawn, from its layout until it was handed to the display.
    pub fn add_panel(&mut self, milliseconds: f64) {
        add(&mut self.panel_ms, milliseconds);
    }

    /// The sky's times, oldest first.
    pub fn sky_ms(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.sky_ms.iter().copied()
    }

    /// The panel's times, oldest first.
    pub fn panel_ms(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.panel_ms.iter().copied()
    }

    /// Median and largest of times.
    pub fn summary(times: impl Iterator<Item = f32>) -> Option<(f32, f32)> {
        let mut sorted: Vec<_> = times.collect();
        sorted.sort_by(f32::total_cmp);
        Some((*sorted.get(sorted.len() / 2)?, *sorted.last()?))
    }
}

fn add(times: &mut VecDeque<f32>, milliseconds: f64) {
    times.push_back(milliseconds as f32);
    if times.len() > MOST {
        times.pop_front();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_frames_are_forgotten() {
        let mut graph = Graph::default();
        (0..MOST + 10).for_each(|frame| graph.add_sky(frame as f64));
        assert_eq!((graph.sky_ms().len(), graph.sky_ms().next()), (MOST, Some(10.0)));
        assert_eq!(Graph::summary([3.0, 1.0, 2.0].into_iter()), Some((2.0, 3.0)));
        assert_eq!(Graph::summary(graph.panel_ms()), None);
    }
}
