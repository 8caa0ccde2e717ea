//! Reading and sampling packs.

use std::ffi::{CString, c_char};

use welkin_lut::Table;
use welkin_lut::pack::{Pack, ProbeAnswer, ProbeInput, TableEntry};
use welkin_lut::sky_tables::SkyTables;

use crate::bake::PRECISIONS;
use crate::status::{Failure, Status, given, guarded, path, put};

/// `welkin_pack`: all that its functions give pointers to.
pub struct WelkinPack {
    tables: SkyTables,
    /// In the order of `welkin_table`, each with its size.
    texels: [(Vec<[f32; 4]>, [u32; 3]); 4],
    manifest: CString,
    sky_parameters: Vec<u8>,
}

/// `welkin_texels`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct WelkinTexels {
    /// Red, green, blue and 1.
    pub rgba: *const f32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Slices.
    pub depth: u32,
}

/// `welkin_ray`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct WelkinRay {
    /// Of the observer above the ground, m.
    pub altitude_m: f64,
    /// Cosine of the view's zenith angle.
    pub mu: f64,
    /// Cosine of the sun's.
    pub mu_s: f64,
    /// Cosine of the angle between the two.
    pub nu: f64,
}

/// `welkin_sky`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct WelkinSky {
    /// From the observer towards the sun.
    pub transmittance_to_space: [f64; 3],
    /// Of the view ray's air.
    pub view_transmittance: [f64; 3],
    /// Of the sky on a horizontal plane.
    pub sky_irradiance: [f64; 3],
    /// Of the sun on that plane.
    pub sun_irradiance: [f64; 3],
    /// Of the air, 1/sr.
    pub sky_radiance: [f64; 3],
    /// Of the ground through it, 1/sr.
    pub ground_radiance: [f64; 3],
}

fn texels(table: &Table) -> (Vec<[f32; 4]>, [u32; 3]) {
    let rgba = |&[r, g, b]: &[f64; 3]| [r as f32, g as f32, b as f32, 1.0];
    (table.texels().iter().map(rgba).collect(), table.size())
}

fn open(folder: &std::path::Path, precision: u32) -> Result<WelkinPack, Failure> {
    let known = PRECISIONS.iter().find(|(bit, _)| *bit == precision);
    let Some(&(_, precision)) = known else {
        return Err(Failure::argument(format!("precision is {precision}; WELKIN_F16 (1) or WELKIN_F32 (2)")));
    };
    let pack = Pack::read(folder)?;
    let holds = |table: &TableEntry| table.files.iter().any(|file| file.precision == precision);
    if !pack.manifest().tables.iter().all(holds) {
        return Err(Failure::argument(format!("'{}' holds no tables of {precision}", folder.display())));
    }
    let tables = pack.tables(precision, None)?;
    let file = |name: &str| {
        let path = folder.join(name);
        std::fs::read(&path).map_err(|error| Failure::new(Status::File, format!("'{}': {error}", path.display())))
    };
    let manifest = CString::new(file("manifest.json")?);
    let manifest = manifest.map_err(|_| Failure::new(Status::BrokenPack, "manifest.json has a zero inside"))?;
    let set = tables.set();
    let texels = [&set.transmittance, &set.irradiance, &set.multiple_scattering, &set.scattering].map(texels);
    Ok(WelkinPack { texels, manifest, sky_parameters: file("sky_parameters.bin")?, tables })
}

/// Reads a pack with the tables of one precision.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_open(pack_path: *const c_char, precision: u32, pack: *mut *mut WelkinPack) -> u32 {
    guarded(|| {
        if pack.is_null() {
            return Err(Failure::argument("pack is null"));
        }
        // SAFETY: as the caller promises.
        let read = open(unsafe { path("pack_path", pack_path) }?, precision)?;
        // SAFETY: as the caller promises.
        unsafe { put("pack", pack, Box::into_raw(Box::new(read))) }
    })
}

/// Ends the life of a pack.
///
/// # Safety
/// The pack is null or of [`welkin_pack_open`], is not closed yet and used by no other thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_close(pack: *mut WelkinPack) {
    guarded(|| {
        if !pack.is_null() {
            // SAFETY: as the caller promises.
            drop(unsafe { Box::from_raw(pack) });
        }
        Ok(())
    });
}

/// The pack's `manifest.json`.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_manifest(pack: *const WelkinPack, json: *mut *const c_char) -> u32 {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { put("json", json, given("pack", pack)?.manifest.as_ptr()) })
}

/// A table's texels.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_table(pack: *const WelkinPack, table: u32, texels: *mut WelkinTexels) -> u32 {
    guarded(|| {
        // SAFETY: as the caller promises.
        let pack = unsafe { given("pack", pack) }?;
        let Some((rgba, [width, height, depth])) = pack.texels.get(table as usize) else {
            return Err(Failure::argument(format!("table is {table}; 0 to 3")));
        };
        let found = WelkinTexels { rgba: rgba.as_ptr().cast(), width: *width, height: *height, depth: *depth };
        // SAFETY: as the caller promises.
        unsafe { put("texels", texels, found) }
    })
}

/// The uniform block of the shaders.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_sky_parameters(
    pack: *const WelkinPack,
    block: *mut *const u8,
    bytes: *mut usize,
) -> u32 {
    guarded(|| {
        // SAFETY: as the caller promises.
        let held = &unsafe { given("pack", pack) }?.sky_parameters;
        if block.is_null() {
            return Err(Failure::argument("block is null"));
        }
        // SAFETY: as the caller promises.
        unsafe { put("bytes", bytes, held.len()).and_then(|()| put("block", block, held.as_ptr())) }
    })
}

/// Samples the tables as the shaders do.
///
/// # Safety
/// Pointers are null or what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_pack_sample(
    pack: *const WelkinPack,
    ray: *const WelkinRay,
    sky: *mut WelkinSky,
) -> u32 {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (pack, ray) = unsafe { (given("pack", pack)?, given("ray", ray)?) };
        let WelkinRay { altitude_m, mu, mu_s, nu } = *ray;
        let cosines = [("mu", mu), ("mu_s", mu_s), ("nu", nu)];
        if let Some((name, value)) = cosines.iter().find(|(_, value)| !(-1.0..=1.0).contains(value)) {
            return Err(Failure::argument(format!("ray's {name} is {value}; a cosine lies in [-1, 1]")));
        }
        if !altitude_m.is_finite() {
            return Err(Failure::argument(format!("ray's altitude_m is {altitude_m}; it must be finite")));
        }
        let answer = ProbeAnswer::of(&pack.tables, &ProbeInput { altitude_m, mu, mu_s, nu });
        let found = WelkinSky {
            transmittance_to_space: answer.transmittance_to_space,
            view_transmittance: answer.view_transmittance,
            sky_irradiance: answer.sky_irradiance,
            sun_irradiance: answer.sun_irradiance,
            sky_radiance: answer.sky_radiance,
            ground_radiance: answer.ground_radiance,
        };
        // SAFETY: as the caller promises.
        unsafe { put("sky", sky, found) }
    })
}
