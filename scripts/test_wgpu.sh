#!/usr/bin/env bash
# Checks and tests examples/wgpu_sky, which is no member of the workspace: ./test.sh leaves it out, .ci/run does not.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh

need_to_run
install_missing
find_cargo

# What both build is built once; the command `welkin` is found beside.
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"
example=(--locked --manifest-path examples/wgpu_sky/Cargo.toml)
cargo fmt --manifest-path examples/wgpu_sky/Cargo.toml --check
cargo clippy --release "${example[@]}" --all-targets -- -D warnings
cargo build --release --locked
cargo test --release "${example[@]}"
