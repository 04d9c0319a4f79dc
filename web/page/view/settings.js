// settings.js: every setting with its range. Another value begins the run anew with the same steps, up to the same time.

import { button, byId, make, words } from "../dom.js";

/** A number with a slider, or a choice of words. @param changed called with the name and the value, null: the default */
function makeControl(setting, changed) {
  const id = `setting-${setting.name}`;
  if (setting.words) {
    const select = make("select");
    setting.words.split("|").forEach((word, i) => select.append(new Option(word, word, false, i === setting.preset)));
    select.id = id;
    select.addEventListener("change", () => changed(setting.name, select.selectedIndex === setting.preset ? null : select.value));
    return { control: [select], set: (value) => (select.value = value ?? setting.words.split("|")[setting.preset]) };
  }
  const range = make("input");
  const number = make("input");
  const isId = setting.name.startsWith("id_") || setting.name === "status_frame_id";
  Object.assign(range, { type: "range", min: setting.lowest, max: setting.highest, value: setting.preset, ariaLabel: `${words(setting.name)}, slider` });
  Object.assign(number, { type: isId ? "text" : "number", id, size: 7 });
  const show = (value) => (isId ? `0x${Number(value).toString(16).toUpperCase().padStart(3, "0")}` : String(value));
  const set = (value) => {
    number.value = show(value ?? setting.preset);
    range.value = Number(value ?? setting.preset);
  };
  range.addEventListener("input", () => (number.value = show(range.value)));
  range.addEventListener("change", () => changed(setting.name, Number(range.value) === setting.preset ? null : show(range.value)));
  number.addEventListener("change", () => changed(setting.name, Number(number.value) === setting.preset && number.value !== "" ? null : number.value));
  set(null);
  return { control: [range, number, make("span.unit", setting.unit)], set };
}

export function makeSettings(lists, changed) {
  const search = make("input");
  Object.assign(search, { type: "search", placeholder: "Find a setting", ariaLabel: "Find a setting" });
  const rows = lists.settings.map((setting) => {
    const made = makeControl(setting, changed);
    const label = make("label", setting.name);
    label.htmlFor = `setting-${setting.name}`;
    const range = setting.words ? setting.words.split("|").join(", ") : `${setting.lowest} to ${setting.highest} ${setting.unit}`.trim();
    const preset = setting.words ? setting.words.split("|")[setting.preset] : setting.preset;
    const element = make("li", label, make("span.control", ...made.control),
      make("small", `${setting.meaning}. ${range}, default ${preset}${setting.gateway_only ? ", gateway only" : ""}.`));
    return { setting, element, set: made.set };
  });
  const list = make("ul.settings", ...rows.map((row) => row.element));
  const classes = lists.faults.filter((fault) => !fault.fixed).map((fault) => ({ name: `class_${fault.name.toLowerCase()}`, words: "warn|trip", preset: fault.class === "trip" ? 1 : 0, meaning: `Class of ${fault.name}`, unit: "" }));
  for (const setting of classes) {
    const made = makeControl(setting, changed);
    const label = make("label", setting.name);
    label.htmlFor = `setting-${setting.name}`;
    const element = make("li", label, make("span.control", ...made.control), make("small", `${setting.meaning}: default ${setting.words.split("|")[setting.preset]}.`));
    rows.push({ setting, element, set: made.set });
    list.append(element);
  }
  list.tabIndex = 0;
  search.addEventListener("input", () => {
    const text = search.value.toLowerCase();
    for (const row of rows) row.element.hidden = !`${row.setting.name} ${row.setting.meaning}`.toLowerCase().includes(text);
  });
  byId("settings").append(make("p.tools", search, button("All defaults", () => changed(null, null))), list);

  return (settings) => {
    for (const row of rows) {
      const value = settings[row.setting.name] ?? null;
      row.set(value);
      row.element.classList.toggle("changed", value !== null);
    }
  };
}
