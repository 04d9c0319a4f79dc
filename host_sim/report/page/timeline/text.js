// text.js: texts of a timeline: their widths, times, numbers, and how they stand in SVG.

const FONT = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif'; // as in timeline.css

const escapes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
const ruler = document.createElement("canvas").getContext("2d");

/** A text between tags or in an attribute. */
export const escape = (text) => String(text).replace(/[&<>"]/g, (c) => escapes[c]);

/** The width of a text in px. */
export function widthOf(text, size = 12, weight = 400) {
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

/** A number with a minus sign that is as wide as a plus; no "-0". */
export function numberText(value, digits = 0) {
  return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "\u2212");
}
