# What a bare machine lacks to build, render and test. Sourced by run.sh and test.sh; checks first and installs only
# what is missing, so that a second time costs nothing and needs no network.

missing=()

# have_library NAME: whether the dynamic linker finds it.
have_library() {
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -F "$1" >/dev/null
}

# have_file PATTERN...: whether one of the files is there.
have_file() {
    local file
    for file in "$@"; do
        if [[ -e $file ]]; then return 0; fi
    done
    return 1
}

# A Vulkan driver says what it is in a JSON file; variables of the loader may name others.
have_vulkan_driver() {
    [[ -n ${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-} ]] ||
        have_file {/usr/share,/usr/local/share,/etc}/vulkan/icd.d/*.json
}

have_validation_layer() {
    [[ -n ${VK_LAYER_PATH:-} ]] ||
        have_file {/usr/share,/usr/local/share,/etc}/vulkan/explicit_layer.d/VkLayer_khronos_validation.json
}

have_certificates() {
    have_file "${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}" /etc/pki/tls/certs/ca-bundle.crt /etc/ssl/cert.pem
}

# need PACKAGE CHECK...: notes the package when the check fails.
need() {
    local package=$1
    shift
    if ! "$@" >/dev/null; then missing+=("$package"); fi
}

need_to_run() {
    need g++ command -v c++
    need ca-certificates have_certificates
    need libvulkan1 have_library libvulkan.so.1
    need mesa-vulkan-drivers have_vulkan_driver
}

# What a window on X11 loads when it opens; on Wayland the first is enough.
need_window() {
    need libxkbcommon0 have_library libxkbcommon.so.0
    need libxkbcommon-x11-0 have_library libxkbcommon-x11.so.0
    need libx11-6 have_library libX11.so.6
    need libx11-xcb1 have_library libX11-xcb.so.1
    need libxcursor1 have_library libXcursor.so.1
    need libxi6 have_library libXi.so.6
}

need_to_test() {
    need_to_run
    need vulkan-validationlayers have_validation_layer
    need xvfb command -v Xvfb
    need xdotool command -v xdotool
    need openbox command -v openbox
    need_window
    need glslc command -v glslc
}

give_up() {
    printf '%s: %s\n' "$(basename "$0")" "$1" >&2
    exit 1
}

# Installs what was noted.
install_missing() {
    if ((${#missing[@]} == 0)); then return; fi
    local names="${missing[*]}" as_root=()
    command -v apt-get >/dev/null ||
        give_up "please install what Debian calls: $names (there is no apt-get here to do it)"
    if ((EUID != 0)); then
        command -v sudo >/dev/null || give_up "please install as root: apt-get install $names (there is no sudo here)"
        as_root=(sudo)
    fi
    as_root+=(env DEBIAN_FRONTEND=noninteractive)
    printf 'installing: %s\n' "$names" >&2
    {
        "${as_root[@]}" apt-get update -qq &&
            "${as_root[@]}" apt-get install -qq -y --no-install-recommends "${missing[@]}"
    } >&2 || give_up "apt-get failed; please install: $names"
    missing=()
}

# Cargo, also where the shell's profile has not put it on the path.
find_cargo() {
    export PATH="$PATH:${CARGO_HOME:-$HOME/.cargo}/bin"
    command -v cargo >/dev/null || give_up "there is no Rust toolchain; get one from https://rustup.rs"
}
