// show.js: a report inside the page. Its text and data come in a message; its script and its styles are files here.
addEventListener("message", async ({ data, origin }) => {
  if (origin !== location.origin || typeof data !== "string") return;
  const text = data.replace(/<style>.*?<\/style>/s, "").replace(/<script type="module">.*?<\/script>/s, "");
  const report = new DOMParser().parseFromString(text, "text/html");
  document.title = report.title;
  document.body.replaceChildren(...report.body.children);
  await import("./report.js");
});
