//! What accuracy costs, as users see it: the report's files.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use welkin::goal::MeasuredFront;

mod json_schema;

/// Quick to trace and to render: clear air, a high sun, few pixels.
const SCENE: &str = "name = \"a <high> sun\"\npreset = \"hillaire2020\"\n[sun]\nelevation_deg = 50\nazimuth_deg = 0\n[camera]\n\
                     altitude_m = 500\nelevation_deg = 30\nazimuth_deg = 120\nwidth = 64\nheight = 8\n";

fn welkin(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env("WELKIN_VALIDATION", "1").env("WELKIN_CACHE", folder.join("cache"));
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::write(folder.path().join("scenes").join("scene.toml"), scene).unwrap();
    folder
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

const REPORT: &str = "report --out out --quick --walks 256 --dearest low";

#[test]
fn a_report_is_whole_goes_on_where_it_was_and_tells_good_settings_from_bad() {
    let folder = folder_with(SCENE);
    let output = welkin(folder.path(), REPORT);
    assert!(output.status.success(), "{}", said(&output));
    let out = folder.path().join("out");
    let text = |name: &str| fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let report: Value = serde_json::from_str(&text("report.json")).unwrap();
    let schema: Value = serde_json::from_str(&text("report.schema.json")).unwrap();
    assert_eq!(json_schema::error(&schema, &schema, &report), None);
    let points = report["scenes"][0]["points"].as_array().unwrap();
    let error = |name: &str| {
        let point =
            points.iter().find(|point| point["name"] == name).unwrap_or_else(|| panic!("no {name} in {points:?}"));
        number(&point["error"]["rms"])
    };
    // Hillaire's series is off by several per cent, and one order alone by more.
    assert!(error("low harmonics") < 0.5 * error("low isotropic-series"));
    assert!(error("low isotropic-series") < error("single scattering by quadrature"));
    assert!(error("path tracer, 64 walks") < error("path tracer, 4 walks"));
    assert_eq!(text("report.csv").lines().count(), 1 + points.len());
    assert!(text("passes.csv").contains(",sky_view,"));
    let page = text("report.html");
    assert!(page.contains("<svg") && page.contains("a &lt;high&gt; sun") && !page.contains("a <high> sun"));
    assert!(page.contains("data:image/png;base64,") && !page.contains("http://www.w3.org/1999/xhtml\""));
    for network in ["src=\"http", "href=\"http", "@import", "url(", "<script"] {
        assert!(!page.contains(network), "the page asks the network: {network}");
    }
    assert!(text("docs/cost.md").contains("images/cost-a__high__sun.svg"));
    assert!(text("docs/images/cost-a__high__sun.svg").contains("<text"));

    // The same command measures nothing again, and a list of another program is refused.
    let measured = text("measured.jsonl");
    let again = welkin(folder.path(), &format!("{REPORT} --learn out/learned.json"));
    assert!(again.status.success() && !said(&again).contains(": low"), "{}", said(&again));
    assert_eq!(text("measured.jsonl"), measured);
    // What choices are made from is what was measured, one standard error above.
    let learned: MeasuredFront = serde_json::from_str(&text("learned.json")).unwrap();
    let [scene] = &learned.scenes[..] else { panic!("{learned:?}") };
    let high = scene.errors["low harmonics"];
    assert!(high >= error("low harmonics") && learned.steps().len() == 3, "{learned:?}");
    let total: f64 = learned.passes["low harmonics"].values().sum();
    assert!((total / scene.milliseconds["low harmonics"] - 1.0).abs() < 0.01, "{learned:?}");
    fs::write(out.join("measured.jsonl"), measured.replacen("llvmpipe", "another", 1).replacen("welkin ", "else ", 1))
        .unwrap();
    let refused = welkin(folder.path(), REPORT);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("measured.jsonl") && said(&refused).contains("delete it"), "{}", said(&refused));
}

#[test]
fn a_report_without_scenes_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = welkin(folder.path(), "report --out out --scenes .");
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("no scene file"), "{}", said(&output));
}
