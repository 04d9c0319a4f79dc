// bus.js: the messages on the bus, decoded, with their rates and their age against the deadline; and the last frames.

import { byId, draw, make, mark, say } from "../dom.js";

const GONE_MS = 3000; // a row that is older is grey
const FRAMES = 40;
const BAR = 60;

function makeRow() {
  const cells = Object.fromEntries(["id", "name", "from", "rate", "age", "text"].map((name) => [name, make(`td.${name}`)]));
  const bar = draw("rect", { class: "bar", height: 6, y: 2 });
  const svg = draw("svg", { viewBox: `0 0 ${BAR + 1} 10`, "aria-hidden": "true" }, draw("rect", { class: "bed", width: BAR * 0.75, height: 6, y: 2 }), bar,
    draw("path", { class: "limit", d: `M${BAR * 0.75} 0V10` }));
  const age = make("span");
  cells.age.append(svg, age);
  return { element: make("tr", ...Object.values(cells)), cells, bar, age };
}

function showRow(row, one, now) {
  const age = Math.max(now - one.t_us / 1000, 0);
  const share = one.deadline_ms && one.from !== "supervisor" ? age / one.deadline_ms : 0;
  say(row.cells.id, one.id);
  say(row.cells.name, one.name ?? "unknown");
  say(row.cells.from, one.from);
  say(row.cells.rate, String(one.rate));
  say(row.age, age < 1000 ? `${Math.round(age)} ms` : `${(age / 1000).toFixed(1)} s`);
  say(row.cells.text, one.text);
  row.bar.setAttribute("width", Math.min(share * 0.75, 1) * BAR);
  row.element.classList.toggle("late", share > 1);
  row.element.classList.toggle("gone", age > GONE_MS);
  mark(row.element, "title", `${one.data}, ${one.total} frames`);
}

function frameRow(frame) {
  return make("tr", make("td.time", `${(frame.t_us / 1000).toFixed(3)} ms`), make("td.id", frame.id), make("td.name", frame.name ?? ""), make("td.from", frame.from),
    make("td.data", make("code", frame.data)), make("td.text", frame.text));
}

const heads = (...names) => make("thead", make("tr", ...names.map((name) => make("th", name))));

export function makeBus() {
  const body = make("tbody");
  const load = make("span.soft");
  const rows = new Map();
  const frames = make("tbody");
  const details = make("details", make("summary", "Last frames"), scroller("Last frames", make("table.frames", heads("time", "ID", "message", "sent by", "data", "signals"), frames)));
  byId("bus-title").append(" ", load);
  byId("bus").append(scroller("Messages on the bus", make("table.messages", heads("ID", "message", "sent by", "per s", "age / deadline", "signals"), body)), details);

  function scroller(label, table) {
    const element = make("div.scroll", table);
    element.tabIndex = 0;
    element.setAttribute("role", "region");
    element.setAttribute("aria-label", label);
    return element;
  }

  return (run) => {
    const list = run.simulation.bus().sort((a, b) => (a.from === b.from ? a.id.localeCompare(b.id) : a.from.localeCompare(b.from)));
    const keys = list.map((one) => `${one.id} ${one.from} ${one.side}`);
    if (keys.join() !== [...rows.keys()].join()) {
      rows.clear();
      keys.forEach((key) => rows.set(key, makeRow()));
      body.replaceChildren(...[...rows.values()].map((row) => row.element));
    }
    list.forEach((one, i) => showRow(rows.get(keys[i]), one, run.now));
    say(load, `${(run.view.bus_permille / 10).toFixed(0)} % load`);
    if (details.open) frames.replaceChildren(...run.simulation.frames(FRAMES).reverse().map(frameRow));
  };
}
