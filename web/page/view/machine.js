// machine.js: the state machine with its present state lit up, LED, safety output, and the faults that are active.

import { byId, draw, make, mark, say } from "../dom.js";

export const STATES = ["INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"];
export const TONES = { INIT: "quiet", STANDBY: "calm", ACTIVE: "good", TRIPPED: "bad", SAFE: "warn" };

const PLACES = { INIT: [48, 34], STANDBY: [212, 34], ACTIVE: [376, 34], TRIPPED: [376, 122], SAFE: [212, 122] };
const ARROWS = [
  ["INIT", "STANDBY", "M94 34H162"], ["STANDBY", "ACTIVE", "M258 28H326"], ["ACTIVE", "STANDBY", "M330 40H262"],
  ["STANDBY", "TRIPPED", "M250 54L330 98"], ["ACTIVE", "TRIPPED", "M376 54V98"], ["TRIPPED", "SAFE", "M330 122H262"],
  ["SAFE", "STANDBY", "M212 102V58"],
];
const NOTES = [["healthy", 128, 27], ["engage", 294, 21], ["disengage", 294, 53], ["fault", 395, 80], ["P confirmed", 296, 115], ["reset", 192, 82]];

function drawMachine() {
  const svg = draw("svg", { viewBox: "0 0 424 146", role: "img", "aria-label": "States of the supervisor" },
    draw("defs", {}, draw("marker", { id: "tip", viewBox: "0 0 8 8", refX: 6, refY: 4, markerWidth: 6, markerHeight: 6, orient: "auto" },
      draw("path", { d: "M0 0L8 4L0 8z" }))));
  for (const [from, to, d] of ARROWS) svg.append(draw("path", { class: "arrow", d, "data-way": `${from}-${to}`, "marker-end": "url(#tip)" }));
  for (const [text, x, y] of NOTES) svg.append(draw("text", { class: "note", x, y, "text-anchor": "middle" }, text));
  for (const [name, [x, y]] of Object.entries(PLACES)) {
    svg.append(draw("g", { class: `state ${TONES[name]}`, "data-state": name },
      draw("rect", { x: x - 44, y: y - 18, width: 88, height: 36, rx: 6 }), draw("text", { x, y: y + 5, "text-anchor": "middle" }, name)));
  }
  return svg;
}

const lamp = (id) => {
  const element = make("span.lamp");
  element.id = id;
  return element;
};

export function makeMachine() {
  const svg = drawMachine();
  const led = make("p.indicator", lamp("led"), make("span", make("b", "LED "), text("led-text")));
  const output = make("p.indicator", lamp("output"), make("span", make("b", "Safety output "), text("output-text")));
  const faults = make("ul.active");
  byId("machine").append(svg, make("div.indicators", led, output), make("h3", "Active faults"), faults);

  function text(id) {
    const element = make("span");
    element.id = id;
    return element;
  }

  return (run) => {
    const { view } = run;
    const state = STATES[view.state] ?? "";
    const way = lastWay(run.events);
    for (const group of svg.querySelectorAll(".state")) group.classList.toggle("now", group.dataset.state === state && !view.is_halted);
    for (const arrow of svg.querySelectorAll(".arrow")) arrow.classList.toggle("now", arrow.dataset.way === way);
    byId("led").classList.toggle("on", view.led_on === 1);
    byId("led").dataset.code = Math.min(view.led_code, 1);
    say(byId("led-text"), view.led_code === 0 ? "slow: healthy" : view.led_code < 0 ? "fast: see the reason" : `code ${view.led_code}: ${view.led_code} flashes`);
    byId("output").classList.toggle("on", view.output_closed === 1);
    say(byId("output-text"), `${view.output_closed ? "closed" : "open"}${view.contact_closed !== view.output_closed ? ", its contact is not" : ""}`);
    showFaults(faults, run.active);
  };
}

function lastWay(events) {
  for (let i = events.length - 1; i >= 0; i--) {
    if (events[i].event === "state") return `${events[i].from}-${events[i].to}`;
  }
  return "";
}

function showFaults(list, active) {
  const key = [...active].join();
  if (list.dataset.key === key && list.childElementCount) return;
  list.dataset.key = key;
  list.replaceChildren(...[...active].map(([name, kind]) => make(`li.${kind}`, make("code", name))),
    ...(active.size ? [] : [make("li.none", "none")]));
  mark(list, "aria-label", "Active faults");
}
