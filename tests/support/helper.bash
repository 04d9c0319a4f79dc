# shellcheck shell=bash disable=SC2154,SC2034 # `run` sets status and output; ROOT is for the tests
# Common parts of tests of gates. Each test runs a gate on a seeded fault, and first on the same input without it.
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
: "${BATS_TEST_TMPDIR:=$(mktemp -d)}" # bats before 1.4 has none

# fails_with TEXT COMMAND...: it has to fail, and to say this; a failure for another reason shows nothing.
fails_with() {
    local text=$1
    shift
    run "$@"
    if [[ $status -eq 0 ]]; then
        echo "it passed: $*"
        echo "$output"
        return 1
    fi
    if [[ $output != *"$text"* ]]; then
        echo "it failed, but did not say '$text': $*"
        echo "$output"
        return 1
    fi
}

passes() {
    run "$@"
    if [[ $status -ne 0 ]]; then
        echo "it failed: $*"
        echo "$output"
        return 1
    fi
}
