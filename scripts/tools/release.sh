#!/usr/bin/env bash
# Steps of the release workflow (.github/workflows/release.yml) that can be tried on any computer.
# usage: release.sh check TAG         fails unless the tag is that of this version, and the changelog says that it is released
#        release.sh firmware FOLDER   copies the images of scripts/zephyr-test --boards into the folder, named after their builds
#        release.sh notes             prints the newest section of the changelog
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$ROOT" || exit

version() {
    awk '$1 ~ /^(VERSION_MAJOR|VERSION_MINOR|PATCHLEVEL)$/ { printf "%s%s", dot, $3; dot = "." }' firmware/zephyr/VERSION
}

check() {
    [[ $1 == "v$(version)" ]] || die "the tag $1 is not v$(version), the version in firmware/zephyr/VERSION"
    grep -qxE "## \[$(version)\] - [0-9]{4}-[0-9]{2}-[0-9]{2}" CHANGELOG.md ||
        die "CHANGELOG.md has no date for version $(version)"
}

firmware() {
    local image name count=0
    mkdir -p "$1"
    for image in build/zephyr/firmware-*/zephyr/zephyr.{bin,hex,elf,exe}; do
        if [[ -f $image ]]; then
            name=${image#build/zephyr/}
            cp "$image" "$1/agv-${name%%/*}.${image##*.}"
            count=$((count + 1))
        fi
    done
    ((count > 0)) || die "build/zephyr has no images: run scripts/zephyr-test --boards first"
}

notes() {
    awk '/^## / { sections++ } sections == 1' CHANGELOG.md
}

case ${1:-}:$# in
check:2 | firmware:2) "$1" "$2" ;;
notes:1) notes ;;
*) die "expected 'check TAG', 'firmware FOLDER' or 'notes', not '$*'" ;;
esac
