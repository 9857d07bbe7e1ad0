// The panel beside the picture: everything about the selected state, or about the machine.

import { html } from "./dom";
import { legend } from "./draw";
import type { Badge, Finding, Graph, Key, ModelEdge, Path, StateNode } from "./model";
import { isContainer, kindInWords, nextRound } from "./model";

/** A section of the panel that another module adds. It is filled again for each selection. */
export interface Section {
  id: string;
  title: string;
  /** Whether it stands right below the heading. */
  first?: boolean;
  /** The content for a selected state, null for the machine; null leaves the section out. */
  fill(node: StateNode | null): Node | null;
}

export interface PanelActions {
  select(path: Path): void;
  toggle(path: Path): void;
}

export function fillPanel(
  panel: HTMLElement,
  graph: Graph,
  node: StateNode | null,
  sections: readonly Section[],
  actions: PanelActions,
): void {
  const focused = panel.contains(document.activeElement) ? (document.activeElement as HTMLElement) : null;
  const own = node ? stateSections(graph, node, actions) : machineSections(graph, actions);
  const added = (first: boolean): (HTMLElement | null)[] =>
    sections.filter((each) => (each.first ?? false) === first).map((each) => {
      const content = each.fill(node);
      return content && section(each.title, content, each.id);
    });
  const parts = [own[0]!, ...added(true), ...own.slice(1), ...added(false)];
  panel.replaceChildren(...parts.filter((each) => each !== null));
  panel.scrollTop = 0;
  if (focused?.isConnected) focused.focus();
}

function section(title: string, content: Node, id?: string): HTMLElement {
  return html("section", { "data-section": id ?? title.toLowerCase() }, html("h3", {}, title), content);
}

function link(text: string, path: Path, actions: PanelActions): HTMLElement {
  const made = html("button", { type: "button", class: "link" }, text);
  made.addEventListener("click", () => actions.select(path));
  return made;
}

function stateSections(graph: Graph, node: StateNode, actions: PanelActions): (HTMLElement | null)[] {
  const properties = graph.model.properties.filter((each) => each.states.includes(node.path));
  return [
    heading(graph, node, actions),
    node.findings.length
      ? section("Findings", findings(node.findings.map((index) => graph.model.findings[index]!)))
      : null,
    node.outcomes.length ? section("Outcomes", outcomes(graph, node, actions)) : null,
    node.inputs.length ? section("Inputs", keys(node.inputs, "reads")) : null,
    node.outputs.length ? section("Outputs", keys(node.outputs, "writes")) : null,
    node.userdata?.length ? section("Userdata", userdata(node)) : null,
    node.rules ? section("Rules", rules(graph, node)) : null,
    properties.length ? section("Properties", propertyList(graph, properties, actions)) : null,
    node.children.length ? section("States", children(graph, node, actions)) : null,
    node.snippet ? section(node.file?.endsWith(".py") ? "Code" : "Script", snippet(node)) : null,
  ];
}

function heading(graph: Graph, node: StateNode, actions: PanelActions): HTMLElement {
  const around = node.parent === null ? null : graph.nodes.get(node.parent);
  const made = html("section", { "data-section": "state" },
    html("p", { class: "path" }, around ? link(around.path, around.path, actions) : "machine"),
    html("h2", {}, node.name),
    html("p", { class: "kind" }, kindInWords(node), node.type && isContainer(node) ? ` (${node.type})` : ""),
  );
  if (node.badges.length) {
    made.append(html("ul", { class: "badges" }, ...node.badges.map((badge) => html("li", {}, badgeInWords(badge, node)))));
  }
  if (node.doc) made.append(html("p", { class: "doc" }, node.doc));
  if (node.unknown) made.append(html("p", { class: "doc" }, `Not known exactly: ${node.unknown}.`));
  if (node.tags.length) {
    made.append(html("p", { class: "tags" }, ...node.tags.map((tag) => html("span", { class: "tag" }, tag))));
  }
  return made;
}

/** What a badge does, in a sentence. */
function badgeInWords(badge: Badge, node: StateNode): string {
  const again = badge.again.join(" or ");
  switch (badge.field) {
    case "timeout":
      return `${badge.text}: then ${node.outcomes.some(({ name }) => name === badge.outcome) ? "it" : "a try"} ends with ${badge.outcome}`;
    case "retry":
      return `${badge.text}: the next one after ${again}; after the last one it ends with ${badge.outcome}`;
    case "for_each":
      return again ? `${badge.text}: the next one after ${again}` : badge.text;
    case "catches":
      return `an exception in it ends it with ${badge.outcome}`;
  }
}

export function findings(found: Finding[]): HTMLElement {
  return html("ul", { class: "findings" }, ...found.map((item) =>
    html("li", { class: item.severity },
      html("p", {}, html("strong", {}, `${item.severity} ${item.code}`), " ", item.message),
      item.help ? html("p", { class: "help" }, `help: ${item.help}`) : null,
      item.file ? html("p", { class: "place" }, `${item.file}:${item.line}`) : null,
    )));
}

