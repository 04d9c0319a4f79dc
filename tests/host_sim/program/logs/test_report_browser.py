"""The report, looked at in a browser: what it says, in every light and width, by keyboard and in print, without a network.

A program of its own and not part of a discovery: without Chromium it ends with status 77, which ctest calls skipped.
"""
import pathlib
import re
import sys
import tempfile
import unittest

import browser
import hostsim
import traffic

ROOT = pathlib.Path(__file__).resolve().parents[4]
EXAMPLE = ROOT / "host_sim/examples/ai-stops.log"
SCENARIOS = ROOT / "host_sim/scenarios"
SIZES = ((1440, False), (390, True), (768, False))  # each width, and each light; the one does not depend on the other

# page: (how it is made, what its badge says, what its headline says)
PAGES = {
    "silence": (("replay", EXAMPLE), "STEERING_COMMAND_TIMEOUT",
                "The supervisor would have stopped this vehicle because the AI computer no longer sent steering commands."),
    "bit": (("scenario", SCENARIOS / "eps/eps_temp_above_120.yaml"), "EPS_TEMP_ABOVE_120",
            "The vehicle stands because the EPS (power steering) reported a temperature above 120 \u00b0C."),
    "budget": (("scenario", SCENARIOS / "motion/steering_deviation.yaml"), "STEERING_DEVIATION",
               "The vehicle stands because the steering did not follow its command."),
    "stuck": (("scenario", SCENARIOS / "vcu/vcu_heartbeat_stuck.yaml"), "VCU_HEARTBEAT_STUCK",
              "The vehicle stands because the VCU hung: its alive counter stood still."),
    "several": (("demo",), "STEERING_COMMAND_TIMEOUT",
                "The vehicle stands because the AI computer no longer sent steering commands."),
    "none": (("scenario", SCENARIOS / "overview/healthy_shared.yaml"), "NO TRIP",
             "No trip: the supervisor found no reason to stop the vehicle."),
    "unsupervised": (("replay", "autopilot.log"), "NOT SUPERVISED",
                     "Nothing was supervised: the supervisor never left INIT."),
    "partial": (("replay", "ends.log"), "NO TRIP, BUT NOT ALL WAS SUPERVISED",
                "No trip: the supervisor found no reason to stop the vehicle."),
    "settings": (("replay", "--config", "other.yaml", EXAMPLE), "STEERING_COMMAND_TIMEOUT",
                 "The supervisor would have stopped this vehicle because the AI computer no longer sent steering commands."),
}

# The contrast of an element's text with what is behind it, as WCAG 2 counts it.
CONTRAST = """(() => {
  const parse = (text) => (text.match(/[\\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (element) => {
    for (let one = element; one; one = one.parentElement) {
      const colour = parse(getComputedStyle(one).backgroundColor);
      if (colour.length === 3 || colour[3] > 0) return colour;
    }
  };
  const poor = [];
  for (const element of document.querySelectorAll("h1, h2, p, td, th, b, span, label, button, code, .timeline text")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own || element.closest("noscript")) continue;
    const style = getComputedStyle(element);
    const front = parse(element instanceof SVGElement ? style.fill : style.color);
    const [a, b] = [light(front), light(behind(element))].sort((x, y) => y - x);
    if ((a + 0.05) / (b + 0.05) < 4.5) poor.push(`${element.textContent.slice(0, 30)} ${((a + 0.05) / (b + 0.05)).toFixed(2)}`);
  }
  return [...new Set(poor)];
})()"""
TEXT = "document.getElementById('{}').innerText"


