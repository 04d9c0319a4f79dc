// timeline.js: a picture of what happened over time. Plain JavaScript and SVG; it needs timeline.css and nothing else.
//
//   import { timeline } from "./timeline.js";
//   document.body.append(timeline({ from: 0, to: 9000, rows: [...] }));
//
// timeline(data) returns an element. All times are numbers in milliseconds.
//
//   data.from, data.to   the whole time
//   data.view            [from, to] that is shown first; default: all
//   data.cursor          the time at which the cursor stands first
//   data.views           [{ name, from, to }]: a button for each
//   data.marks           [{ t, text, tone }]: vertical lines with a flag
//   data.label           what the picture shows, for people who hear it
//   data.rows            from top to bottom, each one of:
//     { kind: "head", name }
//     { kind: "lane", name, spans: [{ from, to, text, tone }], slim, hint }
//     { kind: "plot", name, unit, digits, floor, ceiling, limit,
//       lines: [{ name, tone, dashed, sources: [source] }] }
//     { kind: "age", name, hint, limit, judged: [[from, to]], sources: [source] }
//
// A source is { from, to, step, t: [], lo: [], hi: [] } of a plot, { from, to, step, t: [], gap: [] } of an age. The first
// source that covers the view is drawn, else the last: put the finest one first. `lo` and `hi` hold until the next point,
// null is no value; `hi` may be missing. `gap` is the time that had passed at t since the point before; a negative one
// goes on (a frame came, but it does not count). `step` is the time that a point stands for; 0: exact.
//
// tones: quiet, calm, good, warn, bad, note, first, second, third (of timeline.css).
//
// The element has: view(from, to) shows a part; cursor(t) moves the cursor; update(data) shows other data.
// It sends the event "timeline-cursor" with detail.t when the cursor moves.
// Keys: left and right move the cursor, with shift the view; + and - zoom; Home and End; 0 shows all.

const NARROW = 720; // px: below it the names stand above their rows
const AXIS = 26;
const FLAG = 17;
const HEIGHTS = { head: 26, lane: 22, slim: 18, plot: 92, age: 20 };
const PRINTED = { head: 20, lane: 17, slim: 14, plot: 66, age: 15 };
const PRINT_WIDTH = 690;
const LEVELS = 4; // of flags; a quiet mark that finds no room has a line alone
const CROWDED = 30000; // ms: in a longer view a mark beside a bad one gives way
const LABEL_ABOVE = 15;
const FONT = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif'; // as in timeline.css
const LIMIT_AT = 0.66; // the deadline's place in the height of an age row

const escapes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
const escape = (text) => String(text).replace(/[&<>"]/g, (c) => escapes[c]);
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

const ruler = document.createElement("canvas").getContext("2d");

/** The width of a text in px. */
function widthOf(text, size = 12, weight = 400) {
  ruler.font = `${weight} ${size}px ${FONT}`;
  return ruler.measureText(text).width;
}

/** A time as text, as fine as a step of it needs: 62.109 s, 1:02.1, 12:03:20. */
export function timeText(ms, step = 1) {
  const digits = step >= 1000 ? 0 : step >= 100 ? 1 : step >= 10 ? 2 : step >= 1 ? 3 : 4;
  const seconds = ms / 1000;
  if (Math.abs(seconds) < 120) return `${seconds.toFixed(digits)} s`;
  const whole = Math.floor(seconds / 60);
  const rest = (seconds - whole * 60).toFixed(digits).padStart(digits ? digits + 3 : 2, "0");
  return whole < 60 ? `${whole}:${rest} min` : `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}:${rest}`;
}

/** Round steps of an axis: 1, 2, 5, 10, ... */
function niceStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  const factor = rough / power;
  return (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10) * power;
}

function niceTime(rough) {
  const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 15000, 30000, 60000, 120000, 300000, 600000,
    900000, 1800000, 3600000, 7200000, 21600000, 43200000, 86400000];
  return rough < 1 ? niceStep(rough) : steps.find((step) => step >= rough) ?? niceStep(rough / 86400000) * 86400000;
}

/** Index of the last point at or before t; -1: none. */
function indexAt(times, t) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

function pick(sources, from, to) {
  return sources.find((source) => source.from <= from && to <= source.to) ?? sources[sources.length - 1];
}

