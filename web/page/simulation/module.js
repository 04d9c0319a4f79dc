// module.js: the WebAssembly module as functions of JavaScript. web/wasm/web_sim.h is its manual.

const VIEW = ["t_ms", "duration_ms", "has_ended", "state", "reason", "is_halted", "output_closed", "contact_closed", "stop_open",
  "led_on", "led_code", "gear", "autopilot", "speed_mm_s", "throttle_permille", "eps_mode", "angle_ddeg", "alarms",
  "vcu_runs", "eps_runs", "ai_runs", "button_1", "ai_gear", "supervisor_gear", "ai_throttle_permille",
  "supervisor_throttle_permille", "ai_angle_ddeg", "supervisor_angle_ddeg", "event_count", "failure_count", "bus_permille"];

/** As a number: there is none. */
export const NONE = -2147483648;

const INVALID = 28; // errno of WASI
const NOT_SUPPORTED = 52;

/** The imports of WASI: what is printed is collected as text, standard input is bytes. Nothing else is there. */
class System {
  constructor() {
    this.texts = { 1: "", 2: "" };
    this.input = new Uint8Array();
    this.at = 0;
    this.decoder = { 1: new TextDecoder(), 2: new TextDecoder() };
  }

  /** What was written since the last call. @param descriptor 1: standard output, 2: standard error */
  take(descriptor) {
    const text = this.texts[descriptor];
    this.texts[descriptor] = "";
    return text;
  }

  feed(bytes) {
    this.input = bytes;
    this.at = 0;
  }

  /** The pieces of memory of a list of WASI. */
  pieces(list, count) {
    const view = new DataView(this.memory.buffer);
    return Array.from({ length: count }, (_, i) =>
      new Uint8Array(this.memory.buffer, view.getUint32(list + i * 8, true), view.getUint32(list + i * 8 + 4, true)));
  }

  write(descriptor, list, count, result) {
    if (!(descriptor in this.texts)) return INVALID;
    let size = 0;
    for (const piece of this.pieces(list, count)) {
      this.texts[descriptor] += this.decoder[descriptor].decode(piece, { stream: true });
      size += piece.length;
    }
    new DataView(this.memory.buffer).setUint32(result, size, true);
    return 0;
  }

  read(descriptor, list, count, result) {
    if (descriptor !== 0) return INVALID;
    let size = 0;
    for (const piece of this.pieces(list, count)) {
      const part = this.input.subarray(this.at, this.at + piece.length);
      piece.set(part);
      this.at += part.length;
      size += part.length;
    }
    new DataView(this.memory.buffer).setUint32(result, size, true);
    return 0;
  }

  imports(module) {
    const known = {
      fd_write: (...all) => this.write(...all),
      fd_read: (...all) => this.read(...all),
      fd_fdstat_get: () => 0,
      fd_close: () => 0,
      proc_exit: (status) => {
        throw new Error(`the simulation ended with status ${status}`);
      },
    };
    const names = WebAssembly.Module.imports(module).map((one) => one.name);
    return { wasi_snapshot_preview1: Object.fromEntries(names.map((name) => [name, known[name] ?? (() => NOT_SUPPORTED)])) };
  }
}

/** What the module said was wrong, as a sentence for people: without the name of the program. */
function sentence(text) {
  return text.trim().split("\n")[0].replace(/^host_sim: /, "").replace(/^step:\d+: /, "").replace(/^settings:\d+: /, "");
}

/** One instance of the module. Functions that can refuse their input throw an Error with the sentence. */
export class Simulation {
  constructor(instance, system) {
    this.exports = instance.exports;
    this.system = system;
    system.memory = instance.exports.memory;
    this.exports._initialize?.();
    this.encoder = new TextEncoder();
    this.decoder = new TextDecoder();
  }

  /** Call a function with texts as its first arguments. */
  call(name, texts, ...numbers) {
    const places = texts.map((text) => {
      const bytes = this.encoder.encode(text);
      const at = this.exports.web_alloc(bytes.length + 1);
      const memory = new Uint8Array(this.exports.memory.buffer, at, bytes.length + 1);
      memory.set(bytes);
      memory[bytes.length] = 0;
      return at;
    });
    const result = this.exports[name](...places, ...numbers);
    places.forEach((at) => this.exports.web_free(at));
    return result;
  }

  text(at) {
    if (at === 0) return "";
    const memory = new Uint8Array(this.exports.memory.buffer);
    return this.decoder.decode(memory.subarray(at, memory.indexOf(0, at)));
  }

  /** @throws Error if @p good is 0 */
  check(good) {
    const said = sentence(this.system.take(2));
    if (!good) throw new Error(said || "the simulation refused this");
    return good;
  }

  lists() {
    return JSON.parse(this.text(this.exports.web_lists()));
  }

  create(name, scenario, settings = "", withReport = false) {
    this.check(this.call("web_create", [name, scenario, settings], withReport ? 1 : 0));
  }

  inject(step) {
    this.check(this.call("web_inject", [step]));
  }

  step(ms) {
    return this.exports.web_step(ms);
  }

  /** The members of web_view_t. */
  view() {
    const numbers = new Int32Array(this.exports.memory.buffer, this.exports.web_view(), VIEW.length);
    return Object.fromEntries(VIEW.map((name, i) => [name, numbers[i]]));
  }

  /** The events since the last call, as lines. */
  eventText() {
    return this.text(this.exports.web_events());
  }

  bus() {
    return JSON.parse(this.text(this.exports.web_bus()));
  }

  frames(count) {
    return JSON.parse(this.text(this.exports.web_frames(count)));
  }

  expectations() {
    return JSON.parse(this.text(this.exports.web_expectations()));
  }

  /** The report of the run, which is over then. */
  report() {
    return this.text(this.check(this.exports.web_report()));
  }

  /** Replay a log. @param bytes of it, unpacked @return the report */
  replay(name, bytes, settings = "", aiInterface = "") {
    this.system.feed(bytes);
    const report = this.check(this.call("web_replay", [name, settings, aiInterface]));
    this.system.feed(new Uint8Array());
    return this.text(report);
  }

  /** The names of the interfaces of the log of the last replay(). */
  interfaces() {
    return this.text(this.exports.web_interfaces()).split("\n").filter(Boolean);
  }
}

/** @param module a compiled WebAssembly.Module */
export async function instantiate(module) {
  const system = new System();
  return new Simulation(await WebAssembly.instantiate(module, system.imports(module)), system);
}
