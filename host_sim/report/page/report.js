// report.js: the page of a report, from the data in the file.

import { timeline } from "./timeline/timeline.js";

const data = JSON.parse(document.getElementById("data").textContent);
const series = data.series;
const MS = 1000; // us
const unit = series.unit_us / MS;
const BEFORE = 400; // ms that are shown before a cause
const AFTER = 900; // and after a trip

const byId = (id) => document.getElementById(id);

/** make("td.wide", "text", child, ...) */
function make(name, ...children) {
  const [tag, ...classes] = name.split(".");
  const element = document.createElement(tag);
  if (classes.length) element.className = classes.join(" ");
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const seconds = (ms, digits = 3) => `${(ms / 1000).toFixed(digits)} s`;
const lasting = (ms) => (ms < 10 ? `${ms.toFixed(1)} ms` : ms < 1000 ? `${Math.round(ms)} ms` : seconds(ms, ms < 100000 ? 2 : 0));
const inMs = (us) => (us === null ? null : us / MS);

/** The time of day at a time of the run; "" when it is not known. */
function clockAt(ms) {
  if (!data.about.clock) return "";
  const start = Date.parse(`${data.about.clock.replace(" ", "T")}Z`); // any zone: only the difference counts
  return new Date(start + ms).toISOString().slice(11, 23);
}

/** Sums of differences, in ms. */
function times(differences) {
  let sum = 0;
  return differences.map((difference) => (sum += difference) * unit);
}

const end = series.end * unit;
const senders = new Map(series.messages.map((message) => [message.name, message.sender]));
const lanes = Object.fromEntries(Object.entries(series.lanes).map(([name, lane]) => [name, { t: times(lane.t), v: lane.v }]));

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

const overview = readPart(series.overview);
const details = series.details.map(readPart);
const detailAt = (t) => details.filter((one) => one.trip <= t && t <= one.to).pop();

// --- rows of the picture

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

// --- the picture

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

function drawPicture(trip) {
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
      + "A dotted line is its deadline; red is later. Drag the picture to move it; with the keyboard, + and \u2212 zoom, \u2190 and \u2192 move the cursor.")];
  if (trip && !detailAt(inMs(trip.t_us))) parts.push(make("p.soft.small", "The frames around this trip were not kept: the picture has the resolution of the whole run."));
  if (series.left_out > 0) parts.push(make("p.soft.small", `${series.left_out} later changes found no room in this report.`));
  return make("section.picture", ...parts);
}

// --- what stands above it

function drawAbout() {
  const about = data.about;
  const interfaces = about.interfaces.filter(Boolean).join(", ");
  const item = (...children) => make("span", ...children);
  byId("about").replaceChildren(
    item(make("strong", about.name ?? "a run")),
    ...(interfaces ? [item(interfaces)] : []),
    item(about.clock ? `${about.clock}, ${seconds(end)}` : seconds(end)),
    item(about.gateway ? "gateway" : "shared bus"),
    ...(about.shadow ? [item("shadow: nothing was sent")] : []),
    ...(about.recording ? [item("a recording")] : []));
  byId("footer").replaceChildren(make("span", `AGV supervisor, host_sim ${about.version}. Configuration `, make("code", about.checksum),
    ". This file is complete: it loads nothing."));
}

function drawVerdict(trip) {
  const says = trip ?? data.sentence;
  const kind = trip ? "trip" : data.supervised_us > 0 ? "none" : "unsupervised";
  byId("verdict").className = kind;
  byId("badge").replaceChildren(make("span.badge", trip ? trip.reason : kind === "none" ? "NO TRIP" : "NOT SUPERVISED"));
  for (const part of ["headline", "cause", "action", "outcome"]) byId(part).textContent = says[part] ?? "";
}

