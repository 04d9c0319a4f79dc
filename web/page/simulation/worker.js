// worker.js: reports, made beside the page so that it never waits. A message is { id, kind, ... }, the answer
// { id, html } or { id, error }.
//   kind "run": plan (as Run.begin() of run.js), until: the run is played again up to this time
//   kind "log": name, bytes, settings, aiInterface ("": a shared bus); its answer has { interfaces } too, their names

import { instantiate } from "./module.js";
import { settingsText, stepText } from "./run.js";

let simulation;

async function start() {
  const response = await fetch(new URL("../agv.wasm", import.meta.url));
  return instantiate(await WebAssembly.compile(await response.arrayBuffer()));
}

function ofRun({ plan, until }) {
  simulation.create(plan.title, plan.text, settingsText(plan.settings), true);
  plan.steps.forEach((step) => simulation.inject(stepText(step)));
  simulation.step(until);
  return { html: simulation.report() };
}

/** gzip is told by its first bytes. */
async function unpacked(bytes) {
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes;
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function ofLog({ name, bytes, settings, aiInterface }) {
  let log;
  try {
    log = await unpacked(bytes);
  } catch {
    throw new Error(`${name}: the compressed data is damaged or cut off`);
  }
  return { html: simulation.replay(name, log, settingsText(settings), aiInterface), interfaces: simulation.interfaces() };
}

addEventListener("message", async ({ data }) => {
  try {
    simulation ??= await start();
    postMessage({ id: data.id, ...(data.kind === "run" ? ofRun(data) : await ofLog(data)) });
  } catch (error) {
    postMessage({ id: data.id, error: error.message });
  }
});
