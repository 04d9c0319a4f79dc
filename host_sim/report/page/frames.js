// frames.js: the frames around the cause of a trip.

import { data, inMs, senders } from "./data.js";
import { make, seconds, table } from "./format.js";

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
      rows.push(make(`tr.event.${tone}`, make("td.nowrap", seconds(inMs(us))), cell));
      last = us;
    }
  };
  for (const [us, side, sent, id, bytes, name, signals, tells] of trip.frames) {
    if (!all && !tells && (!sent || name === "supervisor_status")) continue;
    put(us - 1);
    const from = (sent ? "supervisor" : senders.get(name) ?? "") + (data.about.gateway ? [", vehicle side", ", AI side"][side] : "");
    const since = last === null ? "" : `+${(inMs(us - last)).toFixed(1)}`;
    last = us;
    rows.push(make(`tr${sent ? ".sent" : ""}${tells ? ".tells" : ""}`, make("td.nowrap", seconds(inMs(us), 4)), make("td.nowrap", make("code", `${id}h`), " ", name),
      make("td.wide", signals), make("td.nowrap", make("code", bytes)), make("td.nowrap", from), make("td.number", since)));
  }
  put(Infinity);
  return rows;
}

/** The table of the frames around a cause; null when none were kept. */
export function drawFrames(trip) {
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
  [["the message that shows the fault, and what the supervisor sent", false], ["all frames near the cause and the trip", true]].forEach(([text, all], i) => {
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
