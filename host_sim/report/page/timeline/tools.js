// tools.js: the buttons above the picture.

function button(text, name, action) {
  const element = document.createElement("button");
  element.type = "button";
  element.textContent = text;
  if (name) {
    element.title = name;
    element.setAttribute("aria-label", name);
  }
  element.addEventListener("click", action);
  return element;
}

function group(name, ...buttons) {
  const element = document.createElement("span");
  element.setAttribute("role", "group");
  element.setAttribute("aria-label", name);
  element.append(...buttons);
  return element;
}

/** @param views [{ name, from, to }] @param picture has show(from, to), pan(share) and zoom(factor) */
export function makeTools(views, picture) {
  return [
    group("Show", ...views.map((view) => button(view.name, "", () => picture.show(view.from, view.to)))),
    group("Move",
      button("\u2190", "Earlier", () => picture.pan(-1 / 3)),
      button("\u2212", "Zoom out", () => picture.zoom(2)),
      button("+", "Zoom in", () => picture.zoom(0.5)),
      button("\u2192", "Later", () => picture.pan(1 / 3))),
  ];
}
