// link.js: a run as the part of an address behind the #, and back. It ends with a checksum, so that a link that was cut is
// noticed:
//   scenario=overview/demo.yaml&steering_command_timeout_ms=80&do=3000.eps.set.field=faults.value=08h&t=4000&end=1a2b3c4d

/** FNV-1a, as 8 hexadecimal digits. */
function checksum(text) {
  let sum = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) sum = Math.imul(sum ^ byte, 0x01000193) >>> 0;
  return sum.toString(16).padStart(8, "0");
}

const escape = (text) => encodeURIComponent(text).replaceAll(".", "%2E");

/** @param run { scenario, settings, steps, t } */
export function toLink({ scenario, settings, steps, t }) {
  const parts = [`scenario=${encodeURIComponent(scenario).replaceAll("%2F", "/")}`];
  for (const [name, value] of Object.entries(settings)) parts.push(`${name}=${encodeURIComponent(value)}`);
  for (const { at, actor, word, parameters } of steps) {
    parts.push(`do=${[at, actor, word, ...Object.entries(parameters).map(([name, value]) => `${name}=${escape(value)}`)].join(".")}`);
  }
  parts.push(`t=${t}`);
  const text = parts.join("&");
  return `${text}&end=${checksum(text)}`;
}

function readStep(text) {
  const [at, actor, word, ...rest] = text.split(".");
  const parameters = Object.fromEntries(rest.map((part) => {
    const [name, ...value] = part.split("=");
    return [name, decodeURIComponent(value.join("="))];
  }));
  return { at: Number(at), actor, word, parameters };
}

/** @return what toLink() took @throws Error with a sentence */
export function fromLink(link) {
  const [text, end] = link.split("&end=");
  if (end !== checksum(text)) throw new Error("This link is incomplete, or it was changed. The run starts from the beginning instead.");
  const run = { scenario: "", settings: {}, steps: [], t: 0 };
  for (const part of text.split("&")) {
    const [name, ...rest] = part.split("=");
    const value = rest.join("=");
    if (name === "scenario") run.scenario = decodeURIComponent(value);
    else if (name === "do") run.steps.push(readStep(value));
    else if (name === "t") run.t = Number(value);
    else run.settings[name] = decodeURIComponent(value);
  }
  return run;
}
