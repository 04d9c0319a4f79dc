// layout.js: where everything stands: rows, names, flags. No drawing.

import { widthOf } from "./text.js";

export const AXIS = 26;
export const FLAG = 17;
export const LABEL_ABOVE = 15;

const NARROW = 720; // px: below it the names stand above their rows
const HEIGHTS = { head: 26, lane: 22, slim: 18, plot: 92, age: 20 };
const PRINTED = { head: 20, lane: 17, slim: 14, plot: 66, age: 15 };
const LEVELS = 4; // of flags; a quiet mark that finds no room has a line alone
const CROWDED = 30000; // ms: in a longer view a mark beside a bad one gives way

/** The room that the names of the rows need beside them. */
export function nameWidth(rows) {
  return Math.max(...rows.filter((row) => row.kind !== "head")
    .map((row) => widthOf(row.name) + (row.hint ? widthOf(row.hint, 11) + 6 : 0) + (row.kind === "plot" ? 30 : 0)), 100) + 12;
}

/** Flags that would touch each other get a level each. */
function placeFlags(marks, layout) {
  const { from, to, left, right, x } = layout;
  const ends = [];
  const strong = to - from > CROWDED ? marks.filter((mark) => mark.tone === "bad") : [];
  const hidden = (mark) => strong.some((one) => one !== mark && Math.abs(x(one.t) - x(mark.t)) < 4);
  const placed = marks.filter((mark) => mark.t >= from && mark.t <= to && !hidden(mark)).sort((a, b) => a.t - b.t).map((mark) => {
    const length = widthOf(mark.text, 12, mark.tone === "bad" ? 600 : 400) + 14;
    const at = x(mark.t);
    const turned = at + length > right;
    const begin = turned ? at - length : at;
    let level = ends.findIndex((end) => end < begin);
    if (level < 0) level = ends.length;
    const mute = level >= LEVELS && !mark.tone;
    if (!mute) ends[level] = begin + length;
    return { mark, x: at, level: mute ? LEVELS : level, turned, mute };
  });
  return { placed, levels: ends.length };
}

/** The rows from top to bottom: { name, y, height } of each, and the height of all. */
function placeRows(rows, top, narrow, printed) {
  let y = top;
  const tops = rows.map((row) => {
    const above = !narrow || row.kind === "head" ? 0 : row.kind === "plot" ? 2 * LABEL_ABOVE : LABEL_ABOVE;
    const height = (printed ? PRINTED : HEIGHTS)[row.slim ? "slim" : row.kind];
    const place = { name: y, y: y + above, height: height - (printed ? 3 : 4) };
    y += above + height;
    return place;
  });
  return { tops, height: y + 2 };
}

/**
 * @param data of the timeline @param view [from, to] @param width of the picture in px @param names width of the names in px
 * @param printed whether it is for paper
 * @return what the drawing needs; x(t) is the place of a time
 */
export function layoutOf(data, [from, to], width, names, printed) {
  const narrow = width < NARROW && !printed;
  const left = narrow ? 0 : Math.ceil(names);
  const plotWidth = Math.max(Math.floor(width - left - (narrow ? 0 : printed ? 92 : 124)), 40);
  const layout = { from, to, width, narrow, left, plotWidth, right: left + plotWidth };
  [layout.legendAt, layout.legendStep] = printed ? [25, 13] : [30, 15];
  layout.x = (t) => left + ((t - from) / (to - from)) * plotWidth;
  layout.flags = placeFlags(data.marks ?? [], layout);
  layout.axisY = AXIS + FLAG * layout.flags.levels;
  return Object.assign(layout, placeRows(data.rows, layout.axisY + 4, narrow, printed));
}