/** The values of a line in each column of pixels: arrays of lowest and highest, null where there is none. */
function columns(source, from, to, width) {
  const lo = new Array(width).fill(null);
  const hi = new Array(width).fill(null);
  const highs = source.hi ?? source.lo;
  const scale = width / (to - from);
  const first = Math.max(indexAt(source.t, from), 0);
  for (let i = first; i < source.t.length && source.t[i] <= to; i++) {
    if (source.lo[i] === null) continue;
    const until = Math.min(i + 1 < source.t.length ? source.t[i + 1] : source.to, to);
    const a = clamp(Math.floor((source.t[i] - from) * scale), 0, width - 1);
    const b = clamp(Math.ceil((until - from) * scale) - 1, a, width - 1);
    for (let x = a; x <= b; x++) {
      if (lo[x] === null || source.lo[i] < lo[x]) lo[x] = source.lo[i];
      if (hi[x] === null || highs[i] > hi[x]) hi[x] = highs[i];
    }
  }
  return { lo, hi };
}

/** The greatest age in each column of pixels; null before the first frame. */
function ages(source, from, to, width) {
  const age = new Array(width).fill(null);
  const scale = width / (to - from);
  for (let i = Math.max(indexAt(source.t, from), 0); i < source.t.length; i++) {
    const gap = Math.abs(source.gap[i]);
    const begin = source.t[i] - Math.max(gap, source.step);
    const a = clamp(Math.floor((begin - from) * scale), 0, width - 1);
    const b = clamp(Math.ceil((source.t[i] - from) * scale) - 1, 0, width - 1);
    if (source.t[i] < from || begin > to) continue;
    for (let x = a; x <= b; x++) {
      const right = from + (x + 1) / scale;
      const value = gap < source.step ? gap : Math.min(right, source.t[i]) - (source.t[i] - gap);
      if (age[x] === null || value > age[x]) age[x] = value;
    }
  }
  return age;
}

/** What a line shows at a time: [lowest, highest], or null. */
function valueAt(source, t) {
  const i = indexAt(source.t, t);
  if (i < 0 || source.lo[i] === null || t > source.to) return null;
  return [source.lo[i], (source.hi ?? source.lo)[i]];
}

function ageAt(source, t) {
  let i = indexAt(source.t, t);
  if (i + 1 < source.t.length) i++; // the gap that is open at t ends there
  if (i < 0) return null;
  const gap = Math.abs(source.gap[i]);
  if (source.step > 0 && gap <= source.step) return gap;
  const since = t - (source.t[i] - gap);
  return since < 0 ? null : Math.min(since, gap);
}

function numberText(value, digits = 0) {
  return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "\u2212");
}

