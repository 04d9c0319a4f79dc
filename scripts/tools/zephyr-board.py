#!/usr/bin/python3
"""What a board can do for the supervisor, from the devicetree and the configuration of a build.

usage: zephyr-board.py settings FILE|CONFIG_AGV_NAME=VALUE...     refuse a value that its Kconfig symbol cannot have; the last
                                        one of a symbol counts (the build of the firmware does this, before Zephyr reads them)
       zephyr-board.py check BUILD      refuse mistakes, one line each (the build of the firmware does this)
       zephyr-board.py bootloader BUILD BUILD-OF-MCUBOOT     refuse a bootloader that overwrites what outlives a reset
       zephyr-board.py header BUILD     the facts as a C header (the build of the firmware does this)
       zephyr-board.py table [--write] BUILD...     the facts as a table; --write puts it into docs/firmware.md

BUILD is the build folder of firmware/zephyr, or of MCUboot. Exit code 2: the build is refused.
"""
import argparse
import os
import pathlib
import pickle
import re
import sys

import tables

BEGIN = "<!-- board table: made by scripts/tools/zephyr-board.py -->"
END = "<!-- end of board table -->"
NODE = "agv,supervisor"
PINS = ("safety-output-gpios", "feedback-gpios", "estop-gpios", "reset-gpios")
NOT_A_BUS = ("zephyr,can-loopback", "zephyr,fake-can", "zephyr,native-linux-can")

# Watchdogs whose window the port can set: compatible, name. Zephyr's driver sets it, or the port itself.
WINDOWS = {
    "st,stm32-window-watchdog": "WWDG",
    "nxp,wdog32": "WDOG",
    "nxp,kinetis-wdog32": "WDOG",
}
WATCHDOGS = {"st,stm32-watchdog": "IWDG", **WINDOWS}

# What the chip's reference manual says of brown-out reset and memory errors, and what the port makes of it.
OPTION = "option bytes, level read at the start"
PARITY = "flash: ECC; RAM: parity by option byte; an error ends the run (NMI)"
CHIPS = {
    "stm32g0x": (OPTION, PARITY),
    "stm32g4x": (OPTION, PARITY),
    "stm32h743": (OPTION, "flash and RAM: ECC; of the RAM read at every tick: SELF_TEST_FAILED"),
    "stm32h753": (OPTION, "flash and RAM: ECC; of the RAM read at every tick: SELF_TEST_FAILED"),
    "stm32h7": (OPTION, "flash and RAM: ECC, not used"),
    "s32k1": ("low-voltage reset, always on", "flash and RAM: ECC, not used"),
    "s32k3": ("low-voltage reset, always on", "flash and RAM: ECC, not used"),
}

KCONFIG_FILES = ("firmware/zephyr/Kconfig", "firmware/zephyr/Kconfig.settings", "firmware/zephyr/Kconfig.watchdog", "hal/zephyr/Kconfig")
NUMBERS = {"int": "decimal number", "hex": "hexadecimal number (0x...)"}


class Refused(Exception):
    """A mistake of the user, in one line."""


class Build:
    """Devicetree and configuration of a build folder."""

    def __init__(self, folder, base=None):
        self.zephyr = folder / "zephyr"
        pickled = self.zephyr / "edt.pickle"
        if not pickled.exists() or not (self.zephyr / ".config").exists():
            raise Refused(f"{folder} is no build folder of Zephyr: zephyr/edt.pickle or zephyr/.config is missing")
        sys.path.insert(0, str((base or zephyr_base(folder)) / "scripts/dts/python-devicetree/src"))
        with pickled.open("rb") as file:
            self.devicetree = pickle.load(file)
        text = (self.zephyr / ".config").read_text(encoding="utf-8")
        self.config = dict(re.findall(r"^CONFIG_(\w+)=(.*)$", text, re.MULTILINE))

    def has(self, *symbols):
        return any(self.config.get(symbol) == "y" for symbol in symbols)

    def node(self):
        nodes = self.devicetree.compat2okay.get(NODE, [])
        return nodes[0] if nodes else None

    def chosen(self, name):
        return self.devicetree.chosen_nodes.get(name)

    def alias(self, name):
        nodes = [node for node in self.devicetree.nodes if name in node.aliases]
        return nodes[0] if nodes else None


