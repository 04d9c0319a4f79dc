#!/usr/bin/env bats
# `cmake --install`: the installed programs need nothing of the source tree, and another project can use the core.
# AGV_BUILD: the build folder.

setup_file() {
    export PREFIX=$BATS_FILE_TMPDIR/moved
    cmake --install "$AGV_BUILD" --prefix "$BATS_FILE_TMPDIR/first" >"$BATS_FILE_TMPDIR/log"
    mv "$BATS_FILE_TMPDIR/first" "$PREFIX"
    cd /
}

@test "the installed host_sim plays the demo and finds its scenarios, in a folder that was moved" {
    run "$PREFIX/bin/host_sim" demo
    [ "$status" -eq 0 ]
    [[ ${lines[-1]} == "All 31 expectations passed." ]]
    "$PREFIX/bin/host_sim" demo --scenario park_at_standstill
}

@test "man pages and completion are installed, and the examples of the help are found" {
    compgen -G "$PREFIX/share/man/man1/host_sim.1*"
    [ "$(find "$PREFIX/share/man/man1" -name 'host_sim-*' | wc -l)" -eq "$("$PREFIX/bin/host_sim" --help | grep -c '^  [a-z][a-z]* \{2,\}')" ]
    [ -s "$PREFIX/share/bash-completion/completions/host_sim" ]
    [ -s "$PREFIX/share/zsh/site-functions/_host_sim" ]
    [ -s "$PREFIX/share/fish/vendor_completions.d/host_sim.fish" ]
    run "$PREFIX/bin/host_sim" help replay
    [[ $output == *"host_sim replay $PREFIX/share/agv-supervisor/examples/ai-stops.log"* ]]
}

@test "the links between the installed pages hold" {
    cd "$PREFIX/share/doc/agv-supervisor"
    [ -f CHANGELOG.md ]
    local links
    mapfile -t links < <(grep -oE '\(docs/[^)#]+' README.md | cut -c2-)
    [ "${#links[@]}" -gt 20 ]
    for link in "${links[@]}"; do
        [ -f "$link" ] || { echo "$link" && return 1; }
    done
}

@test "the JSON Schemas are installed as the program prints them" {
    for file in scenario config; do
        diff <("$PREFIX/bin/host_sim" "$file" --schema) "$PREFIX/share/agv-supervisor/schemas/$file.schema.json"
    done
}

@test "a scenario that is not shipped is named with the installed folder" {
    run "$PREFIX/bin/host_sim" demo --scenario none
    [ "$status" -eq 2 ]
    [[ $output == "host_sim: --scenario: no scenario 'none'; the shipped scenarios are the .yaml files in the folders of $PREFIX/"*"/scenarios" ]]
}

@test "another project finds the core, links it with a port of its own, and runs" {
    local work=$BATS_TEST_TMPDIR
    cp "$BATS_TEST_DIRNAME"/foreign/* "$work"
    cmake -S "$work" -B "$work/build" -DCMAKE_PREFIX_PATH="$PREFIX" >"$work/log"
    cmake --build "$work/build" >>"$work/log"
    run "$work/build/foreign"
    [ "$status" -eq 0 ]
    [ "$output" = TRIPPED ]
}
