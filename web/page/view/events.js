// events.js: what the supervisor reported, in words; the newest first.

import { byId, clock, make, words } from "../dom.js";

const SHOWN = 60;

function textOf(event) {
  switch (event.event) {
    case "state":
      return [event.from ? `${event.from} \u2192 ${event.to}` : `starts in ${event.to}`, event.reason, event.to];
    case "fault":
      return [event.active ? (event.class === "trip" ? "fault" : "warning") : "ended:", event.name, event.active ? event.class : ""];
    case "safety_output":
      return [`safety output ${event.closed ? "closed" : "opened"}`, null, ""];
    case "led":
      return [event.code === 0 ? "LED healthy" : event.code < 0 ? "LED blinks fast" : `LED code ${event.code}`, null, ""];
    case "reset":
      return [event.accepted ? "reset accepted" : `reset refused, missing: ${event.why.map(words).join(", ")}`, null, ""];
    case "startup":
      return [`INIT waits for: ${event.missing.map(words).join(", ")}`, null, ""];
    default:
      return ["end of the run", null, ""];
  }
}

export function makeEvents() {
  const list = make("ol.log");
  list.tabIndex = 0;
  byId("events").append(list);
  let shown = "";
  return (run) => {
    const last = run.events[run.events.length - 1];
    const key = `${run.view.event_count} ${last?.t_ms} ${run.events.length}`;
    if (key === shown) return;
    shown = key;
    list.replaceChildren(...run.events.slice(-SHOWN).reverse().map((event) => {
      const [text, name, tone] = textOf(event);
      return make("li", make("time", clock(event.t_ms)), " ", make(`span.${tone || "plain"}`, text), " ", name ? make("code", name) : null);
    }));
  };
}
