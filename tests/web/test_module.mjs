// The module without a page: events of all scenario files as host_sim writes them, byte for byte; its size; what it
// says of bad input. Run by ctest of the preset wasm: AGV_WASM is the module, HOST_SIM the native program.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { gzipSync } from "node:zlib";
import { instantiate, NONE } from "../../web/page/simulation/module.js";

const ROOT = join(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");
const SCENARIOS = join(ROOT, "host_sim/scenarios");
const FILES = readdirSync(SCENARIOS, { recursive: true }).filter((name) => name.endsWith(".yaml")).sort();
const LEAST = Number(/^LEAST = (\d+)/m.exec(readFileSync(join(ROOT, "tests/host_sim/program/hostsim.py"), "utf8"))[1]);
const SIZE_MAX = 300000;
const DEMO = readFileSync(join(SCENARIOS, "overview/demo.yaml"), "utf8");
const bytes = readFileSync(process.env.AGV_WASM);
const compiled = await WebAssembly.compile(bytes);

const SHORT = `name: short
shows: [SUP-2]
duration_ms: 6000
steps:
  - {at_ms: 700, ai: drive, gear: D, throttle_pct: 30}
  - {at_ms: 1200, operator: engage}
expect:
  states: [{to: INIT, at_ms: 0}, {to: STANDBY, at_ms: [510, 513]}]
`;

function native(...args) {
  const result = spawnSync(process.env.HOST_SIM, args, { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.ok(result.status < 2, result.stderr);
  return result.stdout;
}

async function started(scenario = SHORT, settings = "") {
  const simulation = await instantiate(compiled);
  simulation.create("short.yaml", scenario, settings);
  return simulation;
}

test("events of every scenario file are byte for byte those of host_sim", async () => {
  assert.ok(FILES.length >= LEAST);
  const simulation = await instantiate(compiled);
  for (const file of FILES) {
    simulation.create(file, readFileSync(join(SCENARIOS, file), "utf8"));
    simulation.step(1e9);
    assert.equal(simulation.eventText(), native("scenario", "--events", "-", join(SCENARIOS, file)), file);
    const { items, failures } = simulation.expectations();
    assert.deepEqual(failures, [], file);
    assert.ok(items.every((item) => item[2] === "passed"), file);
  }
  console.log(`${FILES.length} scenario files`);
});

test("a run is the same however it is cut", async () => {
  const whole = await started(DEMO);
  whole.step(1e9);
  const cut = await started(DEMO);
  let text = "";
  for (let ms = 1; cut.step(ms) > 0; ms = (ms * 7) % 97 + 1) text += cut.eventText();
  assert.equal(text + cut.eventText(), whole.eventText());
});

test("the size", () => {
  console.log(`${bytes.length} bytes, ${gzipSync(bytes, { level: 9 }).length} compressed`);
  assert.ok(bytes.length <= SIZE_MAX);
});

test("a step that is injected acts at its time", async () => {
  const simulation = await started();
  simulation.step(3000);
  simulation.inject("{at_ms: 3000, eps: set, field: faults, value: 08h}");
  simulation.step(20);
  assert.match(simulation.eventText(), /"t_ms": 30\d\d, "event": "state", "from": "ACTIVE", "to": "TRIPPED", "reason": "EPS_OVER_CURRENT_SHUTDOWN"/);
  assert.equal(simulation.view().state, 3);
});

test("settings are laid over those of the scenario", async () => {
  const simulation = await started(SHORT, "steering_command_timeout_ms: 80\n");
  simulation.step(3000);
  simulation.inject("{at_ms: 3000, ai: mute, message: steering_command}");
  simulation.step(100);
  assert.match(simulation.eventText(), /"reason": "STEERING_COMMAND_TIMEOUT"/);
});

test("the view, the bus and the frames", async () => {
  const simulation = await started();
  assert.equal(simulation.view().t_ms, -1);
  simulation.step(2901);
  const view = simulation.view();
  assert.deepEqual([view.t_ms, view.state, view.gear, view.autopilot, view.reason], [2900, 2, 1, 1, NONE]);
  assert.ok(view.speed_mm_s > 500 && view.bus_permille > 100);
  const row = simulation.bus().find((one) => one.name === "steering_command");
  assert.deepEqual([row.id, row.from, row.rate, row.gap_us, row.deadline_ms], ["065h", "AI computer", 40, 25000, 125]);
  const frames = simulation.frames(3);
  assert.equal(frames.length, 3);
  assert.equal(frames[2].number - frames[0].number, 2);
});

test("the report is that of host_sim", async () => {
  const simulation = await instantiate(compiled);
  simulation.create(JSON.parse('"' + /name: (.*)/.exec(DEMO)[1] + '"'), DEMO, "", true);
  simulation.step(1e9);
  const data = /id="data">(.*?)<\/script>/s;
  const own = JSON.parse(data.exec(simulation.report())[1]);
  const other = JSON.parse(data.exec(native("scenario", "--report", "-", join(SCENARIOS, "overview/demo.yaml")))[1]);
  assert.deepEqual(own, other);
});

test("the report of a log is that of host_sim", async () => {
  const simulation = await instantiate(compiled);
  const log = join(ROOT, "host_sim/examples/ai-stops.log");
  const data = /id="data">(.*?)<\/script>/s;
  const own = JSON.parse(data.exec(simulation.replay("ai-stops.log", readFileSync(log)))[1]);
  const other = JSON.parse(data.exec(native("replay", "--report", "-", log))[1]);
  other.about.name = "ai-stops.log";
  own.about.clock = other.about.clock; // a page without a time zone
  assert.deepEqual(own, other);
});

test("a log of a gateway has the interface of its AI side", async () => {
  const simulation = await instantiate(compiled);
  const folder = mkdtempSync(join(tmpdir(), "agv-web-"));
  const log = join(folder, "gateway.log");
  writeFileSync(log, readFileSync(join(ROOT, "host_sim/examples/ai-stops.log"), "utf8").replace(/can0 (065|075|168|43F)#/g, "can1 $1#"));
  const data = /id="data">(.*?)<\/script>/s;
  const ofPage = (ai) => JSON.parse(data.exec(simulation.replay("gateway.log", readFileSync(log), "topology: gateway\n", ai))[1]);
  const ofProgram = (...options) => JSON.parse(data.exec(native("replay", "--report", "-", ...options, log))[1]);
  for (const [ai, ...options] of [["can1", "--ai-if", "can1"], [""]]) {
    const [own, other] = [ofPage(ai), ofProgram(...options)];
    assert.equal(own.about.gateway, ai !== "");
    assert.deepEqual({ ...own, about: { ...own.about, name: "", clock: "" } }, { ...other, about: { ...other.about, name: "", clock: "" } });
    assert.deepEqual(simulation.interfaces(), ["can0", "can1"]);
  }
  assert.throws(() => simulation.replay("a.log", Buffer.from("hello\n")));
  assert.deepEqual(simulation.interfaces(), []);
  rmSync(folder, { recursive: true });
});

test("bad input is one sentence", async () => {
  const simulation = await instantiate(compiled);
  const says = (what, sentence) => assert.throws(what, { message: sentence });
  says(() => simulation.inject("{at_ms: 1, ai: stop}"), "there is no run");
  says(() => simulation.create("x.yaml", "name: [", ""), /^x\.yaml:\d+: not YAML/);
  says(() => simulation.create("x.yaml", "", ""), "x.yaml: contains no scenario");
  says(() => simulation.create("short.yaml", SHORT, "steering_command_timeout_ms: 7\n"),
    /^steering_command_timeout_ms: 7 is not within \d+ to \d+ ms$/);
  simulation.create("short.yaml", SHORT);
  simulation.step(100);
  says(() => simulation.inject("{at_ms: 5, ai: stop}"), "5 ms has passed");
  says(() => simulation.inject("{at_ms: 500, ai: fly}"), "ai: unknown action 'fly'; docs/scenarios.md lists them");
  says(() => simulation.inject("{at_ms: 500"), /^not YAML/);
  says(() => simulation.replay("a.log", Buffer.from("hello\n")), /^a\.log:1: .*candump/);
  says(() => simulation.replay("a.log", Buffer.from("")), /^a\.log: /);
});
