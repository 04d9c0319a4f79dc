// expectations.js: the expectations of the scenario, as they stand in its file, ticked as they pass.

import { byId, make, say } from "../dom.js";

const SIGNS = { open: ["\u25cb", "not yet"], holds: ["\u25d0", "holds so far"], passed: ["\u2713", "passed"], failed: ["\u2717", "failed"] };

export function makeExpectations() {
  const sum = make("span.soft");
  const list = make("ol.expectations");
  const failures = make("ul.failures");
  list.tabIndex = 0;
  byId("expectations-title").append(" ", sum);
  byId("expectations").append(failures, list);
  let rows = [];
  let shownOf = null;

  return (run) => {
    const { items, failures: texts } = run.simulation.expectations();
    if (shownOf !== run.plan.text) {
      const source = run.plan.text.split("\n");
      rows = items.map(([line, kind]) => {
        const sign = make("span.sign");
        const text = kind === "hazards" ? "hazards: never" : (source[line - 1] ?? "").replace(/^\s*-\s*/, "").trim();
        return { sign, element: make("li", sign, " ", make("b", kind), " ", make("code", text)) };
      });
      list.replaceChildren(...rows.map((row) => row.element));
      shownOf = run.plan.text;
    }
    items.forEach(([, , standing], i) => {
      const [glyph, name] = SIGNS[standing];
      if (rows[i].sign.textContent === glyph) return;
      rows[i].sign.textContent = glyph;
      rows[i].sign.setAttribute("aria-label", name);
      rows[i].sign.setAttribute("role", "img");
      rows[i].element.className = standing;
    });
    const passed = items.filter((item) => item[2] === "passed").length;
    say(sum, `${passed} of ${items.length} passed${texts.length ? `, ${texts.length} failed` : ""}`);
    byId("expectations").hidden = !items.length && !texts.length;
    if (failures.childElementCount !== texts.length) failures.replaceChildren(...texts.map((text) => make("li", text)));
  };
}
