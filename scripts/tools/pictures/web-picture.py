#!/usr/bin/python3
"""Draw docs/pictures/web.png from the built page (preset wasm). Needs Chromium and pngquant. usage: web-picture"""
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/host_sim/program"))
import browser  # noqa: E402

PAGE = ROOT / "build/wasm/page"
PICTURE = ROOT / "docs/pictures/web.png"
RUN = """(async () => {
  agv.play(false);
  agv.run.seek(12000);
  agv.run.inject("eps", "set", { field: "faults", value: "08h" });
  agv.run.step(3000);
  agv.draw(true);
})()"""


def wait(chromium, script):
    while not chromium.run(f"Boolean({script})"):
        time.sleep(0.1)


def main():
    if browser.find() is None:
        sys.exit("web-picture: there is no Chromium; Debian has it as chromium")
    if not (PAGE / "index.html").exists():
        sys.exit("web-picture: build the page first: cmake --preset wasm && cmake --build --preset wasm")
    server, address = browser.serve(PAGE)
    with browser.Browser() as chromium:
        chromium.open(address, 1320, 1000)
        wait(chromium, "document.documentElement.dataset.ready === 'yes'")
        chromium.run(RUN)
        wait(chromium, "document.querySelectorAll('#details p').length === 3")
        chromium.settle()
        height = chromium.run("document.getElementById('picture').getBoundingClientRect().bottom + scrollY + 2")
        chromium.picture(PICTURE, True, {"x": 0, "y": 0, "width": 1320, "height": height})
    server.shutdown()
    subprocess.run(["pngquant", "--force", "--ext", ".png", "--strip", "--nofs", "--posterize", "2", "256", PICTURE], check=True)
    print(f"{PICTURE.relative_to(ROOT)}: {PICTURE.stat().st_size / 1000:.0f} KB")


main()
