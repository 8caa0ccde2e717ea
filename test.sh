#!/usr/bin/env bash
# Installs what is missing and runs every check and test. The last line says how many passed and failed; the exit code
# is 0 only when none failed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source scripts/setup.sh

need_to_test
install_missing
find_cargo

passed=0 failed=0 failures=()
log=$(mktemp)
trap 'rm -f "$log"' EXIT

fail() {
    failed=$((failed + 1))
    failures+=("$1")
}

# check NAME COMMAND...: one check.
check() {
    local name=$1
    shift
    printf '\n== %s\n' "$name"
    if "$@"; then passed=$((passed + 1)); else fail "$name"; fi
}

# sum WORD: the total of `N WORD` in the result lines of all test programs.
sum() {
    sed -En "s/^test result:.* ([0-9]+) $1.*/\\1/p" "$log" | awk '{ total += $1 } END { print total + 0 }'
}

# All tests, each of which counts.
run_tests() {
    local status=0 failed_before=$failed tests_failed started finished ignored
    printf '\n== tests\n'
    # Not the examples: the lints have compiled them, and to link them takes longer than most tests.
    cargo test --release --locked --workspace --no-fail-fast --lib --bins --tests 2>&1 | tee "$log" || status=$?
    cargo test --release --locked --workspace --no-fail-fast --doc 2>&1 | tee -a "$log" || status=$?
    passed=$((passed + $(sum passed)))
    tests_failed=$(sum failed)
    failed=$((failed + tests_failed))
    mapfile -t -O "${#failures[@]}" failures < <(sed -En 's/^test (.*) \.\.\. FAILED$/\1/p' "$log")
    # A test program that crashes has no result line; one that does not build is not even started.
    started=$(grep -Ec '^ +(Running|Doc-tests) ' "$log" || true)
    finished=$(grep -c '^test result:' "$log" || true)
    for ((; finished < started; finished++)); do fail "a test program that crashed"; done
    if ((status != 0 && failed == failed_before)); then fail "cargo test"; fi
    ignored=$(sum ignored)
    if ((ignored > 0)); then printf '%s tests were ignored\n' "$ignored"; fi
}

shell_syntax() {
    local script
    for script in run.sh test.sh scripts/*.sh .ci/run; do bash -n "$script" || return 1; done
}

check "shell syntax" shell_syntax
check "format" cargo fmt --all --check
check "lints" cargo clippy --release --locked --all-targets --workspace -- -D warnings
check "documentation" env RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --no-deps --workspace
run_tests

printf '\n'
if ((failed > 0)); then printf 'FAILED: %s\n' "${failures[@]}"; fi
printf '%s passed, %s failed\n' "$passed" "$failed"
((failed == 0))
