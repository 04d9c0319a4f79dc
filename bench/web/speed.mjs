// Benchmark of the page's module: simulates the scenario demo.yaml ten times and prints the best multiple of real time.
// usage: node bench/web/speed.mjs [MODULE]     MODULE: default build/wasm/bin/agv.wasm
import { existsSync, readFileSync } from "node:fs";
import { instantiate } from "../../web/page/simulation/module.js";

const [module = "build/wasm/bin/agv.wasm"] = process.argv.slice(2);
if (!existsSync(module)) {
  console.error(`speed.mjs: no file '${module}'; cmake --build --preset wasm makes it`);
  process.exit(2);
}
const demo = readFileSync(new URL("../../host_sim/scenarios/overview/demo.yaml", import.meta.url), "utf8");
const simulation = await instantiate(await WebAssembly.compile(readFileSync(module)));
let best = 0;
for (let i = 0; i < 10; i++) {
  simulation.create("demo.yaml", demo);
  const begin = process.cpuUsage();
  const played = simulation.step(1e9);
  const used = process.cpuUsage(begin);
  best = Math.max(best, (played * 1000) / (used.user + used.system));
}
console.log(`${Math.round(best)} times real time`);
