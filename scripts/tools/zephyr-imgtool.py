#!/usr/bin/python3
"""MCUboot's imgtool for the firmware: what it signs also carries the version with its revision, and the configuration's checksum.

usage: zephyr-imgtool.py sign OPTION... INPUT OUTPUT     (Zephyr's build calls it; OUTPUT is BUILD/zephyr/zephyr.signed.bin)
       zephyr-imgtool.py show IMAGE                      version, revision, checksum of the configuration, and the flags of an image
       zephyr-imgtool.py checksum BUILD                  checksum of the configuration of a build, as `agv version` prints it
       zephyr-imgtool.py test-key FILE                   make a key for tests
       zephyr-imgtool.py check-key FILE                  refuse what is no private Ed25519 key, or is one that everybody has

Exit code 2: refused, with the reason in one line.
"""
import pathlib
import re
import struct
import subprocess
import sys
import zlib

import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
TLV_REVISION = 0x00A0  # text: version, + and revision
TLV_CONFIGURATION = 0x00A1  # 4 bytes, the highest first
IMAGE_MAGIC = 0x96F3B83D
TLV_MAGICS = (0x6908, 0x6907)


class Refused(Exception):
    """A mistake of the user, in one line."""


def configuration(build):
    path = build / "zephyr/.config"
    if not path.exists():
        raise Refused(f"{build} is no build folder of Zephyr: zephyr/.config is missing")
    return dict(re.findall(r"^CONFIG_(\w+)=(.*)$", path.read_text(encoding="utf-8"), re.MULTILINE))


def value_of(expression, config):
    """A number, or "IS_ENABLED(CONFIG_A) ? 1 : IS_ENABLED(CONFIG_B) ? 2 : 0"."""
    expression = expression.strip()
    choice = re.match(r"IS_ENABLED\(CONFIG_(\w+)\)(?: \? (\d+) : (.*))?$", expression)
    if choice is None:
        return int(config[expression.removeprefix("CONFIG_")], 0) if expression.startswith("CONFIG_") else int(expression, 0)
    if config.get(choice[1]) == "y":
        return int(choice[2] or 1)
    return value_of(choice[3], config) if choice[3] else 0


def checksum(build):
    """As agv_config_checksum()."""
    config = configuration(build)
    rows = (ROOT / "firmware/zephyr/src/kconfig_settings.def").read_text(encoding="utf-8")
    values = [value_of(expression, config) for expression in re.findall(r"^AGV_KCONFIG\(\w+, (.*)\)$", rows, re.MULTILINE)]
    classes = dict(re.findall(r"^AGV_KCONFIG_CLASS\((\w+), (.*)\)$", rows, re.MULTILINE))
    faults = tables.faults(ROOT)
    trips = sum(1 << index for index, fault in enumerate(faults)
                if (value_of(classes[fault.name], config) if fault.name in classes else fault.fault_class == "TRIP"))
    words = (len(faults) + 31) // 32
    return zlib.crc32(struct.pack(f"<{len(values)}H", *values) + trips.to_bytes(4 * words, "little"))


def version(build):
    """As `agv version`, without what makes the build differ from one that acts."""
    text = (build / "agv/generated/agv_revision.h").read_text(encoding="utf-8")
    parts = dict(re.findall(r"^(\w+) = *(\w*)$", (ROOT / "firmware/zephyr/VERSION").read_text(encoding="utf-8"), re.MULTILINE))
    number = ".".join(parts[part] for part in ("VERSION_MAJOR", "VERSION_MINOR", "PATCHLEVEL"))
    extra = f"-{parts['EXTRAVERSION']}" if parts["EXTRAVERSION"] else ""
    return f"{number}{extra}+{re.search(r'AGV_REVISION .(.*).$', text, re.MULTILINE)[1]}"


def imgtool(build):
    """MCUboot's own, from the modules of the build."""
    modules = (build / "zephyr_modules.txt").read_text(encoding="utf-8")
    found = re.search(r'^"mcuboot":"([^"]+)"', modules, re.MULTILINE)
    if found is None:
        raise Refused(f"{build} has no module mcuboot")
    return pathlib.Path(found[1]) / "scripts/imgtool.py"


def sign(arguments):
    build = pathlib.Path(arguments[-1]).resolve().parents[1]
    added = ["--custom-tlv", f"0x{TLV_REVISION:02x}", version(build), "--custom-tlv", f"0x{TLV_CONFIGURATION:02x}", f"0x{checksum(build):08x}"]
    return subprocess.run([sys.executable, imgtool(build), "sign", *added, *arguments], check=False).returncode


def tlvs(image, at):
    """(type, value) of an area of TLVs, and its end."""
    magic, size = struct.unpack_from("<HH", image, at)
    if magic not in TLV_MAGICS:
        raise Refused("the image has no TLVs: it is not whole, or not signed")
    found, end, at = [], at + size, at + 4
    while at < end:
        kind, length = struct.unpack_from("<HH", image, at)
        found.append((kind, image[at + 4:at + 4 + length]))
        at += 4 + length
    return found, end


def show(path):
    image = path.read_bytes()
    if len(image) < 32 or struct.unpack_from("<I", image)[0] != IMAGE_MAGIC:
        raise Refused(f"{path} is no image of MCUboot")
    header_size, protected_size, image_size = struct.unpack_from("<HHI", image, 8)
    major, minor, patch, build_number = struct.unpack_from("<BBHI", image, 20)
    found, end = tlvs(image, header_size + image_size)
    if protected_size:
        found += tlvs(image, end)[0]
    fields = dict(found)
    print(f"version {major}.{minor}.{patch}+{build_number}")
    print(f"revision {fields.get(TLV_REVISION, b'-').decode()}")
    print(f"configuration {fields.get(TLV_CONFIGURATION, b'').hex() or '-'}")
    print(f"signature {'Ed25519' if 0x24 in fields else 'none'}, {image_size} bytes")


def test_key(path):
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric import ed25519
    pem = ed25519.Ed25519PrivateKey.generate().private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    path.write_bytes(pem)
    path.chmod(0o600)


def check_key(path):
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric import ed25519
    try:
        key = serialization.load_pem_private_key(path.read_bytes(), password=None)
    except (OSError, TypeError, ValueError):
        raise Refused(f"{path} cannot be read, or is no private key in PEM form without a password") from None
    if not isinstance(key, ed25519.Ed25519PrivateKey):
        raise Refused(f"{path} is no Ed25519 key: make one with imgtool keygen -t ed25519")
    if path.name.startswith("root-"):
        raise Refused(f"{path} is a key of MCUboot's repository, which everybody has: make your own with imgtool keygen -t ed25519")


def main():
    command, *arguments = sys.argv[1:] or ["help"]
    try:
        if command == "sign" and len(arguments) >= 2:
            sys.exit(sign(arguments))
        if command == "checksum" and len(arguments) == 1:
            print(f"{checksum(pathlib.Path(arguments[0])):08x}")
        elif command in ("show", "test-key", "check-key") and len(arguments) == 1:
            {"show": show, "test-key": test_key, "check-key": check_key}[command](pathlib.Path(arguments[0]))
        else:
            raise Refused("usage: zephyr-imgtool.py sign|show|checksum|test-key|check-key ...")
    except (OSError, Refused) as mistake:
        print(mistake, file=sys.stderr)
        sys.exit(2)


main()
