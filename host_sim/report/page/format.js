// format.js: elements of the page, and how times stand in it.
//
// A time is cut, never rounded, as in the text of replay. A duration is the difference of two times as they are shown, so that
// the numbers of the page agree with each other.

import { data } from "./data.js";

export const byId = (id) => document.getElementById(id);

/** make("td.wide", "text", child, ...) */
export function make(name, ...children) {
  const [tag, ...classes] = name.split(".");
  const element = document.createElement(tag);
  if (classes.length) element.className = classes.join(" ");
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const cut = (value) => Math.floor(value + 1e-6);
const wholeMs = (us) => cut(us / 1000);

/** A time or a duration in ms: "62.109 s". */
export const seconds = (ms, digits = 3) => `${(cut((ms * 10 ** digits) / 1000) / 10 ** digits).toFixed(digits)} s`;

/** A duration in ms: "0.3 ms", "272 ms", "1.254 s". */
export const lasting = (ms) => (ms < 10 ? `${(cut(ms * 10) / 10).toFixed(1)} ms` : ms < 1000 ? `${cut(ms)} ms` : seconds(ms));

/** The duration between two times in us. */
export const between = (from, to) => lasting(to - from < 10000 ? (to - from) / 1000 : wholeMs(to) - wholeMs(from));

/** The time of day at a time in us; "" when it is not known. */
export function clockAt(us) {
  const { clock, clock_us: rest } = data.about; // the start: to the millisecond, and the microseconds behind it
  if (!clock) return "";
  const start = Date.parse(`${clock.replace(" ", "T")}Z`); // any zone: only the difference counts
  return new Date(start + wholeMs(rest + us)).toISOString().slice(11, 23);
}

/** @param heads [[text, class]] @param rows arrays of cells, or rows that are ready */
export function table(heads, rows) {
  const head = make("tr", ...heads.map(([text, kind]) => make(`th${kind ? `.${kind}` : ""}`, text)));
  const cells = (row) => make("tr", ...row.map((cell, i) => {
    const kind = heads[i][1];
    const element = make(`td${kind ? `.${kind}` : ""}`, cell);
    if (kind === "number") element.dataset.name = heads[i][0];
    return element;
  }));
  return make("table", make("thead", head), make("tbody", ...rows.map((row) => (row instanceof Node ? row : cells(row)))));
}
