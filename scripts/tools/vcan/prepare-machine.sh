#!/usr/bin/env bash
# What the virtual machine of with-vcan boots: fetch the distribution's newest kernel, once, and pack an initramfs.
# Prints the folder, build/vcan/RELEASE, that holds `kernel` and `initramfs`. Nothing is installed, and no root is needed.
# A folder that is there is used as it is, without a network; remove build/vcan to fetch the kernel that is newest then.
# shellcheck source=../lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
cache=$ROOT/build/vcan
umask 022 # for all users
init=$ROOT/scripts/tools/vcan/init.sh
modules=(virtio_pci virtio_console 9p 9pnet_virtio vcan can-raw can-bcm can-gw can-dev sch_tbf sch_netem sch_plug)

fail() {
    echo "with-vcan: $*" >&2
    exit 125
}

# The newest kernel that was fetched with these modules; nothing where there is none.
fetched_kernel() {
    local folder
    while read -r folder; do
        if [[ $(cat "$folder/wanted" 2>/dev/null) == "${modules[*]}" ]]; then
            echo "$folder"
            return
        fi
    done < <(printf '%s\n' "$cache"/[0-9]* | sort -Vr)
}

# Whether the initramfs of this folder is there, and newer than all that it was made of.
is_packed() {
    [[ $1/initramfs -nt $init && $1/initramfs -nt ${BASH_SOURCE[0]} && $1/initramfs -nt $1/modules ]]
}

# apt-get or apt-cache; own_lists are options for package lists of our own
apt() {
    "apt-$1" -q -o APT::Sandbox::User= "${own_lists[@]}" "${@:2}" 2>>log
}

# The package of the newest kernel: what those depend on that always mean the newest. The last is Debian's.
kernel_package() {
    local name
    for name in linux-image-generic linux-image-virtual "linux-image-$(dpkg --print-architecture)"; do
        apt cache depends "$name" | sed -nE 's/^ *Depends: (linux-image-(unsigned-)?[0-9].*)$/\1/p'
    done | sed -n 1p
}

# The kernel's packages; Ubuntu has the modules in others beside it, and CAN in the second of these.
download_packages() {
    local image release package
    image=$(kernel_package)
    release=${image#linux-image-}
    release=${release#unsigned-}
    [[ -n $release ]] && apt get download "$image" >>log || return 1
    for package in "linux-modules-$release" "linux-modules-extra-$release"; do
        if [[ -n $(apt cache show "$package") ]]; then
            apt get download "$package" >>log || return 1
        fi
    done
}

# By the system's package lists or, where these are missing or out of date, by lists of our own, which need no root.
download() {
    own_lists=()
    download_packages && return
    rm -f ./*.deb
    mkdir -p lists/partial archives/partial
    own_lists=(-o "Dir::State::Lists=$PWD/lists" -o "Dir::Cache=$PWD" -o "Dir::Cache::Archives=$PWD/archives")
    apt get update >>log || true # the next step tells
    download_packages
}

# The files of the wanted modules of tree/ and of what they need, in the order in which they can be loaded.
modules_in_order() {
    depmod -b tree "$1" >>log 2>&1
    modprobe -d "$PWD/tree" -C "$PWD/no-configuration" -S "$1" -a --show-depends "${modules[@]}" 2>>log |
        sed -nE 's/^insmod (.*[^ ]) *$/\1/p' | awk '!seen[$0]++'
}

# unpack_module FILE FOLDER: uncompressed, for busybox
unpack_module() {
    local name=${1##*/}
    name=${name%%.ko*}.ko
    case $1 in
    *.xz) xz -dc "$1" ;;
    *.zst) zstd -qdc "$1" ;;
    *) cat "$1" ;;
    esac >"$2/$name"
    echo "$name" >>"$2/order"
}

