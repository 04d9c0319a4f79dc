// faults.js: what can be done to the vehicle, the bus and the supervisor: the common faults as buttons of their own, and
// every action that a scenario file knows.

import { button, byId, make, words } from "../dom.js";

const FOREIGN = { message: "gear_command", bytes: "01 00 00 00 00 00 00 00", every_ms: "20" };

/** title, actor, word, parameters */
const COMMON = [
  ["AI computer", [["falls silent", "ai", "stop"], ["counter freezes", "ai", "freeze_counter"], ["no steering command", "ai", "mute", { message: "steering_command" }],
    ["angle out of range", "ai", "set", { field: "angle", value: "FFFFh" }]]],
  ["EPS (power steering)", [["falls silent", "eps", "stop"], ["over-current", "eps", "set", { field: "faults", value: "08h" }], ["does not move", "eps", "stick"],
    ["sends garbage", "eps", "garbage", { kind: "random" }]]],
  ["VCU (drive)", [["falls silent", "vcu", "stop"], ["counter freezes", "vcu", "freeze_counter"], ["refuses gear P", "vcu", "refuse_park"],
    ["obeys no throttle", "vcu", "ignore", { message: "throttle_command" }]]],
  ["Operator", [["emergency stop", "board", "open_emergency_stop"], ["remote signal lost", "operator", "lose_remote_signal"]]],
  ["Bus", [["rogue node commands D", "bus", "send", FOREIGN], ["supervisor bus-off", "supervisor", "bus_off"], ["supervisor cannot send", "supervisor", "stall_tx"]]],
  ["Supervisor", [["hangs for 0.3 s", "supervisor", "hang", { for_ms: "300" }], ["a bit of memory flips", "supervisor", "flip_bit", { bit: "100" }],
    ["its contact is welded", "board", "weld_contact"], ["its clock is slow", "board", "slow_clock", { permille: "200" }]]],
];

/** What ends an action: a word, or "recover" of its node. */
const ENDS = {
  stop: "start", roll: "hold", refuse_park: "take_park", be_sloppy: "be_strict", be_stubborn: "be_obedient", ask_autopilot_off: "ask_nothing",
  hunt: "stop_hunting", stick: "unstick", lose_remote_signal: "regain_remote_signal", lose_remote_power: "regain_remote_power", send: "stop_sending",
  stall_tx: "free_tx", swallow_tx: "pass_tx", fill_queue: "free_queue", error_passive: "error_active", weld_contact: "repair_contact",
  stick_contact: "repair_contact", invert_feedback: "restore_feedback", open_emergency_stop: "close_emergency_stop", slow_clock: "right_clock",
  fast_clock: "right_clock", ignore: "obey",
};
const NODES = ["vcu", "eps", "ai"];
const RECOVERED = ["freeze_counter", "lag", "repeat", "garbage", "mute", "send_every", "delay", "set", "set_bytes", "freeze_field"];

/** The steps that end what was done. */
export function endsOf(steps) {
  const ends = new Map();
  for (const { actor, word, parameters } of steps) {
    const end = RECOVERED.includes(word) && NODES.includes(actor) ? "recover" : ENDS[word];
    if (end) ends.set(`${actor} ${end} ${end === "obey" ? parameters.message : ""}`, [actor, end, end === "obey" ? { message: parameters.message } : {}]);
  }
  return [...ends.values()];
}

const CHOICES = {
  gear: ["D", "R", "N", "P"], side: ["vehicle", "ai"], cause: ["power-on", "watchdog", "brown-out", "lock-up", "software", "unknown"], button: ["1", "2"],
  part: ["flash", "ram", "processor", "watchdog", "devices", "supply"],
};
const KINDS = { garbage: ["random", "wrong_length", "extended", "remote"], deliver: ["data", "extended", "remote", "fd", "error"], send: ["data", "extended", "remote", "fd"] };
const DEFAULTS = {
  off_ms: "500", by_ms: "50", times: "1", frames: "3", every_frames: "10", every_ms: "50", value: "01h", bytes: "08 00 00 00 00 00 00 00", throttle_pct: "30",
  steer_deg: "20", id: "168h", for_ms: "300", bit: "100", pct_s: "20", speed_mm_s: "1000", pattern_ms: "[5, 5, 5]", permille: "100",
};

/** The field of a form for a parameter. */
function makeField(name, action, actor, lists) {
  const choices = { ...CHOICES, kind: KINDS[action.word], field: lists.fields.filter((field) => field.actor === actor).map((field) => field.name),
    message: messagesOf(action, actor, lists) }[name];
  const isNeeded = action.needs.includes(name);
  const input = make(choices ? "select" : "input");
  if (choices) input.append(...(isNeeded ? [] : [new Option("", "")]), ...choices.map((one) => new Option(one, one)));
  else Object.assign(input, { value: isNeeded ? DEFAULTS[name] ?? "" : "", size: Math.max((DEFAULTS[name] ?? "").length, 6), placeholder: isNeeded ? "" : "optional" });
  input.name = name;
  return make("label", `${words(name)} `, input);
}

function messagesOf(action, actor, lists) {
  if (action.word === "ignore" || action.word === "obey") return lists.messages.filter((one) => one.command).map((one) => one.name);
  return lists.messages.filter((one) => !NODES.includes(actor) || one.sender === actor).map((one) => one.name);
}

function makeForm(action, actor, lists, act) {
  const form = make("form.parameters", make("b", words(action.word)), ...[...action.needs, ...action.takes].map((name) => makeField(name, action, actor, lists)));
  const go = make("button.primary", "Do it");
  form.append(go);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    act(actor, action.word, Object.fromEntries([...new FormData(form)].filter(([, value]) => value !== "")));
  });
  return form;
}

function makeAll(lists, act) {
  const NAMES = { vcu: "VCU", eps: "EPS", ai: "AI computer", operator: "operator", bus: "bus", supervisor: "supervisor", board: "board of the supervisor" };
  return Object.entries(NAMES).map(([actor, name]) => {
    const place = make("div");
    const actions = lists.actions.filter((action) => action.actor === actor || (action.actor === "node" && NODES.includes(actor)));
    const buttons = actions.map((action) => button(words(action.word), () => {
      if (!action.needs.length && !action.takes.length) {
        place.replaceChildren();
        act(actor, action.word, {});
      } else place.replaceChildren(makeForm(action, actor, lists, act));
    }, `${name}: ${words(action.word)}`));
    return make("details", make("summary", `${name}: all ${actions.length} actions`), make("div.buttons", ...buttons), place);
  });
}

/** @param control { act(actor, word, parameters), actAll(steps), endFaults() } */
export function makeFaults(lists, control) {
  const act = (...step) => control.act(...step);
  const common = COMMON.map(([name, rows]) => make("div.group", make("h3", name), make("div.buttons",
    ...rows.map(([title, actor, word, parameters]) => button(title, () => act(actor, word, parameters ?? {}), `${name}: ${title}`)))));
  const reset = button("Reset", () => {
    control.actAll([["operator", "press", { button: "1" }], ["operator", "release", { button: "1" }, 1500]]);
  }, "Reset: the operator holds remote button 1 for 1.5 s");
  byId("faults").append(
    make("div.buttons.operator", button("End all faults", () => control.endFaults()), reset, button("Engage autopilot", () => act("operator", "engage", {}))),
    ...common, ...makeAll(lists, act));
}
