#!/bin/busybox sh
# shellcheck shell=dash
# The first process of with-vcan's virtual machine, once the host's files are its root: run the command.
#
# The session, a folder of the host at /run/with-vcan/session, holds `settings` and `command`. The bytes of the command go
# through the ports stdin, stdout and stderr: of virtio in QEMU, serial lines in user-mode-linux. Over the port control come
# `signal NAME` and `closed STREAM`; `ready` goes, and in the end `exit STATUS STDOUT-BYTES STDERR-BYTES`: with-vcan ends the
# machine once it has got so many.
here=/run/with-vcan
export PATH=$here/bin
session=$here/session
streams=$here/streams
job=/sys/fs/cgroup/command

fail() {
    echo "with-vcan: $*"
    poweroff -f
}

mount_rest() {
    mkdir -p /dev/pts /dev/shm /run/lock
    mount -t devpts -o gid=5,mode=620,ptmxmode=666 devpts /dev/pts
    mount -t tmpfs -o mode=1777 tmpfs /dev/shm
    mount -t cgroup2 cgroup2 /sys/fs/cgroup
    chmod 1777 /run/lock
    ln -s /proc/self/fd /dev/fd
    ln -s fd/0 /dev/stdin
    ln -s fd/1 /dev/stdout
    ln -s fd/2 /dev/stderr
}

# The clock that the kernel read counts whole seconds. A new file of the host is stamped with the host's time, one made just
# before it here with ours: set right by the difference, however long the programs take that do it.
set_clock() {
    touch $here/now $session/now
    difference=$(/usr/bin/stat -c %.9Y $session/now $here/now | awk 'NR == 1 { a = $1 } END { printf "%+.6f", a - $1 }')
    /usr/bin/date -s "now $difference seconds" >/dev/null
}

raise_interfaces() {
    ip link set dev lo up
    for name in "$@"; do
        { ip link add dev "$name" type vcan && ip link set dev "$name" up; } || fail "no interface $name"
    done
}

# port NAME: its device; one of virtio appears a little after the module was loaded
port() {
    case $1:${machine:?} in
    stdin:uml) echo /dev/ttyS0 && return ;;
    stdout:uml) echo /dev/ttyS1 && return ;;
    stderr:uml) echo /dev/ttyS2 && return ;;
    control:uml) echo /dev/ttyS3 && return ;;
    esac
    for _ in $(seq 200); do
        for folder in /sys/class/virtio-ports/*; do
            if [ "$(cat "$folder/name")" = "$1" ]; then
                echo "/dev/${folder##*/}"
                return
            fi
        done
        usleep 50000
    done
}

# copy_out STREAM: from the command to with-vcan, and count
copy_out() {
    # shellcheck disable=SC2016 # for the inner shell: its number becomes that of tee
    sh -c 'echo $$ >"$0.copier"; exec tee "$1"' "$streams/$1" "$(port "$1")" | wc -c >"$streams/$1.bytes"
}

# The input of the command. A serial line has no end of file: pieces come, each after a line with its size, at the end 0.
copy_in() {
    if [ "$machine" != uml ]; then
        exec cat "$(port stdin)"
    fi
    while read -r size && [ "$size" -gt 0 ]; do
        /usr/bin/dd bs=64k count="$size" iflag=count_bytes,fullblock status=none || return
    done <"$(port stdin)"
}

# A terminal sends the first three to a whole group; the others are meant for one.
pass_on() {
    case $1 in
    INT | QUIT | HUP) kill -s "$1" "-$command" || kill -s "$1" "$command" ;;
    *) kill -s "$1" "$command" ;;
    esac
}

listen() {
    while read -r what name; do
        read -r command <$streams/command
        case $what in
        signal) pass_on "$name" ;;
        closed) kill "$(cat "$streams/$name.copier")" ;;
        esac
    done
}

# run_command <INPUT 4>OUTPUT 5>ERRORS: in the foreground, where no signal is ignored; in a group of its own, for a signal to
# reach all of it; and in a control group, so that nothing outlives it.
run_command() {
    mkdir $job
    (
        exec >&4 2>&5 4>&- 5>&-
        chown "${owner:?}" /dev/stdin /dev/stdout /dev/stderr # who does not own a pipe cannot open it anew
        # shellcheck disable=SC2016 # for the inner shell: its number becomes the command's
        exec sh -c 'echo $$ >'$job'/cgroup.procs; echo $$ >'$streams'/command; echo ready >&3
            exec 3>&- setsid /bin/bash '$session/command
    )
    echo $? >$streams/status
    echo 1 >$job/cgroup.kill
}

# The command has pipes of its own, so it gets SIGPIPE when nobody reads any more. They have no name: to open /dev/stdin or
# /dev/stdout anew would wait for ever for the other end of one that has. Nobody waits for the input to end.
run_in_pipes() {
    (copy_in &) |
        if [ -n "$merged" ]; then
            run_command 4>&1 5>&1 | copy_out stdout
        else
            { run_command 5>&1 | copy_out stderr 4>&-; } 4>&1 | copy_out stdout
        fi
}

bytes_of() {
    cat "$streams/$1.bytes" 2>/dev/null || echo 0
}

mount_rest
# shellcheck source=/dev/null
. $session/settings || fail "the session cannot be read"
clock=
if [ "$machine" = qemu ]; then # user-mode-linux has the clock of the host
    set_clock &
    clock=$!
fi
hostname "${host_name:?}"
# shellcheck disable=SC2154,SC2086 # a list of words
raise_interfaces $interfaces
exec 3<>"$(port control)" || fail "the control port is missing"
mkdir $streams
listen <&3 &
if [ -n "$clock" ]; then
    wait $clock
fi
run_in_pipes
sync
echo "exit $(cat $streams/status) $(bytes_of stdout) $(bytes_of stderr)" >&3
sleep 1000000
