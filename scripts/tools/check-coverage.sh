#!/usr/bin/env bash
# Line and branch coverage of the core: 100 %, each exclusion with its reason beside it.
# usage: check-coverage [SOURCE_ROOT BUILD_DIR]      run the tests of the preset coverage before
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "${1:-$ROOT}" || exit
build=${2:-$ROOT/build/coverage}
mkdir -p "$build"

# `GCOVR_EXCL_LINE: why`, at least two words. The STOP of a block needs none: its START has it.
unreasoned=$(grep -rnE '(GCOVR|LCOV)_EXCL' firmware/src firmware/include |
    grep -vE '_EXCL(_BR)?_STOP|GCOVR_EXCL_(BR_)?(LINE|START): *[^ ]+ +[^ ]{2,}') || true
if [[ -n $unreasoned ]]; then
    echo "$unreasoned" >&2
    die "an exclusion needs its reason on the same line: /* GCOVR_EXCL_LINE: the reason */"
fi

# Of a table the core makes data, and no code; what a test program makes of it is not the core's.
report() {
    gcovr --root . --object-directory "$build" --filter 'firmware/(src|include)/' --exclude '.*\.def$' "$@" "$build"
}
if ! report --json-summary "$build/coverage.json" --print-summary --fail-under-line 100 --fail-under-branch 100; then
    report            # lines that are missing
    report --branches # and branches
    die "coverage is below 100 %"
fi

# A file that the report does not know was never compiled with coverage, and is not 100 %.
while read -r file; do
    if ! grep -q "\"$file\"" "$build/coverage.json"; then
        die "$file is missing in the report"
    fi
done < <(find firmware/src -name '*.c' | sort)
