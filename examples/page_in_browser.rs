//! Opens the page of `welkin report` in a browser and asks it what it shows: whether every plot is drawn and every picture
//! there, and whether anything was asked of the network.
//!
//! `cargo run --release --example page_in_browser -- OUT/report.html [PICTURE.png]`, with Debian's `chromium`; fails where
//! something is missing, or where two broken copies of the page go unnoticed. With a second argument the page's screen is kept.

use std::error::Error;
use std::path::Path;
use std::process::{Command, ExitCode};

use serde_json::Value;

/// Runs in the page and leaves what it finds as text: the plots with how many shapes of theirs have a size, the pictures with
/// their width, all that was loaded, and the tables with their rows.
const ASK: &str = r#"<script>addEventListener("load", () => {
    const all = (names, inside) => [...(inside || document).querySelectorAll(names)];
    all("details").forEach((details) => { details.open = true; });
    const drawn = (shape) => { const box = shape.getBoundingClientRect(); return box.width + box.height > 0; };
    const found = {
        plots: all("svg").map((plot) => all("polyline,path,circle,line,rect,text", plot).filter(drawn).length),
        pictures: all("img").map((picture) => picture.complete ? picture.naturalWidth : 0),
        tables: all("table").map((table) => table.rows.length),
        loaded: performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !name.startsWith("data:")),
    };
    const text = document.createElement("pre");
    text.id = "found";
    text.textContent = JSON.stringify(found);
    document.body.append(text);
});</script>"#;

/// Shapes of a plot that is more than its frame.
const LEAST_SHAPES: u64 = 20;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which page? cargo run --example page_in_browser -- OUT/report.html")?;
    let page = std::fs::read_to_string(&path)?;
    let folder = tempfile::tempdir()?;
    let found = ask(folder.path(), &page)?;
    println!("{found:#}");
    let problems = problems(&found);
    problems.iter().for_each(|problem| eprintln!("{problem}"));
    // Controls: a picture that is cut off, and one that lies elsewhere.
    let cut = page.replacen("base64,", "base64,AAAA", 1);
    let elsewhere = page.replacen("<body>", "<body><img src=\"http://127.0.0.1:9/picture.png\">", 1);
    for (what, broken) in [("a broken picture", cut), ("a picture from the network", elsewhere)] {
        if broken == page || self::problems(&ask(folder.path(), &broken)?).is_empty() {
            return Err(format!("{what} goes unnoticed").into());
        }
    }
    if let Some(picture) = arguments.next() {
        let to = std::path::absolute(picture)?;
        chromium(folder.path(), &["--window-size=1200,2400", &format!("--screenshot={}", to.display())], &path)?;
    }
    Ok(if problems.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What a page says of itself in the browser.
fn ask(folder: &Path, page: &str) -> Result<Value, Box<dyn Error>> {
    let path = folder.join("page.html");
    std::fs::write(&path, page.replacen("</head>", &format!("{ASK}</head>"), 1))?;
    let shown = chromium(folder, &["--virtual-time-budget=10000", "--dump-dom"], &path.display().to_string())?;
    let (_, rest) = shown.split_once("<pre id=\"found\">").ok_or("the page was not loaded to its end")?;
    let (text, _) = rest.split_once("</pre>").ok_or("the page was not loaded to its end")?;
    Ok(serde_json::from_str(&text.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))?)
}

fn chromium(folder: &Path, options: &[&str], page: &str) -> Result<String, Box<dyn Error>> {
    let page = std::path::absolute(page)?;
    let profile = format!("--user-data-dir={}", folder.join("profile").display());
    let usual = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", &profile];
    let mut command = Command::new("chromium");
    command.args(usual).args(options).arg(format!("file://{}", page.display()));
    let output = command.output().map_err(|error| format!("chromium: {error}; apt-get install chromium"))?;
    Ok(String::from_utf8(output.stdout)?)
}

/// What is missing, or should not be there.
fn problems(found: &Value) -> Vec<String> {
    let list = |name: &str| found[name].as_array().cloned().unwrap_or_default();
    let mut problems = Vec::new();
    for (name, least) in [("plots", LEAST_SHAPES), ("pictures", 1), ("tables", 2)] {
        let all = list(name);
        let missing = all.iter().filter(|number| number.as_u64().unwrap_or(0) < least).count();
        if all.is_empty() || missing > 0 {
            problems.push(format!("{missing} of {} {name} are not shown", all.len()));
        }
    }
    problems.extend(list("loaded").iter().map(|name| format!("the page loads {name}")));
    problems
}