/** Cause, trip and what followed, as a row of points. */
function drawSteps(trip) {
  const t = inMs(trip.t_us);
  const point = (us, name, kind, missing) => {
    if (us === null && !missing) return null;
    const ms = inMs(us);
    const clock = ms === null ? "" : clockAt(ms);
    const relative = ms === null || ms === t ? "" : ms < t ? `${lasting(t - ms)} before` : `${lasting(ms - t)} after`;
    return make(`li${kind ? `.${kind}` : ""}${ms === null ? ".open" : ""}`, make("b", name), make("span", ms === null ? missing : seconds(ms)),
      ...(relative ? [make("span", relative)] : []), ...(clock ? [make("span", clock)] : []));
  };
  const list = make("ol", point(trip.last_good_us, "last good frame"), point(trip.cause_us, "cause", "warn"), point(trip.t_us, "trip", "bad"),
    point(trip.first_safe_us, "first safe frame", "", "none was sent"), point(trip.confirmed_us, "P confirmed", "", "not in this run"),
    point(trip.stopped_us, "stands", "", "not in this run"));
  list.id = "steps";
  return list;
}

function drawTrips(choose) {
  if (data.trips.length < 2) return;
  const consequences = data.trips.filter((trip) => trip.from_recording).length;
  const trips = data.trips.length - consequences;
  const more = consequences ? ", and what followed because a recording cannot obey" : "";
  const set = make("fieldset", make("legend", `${trips} trip${trips === 1 ? "" : "s"}${more}`));
  set.id = "trips";
  data.trips.forEach((trip, i) => {
    const input = make("input");
    input.type = "radio";
    input.name = "trip";
    input.checked = i === 0;
    input.addEventListener("change", () => choose(i));
    set.append(make(`label${trip.from_recording ? ".soft" : ""}`, input, make("span", seconds(inMs(trip.t_us))), make("span", make("code", trip.reason))));
  });
  byId("trips-place").replaceChildren(set);
}

// --- tables

function table(heads, rows) {
  const head = make("tr", ...heads.map(([text, kind]) => make(`th${kind ? `.${kind}` : ""}`, text)));
  const cells = (row) => make("tr", ...row.map((cell, i) => {
    const kind = heads[i][1];
    const element = make(`td${kind ? `.${kind}` : ""}`, cell);
    if (kind === "number") element.dataset.name = heads[i][0];
    return element;
  }));
  return make("table", make("thead", head), make("tbody", ...rows.map((row) => (row instanceof Node ? row : cells(row)))));
}

/** What happened between the frames: the trip and its neighbours. */
function eventsOf(trip) {
  const events = [[trip.t_us, `trip: ${trip.reason}`, "bad"]];
  if (trip.cause_us !== null && trip.cause_us < trip.t_us) events.push([trip.cause_us, "cause", "warn"]);
  return events.sort((a, b) => a[0] - b[0]);
}

function frameRows(trip, all) {
  const events = eventsOf(trip);
  const rows = [];
  let last = null;
  const put = (until) => {
    while (events.length && events[0][0] <= until) {
      const [us, text, tone] = events.shift();
      const cell = make("td", text);
      cell.colSpan = 5;
      rows.push(make(`tr.event.${tone}`, make("td.nowrap", seconds(us / MS)), cell));
      last = us;
    }
  };
  for (const [us, side, sent, id, bytes, name, signals, tells] of trip.frames) {
    if (!all && !tells && (!sent || name === "supervisor_status")) continue;
    put(us - 1);
    const from = (sent ? "supervisor" : senders.get(name) ?? "") + (data.about.gateway ? [", vehicle side", ", AI side"][side] : "");
    const since = last === null ? "" : `+${((us - last) / MS).toFixed(1)}`;
    last = us;
    rows.push(make(`tr${sent ? ".sent" : ""}${tells ? ".tells" : ""}`, make("td.nowrap", seconds(us / MS, 4)), make("td.nowrap", make("code", `${id}h`), " ", name),
      make("td.wide", signals), make("td.nowrap", make("code", bytes)), make("td.nowrap", from), make("td.number", since)));
  }
  put(Infinity);
  return rows;
}

