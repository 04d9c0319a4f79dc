// picture.js: the run over time, with the timeline of the report.

import { byId } from "../dom.js";
import { timeline } from "../report/timeline/timeline.js";
import { TONES } from "./machine.js";

const WINDOW = 20000; // ms that are shown while it runs
const FAULTS_SHOWN = 8;
const GEAR_TONES = { P: "warn", R: "calm", N: "quiet", D: "good" };

const plot = (name, unit, digits, limits, lines) => ({ kind: "plot", name, unit, digits, ...limits, lines });

function rowsOf({ history, now }) {
  const { lines, lanes, faults } = history;
  const line = (key, name, tone, dashed) => ({ name, tone, dashed, sources: lines[key].sources() });
  const lane = (key, name, tone, text, hint) => (lanes[key] ? [{ kind: "lane", name, hint, spans: lanes[key].spans(now, tone, text) }] : []);
  const seen = [...faults].map(([name, one]) => ({ kind: "lane", slim: true, name, spans: one.spans(now, (kind) => (kind === "trip" ? "bad" : "warn")) }))
    .filter((row) => row.spans.length).sort((a, b) => b.spans[b.spans.length - 1].to - a.spans[a.spans.length - 1].to).slice(0, FAULTS_SHOWN);
  return [
    ...lane("state", "state", (state) => TONES[state]),
    ...lane("output", "safety output", (value) => (value === "closed" ? "good" : "warn")),
    ...lane("led", "LED", (code) => (code === 0 ? "quiet" : "warn"), (code) => (code === 0 ? "healthy" : code < 0 ? "fast" : `code ${code}`)),
    ...seen,
    ...lane("mode", "mode", (mode) => (mode === "manual" ? "calm" : "good")),
    ...lane("gear", "gear", (gear) => GEAR_TONES[gear] ?? "bad", String, "engaged"),
    ...lane("supervisor_gear", "gear", (gear) => GEAR_TONES[gear] ?? "bad", String, "supervisor"),
    plot("speed", "m/s", 2, { floor: 0, ceiling: 1.5 }, [line("speed", "wheels", "first")]),
    plot("throttle", "%", 1, { floor: 0, ceiling: 40 }, [line("throttle", "measured", "first"), line("ai_throttle", "AI computer", "second", true), line("supervisor_throttle", "supervisor", "third")]),
    plot("steering", "\u00b0", 1, { floor: -20, ceiling: 20 }, [line("angle", "measured", "first"), line("ai_angle", "AI computer", "second", true), line("supervisor_angle", "supervisor", "third")]),
  ];
}

function marksOf(events) {
  return events.filter((event) => event.event === "state" && event.to === "TRIPPED" && event.from !== "SAFE").slice(-12)
    .map((event) => ({ t: event.t_ms, text: event.reason ?? "trip", tone: "bad" }));
}

/** With other data it has other buttons: the one that has the focus keeps it. */
function update(element, data) {
  const buttons = () => [...element.querySelectorAll("button")];
  const at = buttons().indexOf(document.activeElement);
  element.update(data);
  buttons()[at]?.focus({ preventScroll: true });
}

export function makePicture() {
  let element = null;
  return (run, isPlaying) => {
    if (!run.history.lines.speed) return;
    const to = Math.max(run.now, WINDOW);
    const data = {
      from: 0, to, view: [Math.max(run.now - WINDOW, 0), Math.max(run.now, WINDOW)], cursor: run.now, rows: rowsOf(run), marks: marksOf(run.events),
      label: "The run over time. Left and right move the cursor, plus and minus zoom.",
    };
    if (element) update(element, data);
    else {
      element = timeline(data);
      byId("picture").append(element);
    }
    element.classList.toggle("live", isPlaying);
  };
}
