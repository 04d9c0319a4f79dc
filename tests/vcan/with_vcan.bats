#!/usr/bin/env bats
# scripts/with-vcan: a virtual machine (WAY in the environment: qemu or uml), and the network namespace; the latter inside the
# machine where the kernel that runs the tests has no CAN. A start of the machine takes seconds, so a test looks at many things.
# shellcheck disable=SC2016 # what stands in '' is for the shell in there
load ../support/helper

setup_file() {
    export WAY=${WAY:-qemu}
    "$ROOT/scripts/with-vcan" --quiet --with "$WAY" true # a new machine fetches its kernel, and says so
}

setup() {
    unset LC_ALL
    cd "$BATS_TEST_TMPDIR" || exit
    vcan=$ROOT/scripts/with-vcan
}

# Whether two texts are the same, and what differs
same() {
    diff <(printf '%s\n' "$1") <(printf '%s\n' "$2")
}

# Wait until a file is there.
await() {
    local tries
    for ((tries = 0; tries < 600; tries++)); do
        [[ ! -e $1 ]] || return 0
        sleep 0.1
    done
    echo "there is no $1"
    return 1
}

# Wait until a process is gone, or waits for its parent only.
await_end() {
    local tries
    for ((tries = 0; tries < 100; tries++)); do
        [[ $(ps -o stat= -p "$1") == [^Z]* ]] || return 0
        sleep 0.1
    done
    echo "it still runs: $1"
    return 1
}

# Run a command where there is a namespace for with-vcan: here, or in the machine.
with_can_kernel() {
    if "$vcan" --quiet --with namespace true 2>/dev/null; then
        "$@"
    else
        "$vcan" --quiet --with "$WAY" "$@"
    fi
}

# What a command must find, whichever way it came there: printed by the command, compared with what is so outside.
look_around() {
    cat >look <<'END'
pwd; umask; id -u; printf '<%s>' "$@" "$PLANTED" "${LC_ALL-unset}"; echo; ip -br link | cut -d ' ' -f 1
END
}
surroundings() {
    pwd
    umask
    id -u
    printf '<%s>' "$@" "$PLANTED" unset
    printf '\nlo\nvcan0\nvcan1\nvcan2\n'
}

