// samples.js: what a source says (see timeline.js): at a time, in each column of pixels, and over all of it.

import { clamp, niceStep } from "./scale.js";

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

/** The first source that covers the view, else the last. */
export function pick(sources, from, to) {
  return sources.find((source) => source.from <= from && to <= source.to) ?? sources[sources.length - 1];
}

/** The values of a line in each column of pixels: arrays of lowest and highest, null where there is none. */
export function columns(source, from, to, width) {
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
export function ages(source, from, to, width) {
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
export function valueAt(source, t) {
  const i = indexAt(source.t, t);
  if (i < 0 || source.lo[i] === null || t > source.to) return null;
  return [source.lo[i], (source.hi ?? source.lo)[i]];
}

/** The age at a time; null before the first frame. */
export function ageAt(source, t) {
  let i = indexAt(source.t, t);
  if (i + 1 < source.t.length) i++; // the gap that is open at t ends there
  if (i < 0) return null;
  const gap = Math.abs(source.gap[i]);
  if (source.step > 0 && gap <= source.step) return gap;
  const since = t - (source.t[i] - gap);
  if (since < 0) return i > 0 ? Math.abs(source.gap[i - 1]) : null; // a step before: its longest gap
  return Math.min(since, gap);
}

/** Lowest and highest of a plot over the whole of its sources, widened to what the row asks for. */
export function range(row) {
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
