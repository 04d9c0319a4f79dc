// axis.js: the axis of time and the flags, as SVG.

import { FLAG } from "./layout.js";
import { niceTime } from "./scale.js";
import { escape, timeText } from "./text.js";

export function drawAxis(layout) {
  const { from, to, left, right, axisY, height } = layout;
  const step = niceTime((to - from) / (layout.plotWidth / (layout.narrow ? 74 : 96)));
  let text = "";
  for (let t = Math.ceil(from / step) * step; t <= to; t += step) {
    const x = layout.x(t).toFixed(1);
    const anchor = x - left < 24 ? "start" : right - x < 24 ? "end" : "middle";
    text += `<path class="tl-grid" d="M${x} ${axisY}V${height}"/>` +
      `<text class="tl-tick" x="${x}" y="${axisY - 8}" text-anchor="${anchor}">${escape(timeText(t, step))}</text>`;
  }
  return text;
}

export function drawMarks(layout) {
  const { placed } = layout.flags;
  const lines = placed.map(({ mark, x, level }) =>
    `<path class="tl-mark tl-${mark.tone ?? "quiet"}" d="M${x.toFixed(1)} ${FLAG * level + 2}V${layout.height}"/>`);
  const texts = placed.filter(({ mute }) => !mute).map(({ mark, x, level, turned }) =>
    `<text class="tl-mark tl-${mark.tone ?? "quiet"}" x="${(turned ? x - 5 : x + 5).toFixed(1)}" y="${FLAG * level + 12}"` +
    ` text-anchor="${turned ? "end" : "start"}">${escape(mark.text)}</text>`);
  return lines.join("") + texts.join("");
}
