#!/usr/bin/env bash
# Fetch the sources of libyaml, jansson and zlib from the distribution, to compile them for WebAssembly: into
# build/wasm-libraries, without root and without a change of the system's package sources.
# Called by the build of the preset wasm; does nothing if they are there.
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

folder=$ROOT/build/wasm-libraries
packages=(libyaml jansson zlib)

mkdir -p "$folder"
exec 9>"$folder/.lock"
flock 9 # several build trees share them
if [[ -e $folder/.complete ]]; then
    exit 0
fi
command -v apt-get >/dev/null ||
    die "this is not Debian or Ubuntu: unpack the sources of ${packages[*]} as $folder/NAME, then create $folder/.complete"
command -v dpkg-source >/dev/null || die "'dpkg-source' is missing: run ./scripts/install-deps"

# The package sources of the system, for source packages only.
mkdir -p "$folder"/apt/{parts,lists/partial,cache/archives/partial}
: >"$folder/apt/sources.list"
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
    case $list in
    *.sources) sed 's/^Types:.*/Types: deb-src/' "$list" >"$folder/apt/parts/${list##*/}" ;;
    *.list) if [[ -e $list ]]; then sed -nE 's/^deb(-src)? /deb-src /p' "$list" >>"$folder/apt/sources.list"; fi ;;
    esac
done
sort -u -o "$folder/apt/sources.list" "$folder/apt/sources.list"
options=(-q -o "Dir::Etc::SourceList=$folder/apt/sources.list" -o "Dir::Etc::SourceParts=$folder/apt/parts"
    -o "Dir::State::Lists=$folder/apt/lists" -o "Dir::Cache=$folder/apt/cache" -o "APT::Sandbox::User=$(id -un)")

cd "$folder"
apt-get "${options[@]}" update >update.log 2>&1 || true # a source without source packages does not matter
for package in "${packages[@]}"; do
    rm -rf "$package" "$package"-*/
    apt-get "${options[@]}" --only-source source "$package" >"$package.log" 2>&1 ||
        die "apt-get has no source of $package (log: $folder/$package.log): is there a network?"
    mv "$package"-*/ "$package"
done
rm -rf apt ./*.dsc ./*.tar.* update.log
touch .complete
