// timeline.js: a picture of what happened over time. Plain JavaScript and SVG without a dependency. It is used by the report and
// by the page in the browser: what stands in this comment is its interface.
//
//   import { timeline } from "./timeline/timeline.js"; // and timeline.css
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

import { drawAxis, drawMarks } from "./axis.js";
import { drawCursor, spokenCursor } from "./cursor.js";
import { layoutOf, nameWidth } from "./layout.js";
import { drawName, drawRow } from "./rows.js";
import { clamp } from "./scale.js";
import { makeTools } from "./tools.js";

const PRINT_WIDTH = 690;
const SHORTEST = 2; // ms: the finest view

class Timeline {
  constructor(data) {
    this.element = document.createElement("figure");
    this.element.className = "timeline";
    this.element.innerHTML = '<div class="tl-tools"></div><svg class="tl-picture" tabindex="0" role="slider"></svg>';
    this.tools = this.element.firstChild;
    this.svg = this.element.lastChild;
    this.element.view = (from, to) => this.show(from, to);
    this.element.cursor = (t) => this.setCursor(t);
    this.element.update = (other) => this.update(other);
    this.listen();
    this.update(data);
  }

  update(data) {
    this.data = data;
    [this.from, this.to] = data.view ?? [data.from, data.to];
    this.at = data.cursor ?? this.from;
    this.nameWidth = nameWidth(data.rows);
    const views = [...(data.views ?? []), { name: "All", from: data.from, to: data.to }];
    this.tools.replaceChildren(...makeTools(views, this));
    this.draw();
  }

  listen() {
    new ResizeObserver(() => this.draw()).observe(this.element);
    const print = (width) => {
      this.printWidth = width;
      if (this.element.isConnected) this.draw();
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
      ArrowLeft: () => (event.shiftKey ? this.pan(-1 / 10) : this.setCursor(this.at - step, true)),
      ArrowRight: () => (event.shiftKey ? this.pan(1 / 10) : this.setCursor(this.at + step, true)),
      Home: () => this.setCursor(this.data.from, true),
      End: () => this.setCursor(this.data.to, true),
      "+": () => this.zoom(0.5, this.at),
      "=": () => this.zoom(0.5, this.at),
      "-": () => this.zoom(2, this.at),
      0: () => this.show(this.data.from, this.data.to),
    };
    if (keys[event.key] && !event.ctrlKey && !event.metaKey) {
      event.preventDefault();
      keys[event.key]();
    }
  }

  timeOf(event) {
    const { left, plotWidth, width } = this.layout;
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) * width) / box.width - left;
    return clamp(this.from + (x / plotWidth) * (this.to - this.from), this.from, this.to);
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
    const from = this.drag.from - (shift / this.layout.plotWidth) * (this.to - this.from);
    this.show(from, from + (this.to - this.from));
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

  // --- the view and the cursor

  /** @param share of the view by which it moves; a negative one is earlier */
  pan(share) {
    const shift = share * (this.to - this.from);
    this.show(this.from + shift, this.to + shift);
  }

  zoom(factor, around = (this.from + this.to) / 2) {
    const from = around - (around - this.from) * factor;
    this.show(from, from + (this.to - this.from) * factor);
  }

  show(from, to) {
    const whole = this.data.to - this.data.from;
    const span = clamp(to - from, Math.min(SHORTEST, whole), whole);
    const middle = (from + to) / 2;
    this.from = clamp(middle - span / 2, this.data.from, this.data.to - span);
    this.to = this.from + span;
    this.draw();
  }

  /** @param follow move the view with the cursor */
  setCursor(t, follow = false) {
    this.at = clamp(t, this.data.from, this.data.to);
    const span = this.to - this.from;
    if (follow && (this.at < this.from || this.at > this.to)) this.show(this.at - span / 2, this.at + span / 2);
    else this.drawNow();
    this.element.dispatchEvent(new CustomEvent("timeline-cursor", { detail: { t: this.at } }));
  }

  // --- drawing

  draw() {
    const width = Math.floor(this.printWidth || this.element.clientWidth);
    if (width === 0) return;
    const { data } = this;
    const layout = layoutOf(data, [this.from, this.to], width, this.nameWidth, Boolean(this.printWidth));
    const each = (drawn) => data.rows.map((row, i) => drawn(layout, row, layout.tops[i])).join("");
    this.layout = layout;
    this.svg.setAttribute("viewBox", `0 0 ${layout.width} ${layout.height}`);
    this.svg.style.height = this.printWidth ? "auto" : `${layout.height}px`;
    this.svg.innerHTML = `${drawAxis(layout)}${each(drawRow)}${drawMarks(layout)}${each(drawName)}<g class="tl-now"></g>`;
    this.drawNow();
  }

  /** The cursor alone: it moves with the mouse. */
  drawNow() {
    if (!this.layout) return;
    this.svg.lastChild.innerHTML = drawCursor(this.layout, this.data.rows, this.at);
    this.svg.setAttribute("aria-label", this.data.label ?? "Timeline");
    this.svg.setAttribute("aria-valuemin", this.data.from);
    this.svg.setAttribute("aria-valuemax", this.data.to);
    this.svg.setAttribute("aria-valuenow", this.at.toFixed(1));
    this.svg.setAttribute("aria-valuetext", spokenCursor(this.layout, this.data.rows, this.at));
  }
}

/** Make a timeline. @param data as above @return its element */
export function timeline(data) {
  return new Timeline(data).element;
}
