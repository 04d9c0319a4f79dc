// vehicle.js: the instruments of the vehicle.

import { byId, draw, make, say } from "../dom.js";
import { NONE } from "../simulation/module.js";

const GEARS = { P: 8, R: 2, N: 4, D: 1 };
const EPS_MODES = { 0: "assist", 1: "angle control", 2: "speed", 3: "torque", 255: "off" };
const ALARMS = [[0x01, "remote signal lost"], [0x02, "remote power lost"], [0x08, "AI computer lost"], [0x10, "EPS hardware"],
  [0x20, "EPS CAN bus fault"], [0x80, "S-driver"]];
const STRIPE = 24; // px of a metre of the road

/** A scale with a bar, and marks for what was commanded. */
function gauge(name, unit, low, high, digits) {
  const width = 240;
  const x = (value) => ((Math.min(Math.max(value, low), high) - low) / (high - low)) * width;
  const bar = draw("rect", { class: "bar", y: 6, height: 8 });
  const marks = { ai: draw("path", { class: "ai" }), supervisor: draw("path", { class: "supervisor" }) };
  const value = make("b");
  const svg = draw("svg", { viewBox: `-6 0 ${width + 12} 22`, preserveAspectRatio: "none", "aria-hidden": "true" },
    draw("rect", { class: "bed", x: 0, y: 6, width, height: 8 }), bar, draw("path", { class: "zero", d: `M${x(0)} 3V17` }), marks.ai, marks.supervisor);
  const element = make("div.gauge", make("p", make("span", name), value), svg);
  return {
    element,
    show(number, commands = {}) {
      const from = Math.min(x(0), x(number));
      bar.setAttribute("x", from);
      bar.setAttribute("width", Math.max(Math.abs(x(number) - x(0)), 0));
      say(value, `${(Object.is(number, -0) ? 0 : number).toFixed(digits).replace("-", "\u2212")} ${unit}`);
      for (const [who, path] of Object.entries(marks)) {
        const at = commands[who];
        path.setAttribute("d", at === null || at === undefined ? "" : who === "ai" ? `M${x(at)} 6l-4 -6h8z` : `M${x(at)} 14l-4 7h8z`);
      }
    },
  };
}

function drawVehicle() {
  const wheel = (x, y) => draw("rect", { class: "wheel", x: x - 5, y: y - 13, width: 10, height: 26, rx: 3 });
  const front = [[26, 44], [94, 44]].map(([x, y]) => [x, y, wheel(x, y)]);
  const road = draw("path", { class: "road", d: "M6 0V190M114 0V190" });
  const lamp = draw("circle", { class: "beacon", cx: 60, cy: 108, r: 7 });
  const svg = draw("svg", { viewBox: "0 0 120 190", class: "plan", role: "img", "aria-label": "The vehicle from above" },
    road, draw("rect", { class: "body", x: 30, y: 22, width: 60, height: 140, rx: 10 }), draw("path", { class: "nose", d: "M44 34H76L60 24z" }),
    ...front.map((one) => one[2]), wheel(26, 140), wheel(94, 140), lamp);
  return { svg, front, road, lamp };
}

const commandOf = (number, factor) => (number === NONE ? null : number * factor);

export function makeVehicle() {
  const plan = drawVehicle();
  const speed = gauge("Speed", "m/s", 0, 4, 2);
  const throttle = gauge("Throttle", "%", 0, 100, 1);
  const steering = gauge("Steering", "\u00b0", -90, 90, 1);
  const gears = Object.keys(GEARS).map((letter) => make("span.gear", letter));
  const mode = make("b");
  const nodes = ["VCU", "EPS", "AI computer"].map((name) => make("span.node", name));
  const notes = make("p.soft.notes");
  byId("vehicle").append(make("div.vehicle", plan.svg, make("div.gauges",
    make("p.gears", ...gears, mode), speed.element, throttle.element, steering.element,
    make("p.key.soft", make("span.ai", "\u25be AI computer"), make("span.supervisor", "\u25b4 supervisor")),
    make("p.nodes", ...nodes), notes)));
  let distance = 0;
  let last = 0;

  return (run) => {
    const { view } = run;
    distance = run.now < last ? 0 : distance + (view.speed_mm_s / 1000) * ((run.now - last) / 1000);
    last = run.now;
    plan.road.setAttribute("stroke-dashoffset", (-(distance % 1) * STRIPE).toFixed(1));
    const angle = view.angle_ddeg / 10;
    for (const [x, y, wheel] of plan.front) wheel.setAttribute("transform", `rotate(${-Math.max(Math.min(angle, 40), -40)} ${x} ${y})`);
    plan.lamp.classList.toggle("on", view.led_on === 1);
    speed.show(Math.abs(view.speed_mm_s) / 1000);
    throttle.show(view.throttle_permille / 10, { ai: commandOf(view.ai_throttle_permille, 0.1), supervisor: commandOf(view.supervisor_throttle_permille, 0.1) });
    steering.show(angle, { ai: commandOf(view.ai_angle_ddeg, 0.1), supervisor: commandOf(view.supervisor_angle_ddeg, 0.1) });
    Object.values(GEARS).forEach((code, i) => gears[i].classList.toggle("now", view.gear === code));
    say(mode, view.autopilot ? "autopilot" : "manual");
    ["vcu_runs", "eps_runs", "ai_runs"].forEach((name, i) => nodes[i].classList.toggle("off", view[name] === 0));
    const alarms = ALARMS.filter(([bit]) => view.alarms & bit).map(([, text]) => text);
    say(notes, [`EPS: ${EPS_MODES[view.eps_mode] ?? "?"}`, ...(alarms.length ? [`VCU reports: ${alarms.join(", ")}`] : []),
      ...(view.stop_open ? ["emergency stop pressed"] : []), ...(view.is_halted ? ["the supervisor stands still"] : [])].join(" \u00b7 "));
  };
}