/** Each outcome of a state with what follows it. */
function outcomes(graph: Graph, node: StateNode, actions: PanelActions): HTMLElement {
  const leaving = graph.leaving.get(node.path) ?? [];
  const rows = node.outcomes.map((outcome) => {
    const edges = leaving.filter((edge) => edge.outcome === outcome.name);
    const name = html("span", { class: `outcome${outcome.failure ? " failure" : outcome.success ? " success" : ""}` }, outcome.name);
    const targets = html("span", { class: "targets" }, ...edges.map((edge) => target(graph, edge, actions)));
    return html("li", {}, name, targets);
  });
  const repeated = (node.repeated ?? []).map((outcome) => {
    const name = html("span", { class: `outcome${outcome.failure ? " failure" : ""}` }, outcome.name);
    return html("li", {}, name, html("span", { class: "targets" }, html("span", { class: "target" }, nextRound(node, outcome.name))));
  });
  return html("ul", { class: "rows" }, ...rows, ...repeated);
}

function target(graph: Graph, edge: ModelEdge, actions: PanelActions): HTMLElement {
  const words = { default: "otherwise ", implicit: "implied: ", loop: "next item: ", exhausted: "no more items: ", rule: "by rule: " };
  const how = (words as Record<string, string>)[edge.kind] ?? "";
  if (typeof edge.target === "string") {
    const node = graph.nodes.get(edge.target);
    return html("span", { class: "target" }, how, link(node?.name ?? edge.target, edge.target, actions));
  }
  const around = graph.nodes.get(edge.container);
  return html("span", { class: "target" }, `${how}ends ${around?.name ?? edge.container} with ${edge.target.outcome}`);
}

function keys(list: Key[], verb: string): HTMLElement {
  return html("ul", { class: "rows" }, ...list.map((key) =>
    html("li", {},
      html("span", { class: "key", title: key.doc }, key.name),
      html("code", {}, key.type),
      key.key === key.name ? null : html("span", { class: "target" }, `${verb} ${key.key}`),
    )));
}

function userdata(node: StateNode): HTMLElement {
  return html("ul", { class: "rows" }, ...(node.userdata ?? []).map((each) =>
    html("li", {}, html("span", { class: "key" }, each.key), html("code", {}, each.type), html("code", { class: "value" }, each.value))));
}

function rules(graph: Graph, node: StateNode): HTMLElement {
  const named = (path: Path): string => graph.nodes.get(path)?.name ?? path;
  const rows = (node.rules ?? []).map((rule) =>
    html("li", {}, html("span", { class: "outcome" }, rule.outcome),
      html("span", { class: "target" }, rule.when.map(([path, outcome]) => `${named(path)}: ${outcome}`).join(" and ") || "always")));
  if (node.default) {
    rows.push(html("li", {}, html("span", { class: "outcome" }, node.default), html("span", { class: "target" }, "otherwise")));
  }
  return html("ul", { class: "rows" }, ...rows);
}

function children(graph: Graph, node: StateNode, actions: PanelActions): HTMLElement {
  return html("p", { class: "chips" }, ...node.children.map((path) =>
    link(graph.nodes.get(path)?.name ?? path, path, actions)));
}

function snippet(node: StateNode): HTMLElement {
  return html("div", {},
    html("p", { class: "place" }, `${node.file}:${node.line}`),
    html("pre", { tabindex: "0", "aria-label": `script of ${node.name}` }, html("code", {}, node.snippet)));
}

function propertyList(graph: Graph, list: Graph["model"]["properties"], actions: PanelActions): HTMLElement {
  return html("ul", { class: "properties" }, ...list.map((each) =>
    html("li", { class: each.verdict },
      html("span", { class: "verdict" }, each.verdict), " ", each.name,
      each.name === each.text ? null : html("p", { class: "help" }, each.text),
      html("p", { class: "chips" }, ...each.states.map((path) => link(graph.nodes.get(path)?.name ?? path, path, actions))),
    )));
}

const KEYS: [string, string][] = [
  ["/", "search"],
  ["arrows", "next state in that direction"],
  ["Enter", "open or close a container"],
  ["Escape", "container around the state"],
  ["f", "whole machine"],
  ["+ and -", "zoom"],
  ["e and c", "open and close all containers"],
  ["d", "down or to the right"],
];

function machineSections(graph: Graph, actions: PanelActions): (HTMLElement | null)[] {
  const { model } = graph;
  const root = graph.nodes.get(model.root);
  const heading = html("section", { "data-section": "machine" },
    html("p", { class: "path" }, model.source),
    html("h2", {}, model.name),
    html("p", { class: "kind" }, `${counted(model.nodes.length - 1, "state")}, ${counted(model.edges.length, "transition")}`),
    root?.doc ? html("p", { class: "doc" }, root.doc) : null,
  );
  return [
    heading,
    model.findings.length ? section("Findings", machineFindings(graph, actions)) : null,
    model.properties.length ? section("Properties", propertyList(graph, model.properties, actions)) : null,
    section("Legend", legend(model)),
    section("Keys", html("dl", { class: "keys" }, ...KEYS.flatMap(([key, text]) => [html("dt", {}, html("kbd", {}, key)), html("dd", {}, text)]))),
  ];
}

function counted(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

function machineFindings(graph: Graph, actions: PanelActions): HTMLElement {
  const list = findings(graph.model.findings);
  graph.model.findings.forEach((item, index) => {
    const node = item.node === null ? undefined : graph.nodes.get(item.node);
    if (node) list.children[index]!.append(html("p", { class: "chips" }, link(node.name, node.path, actions)));
  });
  return list;
}
