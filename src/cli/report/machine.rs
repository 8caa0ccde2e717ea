//! Where numbers come from: the machine, the device and the program's source.

use std::process::Command;

use welkin::gpu::DeviceInfo;
use welkin::report::Provenance;

/// Of measurements on a device.
pub fn provenance(device: &DeviceInfo) -> Provenance {
    Provenance {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: commit().unwrap_or_else(|| "unknown".to_owned()),
        device: device.name.clone(),
        driver: format!("{} {}", device.driver, device.driver_version),
        machine: machine(),
        load: load(),
    }
}

/// The command as it was given, with the program's name alone.
pub fn command_line() -> String {
    let words = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    format!("welkin {words}")
}

/// What tells this build of the program from any other: the checksum of its file.
///
/// # Errors
/// Those of the disk.
pub fn program() -> std::io::Result<String> {
    let bytes = std::fs::read(std::env::current_exe()?)?;
    Ok(format!("welkin {}, checksum {:08x}", env!("CARGO_PKG_VERSION"), crc32fast::hash(&bytes)))
}

/// The commit of the source that this was built from, where it still lies there.
fn commit() -> Option<String> {
    let git = Command::new("git").args(["-C", env!("CARGO_MANIFEST_DIR"), "describe", "--always", "--dirty"]).output();
    let output = git.ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        cpuinfo.lines().find_map(|line| line.strip_prefix("model name")).and_then(|rest| rest.split(':').nth(1));
    format!("{}, {cores} cores", model.map_or("unknown processor", str::trim))
}

/// What else the machine does as the report begins.
fn load() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from) as f64;
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    match text.split_whitespace().next().and_then(|first| first.parse::<f64>().ok()) {
        Some(load) if load < 0.25 * cores => format!("The machine was quiet (load {load})."),
        Some(load) => format!(
            "The machine was busy with other work (load {load} before the start), so times are good as ratios only."
        ),
        None => "What else the machine did is not known.".to_owned(),
    }
}
