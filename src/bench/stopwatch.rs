//! Processor time and memory of the process.

use std::time::Instant;

use cpu_time::ProcessTime;

/// Runs from its making.
pub struct Stopwatch {
    wall: Instant,
    processor: ProcessTime,
}

impl Stopwatch {
    /// Starts.
    pub fn start() -> Self {
        Self { wall: Instant::now(), processor: ProcessTime::now() }
    }

    /// What all threads have worked so far, ms.
    pub fn processor_ms(&self) -> f64 {
        self.processor.elapsed().as_secs_f64() * 1e3
    }

    /// Time that has passed, ms.
    pub fn wall_ms(&self) -> f64 {
        self.wall.elapsed().as_secs_f64() * 1e3
    }
}

/// The most memory that the process has held at once, bytes; none where the system does not say (Linux does).
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

#[cfg(test)]
mod tests {
    use std::process::Command;
    use std::time::Duration;

    use cpu_time::ThreadTime;

    use super::*;

    /// Named for the process that only sleeps: in this one other tests work at the same time.
    const SLEEPER: &str = "WELKIN_TEST_SLEEPER";

    #[test]
    fn sleeping_costs_time_but_no_work() {
        if std::env::var_os(SLEEPER).is_some() {
            let stopwatch = Stopwatch::start();
            std::thread::sleep(Duration::from_millis(200));
            assert!(stopwatch.wall_ms() >= 200.0 && stopwatch.processor_ms() < 100.0);
            return;
        }
        let this_test = "bench::stopwatch::tests::sleeping_costs_time_but_no_work";
        let mut alone = Command::new(std::env::current_exe().unwrap());
        let output = alone.args(["--exact", this_test]).env(SLEEPER, "1").output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && said.contains("1 passed"), "{said}");
    }

    #[test]
    fn work_of_every_thread_is_counted() {
        let stopwatch = Stopwatch::start();
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    let own = ThreadTime::now();
                    while own.elapsed() < Duration::from_millis(30) {}
                });
            }
        });
        assert!(stopwatch.processor_ms() >= 60.0);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_that_is_filled_shows_in_the_peak() {
        let before = peak_memory_bytes().unwrap();
        let filled = vec![1_u8; before as usize + (64 << 20)];
        assert!(filled.iter().all(|&byte| byte == 1));
        assert!(peak_memory_bytes().unwrap() >= before + (60 << 20));
    }
}
