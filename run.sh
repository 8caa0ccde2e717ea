#!/usr/bin/env bash
# Installs what is missing, builds, and renders every scene in scenes/ to out/: a PNG, an EXR and a table of the passes.
# `./run.sh window [SCENE]` opens the window instead.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source scripts/setup.sh

need_to_run
if [[ ${1:-} == window ]]; then need_window; fi
install_missing
find_cargo
cargo build --release --locked
welkin="${CARGO_TARGET_DIR:-target}/release/welkin"

if [[ ${1:-} == window ]]; then
    exec "$welkin" "$@"
elif (($# > 0)); then
    give_up "unknown argument '$1'; allowed: window [SCENE], or nothing to render the gallery"
fi

mkdir -p out
for scene in scenes/*.toml; do
    name=$(basename "$scene" .toml)
    printf '\n%s\n' "$name"
    "$welkin" render "$scene" -o "out/$name.png" -o "out/$name.exr"
done
