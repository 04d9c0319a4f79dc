// verdict.js: the sentence first: what failed, what the supervisor did, and why the vehicle stands.

import { byId, make, say } from "../dom.js";
import { STATES, TONES } from "./machine.js";

const CALM = {
  INIT: ["The supervisor starts: it waits for VCU, EPS, manual mode and standstill.", "The safety output is open, and the safe commands are sent."],
  STANDBY: ["Manual. The supervisor listens.", "There is no trip. The autopilot is not engaged: the supervisor sends no command of its own."],
  ACTIVE: ["On autopilot. There is no trip.", "The AI computer drives. The supervisor checks every message against its deadline and its range."],
};

const TITLES = ["What failed", "What the supervisor did", "Why the vehicle stands"];

/** Up to three texts; with three of them, each has its title. */
function showDetails(...texts) {
  const place = byId("details");
  if (place.dataset.key === texts.join()) return;
  place.dataset.key = texts.join();
  place.replaceChildren(...texts.map((text, i) => make("p", texts.length > 1 ? make("b", TITLES[i]) : null, text)));
}

export function makeVerdict(lists) {
  const section = byId("verdict");

  /** @param data of the report up to now; null: it is not there yet */
  return (run, data) => {
    const { view } = run;
    const state = view.is_halted ? "HALTED" : STATES[view.state] ?? "?";
    const fault = lists.faults[view.reason];
    section.className = TONES[state] ?? "bad";
    say(byId("state"), state);
    say(byId("reason"), fault ? fault.name : "");
    if (view.is_halted) {
      say(byId("headline"), "The supervisor itself hangs.");
      showDetails("Its hardware watchdog resets it, and the safety output opens.");
    } else if (!fault) {
      const [headline, details] = CALM[state] ?? ["", ""];
      say(byId("headline"), run.hasEnded ? `The scenario has ended. ${headline}` : headline);
      showDetails(details);
    } else {
      const trip = data?.trips?.filter((one) => !one.from_recording && one.reason === fault.name).pop();
      say(byId("headline"), trip?.headline ?? `The supervisor stops the vehicle because ${fault.phrase}.`);
      if (trip) showDetails(trip.cause, trip.action, trip.outcome);
      else showDetails("The cause is being looked up.");
    }
  };
}
