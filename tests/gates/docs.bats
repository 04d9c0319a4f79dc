#!/usr/bin/env bats
# Pages: the table of faults, links, commands and defaults, each on a planted mistake in a small project made here.
# shellcheck disable=SC2016 # backticks are what stands in pages
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p docs firmware/include/agv scripts
    printf 'AGV_FAULT(BUS_OFF, TRIP, 14, FIXED)\nAGV_FAULT_EVENT(RX_OVERRUN, WARN, 14, NONE)\n' \
        >firmware/include/agv/fault_table.def
    echo 'AGV_SETTING(gap_ms, 50, 30, 500, "ms", "a gap")' >firmware/include/agv/config_settings.def
    {
        echo '<!-- fault table: made by scripts/tools/fault-docs.py, but for the two columns on the right -->'
        echo '| 0 | `BUS_OFF` | | | | | | the controller says so | always |'
        echo '| 0 | `RX_OVERRUN` | | | | | | frames were lost | always |'
        echo '<!-- end of fault table -->'
    } >docs/faults.md
    printf '# Rows\n\nA gap of 50 ms (`gap_ms`), see `BUS_OFF`, [table](faults.md) and [above](#rows).\n' >docs/requirements.md
    echo '[table](../firmware/include/agv/fault_table.def), [settings](../firmware/include/agv/config_settings.def)' \
        >docs/architecture.md
    printf '#!/bin/sh\n' >scripts/run
    chmod +x scripts/run
    printf '[rows](docs/requirements.md#rows)\n\n```sh\n./scripts/run --fast | sed -n 1p # comment\n```\n' >README.md
    printf '\n```console\n$ sed -n 1p README.md\nno-such-program is only printed\n```\n' >>README.md
    passes "$ROOT/scripts/tools/fault-docs.py" --root "$PWD"
    passes faults
    passes pages
}

faults() {
    "$ROOT/scripts/tools/fault-docs.py" --root "$PWD" --check
}

pages() {
    "$ROOT/scripts/tools/check-docs.py" --root "$PWD"
}

@test "fault table: a class that was changed in the code" {
    sed -i 's/RX_OVERRUN, WARN/RX_OVERRUN, TRIP/' firmware/include/agv/fault_table.def
    fails_with "out of date" faults
}

@test "fault table: a rank that was changed in the code" {
    sed -i '1{h;d};$G' firmware/include/agv/fault_table.def
    fails_with "out of date" faults
}

@test "fault table: an LED code that was changed in the page" {
    sed -i 's/| 14 |/| 13 |/' docs/faults.md
    fails_with "out of date" faults
}

@test "fault table: a fault that may be weakened now" {
    sed -i 's/FIXED/NONE/' firmware/include/agv/fault_table.def
    fails_with "out of date" faults
}

@test "fault table: a new fault without a text" {
    echo 'AGV_FAULT(AI_BUS_OFF, WARN, 14, NONE)' >>firmware/include/agv/fault_table.def
    fails_with "out of date" faults
    fails_with "no text for AI_BUS_OFF" "$ROOT/scripts/tools/fault-docs.py" --root "$PWD"
    fails_with "no text for AI_BUS_OFF" faults
}

@test "fault table: a text for a fault that is gone" {
    sed -i '/RX_OVERRUN/d' firmware/include/agv/fault_table.def
    fails_with "RX_OVERRUN, which is no fault" faults
}

@test "fault table: a row that cannot be read" {
    echo 'AGV_FAULT(AI_BUS_OFF, WARN)' >>firmware/include/agv/fault_table.def
    fails_with "not like AGV_FAULT" faults
}

@test "fault table: an empty table" {
    : >firmware/include/agv/fault_table.def
    fails_with "holds no faults" faults
}

@test "fault table: a page that names a fault that is none" {
    sed -i 's/BUS_OFF/BUS_OUT/' docs/requirements.md
    fails_with "names BUS_OUT, which is no fault" faults
}

@test "pages: a link to a file that is not there" {
    echo '[gone](docs/gone.md)' >>README.md
    fails_with "docs/gone.md leads nowhere" pages
}

@test "pages: a link to a heading that is not there" {
    sed -i 's/^# Rows/# Lines/' docs/requirements.md
    fails_with "names a heading that is not there" pages
}

@test "pages: a script that is not there" {
    rm scripts/run
    fails_with "no command ./scripts/run" pages
}

@test "pages: a program that is not there, behind a pipe" {
    sed -i 's/sed -n/no-such-program -n/' README.md
    fails_with "no command no-such-program" pages
}

@test "pages: a block of commands that would go by" {
    sed -i 's/```sh/```bash/' README.md
    fails_with "is marked sh" pages
}

@test "pages: a default that was changed in the code" {
    sed -i 's/gap_ms, 50/gap_ms, 60/' firmware/include/agv/config_settings.def
    fails_with "50 ms is not the default of gap_ms" pages
}

@test "pages: a setting that is not there" {
    sed -i 's/`gap_ms`/`hole_ms`/' docs/requirements.md
    fails_with "not the default of hole_ms" pages
}

@test "pages: a module that the architecture does not name" {
    mkdir firmware/src
    : >firmware/src/new.c
    fails_with "does not link firmware/src/new.c" pages
}

@test "pages: a program that is not there, in a console" {
    sed -i 's/^\$ sed/$ no-such-program/' README.md
    fails_with "no command no-such-program" pages
}

@test "pages: nothing to check" {
    rm README.md docs/*.md
    fails_with "no page" pages
}

@test "pages: what is marked as for another machine is left alone" {
    printf '```sh not-run-here\nno-such-program\n```\n' >>README.md
    passes pages
}
