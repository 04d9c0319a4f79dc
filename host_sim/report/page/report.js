// report.js: the page of a report, from the data in the file.

import { data, end, inMs, series, unit } from "./data.js";
import { between, byId, clockAt, lasting, make, seconds, table } from "./format.js";
import { drawFrames } from "./frames.js";
import { drawPicture } from "./picture.js";
import { numberText } from "./timeline/text.js";

// --- what stands above the picture

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
  const kind = trip ? "trip" : data.supervised_us > 0 && !data.partial ? "none" : "unsupervised";
  const badge = data.supervised_us === 0 ? "NOT SUPERVISED" : data.partial ? "NO TRIP, BUT NOT ALL WAS SUPERVISED" : "NO TRIP";
  byId("verdict").className = kind;
  byId("badge").replaceChildren(make("span.badge", trip ? trip.reason : badge));
  for (const part of ["headline", "cause", "action", "outcome"]) byId(part).textContent = says[part] ?? "";
}

/** Cause, trip and what followed, as a row of points. */
function drawSteps(trip) {
  const point = (us, name, kind, missing) => {
    if (us === null && !missing) return null;
    const texts = [us === null ? missing : seconds(inMs(us))];
    if (us !== null && us !== trip.t_us) texts.push(us < trip.t_us ? `${between(us, trip.t_us)} before` : `${between(trip.t_us, us)} after`);
    if (us !== null && data.about.clock) texts.push(clockAt(us));
    return make(`li${kind ? `.${kind}` : ""}${us === null ? ".open" : ""}`, make("b", name), ...texts.map((text) => make("span", text)));
  };
  const list = make("ol", point(trip.last_good_us, "last good frame"), point(trip.cause_us, "cause", "warn"), point(trip.t_us, "trip", "bad"),
    point(trip.first_safe_us, "first safe frame", "", "none was sent"), point(trip.confirmed_us, trip.confirmed_us === null ? `${trip.unconfirmed} confirmed` : "P confirmed", "", "not in this run"),
    point(trip.stopped_us, "stands", "", "not in this run"));
  list.id = "steps";
  return list;
}

function drawTrips(choose) {
  if (data.trips.length < 2) return;
  const consequences = data.trips.filter((trip) => trip.from_recording).length;
  const trips = data.trips.length - consequences;
  const more = consequences ? ", and faults that follow because a recording does not react" : "";
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

// --- what stands below it

function drawFaults() {
  if (!data.faults.length) return make("section", make("h2", "Faults"), make("p", "None."));
  const rows = data.faults.map((fault) => [
    make("span", make("code", fault.name), make("span.soft", fault.from_recording ? " (a recording cannot obey)" : fault.no_trip ? " (in INIT: no trip)" : "")),
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
  if (!data.engaged) parts.push(make("p", "Not judged: the commands of the AI computer. The autopilot was never engaged."));
  if (silent.length) parts.push(make("p", `Never received: ${silent.map((message) => `${message.id}h ${message.name}`).join(", ")}.`));
  if (series.notes.length) {
    parts.push(table([["time", "nowrap"], ["what", "wide"]], series.notes.slice(0, 50).map(([t, text]) => [seconds(t * unit), text])));
  }
  return make("section", ...parts);
}

/** What is wrong with a message. */
function faultsOf(message) {
  return [
    message.late > 0 ? `late ${message.late > 1 ? `${message.late} times, first ` : ""}at ${seconds(message.first_late_ms)}` : "",
    message.counter?.counts === "stuck" ? "alive counter stuck" : "",
    message.malformed > 0 ? `${message.malformed} malformed` : "",
    ...message.alarms.map((alarm) => alarm.frames > 1 ? `${alarm.name} from ${seconds(alarm.first_ms)} on` : `${alarm.name} at ${seconds(alarm.first_ms)}`),
  ].filter(Boolean).join("; ");
}

/** A message with its longest gap, deadline and margin; and below it what is wrong. */
function messageRows(message) {
  const gaps = message.deadline_gap_ms;
  const ms = (value, digits = 1) => (value === null || value === undefined ? "\u2013" : numberText(value, digits));
  const row = [make("span", make("code", `${message.id}h`), ` ${message.name}`), String(message.count), ms(message.gap_ms?.median), ms(gaps?.max),
    ms(message.deadline_ms, 0), ms(message.margin_ms)];
  const wrong = make("td", faultsOf(message));
  wrong.colSpan = row.length;
  return wrong.textContent ? [row, make("tr.note", wrong)] : [row];
}

/** Every message of the protocol that was on the bus, as survey shows it. */
function drawMessages() {
  if (!data.messages?.length) return null;
  return make("section.messages", make("h2", "Messages on the bus"),
    table([["message", "nowrap"], ["frames", "number"], ["every", "number"], ["longest gap", "number"], ["deadline", "number"],
      ["margin", "number"]], data.messages.flatMap(messageRows)),
    make("p.soft.small", "All times in ms. The longest gap is the one that the deadline measures: of a command while the autopilot is engaged, of a "
      + "message with an alive counter from one change to the next."));
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
    drawFaults(), trip ? drawSupervision() : null, drawMessages(), drawSettings()].filter(Boolean));
}

drawAbout();
drawTrips(draw);
draw(0);
