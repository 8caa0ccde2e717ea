//! A device for tests, under validation.

use std::sync::{Mutex, MutexGuard, PoisonError};

use welkin::gpu::{DeviceRequest, Gpu, Validation, ValidationLog};
use welkin::renderer::Renderer;

/// One device at a time: the validation layer's state and the processor's threads are shared by all of them.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Waits until no other test of this program uses a device.
#[allow(dead_code)]
pub fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Memory that this process occupies, KiB.
#[allow(dead_code)]
pub fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).expect("a process has memory");
    line.split_whitespace().nth(1).and_then(|number| number.parse().ok()).expect("a number of KiB")
}

/// Runs a test on a device with validation on. A machine without a device fails the test, and so does a single message
/// of the validation layer, also one that comes when the device is closed.
#[allow(dead_code)]
pub fn with_gpu(test: impl FnOnce(&Gpu)) {
    let _alone = alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let gpu = Gpu::new(&request).unwrap_or_else(|error| panic!("{error}"));
    let log: ValidationLog = gpu.validation_log();
    test(&gpu);
    drop(gpu);
    let messages: Vec<String> = log.messages().iter().map(ToString::to_string).collect();
    assert!(messages.is_empty(), "the validation layer complains:\n{}", messages.join("\n"));
}

/// Does something with a renderer that the validation layer watches: see [`with_gpu`].
#[allow(dead_code)]
pub fn with_renderer<T>(work: impl FnOnce(&mut Renderer) -> T) -> T {
    let mut done = None;
    with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap_or_else(|error| panic!("{error}"));
        done = Some(work(&mut renderer));
    });
    done.expect("it was called")
}
