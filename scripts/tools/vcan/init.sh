#!/bin/busybox sh
# shellcheck shell=dash
# The first process of with-vcan's virtual machine, in its initramfs: load the modules, mount the host's files, and go on
# there with `guest`. What it prints goes to the console, whose line with-vcan shows when the machine fails.

fail() {
    echo "with-vcan: $*"
    poweroff -f
}

# mount_host TAG FOLDER CACHE
mount_host() {
    mount -t 9p -o "trans=virtio,version=9p2000.L,msize=512000,cache=$3" "$1" "$2" ||
        fail "the folder $2 of the host cannot be mounted"
}

mkdir -p /proc /sys /dev /root
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
while read -r module; do
    insmod "/modules/$module" || fail "the module $module cannot be loaded"
done </modules/order

# mmap: what one side writes the other sees at once, and files can be mapped. loose: programs start far sooner, but what
# the host changes there afterwards is not seen.
mount_host root /root mmap
mount_host usr /root/usr loose
mount -t tmpfs -o mode=755 tmpfs /root/run || fail "the folder /run is missing"
mkdir -p /root/run/with-vcan/session
mount_host session /root/run/with-vcan/session none
for folder in proc sys dev; do
    mount -o move "/$folder" "/root/$folder" || fail "the folder /$folder is missing"
done

# busybox goes along: from memory it starts much faster than the host's programs.
cp -a /bin /root/run/with-vcan/
exec switch_root /root /run/with-vcan/bin/sh /run/with-vcan/session/guest
