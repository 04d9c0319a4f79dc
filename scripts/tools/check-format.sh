#!/usr/bin/env bash
# The format of all C files, by clang-format 19 and .clang-format. usage: check-format [--fix] [FILE...]
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

mode=(--dry-run -Werror)
if [[ ${1:-} == --fix ]]; then
    mode=(-i)
    shift
fi
files=("$@")
if ((${#files[@]} == 0)); then
    mapfile -t files < <(c_files)
fi
printf '%s\0' "${files[@]}" |
    xargs -0 -n 50 -P "$(nproc)" clang-format-19 --style="file:$ROOT/.clang-format" "${mode[@]}"
