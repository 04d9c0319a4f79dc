#!/usr/bin/env bash
# Run shellcheck over all shell scripts. usage: check-shell [FILE...]
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$ROOT" || exit

files=("$@")
if ((${#files[@]} == 0)); then
    mapfile -t files < <(find . \( -name build -o -name .git \) -prune -o -type f -print0 |
        xargs -0 grep -lE '^(#!/usr/bin/env (bash|bats)|#!/bin/(ba)?sh|# shellcheck shell=)' | sort)
fi
shellcheck "${files[@]}"
