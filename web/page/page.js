// page.js: puts the page together: one run, its parts on the screen, its time.

import { byId, say } from "./dom.js";
import { dataOf, Reports } from "./reports.js";
import { fromLink, toLink } from "./simulation/link.js";
import { instantiate } from "./simulation/module.js";
import { Run } from "./simulation/run.js";
import { makeBus } from "./view/bus.js";
import { makeEvents } from "./view/events.js";
import { makeExpectations } from "./view/expectations.js";
import { endsOf, makeFaults } from "./view/faults.js";
import { makeMachine } from "./view/machine.js";
import { makePicture } from "./view/picture.js";
import { makeSettings } from "./view/settings.js";
import { makeTransport } from "./view/transport.js";
import { makeVehicle } from "./view/vehicle.js";
import { makeVerdict } from "./view/verdict.js";

const DRIVE = "drive.yaml";
const SLOWLY_MS = 200; // between two drawings of what is read, not watched
const BUDGET_MS = 10; // of a screen frame, as fast as it goes
const LEAP_MS = 250; // a page that was hidden does not catch up
const LONG_RUN_MS = 600000; // a longer one is explained when it pauses

class Page {
  constructor(simulation) {
    this.run = new Run(simulation);
    this.lists = simulation.lists();
    this.playing = false;
    this.speed = 1;
    this.debt = 0;
    this.reports = new Reports();
    this.choices = { run: 0, report: 0 };
    this.plans = 0;
    this.explained = { key: "", trip: "", data: null };
  }