/** Lowest and highest of a plot over the whole of its sources, widened to what the row asks for. */
function range(row) {
  let low = row.floor ?? Infinity;
  let high = row.ceiling ?? -Infinity;
  for (const line of row.lines) {
    for (const source of line.sources) {
      for (const value of source.lo) if (value !== null && value < low) low = value;
      for (const value of source.hi ?? source.lo) if (value !== null && value > high) high = value;
    }
  }
  if (!(low <= high)) return [0, 1];
  const step = niceStep(Math.max(high - low, 1e-6) / 3);
  low = Math.floor(low / step) * step;
  high = Math.ceil(high / step) * step;
  return low === high ? [low - step, high + step] : [low, high];
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

class Timeline {
  constructor(data) {
    this.element = document.createElement("figure");
    this.element.className = "timeline";
    this.element.innerHTML = '<div class="tl-tools"></div><svg class="tl-picture" tabindex="0" role="slider"></svg>';
    this.tools = this.element.firstChild;
    this.svg = this.element.lastChild;
    this.element.view = (from, to) => this.setView(from, to);
    this.element.cursor = (t) => this.setCursor(t);
    this.element.update = (other) => this.update(other);
    this.listen();
    this.update(data);
  }

  update(data) {
    this.data = data;
    [this.from, this.to] = data.view ?? [data.from, data.to];
    this.at = data.cursor ?? this.from;
    this.ranges = new Map(data.rows.filter((row) => row.kind === "plot").map((row) => [row, range(row)]));
    this.nameWidth = Math.max(...data.rows.filter((row) => row.kind !== "head")
      .map((row) => widthOf(row.name) + (row.hint ? widthOf(row.hint, 11) + 6 : 0) + (row.kind === "plot" ? 30 : 0)), 100) + 12;
    this.drawTools();
    this.draw();
  }

  listen() {
    new ResizeObserver(() => this.draw()).observe(this.element);
    const print = (width) => {
      this.printWidth = width;
      this.draw();
    };
    window.addEventListener("beforeprint", () => print(PRINT_WIDTH));
    window.addEventListener("afterprint", () => print(0));
    this.svg.addEventListener("keydown", (event) => this.key(event));
    this.svg.addEventListener("pointerdown", (event) => this.press(event));
    this.svg.addEventListener("pointermove", (event) => this.move(event));
    this.svg.addEventListener("pointerup", (event) => this.release(event));
    this.svg.addEventListener("pointercancel", () => (this.drag = null));
    this.svg.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  // --- what the user does

  key(event) {
    const span = this.to - this.from;
    const step = span / (event.altKey ? 1000 : 100);
    const keys = {
      ArrowLeft: () => (event.shiftKey ? this.pan(-span / 10) : this.setCursor(this.at - step, true)),
      ArrowRight: () => (event.shiftKey ? this.pan(span / 10) : this.setCursor(this.at + step, true)),
      Home: () => this.setCursor(this.data.from, true),
      End: () => this.setCursor(this.data.to, true),
      "+": () => this.zoom(0.5, this.at),
      "=": () => this.zoom(0.5, this.at),
      "-": () => this.zoom(2, this.at),
      0: () => this.setView(this.data.from, this.data.to),
    };
    if (keys[event.key] && !event.ctrlKey && !event.metaKey) {
      event.preventDefault();
      keys[event.key]();
    }
  }

  timeOf(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) * this.width) / box.width - this.left;
    return clamp(this.from + (x / this.plotWidth) * (this.to - this.from), this.from, this.to);
  }

  press(event) {
    if (event.button === 0) this.drag = { x: event.clientX, from: this.from, moved: false };
  }

  move(event) {
    if (!this.drag || event.buttons === 0) {
      this.drag = null;
      if (event.pointerType === "mouse") this.setCursor(this.timeOf(event));
      return;
    }
    const shift = event.clientX - this.drag.x;
    if (Math.abs(shift) < 4 && !this.drag.moved) return;
    if (!this.drag.moved) this.svg.setPointerCapture(event.pointerId);
    this.drag.moved = true;
    const from = this.drag.from - (shift / this.plotWidth) * (this.to - this.from);
    this.setView(from, from + (this.to - this.from));
  }

  release(event) {
    if (this.drag && !this.drag.moved) this.setCursor(this.timeOf(event));
    this.drag = null;
  }

  wheel(event) {
    if (!event.ctrlKey) return; // else the page scrolls
    event.preventDefault();
    this.zoom(event.deltaY > 0 ? 1.25 : 0.8, this.timeOf(event));
  }

  pan(shift) {
    this.setView(this.from + shift, this.to + shift);
  }

  zoom(factor, around) {
    const from = around - (around - this.from) * factor;
    this.setView(from, from + (this.to - this.from) * factor);
  }

  setView(from, to) {
    const whole = this.data.to - this.data.from;
    const span = clamp(to - from, Math.min(2, whole), whole);
    const middle = (from + to) / 2;
    this.from = clamp(middle - span / 2, this.data.from, this.data.to - span);
    this.to = this.from + span;
    this.draw();
  }

  /** @param follow move the view with the cursor */
  setCursor(t, follow = false) {
    this.at = clamp(t, this.data.from, this.data.to);
    const span = this.to - this.from;
    if (follow && (this.at < this.from || this.at > this.to)) this.setView(this.at - span / 2, this.at + span / 2);
    else this.drawCursor();
    this.element.dispatchEvent(new CustomEvent("timeline-cursor", { detail: { t: this.at } }));
  }

  // --- drawing

  drawTools() {
    const button = (text, name, action) => {
      const element = document.createElement("button");
      element.type = "button";
      element.textContent = text;
      if (name) {
        element.title = name;
        element.setAttribute("aria-label", name);
      }
      element.addEventListener("click", action);
      return element;
    };
    const group = (name, ...buttons) => {
      const element = document.createElement("span");
      element.setAttribute("role", "group");
      element.setAttribute("aria-label", name);
      element.append(...buttons);
      return element;
    };
    const views = [...(this.data.views ?? []), { name: "All", from: this.data.from, to: this.data.to }];
    this.tools.replaceChildren(
      group("Show", ...views.map((view) => button(view.name, "", () => this.setView(view.from, view.to)))),
      group("Move",
        button("\u2190", "Earlier", () => this.pan((this.from - this.to) / 3)),
        button("\u2212", "Zoom out", () => this.zoom(2, (this.from + this.to) / 2)),
        button("+", "Zoom in", () => this.zoom(0.5, (this.from + this.to) / 2)),
        button("\u2192", "Later", () => this.pan((this.to - this.from) / 3))));
  }

  x(t) {
    return this.left + ((t - this.from) / (this.to - this.from)) * this.plotWidth;
  }

  layout() {
    this.width = Math.floor(this.printWidth || this.element.clientWidth);
    this.narrow = this.width < NARROW && !this.printWidth;
    this.left = this.narrow ? 0 : Math.ceil(this.nameWidth);
    this.plotWidth = Math.max(Math.floor(this.width - this.left - (this.narrow ? 0 : this.printWidth ? 92 : 124)), 40);
    [this.legendAt, this.legendStep] = this.printWidth ? [25, 13] : [30, 15];
    this.flags = this.placeFlags();
    let y = AXIS + FLAG * this.flags.levels + 4;
    this.tops = this.data.rows.map((row) => {
      const above = !this.narrow || row.kind === "head" ? 0 : row.kind === "plot" ? 2 * LABEL_ABOVE : LABEL_ABOVE;
      const height = (this.printWidth ? PRINTED : HEIGHTS)[row.slim ? "slim" : row.kind];
      const top = { name: y, y: y + above, height: height - (this.printWidth ? 3 : 4) };
      y += above + height;
      return top;
    });
    this.height = y + 2;
  }

  /** Flags that would touch each other get a level each. */
  placeFlags() {
    const ends = [];
    const strong = this.to - this.from > CROWDED ? (this.data.marks ?? []).filter((mark) => mark.tone === "bad") : [];
    const hidden = (mark) => strong.some((one) => one !== mark && Math.abs(this.x(one.t) - this.x(mark.t)) < 4);
    const placed = (this.data.marks ?? []).filter((mark) => mark.t >= this.from && mark.t <= this.to && !hidden(mark))
      .sort((a, b) => a.t - b.t).map((mark) => {
        const length = widthOf(mark.text, 12, mark.tone === "bad" ? 600 : 400) + 14;
        const x = this.x(mark.t);
        const turned = x + length > this.left + this.plotWidth;
        const begin = turned ? x - length : x;
        let level = ends.findIndex((end) => end < begin);
        if (level < 0) level = ends.length;
        const mute = level >= LEVELS && !mark.tone;
        if (!mute) ends[level] = begin + length;
        return { mark, x, level: mute ? LEVELS : level, turned, mute };
      });
    return { placed, levels: ends.length };
  }

  draw() {
    if (this.element.clientWidth === 0 && !this.printWidth) return;
    this.layout();
    const rows = this.data.rows.map((row, i) => this.drawRow(row, this.tops[i])).join("");
    const names = this.data.rows.map((row, i) => this.drawName(row, this.tops[i])).join("");
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    this.svg.style.height = this.printWidth ? "auto" : `${this.height}px`;
    this.svg.innerHTML = `${this.drawAxis()}${rows}${this.drawMarks()}${names}<g class="tl-now"></g>`;
    this.now = this.svg.lastChild;
    this.drawCursor();
  }

  drawAxis() {
    const step = niceTime((this.to - this.from) / (this.plotWidth / (this.narrow ? 74 : 96)));
    const y = AXIS + FLAG * this.flags.levels;
    let text = "";
    for (let t = Math.ceil(this.from / step) * step; t <= this.to; t += step) {
      const x = this.x(t).toFixed(1);
      const anchor = x - this.left < 24 ? "start" : this.left + this.plotWidth - x < 24 ? "end" : "middle";
      text += `<path class="tl-grid" d="M${x} ${y}V${this.height}"/>` +
        `<text class="tl-tick" x="${x}" y="${y - 8}" text-anchor="${anchor}">${escape(timeText(t, step))}</text>`;
    }
    return text;
  }

  drawMarks() {
    const lines = this.flags.placed.map(({ mark, x, level }) =>
      `<path class="tl-mark tl-${mark.tone ?? "quiet"}" d="M${x.toFixed(1)} ${FLAG * level + 2}V${this.height}"/>`);
    const texts = this.flags.placed.filter(({ mute }) => !mute).map(({ mark, x, level, turned }) =>
      `<text class="tl-mark tl-${mark.tone ?? "quiet"}" x="${(turned ? x - 5 : x + 5).toFixed(1)}" y="${FLAG * level + 12}"` +
      ` text-anchor="${turned ? "end" : "start"}">${escape(mark.text)}</text>`);
    return lines.join("") + texts.join("");
  }

  drawName(row, top) {
    if (row.kind === "head") return `<text class="tl-head" x="0" y="${top.y + top.height - 5}">${escape(row.name)}</text>`;
    const y = this.narrow ? top.name + 11 : top.y + (row.kind === "plot" ? 11 : top.height / 2 + 4);
    let text = `<text class="tl-name" x="0" y="${y}">${escape(row.name)}`;
    if (row.hint) text += `<tspan class="tl-hint" dx="6">${escape(row.hint)}</tspan>`;
    return `${text}</text>${row.kind === "plot" ? this.drawLegend(row, top) : ""}`;
  }

  drawLegend(row, top) {
    let x = 0;
    return row.lines.map((line, i) => {
      const y = this.narrow ? top.name + LABEL_ABOVE + 10 : top.y + this.legendAt + i * this.legendStep;
      const text = `<g class="tl-${line.tone}"><path class="tl-line${line.dashed ? " tl-dashed" : ""}" d="M${x} ${y - 4}h16"/>` +
        `<text class="tl-hint" x="${x + 21}" y="${y}">${escape(line.name)}</text></g>`;
      if (this.narrow) x += 21 + widthOf(line.name, 11) + 12;
      return text;
    }).join("");
  }

  drawRow(row, top) {
    const draw = { lane: this.drawLane, plot: this.drawPlot, age: this.drawAge }[row.kind];
    return draw ? draw.call(this, row, top) : "";
  }

  drawLane(row, top) {
    const right = this.left + this.plotWidth;
    let text = `<rect class="tl-bed" x="${this.left}" y="${top.y}" width="${this.plotWidth}" height="${top.height}"/>`;
    let end = -Infinity; // of the rectangle before: thinner ones than a pixel are drawn once
    for (const span of row.spans) {
      if (span.to < this.from || span.from > this.to) continue;
      const x = clamp(this.x(span.from), this.left, right);
      const width = Math.max(clamp(this.x(span.to), this.left, right) - x, span.tone === "bad" ? 4 : 1);
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

  drawPlot(row, top) {
    const [low, high] = this.ranges.get(row);
    const y = (value) => top.y + 3 + ((high - value) / (high - low)) * (top.height - 8);
    const step = niceStep((high - low) / 3);
    const right = this.left + this.plotWidth;
    let text = `<rect class="tl-bed" x="${this.left}" y="${top.y}" width="${this.plotWidth}" height="${top.height - 2}"/>`;
    for (let value = Math.ceil(low / step) * step; value <= high + step / 100; value += step) {
      text += `<path class="tl-rule${Math.abs(value) < step / 100 ? " tl-zero" : ""}" d="M${this.left} ${y(value).toFixed(1)}H${right}"/>` +
        `<text class="tl-scale" x="${this.narrow ? this.left + 3 : this.left - 5}" y="${(y(value) + (!this.narrow ? 4 : y(value) < top.y + 12 ? 10 : -2)).toFixed(1)}"` +
        ` text-anchor="${this.narrow ? "start" : "end"}">${numberText(value, step < 1 ? 1 : 0)}</text>`;
    }
    for (const line of row.lines) {
      const source = pick(line.sources, this.from, this.to);
      if (!source) continue;
      const path = linePath(columns(source, this.from, this.to, this.plotWidth), this.left, y);
      text += `<path class="tl-line tl-${line.tone}${line.dashed ? " tl-dashed" : ""}" d="${path}"/>`;
    }
    return text;
  }

  drawAge(row, top) {
    const source = pick(row.sources, this.from, this.to);
    const base = top.y + top.height;
    const limitY = base - top.height * LIMIT_AT;
    let text = `<rect class="tl-bed" x="${this.left}" y="${top.y}" width="${this.plotWidth}" height="${top.height}"/>`;
    const parts = { fine: "", late: "", idle: "" };
    const age = source && source.t.length ? ages(source, this.from, this.to, this.plotWidth) : [];
    age.forEach((value, i) => {
      if (value === null) return;
      const t = this.from + ((i + 0.5) / this.plotWidth) * (this.to - this.from);
      const height = Math.min((value / row.limit) * LIMIT_AT, 1) * top.height;
      const kind = value <= row.limit ? "fine" : row.judged.some(([from, to]) => from <= t && t <= to) ? "late" : "idle";
      parts[kind] += `M${this.left + i} ${base}v${(-height).toFixed(1)}h1V${base}z`;
    });
    for (const kind of Object.keys(parts)) if (parts[kind]) text += `<path class="tl-age tl-${kind}" d="${parts[kind]}"/>`;
    text += `<path class="tl-deadline" d="M${this.left} ${limitY.toFixed(1)}h${this.plotWidth}"/>`;
    if (age.length === 0) {
      text += `<text class="tl-hint" x="${this.left + 6}" y="${top.y + top.height / 2 + 4}">never heard</text>`;
    }
    return text;
  }

  // --- the cursor, and what the rows show there

  valueText(row) {
    if (row.kind === "lane") {
      const span = row.spans.find((one) => one.from <= this.at && this.at < one.to);
      return span ? (span.value ?? span.text ?? "") : "";
    }
    if (row.kind === "age") {
      const source = pick(row.sources, this.from, this.to);
      const age = source ? ageAt(source, this.at) : null;
      return age === null ? "" : `${numberText(age, age < 100 ? 1 : 0)} ms`;
    }
    return "";
  }

  drawCursor() {
    if (!this.now) return;
    const x = this.x(this.at);
    const visible = this.at >= this.from && this.at <= this.to;
    const right = this.left + this.plotWidth;
    const y = AXIS + FLAG * this.flags.levels;
    const label = timeText(this.at, Math.min((this.to - this.from) / this.plotWidth, 1));
    const first = this.tops[0] ?? { y: 0, height: 0 };
    let text = visible ? `<path class="tl-cursor" d="M${x.toFixed(1)} ${y}V${this.height}m-4 ${y - this.height - 5}h8l-4 6z"/>` : "";
    text += this.narrow
      ? `<text class="tl-time" x="${this.width}" y="${first.y + first.height - 5}" text-anchor="end">${escape(label)}</text>`
      : `<text class="tl-time" x="${right + 8}" y="${y - 8}">${escape(label)}</text>`;
    const spoken = [label];
    this.data.rows.forEach((row, i) => {
      const top = this.tops[i];
      const end = this.narrow ? this.width : right + 8;
      const anchor = this.narrow ? "end" : "start";
      if (row.kind === "plot") {
        text += this.drawPlotValues(row, top, end, anchor);
        return;
      }
      const value = this.valueText(row);
      if (!value) return;
      if (row.kind === "lane") spoken.push(`${row.name} ${value}`);
      const over = row.kind === "age" && parseFloat(value) > row.limit ? " tl-over" : "";
      text += `<text class="tl-value${over}" x="${end}" y="${this.narrow ? top.name + 11 : top.y + top.height / 2 + 4}" text-anchor="${anchor}">${escape(value)}</text>`;
    });
    this.now.innerHTML = text;
    this.speak(spoken.join(", "));
  }

  drawPlotValues(row, top, end, anchor) {
    const texts = row.lines.map((line) => {
      const source = pick(line.sources, this.from, this.to);
      const value = source ? valueAt(source, this.at) : null;
      if (!value) return null;
      const [lo, hi] = value.map((one) => numberText(one, row.digits));
      return { tone: line.tone, text: `${lo === hi ? lo : `${lo} \u2026 ${hi}`} ${row.unit}` };
    });
    if (this.narrow) {
      const shown = texts.filter((one) => one !== null);
      const last = shown[shown.length - 1];
      return last ? `<text class="tl-value" x="${end}" y="${top.name + 11}" text-anchor="end">${escape(last.text)}</text>` : "";
    }
    return texts.map((one, i) => (one === null ? "" :
      `<text class="tl-value tl-ink tl-${one.tone}" x="${end}" y="${top.y + this.legendAt + i * this.legendStep}" text-anchor="${anchor}">${escape(one.text)}</text>`)).join("");
  }

  speak(text) {
    this.svg.setAttribute("aria-label", this.data.label ?? "Timeline");
    this.svg.setAttribute("aria-valuemin", this.data.from);
    this.svg.setAttribute("aria-valuemax", this.data.to);
    this.svg.setAttribute("aria-valuenow", this.at.toFixed(1));
    this.svg.setAttribute("aria-valuetext", text);
  }
}

/** Make a timeline. @param data as above @return its element */
export function timeline(data) {
  return new Timeline(data).element;
}
