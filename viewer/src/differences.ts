// The differences of two machines: in words, in the panel. The picture has them as classes and signs.

import { html, svg } from "./dom";
import { changeSign } from "./draw";
import type { Differences } from "./model";
import type { Viewer } from "./viewer";

/** List the differences of the model, if it has any. */
export function showDifferences(viewer: Viewer): void {
  const { differences } = viewer.graph.model;
  if (!differences) return;
  viewer.addSection({
    id: "differences",
    title: "Differences",
    first: true,
    fill: (node) => (node ? ofState(differences, node.path) : ofMachine(viewer, differences)),
  });
}

function ofState({ changes }: Differences, path: string): HTMLElement {
  const found = changes.filter((each) => each.path === path);
  if (!found.length) return html("p", {}, "no difference in this state itself");
  return html("ul", { class: "changes" }, ...found.map(({ text }) => html("li", {}, html("code", {}, text))));
}

function ofMachine(viewer: Viewer, { summary, changes }: Differences): HTMLElement {
  const rows = changes.map(({ path, text }) => {
    const link = html("button", { type: "button", class: "link" }, path);
    link.addEventListener("click", () => void viewer.select(path));
    return html("li", {}, link, " ", html("code", {}, text));
  });
  const signs = (["added", "removed", "changed"] as const).map((change) =>
    html("li", {},
      svg("svg", { viewBox: "-9 -9 18 18", width: 18, height: 18, "aria-hidden": "true" }, changeSign(change)),
      html("span", {}, change)));
  return html("div", {},
    html("p", {}, summary),
    html("ul", { class: "legend" }, ...signs),
    html("ul", { class: "changes", "aria-label": "All differences" }, ...rows));
}
