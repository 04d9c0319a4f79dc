// run.js: a run of the simulation: its scenario, settings and added steps, its time, its events, its history. It knows
// nothing of the page.

import { History, SAMPLE_MS } from "./history.js";
import { NONE } from "./module.js";

const EVENTS_KEPT = 500;
const GEARS = { 1: "D", 2: "R", 4: "N", 8: "P" };
const valueOf = (number) => (number === NONE ? null : number);
const gearOf = (number) => (number === NONE ? null : GEARS[number] ?? "?");

/** A step as a scenario file has it: "{at_ms: 3000, eps: set, field: faults, value: 08h}". */
export function stepText({ at, actor, word, parameters }) {
  const values = Object.entries(parameters).map(([name, value]) => `, ${name}: ${/^[\w.-]+$|^\[/.test(value) ? value : `"${value}"`}`);
  return `{at_ms: ${at}, ${actor}: ${word}${values.join("")}}`;
}

/** Settings as a configuration file has them. */
export const settingsText = (settings) => Object.entries(settings).map(([name, value]) => `${name}: ${value}\n`).join("");

export class Run {
  /** @param simulation of module.js */
  constructor(simulation) {
    this.simulation = simulation;
  }

  /**
   * Begin anew. @param plan { name, text, settings: { name: value }, steps: [{ at, actor, word, parameters }] }
   * @throws Error with a sentence; the run before is over then
   */
  begin(plan) {
    this.plan = { settings: {}, steps: [], ...plan };
    this.history = new History();
    this.events = [];
    this.active = new Map(); // faults: name -> class
    this.trips = 0;
    this.simulation.create(plan.name, plan.text, settingsText(this.plan.settings));
    this.plan.steps.forEach((step) => this.simulation.inject(stepText(step)));
    this.look();
  }

  /** The time that was played, in ms. */
  get now() {
    return this.view.t_ms + 1;
  }

  get hasEnded() {
    return this.view.has_ended !== 0;
  }

  /** Add a step, now. @throws Error with a sentence */
  inject(actor, word, parameters = {}, after = 0) {
    const step = { at: this.now + after, actor, word, parameters };
    this.simulation.inject(stepText(step));
    this.plan.steps.push(step);
  }

  /** Play. @return how many milliseconds were played */
  step(ms) {
    let played = 0;
    while (played < ms) {
      const count = this.simulation.step(Math.min(ms - played, SAMPLE_MS - (this.now % SAMPLE_MS)));
      if (count === 0) break;
      played += count;
      this.look();
    }
    return played;
  }

  /** Play until something happens that is worth a line. */
  stepToEvent(most = 60000) {
    const before = this.view.event_count;
    for (let ms = 0; ms < most && this.view.event_count === before; ms++) {
      if (this.step(1) === 0) break;
    }
  }

  /** Go to a time, also back: the same run is played again. */
  seek(t) {
    if (t < this.now) this.begin(this.plan);
    this.step(Math.max(t, 0) - this.now);
  }

  look() {
    const before = this.view?.event_count ?? 0;
    this.view = this.simulation.view();
    if (this.view.event_count !== before || !this.events.length) this.readEvents();
    if (this.now % SAMPLE_MS === 0 || this.hasEnded) this.sample();
  }

  readEvents() {
    for (const line of this.simulation.eventText().split("\n")) {
      if (line) this.take(JSON.parse(line));
    }
    if (this.events.length > EVENTS_KEPT) this.events.splice(0, this.events.length - EVENTS_KEPT);
  }

  take(event) {
    const { history } = this;
    const t = event.t_ms;
    this.events.push(event);
    if (event.event === "state") {
      history.lane("state", t, event.to);
      if (event.from === null) this.active.clear(); // the supervisor started
      if (event.to === "TRIPPED" && event.from !== "SAFE") this.trips++;
    } else if (event.event === "safety_output") history.lane("output", t, event.closed ? "closed" : "open");
    else if (event.event === "led") history.lane("led", t, event.code);
    else if (event.event === "fault") {
      history.fault(event.name, t, event.active ? event.class : null);
      if (event.active) this.active.set(event.name, event.class);
      else this.active.delete(event.name);
    }
  }

  sample() {
    const { history, view, now: t } = this;
    history.line("speed", t, view.speed_mm_s / 1000);
    history.line("throttle", t, view.throttle_permille / 10);
    history.line("angle", t, view.angle_ddeg / 10);
    for (const who of ["ai", "supervisor"]) {
      const throttle = valueOf(view[`${who}_throttle_permille`]);
      const angle = valueOf(view[`${who}_angle_ddeg`]);
      history.line(`${who}_throttle`, t, throttle === null ? null : throttle / 10);
      history.line(`${who}_angle`, t, angle === null ? null : angle / 10);
      history.lane(`${who}_gear`, t, gearOf(view[`${who}_gear`]));
    }
    history.lane("mode", t, view.autopilot ? "autopilot" : "manual");
    history.lane("gear", t, gearOf(view.gear));
  }
}
