// picture.js: the picture of the run: the rows, marks and views of a timeline.

import { data, detailAt, end, inMs, lanes, overview, series, unit } from "./data.js";
import { make } from "./format.js";
import { timeline } from "./timeline/timeline.js";

const BEFORE = 400; // ms that are shown before a cause
const AFTER = 900; // and after a trip

const stateTones = { INIT: "quiet", STANDBY: "calm", ACTIVE: "good", TRIPPED: "bad", SAFE: "warn" };
const modeTones = { manual: "calm", autopilot: "good", both: "bad", neither: "quiet" };

function spansOf(lane, tone, text = String) {
  return lane.t.map((from, i) => ({
    from, to: i + 1 < lane.t.length ? lane.t[i + 1] : end, text: text(lane.v[i]), tone: tone(lane.v[i]), is: lane.v[i],
  })).filter((span) => span.is !== null);
}

const gearTone = (gear) => (gear === "P" ? "calm" : "DRN".includes(gear) ? "good" : "bad");
const ledText = (code) => (code === 0 ? "off" : code < 0 ? "fast blink" : `code ${String(code).padStart(2, "0")}`);

function laneRow(name, lane, tone, text, hint) {
  return lane.t.length ? [{ kind: "lane", name, hint, slim: true, spans: spansOf(lane, tone, text) }] : [];
}

/** One lane for each fault, in the order of their first time. */
function faultRows() {
  const rows = new Map();
  for (const [t, name, kind, raised] of series.faults) {
    if (!rows.has(name)) rows.set(name, { kind: "lane", name, slim: true, spans: [] });
    const spans = rows.get(name).spans;
    const open = spans[spans.length - 1];
    if (open && open.to === end && open.open) {
      open.to = t * unit;
      open.open = false;
    }
    if (raised) {
      spans.push({ from: t * unit, to: end, open: true, text: kind, value: kind === "warn" ? "warning" : "active", tone: kind === "warn" ? "warn" : "bad" });
    }
  }
  return [...rows.values()];
}

/** The sources of a signal, the finest first. @param factor from the number in the data to the one that is shown */
function sources(name, detail, factor) {
  const scale = (source) => ({
    ...source,
    lo: source.lo.map((value) => (value === null ? null : value * factor)),
    ...(source.hi ? { hi: source.hi.map((value) => (value === null ? null : value * factor)) } : {}),
  });
  return [detail?.signals[name], overview.signals[name]].filter(Boolean).map(scale);
}

function plotRow(name, unitName, digits, detail, factor, lines, limits = {}) {
  const drawn = lines.map(([signal, text, tone, dashed]) => ({ name: text, tone, dashed, sources: sources(signal, detail, factor) }))
    .filter((line) => line.sources.length);
  return drawn.length ? [{ kind: "plot", name, unit: unitName, digits, lines: drawn, ...limits }] : [];
}

/** When the silence of a command counts: on autopilot. */
function engagedTimes() {
  return spansOf(lanes.mode, () => "").filter((span) => span.text === "autopilot").map((span) => [span.from, span.to]);
}

function ageRows(detail) {
  const engaged = engagedTimes();
  return series.messages.map((message, i) => ({
    kind: "age",
    name: `${message.id}h`,
    hint: message.name,
    limit: message.deadline,
    judged: message.command ? engaged : [[0, end]],
    sources: message.heard ? [detail?.gaps[i], overview.gaps[i]].filter(Boolean) : [],
  }));
}