def symbols():
    """Type and range of each symbol of the application."""
    root = pathlib.Path(__file__).resolve().parents[2]
    known, name = {}, None
    for file in KCONFIG_FILES:
        for line in (root / file).read_text(encoding="utf-8").splitlines():
            if found := re.match(r"(?:menu)?config (AGV_\w+)", line):
                name = found[1]
                known[name] = {"type": "bool", "range": None}
            elif found := re.match(r"\t(int|hex)\b", line):
                known[name]["type"] = found[1]
            elif found := re.match(r"\trange (\w+) (\w+)$", line):
                known[name]["range"] = found.groups()
    return known


def requested(sources):
    """(symbol, value, where it is written) of each symbol of the application: the last one counts, as for Zephyr."""
    last = {}
    for source in sources:
        is_value = source.startswith("CONFIG_AGV_")
        lines = [source] if is_value else pathlib.Path(source).read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines, 1):
            if found := re.match(r"\s*CONFIG_(AGV_\w+)=(.*?)\s*$", line):
                last[found[1]] = (found[2], "" if is_value else f"{source}:{number}: ")
    return [(name, *rest) for name, rest in last.items()]


def check_settings(sources):
    known = symbols()
    for name, value, where in requested(sources):
        if name not in known:
            raise Refused(f"{where}CONFIG_{name}: there is no such setting")
        kind, limits = known[name]["type"], known[name]["range"]
        if kind == "bool":
            if value not in ("y", "n"):
                raise Refused(f"{where}CONFIG_{name}={value}: it must be y or n")
            continue
        wanted = f"it must be {limits[0]} to {limits[1]}"
        if not re.fullmatch(r"0[xX][0-9a-fA-F]+" if kind == "hex" else r"-?[0-9]+", value):
            raise Refused(f"{where}CONFIG_{name}={value} is no {NUMBERS[kind]}: {wanted}")
        base = 16 if kind == "hex" else 10
        if not int(limits[0], base) <= int(value, base) <= int(limits[1], base):
            raise Refused(f"{where}CONFIG_{name}={value} is out of range: {wanted}")


def zephyr_base(folder):
    """Where the build found Zephyr."""
    cache = folder / "CMakeCache.txt"
    text = cache.read_text(encoding="utf-8") if cache.exists() else ""
    found = re.search(r"^(?:CACHED_)?ZEPHYR_BASE:\w+=(.+)$", text, re.MULTILINE)
    base = found[1] if found else os.environ.get("ZEPHYR_BASE", "")
    if not base:
        raise Refused("ZEPHYR_BASE is not set")
    return pathlib.Path(base)


def label(node):
    return "&" + node.labels[0] if node.labels else node.path


def pin_text(entry):
    return f"{label(entry.controller)} {entry.data.get('pin', '?')}"


def is_disabled(node):
    return node.status not in ("okay", "ok")


def require_enabled(name, node, more=""):
    if is_disabled(node):
        raise Refused(f'devicetree: {name}: {label(node)} is disabled: write {label(node)} {{ status = "okay"; }};{more}')


def check_node(build):
    nodes = build.devicetree.compat2okay.get(NODE, [])
    if not nodes:
        raise Refused(f'devicetree: no node has compatible = "{NODE}": write one into boards/<board>.overlay, as '
                      "hal/zephyr/dts/bindings/agv,supervisor.yaml shows")
    if len(nodes) > 1:
        raise Refused(f'devicetree: {len(nodes)} nodes have compatible = "{NODE}": a chip has one supervisor, delete the others')
    if "agv_supervisor" not in nodes[0].labels:
        raise Refused(f"devicetree: {nodes[0].path} needs the label agv_supervisor: write agv_supervisor: {nodes[0].name} {{")


def check_controller(build, name):
    """A CAN controller that is enabled and has a driver that reaches a bus."""
    controller = build.node().props[name].val
    if "sample-point" not in controller._binding.prop2specs:  # of can-controller.yaml; edtlib has no public question for it
        raise Refused(f"devicetree: {name} = <{label(controller)}> is no CAN controller")
    require_enabled(name, controller, " with its pins")
    if build.has("AGV_RELEASE") and controller.matching_compat in NOT_A_BUS:
        raise Refused(f"release: {name} = <{label(controller)}> is {controller.matching_compat}, which reaches no bus: name a controller "
                      "of the chip")