function drawFrames(trip) {
  if (!trip.frames.length) return null;
  const heads = [["time", "nowrap"], ["message", "nowrap"], ["signals", "wide"], ["data", "nowrap"], ["sent by", "nowrap"], ["ms", "number"]];
  const tells = trip.frames.some((frame) => frame[7]);
  const place = make("div.frames");
  place.tabIndex = 0;
  place.setAttribute("role", "region");
  place.setAttribute("aria-label", "Frames around the cause");
  const show = (all) => {
    place.replaceChildren(table(heads, frameRows(trip, all)));
    requestAnimationFrame(() => { // the first event, with some rows before it
      const first = place.querySelector(".event");
      place.scrollTop = first ? first.offsetTop - 150 : 0;
    });
  };
  const choice = make("div.choice");
  [["the message that tells, and what the supervisor sent", false], ["all frames near the cause and the trip", true]].forEach(([text, all], i) => {
    const input = make("input");
    input.type = "radio";
    input.name = "frames";
    input.checked = tells ? i === 0 : i === 1;
    input.addEventListener("change", () => show(all));
    choice.append(make("label", input, ` ${text}`));
  });
  show(!tells);
  return make("section.framed", make("h2", "Frames around the cause"), choice, place,
    trip.frames_left_out > 0 ? make("p.soft.small", `${trip.frames_left_out} more frames are not shown.`) : null);
}

function drawFaults() {
  if (!data.faults.length) return make("section", make("h2", "Faults"), make("p", "None."));
  const rows = data.faults.map((fault) => [
    make("span", make("code", fault.name), ...(fault.from_recording ? [make("span.soft", " (a recording cannot obey)")] : [])),
    make(`span.tag.${fault.class === "trip" ? "bad" : "warn"}`, fault.class === "trip" ? "trip" : "warning"),
    fault.phrase, seconds(inMs(fault.first_us)), String(fault.times), lasting(inMs(fault.active_us)) + (fault.active ? ", until the end" : "")]);
  return make("section", make("h2", "Faults"),
    table([["fault"], ["class", "nowrap"], ["meaning", "wide"], ["first", "number"], ["times", "number"], ["in all", "number"]], rows));
}

function drawSupervision() {
  const names = ["INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"];
  const list = make("ul", ...names.map((name, i) => make("li", make("b", name), ` ${seconds(inMs(data.states[i]))}`)));
  list.id = "states";
  const parts = [make("h2", "What was supervised"), list];
  const silent = series.messages.filter((message) => !message.heard);
  const rest = inMs(data.states[0]);
  if (rest > 0.5) parts.push(make("p", `Not supervised: ${seconds(rest)} in INIT.`));
  if (!data.states[2]) parts.push(make("p", "Not judged: the commands of the AI computer. The autopilot was never engaged."));
  if (silent.length) parts.push(make("p", `Never heard: ${silent.map((message) => `${message.id}h ${message.name}`).join(", ")}.`));
  if (series.notes.length) {
    parts.push(table([["time", "nowrap"], ["what", "wide"]], series.notes.slice(0, 50).map(([t, text]) => [seconds(t * unit), text])));
  }
  return make("section", ...parts);
}

function drawSettings() {
  if (!data.settings.length) return make("section", make("h2", "Settings"), make("p", "All settings are the defaults."));
  const rows = data.settings.map((setting) => [make("code", setting.name), `${setting.value} ${setting.unit}`, `${setting.preset} ${setting.unit}`,
    make("span", setting.meaning, " ", setting.weakens ? make("span.tag.warn", "weakens the supervision") : null)]);
  return make("section", make("h2", "Settings that differ from the defaults"),
    table([["setting"], ["value", "number"], ["default", "number"], ["meaning", "wide"]], rows));
}

/** Draw the page for a trip. @param index of data.trips */
function draw(index) {
  const trip = data.trips[index];
  drawVerdict(trip);
  byId("report").replaceChildren(...[trip ? drawSteps(trip) : null, trip ? null : drawSupervision(), drawPicture(trip), trip ? drawFrames(trip) : null,
    drawFaults(), trip ? drawSupervision() : null, drawSettings()].filter(Boolean));
}

drawAbout();
drawTrips(draw);
draw(0);
