//! Every hard case at every quality, held to the laws and to the path tracer. Prints Markdown, or puts it into a page
//! between the lines that begin and end what is made (docs/stability.md).
//!
//! `cargo run --release --example stability [-- [--long] [--case PART] [--out FILE] [QUALITY...]]`
//!
//! Without `--long` fewer walks are traced for each pixel.

#[path = "../../tests/hard_cases/mod.rs"]
mod hard_cases;
mod table;

use std::path::PathBuf;

use hard_cases::judge::{Judgement, judge, render};
use hard_cases::{Case, all, truth};
use welkin::gpu::DeviceRequest;
use welkin::plan::Quality;
use welkin::renderer::Renderer;

const WALKS: u64 = 512;
const LONG_WALKS: u64 = 1 << 14;

struct Options {
    long: bool,
    out: Option<PathBuf>,
    part: String,
    qualities: Vec<Quality>,
}

fn options() -> Options {
    let mut options = Options { long: false, out: None, part: String::new(), qualities: Vec::new() };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--long" => options.long = true,
            "--out" => options.out = words.next().map(PathBuf::from),
            "--case" => options.part = words.next().unwrap_or_default(),
            name => options.qualities.push(name.parse().unwrap_or_else(|error| panic!("{error}"))),
        }
    }
    if options.qualities.is_empty() {
        options.qualities = Quality::ALL.to_vec();
    }
    options
}

fn main() {
    let options = options();
    if let Some(path) = &options.out {
        table::around_marks(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    let request = DeviceRequest { poisons_memory: true, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap_or_else(|error| panic!("{error}"));
    let cases: Vec<Case> = all().into_iter().filter(|case| case.name.contains(&options.part)).collect();
    let walks = if options.long { LONG_WALKS } else { WALKS };
    let truths: Vec<_> = cases.iter().map(|case| truth::of(case, walks)).collect();
    let mut columns: Vec<Vec<Judgement>> = Vec::new();
    for &quality in &options.qualities {
        let (mut column, mut frames) = (Vec::new(), Vec::new());
        for (case, truth) in cases.iter().zip(&truths) {
            let (found, frame) = judge(&mut renderer, case, quality, truth.as_ref());
            found.broken.iter().chain(&found.missed).for_each(|words| eprintln!("{} at {quality}: {words}", case.name));
            column.push(found);
            frames.push(frame);
        }
        for (index, case) in cases.iter().enumerate().rev() {
            if render(&mut renderer, case, &case.scene(), quality) != frames[index] {
                column[index].broken.push("a second picture differs".to_owned());
            }
        }
        columns.push(column);
    }
    let furnaces = options.qualities.iter().map(|&quality| table::furnace(&mut renderer, quality)).collect::<String>();
    let page = table::page(renderer.gpu().info(), &cases, &options.qualities, &columns, walks);
    let page = page + &table::furnace_head() + &furnaces;
    match options.out {
        Some(path) => table::put_into(&path, &page).unwrap_or_else(|error| panic!("{}: {error}", path.display())),
        None => print!("{page}"),
    }
}
