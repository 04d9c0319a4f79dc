"""The page in a browser: what it shows and says, by keyboard, in every light and width, and that it is the real program.

A program of its own and not part of a discovery: without Chromium it ends with status 77, which ctest calls skipped.
AGV_PAGE is the folder of the page, HOST_SIM the native program, AGV_AXE the file of axe-core.
"""
import base64
import os
import pathlib
import re
import subprocess
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/host_sim/program"))
import browser  # noqa: E402

PAGE = pathlib.Path(os.environ["AGV_PAGE"])
SCENARIOS = ROOT / "host_sim/scenarios"
EXAMPLE = ROOT / "host_sim/examples/ai-stops.log"
SIZES = ((1440, False), (1440, True), (1024, False), (390, False), (390, True))
PATIENCE_S = 60
HOUR_MS = 3600000
STATE = "document.getElementById('state').textContent"
MESSAGE = "document.getElementById('message').hidden ? '' : document.getElementById('message').textContent"


class Handler(browser.PageHandler):
    missing = None  # a file that the server does not have

    def end_headers(self):
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def do_GET(self):
        if self.path == Handler.missing:
            self.send_error(404)
        else:
            super().do_GET()


def native(*arguments):
    """What host_sim prints."""
    result = subprocess.run([os.environ["HOST_SIM"], *map(str, arguments)], capture_output=True, text=True, check=False)
    assert result.returncode < 2, result.stderr
    return result.stdout


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.address = browser.serve(PAGE, Handler)
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.server.shutdown)
        cls.addClassCleanup(cls.browser.__exit__)

    def run_script(self, script):
        return self.browser.run(script)

    def wait(self, script, what=None):
        """Until a script says something true."""
        until = time.monotonic() + PATIENCE_S
        while not self.run_script(f"Boolean({script})"):
            self.assertLess(time.monotonic(), until, what or script)
            time.sleep(0.05)

    def show(self, link="", width=1440, dark=False, ready=True):
        self.browser.call("Page.navigate", url="about:blank")  # another part of the same address is no new page
        self.browser.open(self.address + link, width, 900, dark)
        if ready:
            self.wait("document.documentElement.dataset.ready === 'yes'", self.browser.complaints())

    def paused(self, ms, link=""):
        """The page, standing at a time of the run."""
        self.show(link)
        self.run_script(f"agv.play(false); agv.run.seek({ms}); agv.draw(true)")

    def lose(self, path):
        """From now on the server does not have a file."""
        Handler.missing = path
        self.addCleanup(setattr, Handler, "missing", None)

    def clean(self):
        self.assertEqual(self.browser.complaints(), [])

    def test_it_starts_by_itself_and_asks_nobody_else(self):
        figures = []
        for _ in range(3):
            self.show()
            figures.append(self.run_script("performance.getEntriesByName('first-contentful-paint')[0].startTime"))
        print(f"\nfirst picture after {min(figures):.0f} ms", end=" ")
        self.assertLess(min(figures), 1000)
        self.wait("agv.run.now > 100")
        self.assertTrue(all(url.startswith(self.address) for url in self.browser.requests()), self.browser.requests())
        self.clean()

    # Their events: test_module.mjs
    def test_every_scenario_file_is_in_the_list(self):
        files = [line.split("\t")[0] for line in (PAGE / "scenarios/list.txt").read_text(encoding="utf-8").splitlines()]
        self.assertEqual(files, sorted(str(path.relative_to(SCENARIOS)) for path in SCENARIOS.glob("*/*.yaml")))

    def click(self, label):
        """A button outside of a screen frame. @return the state that the frame begins with that is painted next"""
        return self.run_script(f"""new Promise((done) => setTimeout(() => {{
            document.querySelector('[aria-label="{label}"]').click();
            requestAnimationFrame(() => done({STATE}));
        }}))""")

    def test_a_fault_that_is_clicked_trips_within_a_screen_frame(self):
        for speed in ("0.0001", "1", "Infinity"):  # at the first one, a frame alone plays nothing
            with self.subTest(speed=speed):
                self.show()
                self.run_script(f"agv.setSpeed({speed}); agv.play(false); agv.run.seek(3000); agv.play(true)")
                self.assertIn(self.click("Operator: emergency stop"), ("TRIPPED", "SAFE"))
        self.clean()

    def test_a_fault_that_is_clicked_while_the_time_stands(self):
        self.paused(3000)
        self.run_script("agv.setSpeed(0.0001)")
        self.assertEqual(self.click("Operator: emergency stop"), "TRIPPED")
        self.assertTrue(self.run_script("agv.playing"))

    def test_what_tripped_is_said(self):
        self.show()
        self.run_script("agv.play(false); agv.run.seek(3000); agv.play(true)")
        self.click("EPS (power steering): over-current")
        self.wait("document.querySelectorAll('#details p').length === 3")
        self.assertEqual(self.run_script("document.getElementById('headline').textContent").split(" because ")[1],
                         "the EPS (power steering) reported a shutdown by over-current.")
        self.assertEqual(self.run_script("document.getElementById('reason').textContent"), "EPS_OVER_CURRENT_SHUTDOWN")
        self.clean()

    def test_by_keyboard_alone(self):
        self.paused(3000)
        self.run_script("document.activeElement.blur()")
        self.browser.press(".", "Period")
        self.assertEqual(self.run_script("agv.run.now"), 3001)
        self.browser.press(" ", "Space")
        self.assertTrue(self.run_script("agv.playing"))
        label = "document.activeElement.getAttribute('aria-label')"
        for _ in range(80):
            self.browser.press("Tab")
            if self.run_script(label) == "AI computer: no steering command":
                break
        self.assertEqual(self.run_script(label), "AI computer: no steering command")
        self.browser.press(" ", "Space")
        self.wait("agv.run.trips === 1")
        self.assertIn(self.run_script(STATE), ("TRIPPED", "SAFE"))

    def test_keys_of_the_time_work_from_where_the_focus_is_after_a_click(self):
        for place in ("#report", "#faults summary", "#file", ".tl-tools [title=Later]", ".tl-picture"):
            with self.subTest(place):
                self.paused(3000)
                self.run_script(f"document.querySelector('{place}').focus()")
                self.browser.press(".", "Period")
                self.browser.press(".", "Period")
                self.browser.press(",", "Comma")
                self.assertEqual(self.run_script("agv.run.now"), 3001)
                self.assertTrue(self.run_script(f"document.activeElement === document.querySelector('{place}')"))
        self.run_script("document.getElementById('setting-steering_command_timeout_ms').focus()")
        self.browser.press(".", "Period")
        self.assertEqual(self.run_script("agv.run.now"), 3001)

    def test_names_of_buttons_hold_their_texts(self):
        self.paused(0)
        self.assertEqual(self.run_script("""[...document.querySelectorAll('button[aria-label]')].filter((one) => /\\w/.test(one.textContent))
            .filter((one) => !one.ariaLabel.toLowerCase().includes(one.textContent.toLowerCase())).map((one) => one.ariaLabel)"""), [])

    def test_the_time_is_not_read_aloud_in_every_frame(self):
        self.paused(0)
        self.assertEqual(self.run_script("document.querySelectorAll('#transport :is(output, [aria-live], [role=status], [aria-pressed])').length"), 0)

    def test_no_width_needs_scrolling(self):
        for width, dark in SIZES:
            with self.subTest(width=width, dark=dark):
                self.show(width=width, dark=dark)
                self.run_script("agv.play(false); agv.run.seek(3000); agv.act('eps', 'stop', {})")
                self.wait("agv.run.trips === 1")
                self.assertEqual(self.run_script("document.documentElement.scrollWidth"), width)
                self.clean()

    def test_light_and_dark(self):
        colours = set()
        for dark in (False, True):
            self.show(dark=dark)
            colours.add(self.run_script("getComputedStyle(document.body).backgroundColor"))
        self.assertEqual(colours, {"rgb(243, 245, 246)", "rgb(26, 34, 42)"})

    def test_accessibility(self):
        axe = pathlib.Path(os.environ["AGV_AXE"]).read_text(encoding="utf-8")
        for width, dark in ((1440, False), (1440, True), (390, False)):
            for scene in ("agv.play(false)", "agv.play(false); agv.run.seek(3000); agv.run.inject('eps', 'stop'); agv.run.step(1500); agv.draw(true)"):
                with self.subTest(width=width, dark=dark, scene=scene):
                    self.show(width=width, dark=dark)
                    self.run_script(scene)
                    self.run_script(axe)
                    found = self.run_script("""axe.run(document, { resultTypes: ["violations"] }).then((all) => all.violations
                        .filter((one) => ["serious", "critical"].includes(one.impact))
                        .map((one) => `${one.id}: ${one.nodes.slice(0, 3).map((node) => node.target.join(" ")).join("; ")}`))""")
                    self.assertEqual(found, [])

    def test_two_hours_need_no_more_memory(self):
        self.paused(0)

        def step_to(ms):
            while self.run_script(f"agv.run.step(Math.min(60000, {ms} - agv.run.now)); agv.draw(true); agv.run.now") < ms:
                pass

        def used():
            self.browser.call("HeapProfiler.collectGarbage")
            return self.run_script("agv.run.simulation.exports.memory.buffer.byteLength"), self.browser.call("Runtime.getHeapUsage")["usedSize"]

        step_to(HOUR_MS // 4)
        wasm_before, heap_before = used()
        step_to(2 * HOUR_MS)
        wasm, heap = used()
        print(f"\nafter two hours: {wasm / 1e6:.1f} MB of the module, {heap / 1e6:.1f} MB of the page", end=" ")
        self.assertEqual(wasm, wasm_before)
        self.assertLess(heap, heap_before + 2e6)
        self.assertEqual(self.run_script("agv.run.view.state"), 2)

    def test_a_link_gives_the_same_run(self):
        self.paused(2000)
        self.run_script("agv.set('steering_command_timeout_ms', 80)")
        self.run_script("agv.run.step(1000); agv.run.inject('ai', 'mute', { message: 'steering_command' }); agv.run.step(500);"
                        "agv.run.inject('bus', 'send', { bytes: '08 00', id: '123h' }); agv.run.step(250)")
        self.run_script("agv.copyLink()")
        link, events = self.run_script("[location.hash, JSON.stringify(agv.run.events)]")
        self.assertIn("STEERING_COMMAND_TIMEOUT", events)
        self.show(link)
        self.assertEqual(self.run_script("agv.run.now"), 3750)
        self.assertEqual(self.run_script("JSON.stringify(agv.run.events)"), events)
        self.assertFalse(self.run_script("agv.playing"))
        self.clean()

    def test_a_link_that_the_module_refuses_gives_the_free_drive(self):
        for part, sentence in (("settings: { steering_command_timeout_ms: '7' }, steps: []", r"^steering_command_timeout_ms: 7 is not within"),
                               ("settings: {}, steps: [{ at: 3000, actor: 'eps', word: 'dance', parameters: {} }]", r"dance")):
            with self.subTest(part):
                self.show()
                link = self.run_script(f"import('./simulation/link.js').then((module) => '#' + module.toLink({{ scenario: 'overview/demo.yaml', t: 5, {part} }}))")
                self.show(link)
                self.assertRegex(self.run_script(MESSAGE), sentence)
                self.assertEqual(self.run_script("[agv.playing, agv.run.plan.name, document.getElementById('scenario').value]"), [True, "drive.yaml", "drive.yaml"])
                self.wait("agv.run.now > 100")
                self.clean()

    def test_a_link_is_copied_only_if_there_is_a_clipboard(self):
        for clipboard, text in (("{ writeText: async () => {} }", "Link copied"), ("{ writeText: async () => { throw new Error(); } }", "The link is in the address bar"),
                                ("undefined", "The link is in the address bar")):
            with self.subTest(clipboard):
                self.paused(2000)
                self.run_script(f"Object.defineProperty(navigator, 'clipboard', {{ value: {clipboard} }})")
                self.assertEqual(self.run_script("agv.copyLink().then(() => document.getElementById('link').textContent)"), text)
                self.assertTrue(self.run_script("location.hash.includes('t=2000')"))

    def test_the_list_names_the_scenario_that_runs(self):
        choose = "((file) => { const list = document.getElementById('scenario'); list.value = file; list.dispatchEvent(new Event('change')); })"
        chosen = "document.getElementById('scenario').value"
        self.show()
        self.open_log("own.yaml", (SCENARIOS / "overview/demo.yaml").read_bytes())
        self.assertEqual(self.run_script(f"[agv.run.plan.name, {chosen}]"), ["own.yaml", ""])
        self.run_script(f"{choose}('drive.yaml')")
        self.wait("agv.run.plan.name === 'drive.yaml'")
        self.lose("/scenarios/overview/demo.yaml")
        self.run_script(f"{choose}('overview/demo.yaml')")
        self.wait(MESSAGE)
        self.assertEqual(self.run_script(chosen), "drive.yaml")

    def test_of_two_choices_the_last_one_counts(self):
        self.show()
        names = self.run_script("""(async () => {
            const { fetch } = globalThis;
            let answer;
            globalThis.fetch = async (path) => {
                if (path.includes("demo")) await new Promise((done) => (answer = done));
                return fetch(path);
            };
            const first = agv.load("overview/demo.yaml");
            await agv.load("drive.yaml");
            answer();
            await first;
            return [agv.run.plan.name, document.getElementById("scenario").value];
        })()""")
        self.assertEqual(names, ["drive.yaml", "drive.yaml"])

    def test_words_are_about_the_run_that_is_shown(self):
        self.paused(3000)
        self.run_script("""{
            const make = agv.reports.make.bind(agv.reports);
            agv.reports.make = async (...all) => {
                const answer = await make(...all);
                if (!agv.answer) await new Promise((done) => (agv.answer = done));
                return answer;
            };
            agv.run.inject("ai", "mute", { message: "steering_command" });
            agv.run.step(1000);
            agv.draw(true);
        }""")
        self.wait("agv.answer")
        default = self.run_script("agv.lists.settings.find((one) => one.name === 'steering_command_timeout_ms').preset")
        self.assertNotEqual(default, 83)
        self.run_script("agv.set('steering_command_timeout_ms', 83); agv.answer()")
        details = "document.getElementById('details').textContent"
        self.wait("document.querySelectorAll('#details p').length === 3")
        self.assertIn("83 ms", self.run_script(details))
        self.clean()

    def test_expectations_are_ticked(self):
        self.show()
        self.run_script("agv.load('overview/demo.yaml')")
        self.run_script("agv.play(false); agv.run.seek(7000); agv.draw(true)")
        count = "document.querySelectorAll('.expectations .passed').length"
        some = self.run_script(count)
        self.run_script("agv.run.step(1e9); agv.draw(true)")
        self.assertTrue(5 < some < self.run_script(count), some)
        self.assertEqual(self.run_script("document.querySelectorAll('.expectations li:not(.passed)').length"), 0)
        self.assertEqual(self.run_script("document.querySelector('#expectations-title span').textContent"), "31 of 31 passed")

    def test_every_action_and_every_setting_is_there(self):
        self.show()
        self.assertEqual(self.run_script("""agv.lists.actions.filter((action) => ![...document.querySelectorAll('#faults details button')]
            .some((one) => one.textContent === action.word.replaceAll('_', ' '))).map((action) => action.word)"""), [])
        self.assertEqual(self.run_script("agv.lists.settings.filter((one) => !document.getElementById('setting-' + one.name)).map((one) => one.name)"), [])
        self.run_script("[...document.querySelectorAll('#faults details')].forEach((one) => (one.open = true))")
        self.run_script("document.querySelector('[aria-label=\"EPS: set\"]').click()")
        self.assertEqual(self.run_script("[...document.querySelectorAll('.parameters label')].map((one) => one.textContent.split(' ')[0])"),
                         ["field", "value", "frames", "every"])

    def test_the_report_is_the_file_that_host_sim_writes(self):
        self.show()
        self.run_script("agv.load('overview/demo.yaml')")
        self.run_script("agv.play(false); agv.run.step(1e9)")
        self.run_script("agv.showReport()")
        whole = self.run_script("agv.reports.whole()")
        other = native("scenario", "--report", "-", SCENARIOS / "overview/demo.yaml")
        self.assertEqual(sorted(whole.splitlines()), sorted(other.splitlines()))  # its modules may stand in another order
        self.wait("document.getElementById('report-frame').contentDocument?.getElementById('headline')")
        self.wait("document.getElementById('report-frame').contentDocument.querySelector('.tl-picture')")
        self.clean()

    def open_log(self, name, content):
        text = base64.b64encode(content).decode()
        self.run_script(f"agv.open(new File([Uint8Array.from(atob('{text}'), (one) => one.charCodeAt(0))], '{name}'))")

    def test_a_report_that_cannot_be_made_is_one_sentence(self):
        self.paused(2000)
        self.lose("/simulation/worker.js")
        self.run_script("agv.showReport()")
        self.assertEqual(self.run_script(MESSAGE), "The report cannot be made, because simulation/worker.js is missing or has failed.")
        Handler.missing = None
        self.run_script("agv.showReport()")
        self.assertEqual(self.run_script(MESSAGE), "")
        self.assertTrue(self.run_script("document.getElementById('report-dialog').open"))
        self.wait("document.getElementById('report-frame').contentDocument?.getElementById('headline')")
        self.lose("/report/report.css")
        self.run_script("document.getElementById('report-save').click()")
        self.wait(MESSAGE)
        self.assertEqual(self.run_script(MESSAGE), "The report cannot be saved, because report/report.css is missing.")

    def test_a_log_becomes_a_report(self):
        for name in ("ai-stops.log", "other-vehicle.log.gz"):
            with self.subTest(name):
                self.show()
                self.open_log(name, (EXAMPLE.parent / name).read_bytes())
                self.assertEqual(self.run_script(MESSAGE), "")
                self.wait("document.getElementById('report-frame').contentDocument?.getElementById('headline')")
                headline = self.run_script("document.getElementById('report-frame').contentDocument.getElementById('headline').textContent")
                self.assertIn(headline, native("replay", "--report", "-", EXAMPLE.parent / name))

    def test_a_log_of_two_interfaces_has_a_choice_of_the_ai_side(self):
        log = re.sub(rb"can0 (065|075|168|43F)#", rb"can1 \1#", EXAMPLE.read_bytes())
        data = "JSON.parse(/id=\"data\">(.*?)<\\/script>/s.exec(agv.reports.html)[1])"
        label = "document.getElementById('report-ai')"
        self.show()
        self.open_log("one.log", EXAMPLE.read_bytes())
        self.assertTrue(self.run_script(f"{label}.hidden"))
        self.open_log("gateway.log", log)
        self.assertFalse(self.run_script(f"{label}.hidden"))
        self.assertFalse(self.run_script(f"{data}.about.gateway"))
        self.assertEqual(self.run_script(f"[...{label}.querySelectorAll('option')].map((one) => one.value)"), ["", "can0", "can1"])
        self.run_script(f"const select = {label}.querySelector('select'); select.value = 'can1'; select.dispatchEvent(new Event('change'))")
        self.wait(f"{data}.about.gateway")
        self.assertEqual(self.run_script(f"[{data}.about.interfaces, {label}.querySelector('select').value]"), [["can0", "can1"], "can1"])
        self.clean()

    def test_bad_input_is_one_clear_sentence(self):
        self.show("#scenario=drive.yaml&t=5000&end=12")
        self.assertEqual(self.run_script(MESSAGE), "This link is incomplete, or it was changed. "
                         "The run starts from the beginning instead.")
        self.assertTrue(self.run_script("agv.playing"))
        cases = (("agv.set('steering_command_timeout_ms', 7)", r"^steering_command_timeout_ms: 7 is not within \d+ to \d+ ms$"),
                 ("agv.guard(() => agv.load('no/such.yaml'))", r"^There is no scenario no/such\.yaml\.$"),
                 ("agv.act('ai', 'set', { field: 'angle', value: 'x' })", r"^value: 'x' is not a hexadecimal number"))
        for script, sentence in cases:
            self.run_script(script)
            self.assertRegex(self.run_script(MESSAGE), sentence)
            self.assertFalse(self.run_script("agv.run.hasEnded"))
        for name, content, sentence in (("a.log", b"hello\n", r"^a\.log:1: "), ("a.gz", b"\x1f\x8b\x08hello", r"^a\.gz: the compressed data is damaged or cut off$"),
                                        ("a.log", b"", r"^a\.log: "), ("a.yaml", b"name: [", r"^a\.yaml:\d+: not YAML: ")):
            self.open_log(name, content)
            self.assertRegex(self.run_script(MESSAGE), sentence)

    def test_a_refused_file_leaves_the_run_where_it_stands(self):
        self.paused(3000)
        self.run_script("agv.run.inject('ai', 'mute', { message: 'steering_command' }); agv.run.step(500)")
        events = self.run_script("JSON.stringify(agv.run.events)")
        self.open_log("a.yaml", b"name: [")
        self.assertRegex(self.run_script(MESSAGE), r"^a\.yaml:")
        self.assertEqual(self.run_script("[agv.run.now, agv.run.plan.name, JSON.stringify(agv.run.events)]"), [3500, "drive.yaml", events])

    def test_a_refused_press_of_reset_is_said(self):
        self.paused(3000)
        self.run_script("agv.run.inject = (actor, word) => { if (word === 'press') throw new Error('The press is refused.'); }")
        self.click("Reset: the operator holds remote button 1 for 1.5 s")
        self.assertEqual(self.run_script(MESSAGE), "The press is refused.")

    def test_an_exception_pauses_the_run_and_is_said(self):
        self.show()
        self.run_script("agv.run.step = () => { throw new Error('step is broken'); }")
        self.wait(MESSAGE)
        self.assertEqual(self.run_script(MESSAGE), "The run was paused: internal error of the page (step is broken).")
        self.assertEqual(self.run_script("[agv.playing, document.querySelector('#transport button:nth-child(3)').textContent]"), [False, "\u25b6 Play"])
        self.run_script("delete agv.run.step; agv.before = agv.run.now; agv.play(true)")
        self.wait("agv.run.now > agv.before + 100")

    def test_a_module_that_cannot_be_loaded_is_one_sentence(self):
        self.lose("/agv.wasm")
        self.show(ready=False)
        self.wait(MESSAGE)
        self.assertEqual(self.run_script(MESSAGE), "The simulation cannot be loaded, because this browser refuses WebAssembly or agv.wasm is missing "
                         "(agv.wasm: 404).")
        self.assertEqual(self.run_script("document.getElementById('headline').textContent"), "There is no simulation.")


if __name__ == "__main__":
    if browser.find() is None:
        print("SKIPPED: there is no Chromium: the page was not tested. scripts/install-deps test installs it.")
        sys.exit(77)
    unittest.main(verbosity=2)
