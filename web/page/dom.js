// dom.js: the few functions that all parts of the page draw with.

export const byId = (id) => document.getElementById(id);

/** make("td.wide", "text", child, ...) */
export function make(name, ...children) {
  const [tag, ...classes] = name.split(".");
  const element = document.createElement(tag);
  if (classes.length) element.className = classes.join(" ");
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** draw("circle", { cx: 5, r: 3 }, child, ...): an element of SVG */
export function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** @param label says more: it is the name if it holds the text, because people say to a computer what they see; else a hint */
export function button(text, action, label) {
  const element = make("button", text);
  element.type = "button";
  if (label) {
    if (label.toLowerCase().includes(text.toLowerCase())) element.setAttribute("aria-label", label);
    element.title = label;
  }
  element.addEventListener("click", action);
  return element;
}

/** Set a text, if it is another one: an unchanged page is not drawn anew. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Set or remove an attribute, if it changes. */
export function mark(element, name, value) {
  if (value === null || value === false) element.removeAttribute(name);
  else if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value);
}

/** 1234 ms as "1.234 s", 83 minutes as "1:23:00.000". */
export function clock(ms) {
  const seconds = (ms % 60000) / 1000;
  if (ms < 60000) return `${seconds.toFixed(3)} s`;
  const minutes = Math.floor(ms / 60000) % 60;
  const rest = seconds.toFixed(3).padStart(6, "0");
  return ms < 3600000 ? `${minutes}:${rest}` : `${Math.floor(ms / 3600000)}:${String(minutes).padStart(2, "0")}:${rest}`;
}

/** "freeze_counter" as people read it. */
export const words = (name) => name.replaceAll("_", " ");
