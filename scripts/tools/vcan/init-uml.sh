#!/bin/sh
# Not busybox at first: it starts its programs by /proc/self/exe, and /proc is that of the host until it is mounted.
# The first process of with-vcan's user-mode-linux, whose root is that of the host: mount what is its own, load the modules, and
# go on with `guest`, which lies beside this file. What it prints goes to the console, as in init.sh.
modules=/usr/lib/uml/modules
export PATH=/usr/sbin:/usr/bin:/sbin:/bin

fail() {
    echo "with-vcan: $*"
    busybox poweroff -f
}

cd "${0%/*}" || fail "the session cannot be read"
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t tmpfs -o mode=755 tmpfs /run || fail "the folder /run is missing"
mkdir -p /run/with-vcan/session /run/with-vcan/bin /run/with-vcan/kmod/lib
mount --bind . /run/with-vcan/session || fail "the session cannot be mounted"
ln -s "$modules" /run/with-vcan/kmod/lib/modules
modprobe -C /dev/null -d /run/with-vcan/kmod -a vcan can-raw can-bcm can-gw sch_tbf sch_netem sch_plug ||
    fail "the modules for CAN cannot be loaded"
for line in 0 1 2 3; do
    busybox stty -F "/dev/ttyS$line" raw -echo || fail "the line $line is missing"
done
busybox --install -s /run/with-vcan/bin
exec /run/with-vcan/bin/sh /run/with-vcan/session/guest
