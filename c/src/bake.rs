//! Baking and verifying packs.

use std::ffi::{CString, c_char, c_void};

use welkin::bake::{air_of, describe, shaders};
use welkin::plan::{Quality, bake_settings};
use welkin::scene::Scene;
use welkin_lut::bake::{Baked, Progress};
use welkin_lut::pack::{FileFormat, PackOptions, Precision, verify, write_pack};

use crate::status::{Failure, Status, given, guarded, in_full, path};

/// `welkin_progress`.
pub type WelkinProgress = Option<unsafe extern "C" fn(user: *mut c_void, stage: *const c_char, done: f64)>;

/// `welkin_bake_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WelkinBakeOptions {
    /// `welkin_quality`.
    pub quality: u32,
    /// `WELKIN_EXR` and others.
    pub containers: u32,
    /// `WELKIN_F16` and others.
    pub precisions: u32,
    /// May be null.
    pub progress: WelkinProgress,
    /// Handed to it.
    pub user: *mut c_void,
}

/// `welkin_verified`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WelkinVerified {
    /// Files whose hashes are right.
    pub files: u64,
    /// Files of tables that hold the same texels in every container.
    pub table_files: u64,
    /// Values of probes.
    pub probes: u64,
}

const CONTAINERS: [(u32, FileFormat); 4] =
    [(1, FileFormat::Exr), (2, FileFormat::Ktx2), (4, FileFormat::Dds), (8, FileFormat::Raw)];

/// Bits and what they stand for.
pub(crate) const PRECISIONS: [(u32, Precision); 2] = [(1, Precision::F16), (2, Precision::F32)];

/// What bits stand for; at least one of them, and no other.
fn chosen<T: Copy>(name: &str, bits: u32, all: &[(u32, T)]) -> Result<Vec<T>, Failure> {
    let known = all.iter().fold(0, |known, (bit, _)| known | bit);
    if bits == 0 || bits & !known != 0 {
        return Err(Failure::argument(format!("{name} are {bits:#x}; join at least one of the bits of {known:#x}")));
    }
    Ok(all.iter().filter(|(bit, _)| bits & bit != 0).map(|(_, one)| *one).collect())
}

/// The caller's progress function. Its header says that several threads may call it.
struct Reporter {
    progress: WelkinProgress,
    user: *mut c_void,
}

// SAFETY: the header demands a function that may be called from any thread with this pointer.
unsafe impl Sync for Reporter {}

impl Reporter {
    fn report(&self, progress: Progress) {
        if let (Some(function), Ok(stage)) = (self.progress, CString::new(progress.stage)) {
            // SAFETY: the function is the caller's, and the text lives for the time of the call.
            unsafe { function(self.user, stage.as_ptr(), progress.done) };
        }
    }
}

/// Medium quality, KTX2, half floats, no progress.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_default_bake_options() -> WelkinBakeOptions {
    WelkinBakeOptions { quality: 1, containers: 2, precisions: 1, progress: None, user: std::ptr::null_mut() }
}

/// Bakes the tables of a scene file's air on the CPU and writes a pack.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_bake(
    scene_path: *const c_char,
    pack_path: *const c_char,
    options: *const WelkinBakeOptions,
) -> u32 {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (scene_path, pack_path) = unsafe { (path("scene_path", scene_path)?, path("pack_path", pack_path)?) };
        let options = if options.is_null() {
            welkin_default_bake_options()
        } else {
            // SAFETY: as the caller promises.
            *unsafe { given("options", options) }?
        };
        let quality = Quality::ALL.get(options.quality as usize).copied();
        let quality = quality.ok_or_else(|| Failure::argument(format!("quality is {}; 0 to 3", options.quality)))?;
        let formats = chosen("containers", options.containers, &CONTAINERS)?;
        let precisions = chosen("precisions", options.precisions, &PRECISIONS)?;
        let of_scene = |error: &dyn std::error::Error| Failure::new(Status::Scene, in_full(error));
        let scene = Scene::read(scene_path).map_err(|error| of_scene(&error))?;
        let air = air_of(&scene).map_err(|error| of_scene(&error))?;
        let settings = bake_settings(quality);
        let shaders = shaders(&scene, &settings).map_err(|error| of_scene(&error))?;
        let reporter = Reporter { progress: options.progress, user: options.user };
        let reporter = &reporter;
        let baked = Baked::new(&air, settings, &move |progress| reporter.report(progress));
        write_pack(pack_path, &baked, &describe(&scene, &air, "cpu"), &PackOptions { formats, precisions }, &shaders)?;
        Ok(())
    })
}

/// Checks a pack.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_verify(pack_path: *const c_char, verified: *mut WelkinVerified) -> u32 {
    guarded(|| {
        // SAFETY: as the caller promises.
        let found = verify(unsafe { path("pack_path", pack_path) }?)?;
        // SAFETY: as the caller promises.
        if let Some(verified) = unsafe { verified.as_mut() } {
            let [files, table_files, probes] = [found.files, found.table_files, found.probes].map(|n| n as u64);
            *verified = WelkinVerified { files, table_files, probes };
        }
        Ok(())
    })
}
