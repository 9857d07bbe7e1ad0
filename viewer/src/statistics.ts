// Statistics of many runs: figures at the states and transitions of the picture, and in the panel.

import { html } from "./dom";
import type { Picture } from "./draw";
import type { Graph, ModelEdge, Path, Statistics } from "./model";
import { countOf, edgeId, shareOf } from "./model";
import { seconds } from "./run_marks";
import type { Viewer } from "./viewer";

/** Show the statistics of the model, if it has any. */
export function showStatistics(viewer: Viewer): void {
  const { statistics } = viewer.graph.model;
  if (!statistics) return;
  const { graph } = viewer;
  const visits = new Map(Object.entries(statistics.states).map(([path, each]) => [path, each.visits]));
  visits.delete(graph.model.root);
  const taken = graph.model.edges.filter((edge) => isTaken(graph, statistics, edge)).map(edgeId);
  const times = new Map([...visits.keys()].flatMap((path) => {
    const { mean, rounds } = statistics.states[path]!;
    const words = [rounds, mean ? seconds(mean) : ""].filter(Boolean).join(" · ");
    return words ? [[path, words] as const] : [];
  }));
  viewer.highlight({ active: [], taken, visits, times });
  viewer.onMark((picture) => markNever(graph, statistics, picture));
  viewer.addSection({
    id: "statistics",
    title: "Statistics",
    first: true,
    fill: (node) => html("div", {},
      figures(statistics, node?.path ?? graph.model.root),
      node ? null : neverTaken(viewer, statistics)),
  });
}

/** Whether runs took an edge for certain: in concurrences and loops, outcomes alone do not show it. */
function isTaken(graph: Graph, statistics: Statistics, edge: ModelEdge): boolean {
  if (edge.source === null) return typeof edge.target === "string" && edge.target in statistics.states;
  const kind = graph.nodes.get(edge.container)?.kind;
  const known = kind === "machine" || kind === "sequence";
  return known && countOf(statistics.states[edge.source], edge.outcome) > 0;
}

/** Mark the states that no run entered, and the lines whose outcomes no run had. */
function markNever(graph: Graph, statistics: Statistics, picture: Picture): void {
  for (const [path, element] of picture.states) {
    element.classList.toggle("never", path !== graph.model.root && !(path in statistics.states));
  }
  for (const { line, element } of picture.lines) {
    const never = line.line.edges.length > 0 && line.line.edges.every((id) => {
      const [source = "", outcome = ""] = id.split("\n");
      const start = outcome === "" && source === line.container;
      return !start && !countOf(statistics.states[source], outcome);
    });
    element.classList.toggle("never", never);
  }
}

function figures(statistics: Statistics, path: Path): HTMLElement {
  const found = statistics.states[path];
  const row = (name: string, value: string): HTMLElement =>
    html("li", {}, html("span", { class: "key" }, name), html("code", {}, value));
  if (!found) return html("ul", { class: "rows" }, row("visits", "0: no run entered it"));
  const outcomes = Object.entries(found.outcomes).map(([name, count]) =>
    row(name, `${count} (${shareOf(found, name)})`));
  const unfinished = found.unfinished ? [row("not ended", String(found.unfinished))] : [];
  return html("ul", { class: "rows" },
    row("visits", String(found.visits)),
    ...(found.rounds ? [row("tries and items", found.rounds)] : []),
    row("mean time", seconds(found.mean)),
    row("longest", seconds(found.longest)),
    ...outcomes, ...unfinished);
}

/** The transitions that no run took, for the panel of the machine. */
function neverTaken(viewer: Viewer, { never, transitions }: Statistics): HTMLElement {
  const taken = transitions - never.length;
  const failures = never.filter(({ failure }) => failure).length;
  const rows = never.map(({ path, text, failure }) => {
    const link = html("button", { type: "button", class: "link" }, text);
    link.addEventListener("click", () => void viewer.select(path));
    return html("li", {}, link, failure ? html("span", { class: "failure" }, " failure") : null);
  });
  return html("div", {},
    html("p", {}, `${taken} of ${transitions} transitions taken; grey and dotted: never`),
    failures ? html("p", {}, `${failures} of the others ${failures === 1 ? "follows a failure that was" : "follow failures that were"} never exercised`) : null,
    rows.length ? html("ul", { class: "rows never-taken", "aria-label": "Transitions never taken" }, ...rows) : null);
}