@test "machine: arguments, environment, folder, umask, clock, files, both outputs, status" {
    mkdir 'a folder'
    cd 'a folder' || exit
    echo outside >file
    umask 027
    export PLANTED=$'two\nlines and a "quote"'
    look_around
    # shellcheck disable=SC1003 # a backslash, and no quote
    local arguments=('' 'a b' "it's" $'new\nline' '*' '$HOME' '\' $'\xff') status=0
    "$vcan" --with "$WAY" bash -c '. ./look; cat file; echo inside >>file; echo made >new; date +%s.%N >first
        sleep 1; date +%s.%N >now; echo told >/dev/stderr; exit 77' bash "${arguments[@]}" >../out 2>../err || status=$?
    [[ $status -eq 77 ]]
    same "$(surroundings "${arguments[@]}"; echo outside)" "$(<../out)"
    same 'told' "$(sed 1d ../err)"
    [[ $(head -n 1 ../err) =~ ^"with-vcan: "("virtual machine (qemu-system-"[^,]+", tcg)"|user-mode-linux)", kernel "[^,]+", vcan0 vcan1 vcan2"$ ]]
    same $'outside\ninside\nmade' "$(cat file new)"
    # A second is a second, and the clock is right: the host has stamped the file when the first time was written.
    paste now <(stat -c %.9Y first now)
    awk 'NR == 1 { a = $1 } END { exit !($1 - a > 0.999 && $1 - a < 5) }' first now
    awk -v stamp="$(stat -c %.9Y first)" '{ exit !(stamp - $1 > -0.05 && stamp - $1 < 0.5) }' first
}

@test "machine: bytes in and out, 5 MB of them; outputs that are one keep their order; nothing outlives the command" {
    head -c 5000000 /dev/urandom >bytes
    "$vcan" --with "$WAY" --quiet bash -c 'sleep 1000 & tee copy && sha256sum <copy >&2' <bytes >out 2>err
    cmp bytes out
    [[ $(cut -d ' ' -f 1 err) == "$(sha256sum <bytes | cut -d ' ' -f 1)" ]]

    "$vcan" --with "$WAY" --quiet bash -c 'for i in {1..200}; do echo $i; echo $i >&2; done; kill -KILL $$' </dev/null >both 2>&1 ||
        status=$?
    [[ ${status:-0} -eq 137 ]]
    same "$(for i in {1..200}; do printf '%s\n%s\n' "$i" "$i"; done)" "$(<both)"
}

# A start that comes as far as QEMU.
start_only() {
    fails_with "ended before the command did" /usr/bin/python3 -I "$ROOT/scripts/tools/vcan/run-machine.py" --kernel "$PWD" \
        --qemu false --accel tcg --interfaces vcan0 -- true
}

# The folders that with-vcan has for its machines.
folders() {
    find "$TMPDIR" -maxdepth 1 -name 'with-vcan.*' | wc -l
}

@test "machine: signals reach the command, which ends as it likes; killed, with-vcan takes its machine along" {
    export TMPDIR=$PWD
    env --default-signal=INT "$vcan" --with "$WAY" --quiet bash -c 'trap "echo term; : >told" TERM; trap "echo int; exit 9" INT
        : >started; while :; do sleep 0.1; done' </dev/null >out 3>&- &
    local command=$! victim machine status=0
    "$vcan" --with "$WAY" --quiet sh -c ': >running; sleep 1000' </dev/null 3>&- &
    victim=$!
    await started
    kill -TERM $command
    await told
    kill -INT $command
    wait $command || status=$?
    [[ $status -eq 9 ]]
    same $'term\nint' "$(<out)"

    await running
    machine=$(pgrep -P $victim 'qemu-system|linux.uml')
    start_only
    [[ $(folders) -eq 1 ]]
    kill -KILL $victim
    await_end "$machine"
    start_only # clears up
    [[ $(folders) -eq 0 ]]
}

@test "namespace: arguments, environment, user, status and signals; of each interface its own frames" {
    # As many as a socket keeps while the computer has no time for candump.
    awk 'BEGIN { for (i = 0; i < 300; i++) printf "(%.6f) vcan0 %03X#%016X\n", 1 + i / 1000, i, i * i }' >sent
    look_around
    cat >inside <<'END'
PLANTED=$'two\nlines' "$vcan" --with namespace bash look 'a b' $'new\nline' >out 2>err
"$vcan" --with namespace --quiet bash -c 'exit 77'
echo $? >statuses
"$vcan" --with namespace --quiet bash -c 'kill -KILL $$'
echo $? >>statuses
"$vcan" --with namespace --quiet bash -c 'trap "exit 9" TERM; : >started; while :; do sleep 0.1; done' &
until [[ -e started ]]; do sleep 0.1; done
kill -TERM $!
wait $!
echo $? >>statuses
setpriv --reuid 1234 --regid 1234 --clear-groups "$vcan" --with namespace --quiet \
    bash -c 'id -u && ip link set vcan2 down && ip -br link' >user 2>&1
"$vcan" --with namespace --quiet bash -c '
    candump -L -n 300 -T 5000 vcan0 >received & candump -L -n 1 -T 5000 vcan1 >other &
    sleep 0.5
    canplayer -I sent
    cansend vcan1 7FF#C0FFEE
    wait'
END
    # shellcheck disable=SC2154
    vcan=$vcan with_can_kernel bash inside
    same "$(PLANTED=$'two\nlines' surroundings 'a b' $'new\nline')" "$(<out)"
    [[ $(<err) == "with-vcan: network namespace, kernel "*", vcan0 vcan1 vcan2" ]]
    same $'77\n137\n9' "$(<statuses)"
    same "$(cut -d ' ' -f 3 sent)" "$(cut -d ' ' -f 3 received)"
    same '7FF#C0FFEE' "$(cut -d ' ' -f 3 other)"
    if ((EUID == 0)) && setpriv --reuid 1234 --regid 1234 --clear-groups test -r "$vcan"; then
        cat user
        [[ $(head -n 1 user) == 1234 && $(<user) == *vcan2*DOWN* ]]
    fi
}

# A PATH with the commands that with-vcan is made of, and those named.
only() {
    local name
    mkdir -p bin
    for name in bash env dirname basename readlink uname "$@"; do
        ln -sf "$(command -v "$name")" bin/
    done
}

@test "no way: one line that says why and what to do, and 125" {
    only setpriv ip
    printf '#!/bin/sh\necho "unshare failed: Operation not permitted" >&2\nexit 1\n' >bin/unshare
    chmod +x bin/unshare
    run env PATH="$PWD/bin" "$vcan" true
    echo "$output"
    [[ $status -eq 125 && ${#lines[@]} -eq 1 ]]
    [[ $output == "with-vcan: namespace: no vcan in kernel "*" (unshare failed: Operation not permitted); uml: 'linux.uml' is \
missing: run 'scripts/install-deps vcan'; qemu: 'qemu-system-"*"' is missing: run 'scripts/install-deps vcan'" ]]
    run env PATH="$PWD/bin" "$vcan" --with qemu true
    [[ $status -eq 125 && ${#lines[@]} -eq 1 && $output == "with-vcan: qemu: 'qemu-system-"* ]]
    run env PATH="$PWD/bin" "$vcan" --with namespace true
    [[ $status -eq 125 && ${#lines[@]} -eq 1 && $output == "with-vcan: namespace: no vcan in kernel "* ]]
}

@test "uml: one that crashes at its start: it says so, and goes on to QEMU with the whole input; asked for, 125" {
    mkdir bin
    printf '#!/bin/sh\n[ "$1" = --version ] || kill -SEGV $$\n' >bin/linux.uml
    chmod +x bin/linux.uml
    run env PATH="$PWD/bin:$PATH" "$vcan" --with uml true
    [[ $status -eq 125 && ${lines[1]} == "with-vcan: the virtual machine ended before the command did" ]]
    if ! "$vcan" --quiet --with namespace true 2>/dev/null; then # which would come first
        echo input | PATH=$PWD/bin:$PATH "$vcan" sh -c 'cat; exit 7' >out 2>err || status=$?
        [[ $status -eq 7 && $(<out) == input ]]
        cat err
        [[ $(sed -n 2p err) == "with-vcan: user-mode-linux does not start here: "* && $(sed -n 3p err) == *"(qemu-system-"* ]]
    fi
}

@test "options: help, and in one line what is wrong" {
    run "$vcan" --help
    [[ $status -eq 0 && $output == "usage: with-vcan "* ]]
    for bad in "" --slow "--quiet --" "--with xen true" "--with uml --with qemu true" "--with uml --steady true"; do
        # shellcheck disable=SC2086 # several words
        run "$vcan" $bad
        [[ $status -eq 2 && ${#lines[@]} -eq 1 && $output == "with-vcan: "* ]]
    done
    run env AGV_VCAN_ACCEL=xen "$vcan" true
    [[ $status -eq 2 && $output == *"not tcg or kvm"* ]]
}
