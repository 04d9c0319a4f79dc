#!/usr/bin/python3
"""Draw the pictures of docs/report.md from pages that the built host_sim makes: docs/pictures/report*.png. Needs Chromium
and pngquant. usage: report-pictures [--host-sim PROGRAM]"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/host_sim/program"))
import browser  # noqa: E402
import traffic  # noqa: E402

EXAMPLE = ROOT / "host_sim/examples/ai-stops.log"
DEVIATION = ROOT / "host_sim/scenarios/motion/steering_deviation.yaml"

# picture: (how its page is made, width, dark, the part of the page: from the top of one element to the end of another)
PICTURES = {
    "report": (("demo",), 1040, False, ("#verdict", ".timeline")),
    "report-frames": (("scenario", DEVIATION), 1200, False, (".framed", ".framed")),
    "report-phone": (("scenario", DEVIATION), 390, True, ("header", "#steps")),
    "report-not-supervised": (("replay", "autopilot.log"), 960, False, ("header", "#report > section")),
}
PART = """(() => {
  const top = document.querySelector('%s').getBoundingClientRect().top + scrollY;
  const bottom = document.querySelector('%s').getBoundingClientRect().bottom + scrollY;
  return [Math.max(top - 14, 0), bottom + 10];
})()"""


def main():
    parser = argparse.ArgumentParser(prog="report-pictures", description="Draw the pictures of docs/report.md.")
    parser.add_argument("--host-sim", default=ROOT / "build/host/bin/host_sim", metavar="PROGRAM")
    program = parser.parse_args().host_sim
    if browser.find() is None:
        sys.exit("report-pictures: there is no Chromium; Debian has it as chromium")
    with tempfile.TemporaryDirectory(prefix="report-pictures.") as folder, browser.Browser() as chromium:
        pathlib.Path(folder, "autopilot.log").write_text(traffic.log(traffic.frames(20000, engage_ms=0)), encoding="ascii")
        for name, ((command, *rest), width, dark, part) in PICTURES.items():
            subprocess.run([program, command, "--report", "page.html", *map(str, rest)], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
            chromium.open(pathlib.Path(folder, "page.html"), width, 900, dark)
            top, bottom = chromium.run(PART % part)
            path = ROOT / "docs/pictures" / f"{name}.png"
            chromium.picture(path, True, {"x": 0, "y": top, "width": width, "height": bottom - top})
            subprocess.run(["pngquant", "--force", "--ext", ".png", "--strip", "--nofs", "--posterize", "2", "256", path], check=True)
            print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1000:.0f} KB")


main()
