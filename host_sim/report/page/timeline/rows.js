// rows.js: the rows of the picture as SVG: names and legends, lanes, plots, ages.

import { LABEL_ABOVE } from "./layout.js";
import { ages, columns, pick, range } from "./samples.js";
import { clamp, niceStep } from "./scale.js";
import { escape, numberText, widthOf } from "./text.js";

const LIMIT_AT = 0.66; // the deadline's place in the height of an age row

function drawLegend(layout, row, top) {
  let x = 0;
  return row.lines.map((line, i) => {
    const y = layout.narrow ? top.name + LABEL_ABOVE + 10 : top.y + layout.legendAt + i * layout.legendStep;
    const text = `<g class="tl-${line.tone}"><path class="tl-line${line.dashed ? " tl-dashed" : ""}" d="M${x} ${y - 4}h16"/>` +
      `<text class="tl-hint" x="${x + 21}" y="${y}">${escape(line.name)}</text></g>`;
    if (layout.narrow) x += 21 + widthOf(line.name, 11) + 12;
    return text;
  }).join("");
}

/** The name of a row, with its hint or its legend. */
export function drawName(layout, row, top) {
  if (row.kind === "head") return `<text class="tl-head" x="0" y="${top.y + top.height - 5}">${escape(row.name)}</text>`;
  const y = layout.narrow ? top.name + 11 : top.y + (row.kind === "plot" ? 11 : top.height / 2 + 4);
  let text = `<text class="tl-name" x="0" y="${y}">${escape(row.name)}`;
  if (row.hint) text += `<tspan class="tl-hint" dx="6">${escape(row.hint)}</tspan>`;
  return `${text}</text>${row.kind === "plot" ? drawLegend(layout, row, top) : ""}`;
}

function drawBed(layout, top, height) {
  return `<rect class="tl-bed" x="${layout.left}" y="${top.y}" width="${layout.plotWidth}" height="${height}"/>`;
}

function drawLane(layout, row, top) {
  const { left, right } = layout;
  let text = drawBed(layout, top, top.height);
  let end = -Infinity; // of the rectangle before: thinner ones than a pixel are drawn once
  for (const span of row.spans) {
    if (span.to < layout.from || span.from > layout.to) continue;
    const x = clamp(layout.x(span.from), left, right);
    const width = Math.max(clamp(layout.x(span.to), left, right) - x, span.tone === "bad" ? 4 : 1);
    if (x + width < end + 0.5) continue;
    end = x + width;
    text += `<g class="tl-span tl-${span.tone ?? "quiet"}"><rect x="${x.toFixed(1)}" y="${top.y}" width="${width.toFixed(1)}"` +
      ` height="${top.height}"/>`;
    if (span.text && width > widthOf(span.text) + 8) {
      text += `<text x="${(x + 5).toFixed(1)}" y="${top.y + top.height / 2 + 4}">${escape(span.text)}</text>`;
    }
    text += "</g>";
  }
  return text;
}

/** A step line as an SVG path; columns with a range become vertical strokes. */
function linePath(column, x0, y) {
  let path = "";
  let last = null;
  column.lo.forEach((lo, i) => {
    if (lo === null) {
      last = null;
      return;
    }
    const top = y(column.hi[i]).toFixed(1);
    const bottom = y(lo).toFixed(1);
    const x = x0 + i;
    if (last === null) path += `M${x} ${bottom}`;
    else if (last !== bottom || top !== bottom) path += `H${x}V${bottom}`;
    if (top !== bottom) path += `V${top}`;
    last = top;
    if (column.lo[i + 1] === null || i + 1 === column.lo.length) path += `H${x + 1}`;
  });
  return path;
}

/** The horizontal lines of a plot and their numbers. */
function drawRules(layout, top, [low, high], y) {
  const step = niceStep((high - low) / 3);
  const { left, right, narrow } = layout;
  let text = "";
  for (let value = Math.ceil(low / step) * step; value <= high + step / 100; value += step) {
    const at = y(value);
    const baseline = at + (!narrow ? 4 : at < top.y + 12 ? 10 : -2);
    text += `<path class="tl-rule${Math.abs(value) < step / 100 ? " tl-zero" : ""}" d="M${left} ${at.toFixed(1)}H${right}"/>` +
      `<text class="tl-scale" x="${narrow ? left + 3 : left - 5}" y="${baseline.toFixed(1)}"` +
      ` text-anchor="${narrow ? "start" : "end"}">${numberText(value, step < 1 ? 1 : 0)}</text>`;
  }
  return text;
}

function drawPlot(layout, row, top) {
  const [low, high] = range(row);
  const y = (value) => top.y + 3 + ((high - value) / (high - low)) * (top.height - 8);
  let text = drawBed(layout, top, top.height - 2) + drawRules(layout, top, [low, high], y);
  for (const line of row.lines) {
    const source = pick(line.sources, layout.from, layout.to);
    if (!source) continue;
    const path = linePath(columns(source, layout.from, layout.to, layout.plotWidth), layout.left, y);
    text += `<path class="tl-line tl-${line.tone}${line.dashed ? " tl-dashed" : ""}" d="${path}"/>`;
  }
  return text;
}

function drawAge(layout, row, top) {
  const { from, to, left, plotWidth } = layout;
  const source = pick(row.sources, from, to);
  const base = top.y + top.height;
  const age = source && source.t.length ? ages(source, from, to, plotWidth) : [];
  const parts = { fine: "", late: "", idle: "" };
  age.forEach((value, i) => {
    if (value === null) return;
    const t = from + ((i + 0.5) / plotWidth) * (to - from);
    const height = Math.min((value / row.limit) * LIMIT_AT, 1) * top.height;
    const judged = row.judged.some((span) => span[0] <= t && t <= span[1]);
    const kind = value <= row.limit ? "fine" : judged ? "late" : "idle";
    parts[kind] += `M${left + i} ${base}v${(-height).toFixed(1)}h1V${base}z`;
  });
  let text = drawBed(layout, top, top.height);
  for (const kind of Object.keys(parts)) if (parts[kind]) text += `<path class="tl-age tl-${kind}" d="${parts[kind]}"/>`;
  text += `<path class="tl-deadline" d="M${left} ${(base - top.height * LIMIT_AT).toFixed(1)}h${plotWidth}"/>`;
  if (age.length > 0) return text;
  return `${text}<text class="tl-hint" x="${left + 6}" y="${top.y + top.height / 2 + 4}">never received</text>`;
}

const rowDrawers = { head: () => "", lane: drawLane, plot: drawPlot, age: drawAge };

/** A row without its name. */
export function drawRow(layout, row, top) {
  return rowDrawers[row.kind](layout, row, top);
}
