#!/usr/bin/env bash
# Line and branch coverage of the core must be 100 %; each exclusion needs a reason on its line.
# usage: check-coverage [SOURCE_ROOT BUILD_DIR]      run the tests of the preset coverage before
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "${1:-$ROOT}" || exit
build=${2:-$ROOT/build/coverage}
mkdir -p "$build"

# `GCOVR_EXCL_LINE: reason`, at least two words. The STOP of a block needs no reason, because its START has one.
unreasoned=$(grep -rnE '(GCOVR|LCOV)_EXCL' firmware/src firmware/include |
    grep -vE '_EXCL(_BR)?_STOP|GCOVR_EXCL_(BR_)?(LINE|START): *[^ ]+ +[^ ]{2,}') || true
if [[ -n $unreasoned ]]; then
    echo "$unreasoned" >&2
    die "an exclusion needs its reason on the same line: /* GCOVR_EXCL_LINE: the reason */"
fi

# Tables (.def) have no code in the core; code that a test makes of them does not count.
report() {
    gcovr --root . --object-directory "$build" --filter 'firmware/(src|include)/' --exclude '.*\.def$' "$@" "$build"
}
if ! report --json-summary "$build/coverage.json" --print-summary --fail-under-line 100 --fail-under-branch 100; then
    report            # lines that are missing
    report --branches # and branches
    die "coverage is below 100 %"
fi

# A file that is not in the report was compiled without coverage.
while read -r file; do
    if ! grep -q "\"$file\"" "$build/coverage.json"; then
        die "$file is missing in the report"
    fi
done < <(find firmware/src -name '*.c' | sort)
