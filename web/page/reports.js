// reports.js: asks the worker for reports, and shows or saves them.

import { byId } from "./dom.js";

const MODULES = "report/report.js";
const STYLES = ["report/timeline/timeline.css", "report/report.css"];

async function fetchText(path) {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`The report cannot be saved, because ${path} is missing.`);
  return response.text();
}

/** A module with those that it imports before it, as one script: as host_sim puts them into a report. */
async function scriptOf(path, seen = new Set()) {
  if (seen.has(path)) return "";
  seen.add(path);
  const source = await fetchText(path);
  let before = "";
  for (const [, from] of source.matchAll(/^import [^\n]* from "(.*?)";/gm)) {
    before += await scriptOf(new URL(from, new URL(path, location.href)).href, seen);
  }
  return before + source.replace(/^import [^\n]*/gm, "");
}

/** The data of a report. */
export function dataOf(html) {
  return JSON.parse(/id="data">(.*?)<\/script>/s.exec(html)[1]);
}

export class Reports {
  constructor() {
    this.waiting = new Map();
    this.count = 0;
  }

  begin() {
    this.worker = new Worker("simulation/worker.js", { type: "module" });
    this.worker.addEventListener("message", ({ data }) => {
      const { resolve, reject } = this.waiting.get(data.id);
      this.waiting.delete(data.id);
      if (data.error) reject(new Error(data.error));
      else resolve(data);
    });
    for (const name of ["error", "messageerror"]) this.worker.addEventListener(name, () => this.giveUp());
  }

  /** The worker is no good: nobody waits for it, and the next report gets another one. */
  giveUp() {
    this.worker.terminate();
    this.worker = null;
    const error = new Error("The report cannot be made, because simulation/worker.js is missing or has failed.");
    this.waiting.forEach(({ reject }) => reject(error));
    this.waiting.clear();
  }

  /** @return the answer of the worker: html is the report without its styles and scripts @throws Error with a sentence */
  async make(request, transfer = []) {
    if (!this.worker) this.begin();
    const id = ++this.count;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, ...request }, transfer);
    });
  }

  /** @param log { interfaces, aiInterface, choose }: with two interfaces, one of them can be the AI side */
  show(html, name, log = { interfaces: [] }) {
    const [label, dialog] = [byId("report-ai"), byId("report-dialog")];
    label.hidden = log.interfaces.length < 2;
    const select = label.querySelector("select");
    select.replaceChildren(new Option("none: one shared bus", ""), ...log.interfaces.map((one) => new Option(one, one)));
    select.value = log.aiInterface ?? "";
    select.onchange = () => log.choose(select.value);
    this.html = html;
    this.name = name;
    const frame = byId("report-frame");
    frame.addEventListener("load", () => frame.contentWindow.postMessage(html, location.origin), { once: true });
    frame.src = "report/index.html";
    if (!dialog.open) dialog.showModal();
  }

  /** The report that is shown as one file, as host_sim writes it. */
  async whole() {
    const styles = (await Promise.all(STYLES.map(fetchText))).join("");
    const script = await scriptOf(new URL(MODULES, location.href).href);
    return this.html.replace("<style>\n\n</style>", () => `<style>\n${styles}\n</style>`)
      .replace('<script type="module">\n\n</script>', () => `<script type="module">\n${script}\n</script>`);
  }

  async save() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([await this.whole()], { type: "text/html" }));
    link.download = `${this.name.replace(/\.\w+$/, "").replaceAll(/[^\w-]+/g, "-")}.html`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
}