  build() {
    this.fast = [makeVehicle(), makeMachine()];
    this.slow = [makeBus(), makeEvents(), makeExpectations()];
    this.drawPicture = makePicture();
    this.drawVerdict = makeVerdict(this.lists);
    this.drawTransport = makeTransport(this);
    this.showSettings = makeSettings(this.lists, (name, value) => this.set(name, value));
    makeFaults(this.lists, this);
    say(byId("version"), `Version ${this.lists.version}.`);
    byId("link").addEventListener("click", () => this.copyLink());
    byId("report").addEventListener("click", () => this.showReport());
    byId("report-save").addEventListener("click", () => this.guard(() => this.reports.save()));
    byId("file").addEventListener("change", ({ target }) => this.open(target.files[0]).then(() => (target.value = "")));
    byId("scenario").addEventListener("change", ({ target }) => this.guard(() => this.load(target.value)));
    addEventListener("hashchange", () => this.openLink());
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      this.open(event.dataTransfer.files[0]);
    });
    addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const itsOwn = event.key === " " ? "button, summary, input, select, dialog" : "input:not([type=file]), select, dialog";
    if (event.target.closest(itsOwn) || event.ctrlKey || event.metaKey || event.altKey) return;
    const keys = { " ": () => this.play(!this.playing), ".": () => this.step(1), ",": () => this.step(-1), n: () => this.toEvent() };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }

  // --- messages

  complain(error) {
    const element = byId("message");
    say(element, error.message);
    element.hidden = false;
    byId("report-dialog").close(); // it would hide the message
  }

  hush() {
    byId("message").hidden = true;
  }

  /** Do something that may refuse: its sentence is shown. */
  async guard(action) {
    this.hush();
    try {
      await action();
    } catch (error) {
      this.complain(error);
      this.showChoice(); // what was chosen does not run
    }
  }

  /** Of several choices the last one counts, not the one that is there last. @return a function: is this the last one? */
  choose(what) {
    const number = ++this.choices[what];
    return () => number === this.choices[what];
  }

  // --- runs

  /** @param file of the list of scenarios */
  async load(file, { settings = {}, steps = [], t = 0 } = {}) {
    const isLast = this.choose("run");
    const response = await fetch(file === DRIVE ? file : `scenarios/${file}`);
    const text = await response.text();
    if (!isLast()) return;
    if (!response.ok) throw new Error(`There is no scenario ${file}.`);
    this.beginPlan({ name: file, text, settings, steps });
    this.run.seek(t);
    this.play(t === 0);
  }

  /** The list of scenarios names the one that runs; it has no name for one of your own. */
  showChoice() {
    const { plan } = this.run;
    byId("scenario").value = plan && !plan.isOwn ? plan.name : "";
  }

  /** @throws Error with a sentence; the run before stands where it was then */
  beginPlan(plan) {
    const before = this.run.view ? { plan: this.run.plan, now: this.run.now } : null;
    const title = /^name: *(.*)/m.exec(plan.text)?.[1] ?? plan.name;
    try {
      this.run.begin({ ...plan, title });
      this.plans++;
    } catch (error) {
      if (before) this.goBack(before);
      throw error;
    } finally {
      this.showChoice();
      this.showSettings(this.run.plan.settings);
      this.draw(true);
    }
  }

  goBack({ plan, now }) {
    this.run.begin(plan);
    this.run.seek(now);
  }

  begin() {
    this.guard(() => {
      this.beginPlan({ ...this.run.plan, steps: [] });
      this.play(true);
    });
  }

  set(name, value) {
    this.guard(() => {
      const { plan, now } = this.run;
      const settings = name === null ? {} : { ...plan.settings, [name]: value };
      if (value === null) delete settings[name];
      this.beginPlan({ ...plan, settings });
      this.run.seek(now);
      this.draw(true);
    });
  }

  act(actor, word, parameters) {
    this.actAll([[actor, word, parameters]]);
  }

  /** @param steps each as run.inject() takes it */
  actAll(steps) {
    this.guard(() => {
      steps.forEach((step) => this.run.inject(...step));
      this.run.step(1); // what trips at once is in the next picture
      if (!this.playing) this.play(true);
    });
  }

  endFaults() {
    this.guard(() => endsOf(this.run.plan.steps).forEach((step) => this.run.inject(...step)));
  }

  // --- time

  play(on) {
    this.playing = on && !this.run.hasEnded;
    this.last = performance.now();
    this.debt = 0;
    this.draw(true);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.draw(true);
  }

  step(ms) {
    this.playing = false;
    if (ms < 0) this.run.seek(this.run.now + ms);
    else this.run.step(ms);
    this.draw(true);
  }

  toEvent() {
    this.playing = false;
    this.run.stepToEvent();
    this.draw(true);
  }

  advance(now) {
    const passed = Math.min(Math.max(now - this.last, 0), LEAP_MS); // a frame can have begun before play()
    this.last = now;
    if (this.speed === Infinity) {
      const end = performance.now() + BUDGET_MS;
      while (performance.now() < end && this.run.step(100) > 0);
    } else {
      this.debt += passed * this.speed;
      const whole = Math.floor(this.debt);
      this.debt -= whole;
      this.run.step(whole);
    }
    if (this.run.hasEnded) this.play(false);
  }

  frame(now) {
    requestAnimationFrame((next) => this.frame(next)); // first: whatever happens, there is a next frame
    try {
      if (this.playing) this.advance(now);
      if (this.playing) this.draw(false);
    } catch (error) {
      this.stop(error);
    }
  }

  /** Something is wrong that nobody expected. */
  stop(error) {
    this.playing = false;
    console.error(error);
    this.complain(new Error(`The run was paused: internal error of the page (${error.message}).`));
    this.drawTransport(this.run);
  }

  // --- drawing

  /** @param all also what changes slowly */
  draw(all) {
    if (!this.run.view) return;
    const now = performance.now();
    this.fast.forEach((draw) => draw(this.run));
    this.drawWords();
    this.drawTransport(this.run);
    if (all || now - (this.drawn ?? 0) >= SLOWLY_MS) {
      this.drawn = now;
      this.slow.forEach((draw) => draw(this.run));
      this.drawPicture(this.run, this.playing);
      this.explain();
    }
  }

  /** A name of the trip that is the last one now. */
  get trip() {
    return `${this.plans},${this.run.trips}`;
  }

  /** The sentences, with the words about a trip if they are about this one. */
  drawWords() {
    this.drawVerdict(this.run, this.explained.trip === this.trip ? this.explained.data : null);
  }

  /** Ask for the words about a trip, when there is something new to say. */
  async explain() {
    const { run, trip } = this;
    if (run.view.reason < 0 || this.explaining || (this.playing && run.now > LONG_RUN_MS)) return;
    const isStanding = run.view.speed_mm_s === 0;
    const key = [trip, run.plan.steps.length, run.view.state, isStanding].join();
    if (key === this.explained.key) return;
    this.explaining = true;
    try {
      const { html } = await this.reports.make({ kind: "run", plan: run.plan, until: run.now });
      this.explained = { key, trip, data: dataOf(html) };
    } catch {
      this.explained = { key, trip, data: null }; // the plain sentence stays
    }
    this.explaining = false;
    this.drawWords();
    this.explain(); // about what happened in the meantime
  }

  // --- links, reports, files

  openLink() {
    return this.guard(async () => {
      const hash = location.hash.slice(1);
      if (!hash) return this.load(DRIVE);
      let link;
      try {
        link = fromLink(hash);
        await this.load(link.scenario, link);
      } catch (error) {
        if (!this.run.view) await this.load(DRIVE);
        throw error;
      }
      return undefined;
    });
  }

  copyLink() {
    return this.guard(async () => {
      const { plan, now } = this.run;
      if (plan.isOwn) throw new Error("A link does not contain your own scenario: send its file with the link.");
      const hash = toLink({ scenario: plan.name, settings: plan.settings, steps: plan.steps, t: now });
      history.replaceState(null, "", `#${hash}`);
      const isCopied = await copy(location.href);
      say(byId("link"), isCopied ? "Link copied" : "The link is in the address bar");
      setTimeout(() => say(byId("link"), "Copy link"), isCopied ? 2000 : 4000);
    });
  }

  showReport() {
    return this.guard(async () => {
      const isLast = this.choose("report");
      const { plan, now } = this.run;
      this.play(false);
      const { html } = await this.reports.make({ kind: "run", plan, until: now });
      if (isLast()) this.reports.show(html, plan.title);
    });
  }

  /** @param aiInterface of a log: the interface of the AI side; "": a shared bus */
  open(file, aiInterface = "") {
    return this.guard(async () => {
      if (!file) return;
      if (/\.ya?ml$/.test(file.name)) return this.openScenario(file);
      const isLast = this.choose("report");
      const bytes = new Uint8Array(await file.arrayBuffer());
      const request = { kind: "log", name: file.name, bytes, settings: this.run.plan?.settings ?? {}, aiInterface };
      this.play(false);
      const { html, interfaces } = await this.reports.make(request, [bytes.buffer]);
      if (isLast()) this.reports.show(html, file.name, { interfaces, aiInterface, choose: (name) => this.open(file, name) });
    });
  }

  async openScenario(file) {
    const isLast = this.choose("run");
    const text = await file.text();
    if (!isLast()) return;
    this.beginPlan({ name: file.name, text, settings: {}, steps: [], isOwn: true });
    this.play(true);
  }
}

