//! Memory of the process that drivers have freed.

/// Gives the system back what is free between what is still in use.
///
/// Drivers compile shaders in this process, and compilers free what they have taken in small pieces. glibc keeps those for
/// later, up to all that the largest shader took, once for each thread; other allocators give them back by themselves.
/// This takes some milliseconds.
pub fn give_back_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: malloc_trim may be called at any time by any thread; it moves nothing that is in use.
    unsafe {
        libc::malloc_trim(0);
    }
}
