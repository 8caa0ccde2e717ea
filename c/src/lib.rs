//! Sky tables for engines in C and what calls C. `include/welkin.h` is the reference; names, layouts and order are its.
//!
//! Every function catches panics, checks its pointers, and leaves what went wrong to [`welkin_last_error`].

mod bake;
mod pack;
mod status;

pub use bake::{
    WelkinBakeOptions, WelkinProgress, WelkinVerified, welkin_bake, welkin_default_bake_options, welkin_verify,
};
pub use pack::{
    WelkinPack, WelkinRay, WelkinSky, WelkinTexels, welkin_pack_close, welkin_pack_manifest, welkin_pack_open,
    welkin_pack_sample, welkin_pack_sky_parameters, welkin_pack_table,
};
pub use status::welkin_last_error;

/// Changes when a caller must be compiled anew.
pub const ABI_VERSION: u32 = 1;

/// The version of what the header declares.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_abi_version() -> u32 {
    ABI_VERSION
}
