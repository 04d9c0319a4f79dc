// transport.js: the time: paused, single steps, and speeds from a hundredth to as fast as it goes.

import { button, byId, clock, make, say } from "../dom.js";

export const SPEEDS = [["1/100", 0.01], ["1/10", 0.1], ["1\u00d7", 1], ["10\u00d7", 10], ["100\u00d7", 100], ["fastest", Infinity]];

/** @param control { playing, speed, play(on), begin(), step(ms), toEvent(), setSpeed(n) } */
export function makeTransport(control) {
  const play = button("", () => control.play(!control.playing));
  const time = make("span.time"); // no <output>: it would be read aloud in every frame
  time.setAttribute("role", "timer");
  time.setAttribute("aria-label", "Time of the run");
  const speed = make("select");
  speed.setAttribute("aria-label", "Speed");
  SPEEDS.forEach(([name, value]) => speed.append(new Option(name, value)));
  speed.addEventListener("change", () => control.setSpeed(Number(speed.value)));
  byId("transport").append(
    button("Restart", () => control.begin(), "From the beginning, without what was done"), button("\u22121 s", () => control.step(-1000), "Back by a second"), play,
    button("+1 ms", () => control.step(1), "One millisecond"),
    button("Next event", () => control.toEvent(), "To the next event"), speed, time);

  return (run) => {
    say(play, control.playing ? "\u275a\u275a Pause" : "\u25b6 Play");
    play.disabled = run.hasEnded;
    speed.value = String(control.speed);
    const of = run.view.duration_ms < 3600000 ? ` of ${Math.round(run.view.duration_ms / 1000)} s` : "";
    say(time, `${clock(run.now)}${of}`);
  };
}
