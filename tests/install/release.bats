#!/usr/bin/env bats
# scripts/tools/release.sh: what a release refuses, and the files that it collects.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p scripts/tools firmware/zephyr
    cp "$ROOT"/scripts/tools/{release,lib}.sh scripts/tools/
    printf 'VERSION_MAJOR = 1\nVERSION_MINOR = 2\nPATCHLEVEL = 3\nVERSION_TWEAK = 0\nEXTRAVERSION =\n' >firmware/zephyr/VERSION
    printf '# Changelog\n\n## [1.2.3] - 2026-05-04\n\n- New.\n\n## [1.2.2] - 2026-01-01\n\n- Old.\n' >CHANGELOG.md
    release=$PWD/scripts/tools/release.sh
}

@test "a tag of another version, and a version without a date, are refused" {
    "$release" check v1.2.3
    fails_with "the tag v1.2.4 is not v1.2.3" "$release" check v1.2.4
    fails_with "the tag 1.2.3 is not v1.2.3" "$release" check 1.2.3
    sed -i 's/2026-05-04/not released yet/' CHANGELOG.md
    fails_with "CHANGELOG.md has no date for version 1.2.3" "$release" check v1.2.3
}

@test "the notes are the newest section of the changelog" {
    [[ $("$release" notes) == $'## [1.2.3] - 2026-05-04\n\n- New.' ]]
}

@test "images are named after their builds; none at all is a failure" {
    fails_with "build/zephyr has no images" "$release" firmware out
    mkdir -p build/zephyr/firmware-nucleo_x/zephyr build/zephyr/firmware-native/zephyr build/zephyr/port/zephyr
    touch build/zephyr/firmware-nucleo_x/zephyr/zephyr.{bin,elf,map} build/zephyr/firmware-native/zephyr/zephyr.exe
    touch build/zephyr/port/zephyr/zephyr.exe
    "$release" firmware out
    [[ $(ls out) == $'agv-firmware-native.exe\nagv-firmware-nucleo_x.bin\nagv-firmware-nucleo_x.elf' ]]
}