/** @return whether it is in the clipboard: a page that came by http has none, and the user can refuse it */
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

/** The list of scenarios: a line for each, its file and its name. */
async function fillScenarios() {
  const select = byId("scenario");
  select.append(new Option("Free drive", DRIVE));
  const groups = new Map();
  for (const line of (await (await fetch("scenarios/list.txt")).text()).split("\n").filter(Boolean)) {
    const [file, name] = line.split("\t");
    const [folder] = file.split("/");
    if (!groups.has(folder)) {
      const group = document.createElement("optgroup");
      group.label = folder;
      groups.set(folder, group);
      select.append(group);
    }
    groups.get(folder).append(new Option(name, file));
  }
}

async function start() {
  let simulation;
  try {
    const response = await fetch("agv.wasm");
    if (!response.ok) throw new Error(`agv.wasm: ${response.status}`);
    simulation = await instantiate(await WebAssembly.compile(await response.arrayBuffer()));
  } catch (error) {
    byId("message").textContent = `The simulation cannot be loaded, because this browser refuses WebAssembly or agv.wasm is missing (${error.message}).`;
    byId("message").hidden = false;
    byId("headline").textContent = "There is no simulation.";
    return;
  }
  const page = new Page(simulation);
  page.build();
  await fillScenarios();
  await page.openLink();
  requestAnimationFrame((now) => page.frame(now));
  document.documentElement.dataset.ready = "yes";
  globalThis.agv = page; // for the console
}

start();