function pictureRows(detail) {
  const faults = faultRows();
  return [
    { kind: "head", name: "Supervisor" },
    { kind: "lane", name: "state", spans: spansOf(lanes.state, (state) => stateTones[state] ?? "bad") },
    ...laneRow("safety output", lanes.output, (value) => (value === "closed" ? "good" : "warn")),
    ...laneRow("LED", lanes.led, (code) => (code === 0 ? "quiet" : "warn"), ledText),
    ...(faults.length ? [{ kind: "head", name: "Faults" }, ...faults] : []),
    { kind: "head", name: "Vehicle" },
    ...laneRow("mode", lanes.mode, (mode) => modeTones[mode]),
    ...laneRow("gear", lanes.gear, gearTone, String, "reported"),
    ...laneRow("gear", lanes.gear_command, gearTone, String, "AI computer"),
    ...laneRow("gear", lanes.gear_sent, gearTone, String, "supervisor"),
    ...plotRow("speed", "m/s", 2, detail, 0.001,
      [["wheel_left", "left wheel", "first"], ["wheel_right", "right wheel", "third", true], ["vcu_speed", "VCU", "second", true]],
      { floor: 0, ceiling: 0.5 }),
    ...plotRow("throttle", "%", 1, detail, 0.1,
      [["throttle_status", "measured", "first"], ["throttle_command", "AI computer", "second", true], ["throttle_sent", "supervisor", "third"]],
      { floor: 0, ceiling: 20 }),
    ...plotRow("steering", "\u00b0", 1, detail, 0.1,
      [["steering_status", "measured", "first"], ["steering_command", "AI computer", "second", true], ["steering_sent", "supervisor", "third"]],
      { floor: -10, ceiling: 10 }),
    { kind: "head", name: "Age of each message, and its deadline" },
    ...ageRows(detail),
  ];
}

function marksOf(trip) {
  if (!trip) return [];
  const t = inMs(trip.t_us);
  const marks = [{ t, text: trip.reason, tone: "bad" }];
  const add = (us, text, tone) => {
    if (us !== null && us !== trip.t_us) marks.push({ t: inMs(us), text, tone });
  };
  add(trip.cause_us, "cause", "warn");
  add(trip.first_safe_us, "first safe frame");
  add(trip.confirmed_us, "P confirmed");
  add(trip.stopped_us, "stands");
  for (const other of data.trips) {
    if (other !== trip && !other.from_recording) marks.push({ t: inMs(other.t_us), text: "trip" });
  }
  return marks;
}

function viewsOf(trip) {
  if (!trip) return [];
  const t = inMs(trip.t_us);
  const cause = Math.max(inMs(trip.cause_us ?? trip.t_us), t - 6000);
  const last = Math.min(Math.max(inMs(trip.stopped_us ?? trip.t_us), inMs(trip.confirmed_us ?? trip.t_us), t) + AFTER, t + 5500, end);
  const views = [
    { name: "Trip", from: Math.max(cause - BEFORE, 0), to: Math.max(last, t + 100) },
    { name: "Cause", from: Math.max(cause - 150, 0), to: Math.min(t + 60, end) },
  ];
  const detail = detailAt(t);
  if (detail) views.push({ name: "Seconds around", from: detail.from, to: detail.to });
  return views.filter((view) => view.to > view.from);
}

/** The picture of a trip; without one, of the run. */
export function drawPicture(trip) {
  const views = viewsOf(trip);
  const element = timeline({
    from: 0,
    to: Math.max(end, 1),
    view: views.length ? [views[0].from, views[0].to] : undefined,
    cursor: trip ? inMs(trip.t_us) : end / 2,
    views,
    marks: marksOf(trip),
    rows: pictureRows(trip ? detailAt(inMs(trip.t_us)) : undefined),
    label: "The run over time. Left and right move the cursor, plus and minus zoom.",
  });
  const parts = [make("h2", trip ? "What happened" : "The run"), element,
    make("p.soft.small", "The age of a message is the time since it came last; of a message with an alive counter, since the counter changed. "
      + "The dotted line is the deadline; a red age exceeds it. Drag the picture to move it; with the keyboard, + and \u2212 zoom, \u2190 and \u2192 move the cursor.")];
  if (trip && !detailAt(inMs(trip.t_us))) parts.push(make("p.soft.small", "The frames around this trip were not kept: the picture has the resolution of the whole run."));
  if (series.left_out > 0) parts.push(make("p.soft.small", `${series.left_out} later changes are not in this report: it is full.`));
  return make("section.picture", ...parts);
}