class Report(hostsim.Case):
    @classmethod
    def setUpClass(cls):
        cls.pages = tempfile.TemporaryDirectory(prefix="agv-report-")
        cls.addClassCleanup(cls.pages.cleanup)
        folder = pathlib.Path(cls.pages.name)
        (folder / "autopilot.log").write_text(traffic.log(traffic.frames(2000, engage_ms=0)), encoding="ascii")
        ends = traffic.frames(3000, engage_ms=1000, edit=lambda frame: None if frame.name == "steering_command" and frame.t_ms > 2910 else frame)
        (folder / "ends.log").write_text(traffic.log(ends), encoding="ascii")
        (folder / "other.yaml").write_text("steering_command_timeout_ms: 120\nclass_s_driver_alarm: warn\n", encoding="ascii")
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def page(self, name):
        """The path of a page; it is made when it is wanted first."""
        path = pathlib.Path(self.pages.name) / f"{name}.html"
        if not path.exists():
            self.folder = path.parent
            command, *rest = PAGES[name][0]
            self.run_good(command, "--report", path.name, *rest)
        return path

    def show(self, name, width=1440, dark=False):
        self.browser.open(self.page(name), width, 900, dark)
        self.assertEqual(self.browser.complaints(), [], name)
        self.assertEqual(self.browser.requests(), [self.page(name).resolve().as_uri()])

    def text(self, element):
        return self.browser.run(TEXT.format(element))

    def click(self, selector, text):
        self.browser.run(f"[...document.querySelectorAll('{selector}')].find((one) => one.textContent.includes('{text}')).click()")

    def view(self):
        """The times that the picture shows, as texts of its axis."""
        self.browser.settle()
        return self.browser.run("[...document.querySelectorAll('.tl-tick')].map((one) => one.textContent)")

    def test_every_page_says_first_what_it_is_about(self):
        for name, (_, badge, headline) in PAGES.items():
            with self.subTest(name):
                self.show(name)
                self.assertEqual(self.text("badge"), badge)
                self.assertEqual(self.text("headline"), headline)
                self.assertEqual(self.browser.run("document.querySelector('h1').id"), "headline")

    def test_no_width_needs_scrolling_and_every_text_can_be_read(self):
        for name in PAGES:
            for width, dark in SIZES:
                with self.subTest(name, width=width, dark=dark):
                    self.show(name, width, dark)
                    self.assertEqual(self.browser.run("document.documentElement.scrollWidth"), width)
                    self.assertEqual(self.browser.run(
                        "[...document.querySelectorAll('main *, header *')].filter((one) => !one.closest('svg, thead')"
                        " && one.getBoundingClientRect().right > innerWidth + 0.5).map((one) => one.outerHTML.slice(0, 80))"), [])
                    self.assertEqual(self.browser.run(CONTRAST), [])

    def test_light_and_dark(self):
        colours = set()
        for dark in (False, True):
            self.show("silence", dark=dark)
            colours.add(self.browser.run("getComputedStyle(document.body).backgroundColor"))
        self.assertEqual(colours, {"rgb(255, 255, 255)", "rgb(18, 24, 30)"})

    def test_silence_in_words_and_in_the_picture(self):
        self.show("silence")
        self.assertIn("steering_command (065h) came for the last time at 0.881 s. Its deadline is 125 ms.", self.text("cause"))
        self.assertIn("The supervisor tripped at 1.007 s (STEERING_COMMAND_TIMEOUT).", self.text("action"))
        self.assertIn("This is a recording", self.text("outcome"))
        marks = self.browser.run("[...document.querySelectorAll('text.tl-mark')].map((one) => one.textContent)")
        self.assertEqual(set(marks), {"cause", "STEERING_COMMAND_TIMEOUT", "P confirmed", "stands"})
        self.assertGreater(self.browser.run("document.querySelectorAll('path.tl-late').length"), 0)
        rows = self.browser.run("[...document.querySelectorAll('.tl-name')].map((one) => one.textContent)")
        for row in ("state", "safety output", "LED", "mode", "gearreported", "speed", "throttle", "steering", "065hsteering_command"):
            self.assertIn(row, rows)

    def test_the_steps_have_the_times_of_the_text(self):
        self.show("silence")
        steps = self.browser.run("[...document.querySelectorAll('#steps li')].map((one) => [...one.children].slice(0, 3).map((part) => part.innerText))")
        self.assertEqual([step[:2] for step in steps], [
            ["last good frame", "0.881 s"], ["cause", "0.906 s"], ["trip", "1.007 s"], ["first safe frame", "1.007 s"],
            ["P confirmed", "1.120 s"], ["stands", "1.281 s"]])
        self.assertEqual([steps[0][2], steps[1][2], steps[4][2], steps[5][2]],
                         ["126 ms before", "101 ms before", "113 ms after", "274 ms after"])
        self.assertIn("The wheels stood 274 ms after the trip.", self.text("outcome"))

    def test_the_messages_on_the_bus(self):
        self.show("silence")
        rows = self.browser.run("[...document.querySelectorAll('.messages tbody tr')].map((one) => [...one.children].map((cell) => cell.innerText))")
        self.assertEqual(len(rows), 13)
        self.assertEqual(rows[0], ["050h throttle_status", "140", "10.0", "10.0", "60", "50.0"])
        self.assertEqual(rows[1:3], [["065h steering_command", "36", "25.0", "238.9", "125", "\u2212113.9"], ["late at 1.006 s"]])

    def test_the_frames_around_the_cause_are_decoded(self):
        self.show("bit")
        rows = self.browser.run("[...document.querySelectorAll('.frames tbody tr')].map((one) => one.innerText.split('\\t').map((cell) => cell.trim()))")
        at = next(i for i, row in enumerate(rows) if row[1] == "trip: EPS_TEMP_ABOVE_120")
        self.assertEqual(rows[at - 2][1:4], ["167h eps_status", "mode angle", "00 00 00 01 00 00 00 00"])
        self.assertEqual(rows[at - 1][1:5], ["167h eps_status", "mode angle, EPS_TEMP_ABOVE_120", "00 00 00 01 00 00 00 20", "EPS"])
        self.assertEqual(rows[at + 1][1:5], ["075h throttle_command", "throttle 0.0 %", "00 00 00 00 00 00 00 00", "supervisor"])
        few = len(rows)
        self.click(".choice label", "all frames")
        self.assertGreater(self.browser.run("document.querySelectorAll('.frames tbody tr').length"), 2 * few)

    def test_several_trips_are_a_list_to_choose_from(self):
        self.show("several")
        self.assertEqual(self.browser.run("[...document.querySelectorAll('#trips label')].map((one) => one.innerText)"),
                         ["6.109 s\nSTEERING_COMMAND_TIMEOUT", "18.003 s\nEPS_OVER_CURRENT_SHUTDOWN"])
        self.browser.run("document.querySelector('#trips input').focus()")
        self.browser.press("ArrowDown")
        self.assertEqual(self.text("headline"), "The vehicle stands because the EPS (power steering) reported a shutdown by over-current.")
        self.assertEqual(self.text("badge"), "EPS_OVER_CURRENT_SHUTDOWN")
        self.assertTrue(any(tick.startswith("18.") for tick in self.view()), self.view())
        self.assertEqual(self.browser.complaints(), [])

    def test_the_picture_by_keyboard(self):
        self.show("silence")
        for _ in range(60):
            if self.browser.run("document.activeElement.classList.contains('tl-picture')"):
                break
            self.browser.press("Tab")
        else:
            self.fail("the Tab key does not reach the picture")
        at = "Number(document.activeElement.getAttribute('aria-valuenow'))"
        self.assertEqual(self.browser.run(at), 1007)
        self.browser.press("ArrowRight")
        self.assertGreater(self.browser.run(at), 1007)
        self.browser.press("Home")
        self.assertEqual(self.browser.run(at), 0)
        self.assertIn("state INIT", self.browser.run("document.activeElement.getAttribute('aria-valuetext')"))
        before = self.view()
        self.browser.press("+")
        self.assertNotEqual(self.view(), before)
        self.browser.press("0")
        self.assertIn("0.0 s", self.view())

    def test_the_buttons_change_the_view(self):
        self.show("several")
        views = []
        for name in ("Cause", "Seconds around", "All", "+", "\u2192", "Trip"):
            self.click(".tl-tools button", name)
            views.append(tuple(self.view()))
        self.assertEqual(len(set(views)), len(views), views)
        self.assertEqual(self.browser.complaints(), [])

    def test_no_trip_and_nothing_supervised(self):
        self.show("none")
        self.assertIn("0.511 s it was in INIT", self.text("cause"))
        self.show("unsupervised")
        self.assertIn("does not count as passed", self.text("outcome"))
        self.assertIn("Not supervised: 1.9", self.text("report"))
        self.assertNotIn("The autopilot was never engaged", self.text("report"))
        self.assertIn("the VCU does not report manual (363h reports autopilot from its first frame)", self.text("cause"))
        remarks = "[...document.querySelectorAll('.remark')].map((one) => one.innerText)"
        self.assertEqual(self.browser.run(remarks), ["Hint: supervision begins in manual, at standstill: start the recording "
                                                     "before the autopilot is engaged."])
        self.show("partial")
        self.assertEqual(self.browser.run(remarks), ["Not supervised: 065h steering_command was silent for 88 ms, deadline "
                                                     "125 ms: the log ended too early."])

    def test_settings_that_differ(self):
        self.show("settings")
        text = self.text("report")
        self.assertRegex(text, r"steering_command_timeout_ms\s+120 ms\s+125 ms")
        self.assertRegex(text, r"class_s_driver_alarm\s+warn\s+trip")
        self.assertIn("weakens the supervision", text)
        self.show("silence")
        self.assertIn("All settings are the defaults.", self.text("report"))

    def test_print(self):
        for name in ("silence", "several", "none"):
            self.show(name, dark=True)
            width = self.browser.run("document.querySelector('.tl-picture').getBoundingClientRect().width")
            pdf = self.browser.pdf()
            self.browser.settle()
            self.assertEqual(pdf[:5], b"%PDF-")
            pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
            self.assertTrue(2 <= pages <= 6, pages)
            self.assertEqual(self.browser.run("document.querySelector('.tl-picture').getBoundingClientRect().width"), width)
            self.assertEqual(self.browser.complaints(), [])


if __name__ == "__main__":
    if browser.find() is None:
        print("SKIPPED: there is no Chromium: the report was not looked at. scripts/install-deps test installs it.")
        sys.exit(77)
    unittest.main(verbosity=2)