def check_controllers(build):
    props = build.node().props
    check_controller(build, "vehicle-can")
    if not build.has("AGV_TOPOLOGY_GATEWAY"):
        return
    if "ai-can" not in props:
        raise Refused("devicetree: a gateway (CONFIG_AGV_TOPOLOGY_GATEWAY) needs ai-can: write ai-can = <&your_second_controller>; "
                      "into the node agv_supervisor")
    check_controller(build, "ai-can")
    if props["ai-can"].val is props["vehicle-can"].val:
        raise Refused(f"devicetree: ai-can and vehicle-can are both <{label(props['ai-can'].val)}>: a gateway needs two controllers")


def pins_of(build):
    """(property, controller and pin) of each pin that the supervisor uses."""
    props = build.node().props
    pins = [(name, entry) for name in PINS if name in props for entry in props[name].val]
    led = props["alarm-led"].val
    if "gpios" not in led.props:
        raise Refused(f"devicetree: alarm-led = <{label(led)}> has no pin: name a child of a node with compatible = \"gpio-leds\"")
    return pins + [("alarm-led", entry) for entry in led.props["gpios"].val]


def check_pins(build):
    led = build.node().props["alarm-led"].val
    for node in (led, led.parent):
        require_enabled("alarm-led", node)
    seen = {}
    for name, entry in pins_of(build):
        require_enabled(name, entry.controller)
        if entry.controller.bus_node is not None:
            raise Refused(f"devicetree: {name} is a pin of <{label(entry.controller)}>, which is behind a bus: use a pin of the "
                          "processor, which can be set in an interrupt")
        pin = (entry.controller.path, entry.data.get("pin"))
        if pin in seen:
            raise Refused(f"devicetree: {seen[pin]} and {name} are the same pin, {pin_text(entry)}")
        seen[pin] = name


def check_second_clock(build):
    clock = build.node().props.get("second-clock")
    if clock is None:
        return
    require_enabled("second-clock", clock.val)
    kind = pathlib.Path(clock.val.binding_path or "/").parent.name  # edtlib has no question for a driver's interface
    if kind not in ("counter", "rtc", "timer") and not build.has("ZTEST"):
        raise Refused(f"devicetree: second-clock = <{label(clock.val)}> is no counter")


def check_log(build):
    log = build.node().props.get("log-partition")
    if log is not None and (log.val.parent is None or "fixed-partitions" not in log.val.parent.compats):
        raise Refused(f"devicetree: log-partition = <{label(log.val)}> is no partition: name a child of a node with compatible = "
                      '"fixed-partitions"')
    flash = log.val.parent.parent if log is not None else None
    erase = flash.props.get("max-erase-time") if flash is not None else None
    if erase is None:
        return
    period_ms = int(build.config["AGV_WATCHDOG_PERIOD_MS"])
    longest_ms = (period_ms - 20) // 2  # two sectors, one after the other, and a margin
    if erase.val > longest_ms:
        raise Refused(f"devicetree: a sector of <{label(flash)}> takes up to {erase.val} ms to erase, and within "
                      f"CONFIG_AGV_WATCHDOG_PERIOD_MS={period_ms} there is time for two of at most {longest_ms} ms: leave log-partition out")


def retained_memory(build):
    """The node of the memory that outlives a reset, or None: then it is a part of zephyr,sram."""
    named = build.node().props.get("retained-memory")
    return named.val if named is not None else build.chosen("zephyr,dtcm")


def overlap(one, other):
    a, b = one.regs[0], other.regs[0]
    return a.addr < b.addr + b.size and b.addr < a.addr + a.size


def check_retained(build):
    memory, ram = retained_memory(build), build.chosen("zephyr,sram")
    if memory is None:
        if build.has("BOOTLOADER_MCUBOOT"):
            raise Refused("devicetree: a bootloader overwrites what outlives a reset: write retained-memory = <&a_region>; into the node "
                          "agv_supervisor, and leave the region out of zephyr,sram of both programs")
        return
    if "zephyr,memory-region" not in memory.compats:
        raise Refused(f'devicetree: retained-memory = <{label(memory)}> needs compatible = "zephyr,memory-region"')
    if ram is not None and overlap(memory, ram):
        raise Refused(f"devicetree: retained-memory = <{label(memory)}> overlaps zephyr,sram = <{label(ram)}>: make that smaller")


def check_bootloader(build, bootloader):
    memory, ram = retained_memory(build), bootloader.chosen("zephyr,sram")
    if memory is not None and overlap(memory, ram):
        raise Refused(f"devicetree: {label(ram)} of the bootloader overlaps {label(memory)}, which outlives a reset: make it smaller in "
                      "sysbuild/mcuboot/boards/<board>.overlay, too")


