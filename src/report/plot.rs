//! The error of settings over their time, as SVG whose text is text.

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

use super::front::front;
use super::results::{Family, Point, SceneResults};
use super::{ReportError, SlabPoint, SlabResults};

/// Width and height, pixels.
const SIZE: (u32, u32) = (860, 520);
const LADDER: RGBColor = RGBColor(110, 130, 160);
const VARIATION: RGBColor = RGBColor(190, 190, 190);
const REFERENCE: RGBColor = RGBColor(190, 120, 30);
const PRESET: RGBColor = RGBColor(190, 30, 60);
const FRONT: RGBColor = RGBColor(40, 90, 170);

/// Points that look alike: what they are called, their colour and radius, and whether a point is one of them.
type Kind = (&'static str, RGBColor, i32, fn(&Point) -> bool);

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// The plot of one scene. Both axes are logarithmic; an error that cannot be told from zero stands at its upper bar.
///
/// # Errors
/// [`ReportError::Plot`] where the drawing library fails.
pub fn plot(scene: &SceneResults) -> Result<String, ReportError> {
    let mut svg = String::new();
    draw(scene, &mut svg)?;
    Ok(svg)
}

/// The families of methods on all slabs: the larger error of reflectance and transmittance over time.
///
/// # Errors
/// [`ReportError::Plot`] where the drawing library fails.
pub fn slab_plot(slabs: &[SlabResults]) -> Result<String, ReportError> {
    let mut svg = String::new();
    draw_slabs(slabs, &mut svg)?;
    Ok(svg)
}

fn slab_place(point: &SlabPoint) -> (f64, f64) {
    let error = point.reflectance_error.max(point.transmittance_error);
    (point.milliseconds.median.max(1e-7), (100.0 * error).max(1e-6))
}

fn draw_slabs(slabs: &[SlabResults], svg: &mut String) -> Result<(), ReportError> {
    let places: Vec<_> = slabs.iter().flat_map(|slab| slab.points.iter().map(slab_place)).collect();
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = mesh(&root, "homogeneous slabs", "time, ms", "error, %", &places)?;
    for (slab, colour) in slabs.iter().zip([FRONT, PRESET, REFERENCE]) {
        chart
            .draw_series(slab.points.iter().map(|point| Circle::new(slab_place(point), 4, colour.filled())))?
            .label(slab.slab.split(", over").next().unwrap_or_default())
            .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        chart.draw_series(slab.points.iter().map(|point| {
            let name = point.name.replace("path tracer, ", "").replace("discrete ordinates", "ordinates");
            EmptyElement::at(slab_place(point))
                + Text::new(name, (7, -5), ("sans-serif", 11).into_font().color(&colour))
        }))?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)?;
    drop(chart);
    root.present()?;
    Ok(())
}

/// Where a point stands: ms, and error in per cent.
fn place(point: &Point) -> (f64, f64) {
    let error = if point.error.rms > 0.0 { point.error.rms } else { point.error.high };
    (point.milliseconds.median.max(1e-6), (100.0 * error).max(1e-4))
}

fn draw(scene: &SceneResults, svg: &mut String) -> Result<(), ReportError> {
    let places: Vec<_> = scene.points.iter().map(place).collect();
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let labels = ("time of a first picture, ms", "error, % (root mean square)");
    let mut chart = mesh(&root, &scene.scene, labels.0, labels.1, &places)?;
    points(&mut chart, scene)?;
    legend(&mut chart, legend_position(scene))?;
    drop(chart);
    root.present()?;
    Ok(())
}

/// Axes that hold all places.
fn mesh<'a, 'b>(
    root: &'a DrawingArea<SVGBackend<'b>, plotters::coord::Shift>,
    caption: &str,
    x: &str,
    y: &str,
    places: &[(f64, f64)],
) -> Result<Chart<'a, 'b>, ReportError> {
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = places.iter().map(of);
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        if low < high { 0.7 * low..1.6 * high } else { 0.1..100.0 }
    };
    let mut chart = ChartBuilder::on(root)
        .caption(caption, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(range(|place| place.0).log_scale(), range(|place| place.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(x)
        .y_desc(y)
        .x_label_formatter(&|value| number(*value))
        .y_label_formatter(&|value| number(*value))
        .light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .draw()?;
    Ok(chart)
}

fn legend<'a, 'b: 'a>(chart: &mut Chart<'a, 'b>, position: SeriesLabelPosition) -> Result<(), ReportError> {
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.9))
        .border_style(LADDER)
        .label_font(("sans-serif", 13))
        .draw()?;
    Ok(())
}

fn points(chart: &mut Chart, scene: &SceneResults) -> Result<(), ReportError> {
    let line = front(&scene.points).into_iter().map(place).collect::<Vec<_>>();
    chart
        .draw_series(LineSeries::new(line, FRONT.stroke_width(1)))?
        .label("nothing measured is faster and more accurate")
        .legend(|(x, y)| PathElement::new(vec![(x, y), (x + 16, y)], FRONT));
    let bars = scene.points.iter().filter(|point| point.preset.is_some() || point.family == Family::Reference);
    chart.draw_series(bars.map(|point| {
        let (x, bottom, top) = (place(point).0, 100.0 * point.error.low, 100.0 * point.error.high);
        PathElement::new(vec![(x, bottom.max(1e-4)), (x, top.max(1e-4))], LADDER.mix(0.6))
    }))?;
    let kinds: [Kind; 4] = [
        ("one group of settings varied", VARIATION, 3, |point| point.family == Family::Variation),
        ("between the presets, by both treatments", LADDER, 3, |point| {
            point.family == Family::Ladder && point.preset.is_none()
        }),
        ("solvers of the reference, on the CPU", REFERENCE, 4, |point| point.family == Family::Reference),
        ("presets", PRESET, 5, |point| point.preset.is_some()),
    ];
    for (label, colour, size, belongs) in kinds {
        let those: Vec<_> = scene.points.iter().filter(|point| belongs(point)).collect();
        if those.is_empty() {
            continue;
        }
        chart
            .draw_series(those.iter().map(|point| Circle::new(place(point), size, colour.filled())))?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 8, y), size, colour.filled()));
        let named = those.iter().filter_map(|point| Some((place(point), name_in_plot(point)?)));
        chart.draw_series(named.map(|(place, name)| {
            // Solvers are slow: their names stand on the side where there is room.
            let left = if label.starts_with("solvers") { -9 - 7 * name.len() as i32 } else { 7 };
            EmptyElement::at(place) + Text::new(name, (left, -14), ("sans-serif", 13).into_font().color(&colour))
        }))?;
    }
    Ok(())
}

/// Presets and solvers have their names beside them.
fn name_in_plot(point: &Point) -> Option<String> {
    match point.family {
        Family::Reference => {
            let name = point.name.replace("path tracer, ", "");
            Some(name.split([',', ' ']).take(2).collect::<Vec<_>>().join(" "))
        }
        _ => point.preset.clone(),
    }
}

/// The corner where no points are: solvers of the reference stand at the top right.
fn legend_position(scene: &SceneResults) -> SeriesLabelPosition {
    match scene.points.iter().any(|point| point.family == Family::Reference) {
        true => SeriesLabelPosition::LowerRight,
        false => SeriesLabelPosition::UpperRight,
    }
}

/// As few digits as tell it.
fn number(value: f64) -> String {
    if value >= 1.0 { format!("{value:.0}") } else { format!("{value}") }
}
