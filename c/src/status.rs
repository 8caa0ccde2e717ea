//! What went wrong, as a number and in words; and the border that no panic crosses.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use welkin_lut::pack::PackError;

/// `welkin_status`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Status {
    Ok = 0,
    InvalidArgument = 1,
    Scene = 2,
    File = 3,
    NoPack = 4,
    BrokenPack = 5,
    Fault = 6,
}

/// Why a call fails.
pub(crate) struct Failure {
    status: Status,
    message: String,
}

impl Failure {
    pub(crate) fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    pub(crate) fn argument(message: impl Into<String>) -> Self {
        Self::new(Status::InvalidArgument, message)
    }
}

impl From<PackError> for Failure {
    fn from(error: PackError) -> Self {
        let status = match &error {
            PackError::NoPack { .. } | PackError::Version { .. } => Status::NoPack,
            PackError::File { .. } | PackError::Occupied { .. } | PackError::Encode { .. } => Status::File,
            _ => Status::BrokenPack,
        };
        Self::new(status, in_full(&error))
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Why the last call of this thread that failed has done so. The text lives until the thread's next call.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_last_error() -> *const c_char {
    LAST_ERROR.with_borrow(|text| text.as_ptr())
}

fn remember(message: &str) {
    // A text with a zero inside would end there.
    let text = CString::new(message.replace('\0', " ")).unwrap_or_default();
    LAST_ERROR.set(text);
}

/// An error and its causes.
pub(crate) fn in_full(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(error.source(), |cause| cause.source());
    causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}

/// Runs a function's body; what it fails or panics with becomes a status and the last error.
pub(crate) fn guarded(body: impl FnOnce() -> Result<(), Failure>) -> u32 {
    let failure = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => return Status::Ok as u32,
        Ok(Err(failure)) => failure,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
            Failure::new(Status::Fault, format!("a fault of this library: {text}"))
        }
    };
    remember(&failure.message);
    failure.status as u32
}

/// A path from C.
///
/// # Safety
/// The pointer is null or a string that ends in zero and lives as long as what is returned.
pub(crate) unsafe fn path<'a>(name: &str, pointer: *const c_char) -> Result<&'a Path, Failure> {
    if pointer.is_null() {
        return Err(Failure::argument(format!("{name} is null")));
    }
    // SAFETY: as the caller promises.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map(Path::new).map_err(|_| Failure::argument(format!("{name} is not UTF-8: {text:?}")))
}

/// What a pointer from C leads to.
///
/// # Safety
/// The pointer is null, or leads to a `T` that lives as long as what is returned.
pub(crate) unsafe fn given<'a, T>(name: &str, pointer: *const T) -> Result<&'a T, Failure> {
    // SAFETY: as the caller promises.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::argument(format!("{name} is null")))
}

/// Where an answer goes.
///
/// # Safety
/// The pointer is null or may be written to.
pub(crate) unsafe fn put<T>(name: &str, pointer: *mut T, value: T) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::argument(format!("{name} is null")));
    }
    // SAFETY: as the caller promises; what was there may never have been a T.
    unsafe { pointer.write(value) };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_status_with_its_words() {
        let status = guarded(|| panic!("the sky has fallen"));
        assert_eq!(status, Status::Fault as u32);
        // SAFETY: the text lives until this thread's next call.
        let text = unsafe { CStr::from_ptr(welkin_last_error()) };
        assert!(text.to_string_lossy().contains("the sky has fallen"), "{text:?}");
        assert_eq!(guarded(|| Ok(())), 0);
    }
}
