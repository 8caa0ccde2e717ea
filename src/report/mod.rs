//! How far pictures are from the truth, and what that costs in time.

mod candidate;
mod deviation;
mod error;
mod front;
mod ledger;
mod markdown;
mod metrics;
mod overall;
mod page;
mod pictures;
mod plot;
mod random_scene;
mod results;
mod sample_grid;
mod slab;
mod study;
mod table;
mod truth;

pub use candidate::{Breadth, Candidate, candidates, treatment};
pub use deviation::{Deviation, Uncertain};
pub use error::ReportError;
pub use front::{beats_clearly, front};
pub use markdown::markdown;
pub use metrics::{Comparison, MetricsError, RelativeErrors, compare};
pub use overall::{Overall, overall};
pub use page::page;
pub use pictures::{file_name, save_picture};
pub use plot::{plot, slab_plot};
pub use random_scene::{random_scene, random_scene_text};
pub use results::{Family, LeftOut, Point, Provenance, SceneResults, Spread, Study, results_schema};
pub use sample_grid::SampleGrid;
pub use slab::{SlabPoint, SlabResults, slab_results};
pub use study::{Case, Measure, Measured, Request, Shown, Watcher, study};
pub use table::{passes_csv, points_csv};
pub use truth::{Truth, truth};
