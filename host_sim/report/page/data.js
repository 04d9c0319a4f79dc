// data.js: what the page is made from: the data in the file.

export const data = JSON.parse(document.getElementById("data").textContent);
export const { series } = data;
export const unit = series.unit_us / 1000; // ms
export const end = series.end * unit; // ms

/** Times of trips and frames are in us; null: there is none. */
export const inMs = (us) => (us === null ? null : us / 1000);

/** Sums of differences, in ms. */
function times(differences) {
  let sum = 0;
  return differences.map((difference) => (sum += difference) * unit);
}

/** The sender of each message. */
export const senders = new Map(series.messages.map((message) => [message.name, message.sender]));

/** What changes by steps: { t: [], v: [] } for each lane. */
export const lanes = Object.fromEntries(Object.entries(series.lanes).map(([name, lane]) => [name, { t: times(lane.t), v: lane.v }]));

/** The overview, or the surroundings of a trip, as sources of timeline.js. */
function readPart(part) {
  const common = { from: part.from * unit, to: part.to * unit, step: part.step * unit };
  const signals = {};
  for (const [name, line] of Object.entries(part.signals)) {
    signals[name] = { ...common, t: times(line.t), lo: line.lo, ...(line.hi ? { hi: line.hi } : {}) };
  }
  const gaps = part.gaps.map((line) => ({ ...common, t: times(line.t), gap: line.gap.map((gap) => gap * unit) }));
  return { ...common, trip: part.trip * unit, signals, gaps };
}

export const overview = readPart(series.overview);
const details = series.details.map(readPart);

/** The surroundings that were kept of a time; undefined: none. */
export const detailAt = (t) => details.filter((one) => one.trip <= t && t <= one.to).pop();
