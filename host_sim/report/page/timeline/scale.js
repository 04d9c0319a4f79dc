// scale.js: round steps for axes.

export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

const TIMES = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 15000, 30000, 60000, 120000, 300000, 600000,
  900000, 1800000, 3600000, 7200000, 21600000, 43200000, 86400000]; // ms
const DAY = 86400000;

/** The next round step at or above a rough one: 1, 2, 5, 10, ... */
export function niceStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  const factor = rough / power;
  return (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10) * power;
}

/** The same for an axis of time, in ms: above a second it is round in seconds, minutes and hours. */
export function niceTime(rough) {
  return rough < 1 ? niceStep(rough) : TIMES.find((step) => step >= rough) ?? niceStep(rough / DAY) * DAY;
}