def check_watchdog(build):
    watchdog = build.alias("watchdog0")
    if build.has("AGV_WITHOUT_HARDWARE_WATCHDOG", "AGV_ACCEPT_NO_WATCHDOG") and not build.has("AGV_RELEASE"):
        return
    if watchdog is None:
        raise Refused("devicetree: no hardware watchdog: write aliases { watchdog0 = &your_watchdog; }; or set "
                      "CONFIG_AGV_ACCEPT_NO_WATCHDOG=y (not for a release): then the supervisor starts with SELF_TEST_FAILED")
    require_enabled("watchdog0", watchdog)


def longest_window_ms(watchdog):
    """Of an STM32's WWDG: 64 counts of 4096 cycles of its bus, and the largest prescaler of G0, G4 and H7. Otherwise None."""
    if watchdog.matching_compat != "st,stm32-window-watchdog":
        return None
    clock = {name: prop.val for name, prop in watchdog.props["clocks"].val[0].controller.props.items()}
    divider = clock["hpre"] * clock["d1ppre"] if "d1ppre" in clock else clock.get("apb1-prescaler", 1)
    return 64 * 4096 * 128 * 1000 * divider // clock["clock-frequency"]


def check_window_time(build, watchdog):
    added_ms = 20  # WINDOW_FEEDS of hal/zephyr/src/zephyr_watchdog.c
    wanted_ms = int(build.config["TASK_WDT_MIN_TIMEOUT"]) + int(build.config["TASK_WDT_HW_FALLBACK_DELAY"]) + added_ms
    longest_ms = longest_window_ms(watchdog)
    if longest_ms is not None and wanted_ms > longest_ms:
        raise Refused(f"CONFIG_AGV_WATCHDOG_PERIOD_MS={build.config['AGV_WATCHDOG_PERIOD_MS']}: window-watchdog = <{label(watchdog)}> can wait "
                      f"{longest_ms} ms here, and {wanted_ms} ms are needed (CONFIG_TASK_WDT_MIN_TIMEOUT + "
                      f"CONFIG_TASK_WDT_HW_FALLBACK_DELAY + {added_ms}): make them shorter, or leave the alias out")


def check_window(build):
    watchdog = build.alias("window-watchdog")
    if watchdog is None:
        return
    require_enabled("window-watchdog", watchdog)
    if watchdog.matching_compat not in WINDOWS and not build.has("ZTEST"):
        raise Refused(f"devicetree: window-watchdog = <{label(watchdog)}> is {watchdog.matching_compat}, of which the port cannot set a "
                      "window: leave the alias out")
    check_window_time(build, watchdog)


def check_update(build):
    if build.has("AGV_UPDATE") and not build.has("BOOTLOADER_MCUBOOT"):
        raise Refused("update.conf (CONFIG_AGV_UPDATE) needs a bootloader: build with sysbuild")


def check_release(build):
    if not build.has("AGV_RELEASE"):
        return
    if not build.has("MPU_STACK_GUARD", "BUILTIN_STACK_GUARD", "STACK_SENTINEL"):
        raise Refused("release: no stack is guarded: set CONFIG_HW_STACK_PROTECTION=y, or CONFIG_STACK_SENTINEL=y on a processor "
                      "without MPU")
    if build.has("SHELL"):
        raise Refused("release: CONFIG_SHELL=y: leave out shell.conf")
    if build.has("AGV_SHADOW_ON", "AGV_CAN_LISTEN_ONLY"):
        raise Refused("release: a supervisor in shadow mode does not act: leave out shadow.conf (CONFIG_AGV_SHADOW_ON, "
                      "CONFIG_AGV_CAN_LISTEN_ONLY)")
    if build.has("MCUMGR") and not build.has("AGV_UPDATE"):
        raise Refused("release: CONFIG_MCUMGR without CONFIG_AGV_UPDATE takes an update in every state: add update.conf, or leave it out")


def check(build):
    check_node(build)
    check_controllers(build)
    check_pins(build)
    check_second_clock(build)
    check_log(build)
    check_retained(build)
    check_watchdog(build)
    check_window(build)
    check_update(build)
    check_release(build)


