// cursor.js: the cursor and the value of each row there: as SVG, and in words for people who hear it.

import { ageAt, pick, valueAt } from "./samples.js";
import { escape, numberText, timeText } from "./text.js";

function laneValue(row, at) {
  const span = row.spans.find((one) => one.from <= at && at < one.to);
  return span ? (span.value ?? span.text ?? "") : "";
}

/** The value of a lane or an age: its text, and whether it is over its limit. */
function rowValue(layout, row, at) {
  if (row.kind === "lane") return [laneValue(row, at), false];
  const source = pick(row.sources, layout.from, layout.to);
  const age = source ? ageAt(source, at) : null;
  return age === null ? ["", false] : [`${numberText(age, age < 100 ? 1 : 0)} ms`, age > row.limit];
}

function drawValue(layout, row, top, at) {
  const [text, over] = rowValue(layout, row, at);
  if (!text) return "";
  const x = layout.narrow ? layout.width : layout.right + 8;
  const y = layout.narrow ? top.name + 11 : top.y + top.height / 2 + 4;
  return `<text class="tl-value${over ? " tl-over" : ""}" x="${x}" y="${y}" text-anchor="${layout.narrow ? "end" : "start"}">${escape(text)}</text>`;
}

/** The values of a plot beside its lines; where there is no room, the last one. */
function drawPlotValues(layout, row, top, at) {
  const texts = row.lines.map((line) => {
    const source = pick(line.sources, layout.from, layout.to);
    const value = source ? valueAt(source, at) : null;
    if (!value) return null;
    const [lo, hi] = value.map((one) => numberText(one, row.digits));
    return { tone: line.tone, text: `${lo === hi ? lo : `${lo} \u2026 ${hi}`} ${row.unit}` };
  });
  if (layout.narrow) {
    const last = texts.filter((one) => one !== null).pop();
    return last ? `<text class="tl-value" x="${layout.width}" y="${top.name + 11}" text-anchor="end">${escape(last.text)}</text>` : "";
  }
  return texts.map((one, i) => (one === null ? "" :
    `<text class="tl-value tl-ink tl-${one.tone}" x="${layout.right + 8}" y="${top.y + layout.legendAt + i * layout.legendStep}"` +
    ` text-anchor="start">${escape(one.text)}</text>`)).join("");
}

function drawTime(layout, label) {
  if (!layout.narrow) return `<text class="tl-time" x="${layout.right + 8}" y="${layout.axisY - 8}">${escape(label)}</text>`;
  const first = layout.tops[0] ?? { y: 0, height: 0 };
  return `<text class="tl-time" x="${layout.width}" y="${first.y + first.height - 5}" text-anchor="end">${escape(label)}</text>`;
}

function timeLabel(layout, at) {
  return timeText(at, Math.min((layout.to - layout.from) / layout.plotWidth, 1));
}

export function drawCursor(layout, rows, at) {
  const { axisY, height } = layout;
  const visible = at >= layout.from && at <= layout.to;
  const line = visible ? `<path class="tl-cursor" d="M${layout.x(at).toFixed(1)} ${axisY}V${height}m-4 ${axisY - height - 5}h8l-4 6z"/>` : "";
  const values = rows.map((row, i) => {
    if (row.kind === "head") return "";
    return (row.kind === "plot" ? drawPlotValues : drawValue)(layout, row, layout.tops[i], at);
  });
  return line + drawTime(layout, timeLabel(layout, at)) + values.join("");
}

/** "1.007 s, state TRIPPED, gear P": the time and the lanes. */
export function spokenCursor(layout, rows, at) {
  const lanes = rows.filter((row) => row.kind === "lane").map((row) => [row.name, laneValue(row, at)]);
  return [timeLabel(layout, at), ...lanes.filter(([, value]) => value).map((lane) => lane.join(" "))].join(", ");
}