# unpack_kernel FROM TO: an emulated processor takes seconds to unpack it, so QEMU on amd64 gets the kernel that lies in
# the bootable file, where it can start such a one (PVH). For the offsets see "The Linux/x86 Boot Protocol".
unpack_kernel() {
    local begin length unpack
    cp "$1" "$2"
    if [[ $(dpkg --print-architecture) != amd64 ]] || ! grep -qx CONFIG_PVH=y tree/boot/config-*; then
        return
    fi
    begin=$((($(number "$1" $((0x1f1)) 1) + 1) * 512 + $(number "$1" $((0x248)) 4)))
    length=$(number "$1" $((0x24c)) 4)
    case $(number "$1" "$begin" 4) in
    $((0x587a37fd))) unpack=(xz -dc --single-stream) ;;
    $((0xfd2fb528))) unpack=(zstd -dc) ;;
    *) return ;;
    esac
    tail -c +$((begin + 1)) "$1" | head -c "$length" | "${unpack[@]}" >"$2" 2>>log || true # zstd dislikes the last 4 bytes
    if [[ $(number "$2" 0 4) != $((0x464c457f)) ]]; then # no ELF file
        cp "$1" "$2"
    fi
}

# number FILE OFFSET BYTES: the unsigned number there
number() {
    od -An -v --endian=little -t "u$3" -j "$2" -N "$3" "$1" | tr -d ' '
}

# In a folder of its own, which becomes build/vcan/RELEASE when it is complete.
fetch_kernel() {
    local package file release
    download || fail "no kernel could be downloaded (apt-get: $(sed -n 's/^[EW]: //p' log | tail -n 1)): is there a network?"
    for package in *.deb; do
        dpkg-deb -x "$package" tree
    done
    mkdir -p tree/usr
    [[ -e tree/lib ]] || ln -s usr/lib tree/lib # kmod looks in one of them, the package has the other
    [[ -e tree/usr/lib ]] || ln -s ../lib tree/usr/lib
    release=$(basename tree/lib/modules/*)
    mkdir -p "$release/modules"
    unpack_kernel tree/boot/vmlinuz-* "$release/kernel"
    while read -r file; do
        unpack_module "$file" "$release/modules"
    done < <(modules_in_order "$release")
    for file in "${modules[@]}"; do
        if [[ ! -e $release/modules/$file.ko ]] && ! grep -q "/${file//-/[-_]}.ko" "tree/lib/modules/$release/modules.builtin"; then
            fail "the kernel $release has no module $file"
        fi
    done
    echo "${modules[*]}" >"$release/wanted"
    rm -rf "${cache:?}/$release"
    mv "$release" "$cache/"
}

# pack_initramfs FOLDER: busybox, the modules and init, put in place as a whole
pack_initramfs() {
    local name
    mkdir -p initramfs/bin
    cp "$(command -v busybox)" initramfs/bin/
    for name in $(busybox --list); do
        [[ -e initramfs/bin/$name ]] || ln -s busybox "initramfs/bin/$name"
    done
    cp -r "$1/modules" initramfs/
    install -m 755 "$init" initramfs/init
    (cd initramfs && find . | cpio --create --format=newc --owner=0:0 --quiet) >packed
    mv packed "$1/initramfs"
}

kernel=$(fetched_kernel)
if [[ -z $kernel ]] || ! is_packed "$kernel"; then
    mkdir -p "$cache" 2>/dev/null || fail "cannot make the folder $cache"
    [[ -w $cache ]] || fail "cannot write to $cache"
    exec 9>"$cache/.lock"
    flock 9 # one prepares it, the others wait
    rm -rf "$cache"/.work.* # of one that was killed
    work=$(mktemp -d "$cache/.work.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    cd "$work" || exit
    kernel=$(fetched_kernel)
    if [[ -z $kernel ]]; then
        echo "with-vcan: fetching a kernel for the virtual machine, once (about 70 MB) ..." >&2
        fetch_kernel
        kernel=$(fetched_kernel)
    fi
    is_packed "$kernel" || pack_initramfs "$kernel"
fi
echo "$kernel"