def chip(build):
    if build.has("ARCH_POSIX"):
        return ("none", "none")
    names = [build.config.get(symbol, "").strip('"') for symbol in ("SOC", "SOC_SERIES")]
    for known, facts in CHIPS.items():
        if any(name.startswith(known) for name in names):
            return facts
    return ("unknown", "unknown")


def watchdog_text(build, alias):
    node = build.alias(alias)
    if node is None or is_disabled(node):
        return "none"
    return WATCHDOGS.get(node.matching_compat, node.matching_compat)


def guard_text(build):
    for symbol, text in (("MPU_STACK_GUARD", "MPU"), ("BUILTIN_STACK_GUARD", "stack limit register"), ("STACK_SENTINEL", "sentinel")):
        if build.has(symbol):
            return text
    return "none"


def input_text(build, name):
    props = build.node().props
    return pin_text(props[name].val[0]) if name in props else "none"


def second_clock_text(build):
    props = build.node().props
    return label(props["second-clock"].val) if "second-clock" in props else "none"


def log_text(build):
    props = build.node().props
    if "log-partition" not in props:
        return "none"
    return f"{props['log-partition'].val.regs[0].size // 1024} KB"


def controllers_text(build):
    props = build.node().props
    names = [name for name in ("vehicle-can", "ai-can") if name in props]
    return ", ".join(label(props[name].val) for name in names)


FACTS = (
    ("CAN", controllers_text),
    ("watchdog", lambda build: watchdog_text(build, "watchdog0")),
    ("window watchdog", lambda build: watchdog_text(build, "window-watchdog")),
    ("stack guard", guard_text),
    ("brown-out", lambda build: chip(build)[0]),
    ("memory errors", lambda build: chip(build)[1]),
    ("second clock", second_clock_text),
    ("output feedback", lambda build: input_text(build, "feedback-gpios")),
    ("emergency stop", lambda build: input_text(build, "estop-gpios")),
    ("reset button", lambda build: input_text(build, "reset-gpios")),
    ("log in flash", log_text),
    ("bootloader", lambda build: "MCUboot" if build.has("BOOTLOADER_MCUBOOT") else "none"),
)
OF_THE_BUILD = ("bootloader",)  # not of the board: left out of the table


def header(build):
    check_node(build)
    lines = ["/* Made by scripts/tools/zephyr-board.py from devicetree and configuration: what this board can do. */",
             "#define AGV_BOARD_FACTS(X) \\"]
    lines += [f'    X("{name}", "{text(build)}") \\' for name, text in FACTS]
    lacks = [name for name, text in FACTS if text(build) == "none" and name not in OF_THE_BUILD]
    return "\n".join(lines) + f'\n\n#define AGV_BOARD_LACKS "{", ".join(lacks) or "nothing"}"\n'


def table(builds):
    columns = sorted(builds, key=lambda build: build.config["BOARD"])
    names = ["`" + build.config["BOARD"].strip('"') + "`" for build in columns]
    rows = ["| | " + " | ".join(names) + " |", "|---|" + "---|" * len(names)]
    rows += [f"| {name} | " + " | ".join(text(build) for build in columns) + " |" for name, text in FACTS if name not in OF_THE_BUILD]
    return "\n".join(rows)


def write_table(text):
    page = pathlib.Path(__file__).resolve().parents[2] / "docs/firmware.md"
    page.write_text(tables.with_section(page, page.read_text(encoding="utf-8"), BEGIN, END, text), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description="what a board can do for the supervisor")
    parser.add_argument("what", choices=("settings", "check", "bootloader", "header", "table"))
    parser.add_argument("--write", action="store_true", help="with table: into docs/firmware.md")
    parser.add_argument("--zephyr-base", type=pathlib.Path, help="folder of Zephyr; without it that of the build")
    parser.add_argument("sources", nargs="+", help="build folders; with settings: files and values")
    arguments = parser.parse_args()
    try:
        if arguments.what == "settings":
            check_settings(arguments.sources)
            return
        builds = [Build(pathlib.Path(folder), arguments.zephyr_base) for folder in arguments.sources]
        if arguments.what == "check":
            for build in builds:
                check(build)
        elif arguments.what == "bootloader":
            check_bootloader(*builds)
        elif arguments.what == "header":
            sys.stdout.write("".join(header(build) for build in builds))
        elif arguments.write:
            write_table(table(builds))
        else:
            print(table(builds))
    except Refused as mistake:
        print(mistake, file=sys.stderr)
        sys.exit(2)


main()
