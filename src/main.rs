//! The `welkin` program; everything it does lies in the library.

fn main() -> std::process::ExitCode {
    welkin::cli::run()
}
