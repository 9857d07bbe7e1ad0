// The picture: a scene as SVG, and the marks on it of selection and run.

import { html, svg } from "./dom";
import type { Area, Box, PlacedLine, PlacedPiece, Point, Scene } from "./layout";
import type { Graph, Model, Path, StateNode } from "./model";
import { isContainer, kindInWords, nearest } from "./model";
import { CHIP_HEIGHT, LINE_HEIGHT, TITLE_HEIGHT, boxDetail, chipsOf, exitId, exitsInWords } from "./pieces";
import { fitting, width } from "./text";

/** What a run of the machine marks in the picture. `taken` are ids of edges (see `edgeId`), `times` the mean times
 * of states in words. */
export interface Highlight {
  active: Iterable<Path>;
  taken?: Iterable<string>;
  visits?: ReadonlyMap<Path, number>;
  /** The try or item that runs, in words. */
  rounds?: ReadonlyMap<Path, string>;
  times?: ReadonlyMap<Path, string>;
  waiting?: Iterable<Path>;
  breakpoints?: Iterable<Path>;
}

/** The elements of the picture that change after it is drawn. */
export interface Picture {
  root: SVGGElement;
  states: Map<Path, SVGGElement>;
  lines: { line: PlacedLine; element: SVGGElement }[];
  /** The lines that start or end at each state. */
  linesAt: Map<string, SVGGElement[]>;
  /** What is marked now: the selected state, the one that the keyboard reaches, and the run. */
  selected: Path | null;
  focusable: Path | null;
  run: Highlight | null;
}

export function draw(graph: Graph, scene: Scene): Picture {
  const states = new Map<Path, SVGGElement>();
  const tree = svg("g", { role: "tree", "aria-label": `States of ${graph.model.name}` });
  for (const box of scene.boxes) {
    const node = graph.nodes.get(box.path);
    if (!node) continue;
    const element = drawState(graph, node, box);
    states.set(box.path, element);
    tree.append(element);
  }
  const lines = scene.lines.map((line) => ({ line, element: drawLine(line) }));
  const edges = svg("g", { "aria-hidden": "true" }, ...lines.map((each) => each.element));
  const grounds = new Map(scene.boxes.map((box) => [box.path, ground(graph.nodes.get(box.path), box)]));
  const labels = svg("g", { "aria-hidden": "true" }, ...scene.lines.map(({ line, label, container }) =>
    drawLabel(line, label, grounds.get(container) ?? "")));
  const marks = svg("g", { "aria-hidden": "true" }, ...scene.pieces.map((piece) => drawPiece(graph, piece)));
  const linesAt = new Map<string, SVGGElement[]>();
  for (const { line, element } of lines) {
    for (const end of new Set([line.line.from, line.line.to])) {
      const known = linesAt.get(end);
      if (known) known.push(element);
      else linesAt.set(end, [element]);
    }
  }
  const root = svg("g", {}, tree, edges, marks, labels);
  return { root, states, lines, linesAt, selected: null, focusable: null, run: null };
}

function drawState(graph: Graph, node: StateNode, box: Box): SVGGElement {
  const siblings = node.parent === null ? [node.path] : (graph.nodes.get(node.parent)?.children ?? []);
  const group = svg("g", {
    class: classes(node, box),
    transform: `translate(${box.x} ${box.y})`,
    role: "treeitem",
    tabindex: "-1",
    "data-path": node.path,
    "aria-label": spoken(node, box).join("; "),
    "data-words": spoken(node, box)[0],
    "aria-level": box.level + 1,
    "aria-setsize": siblings.length,
    "aria-posinset": siblings.indexOf(node.path) + 1,
    "aria-expanded": isContainer(node) ? String(box.open) : null,
    "aria-selected": "false",
  });
  if (isContainer(node) && !box.open) {
    group.append(svg("rect", { class: "below", x: 4, y: 4, width: box.width, height: box.height, rx: 8 }));
  }
  const radius = box.open ? 12 : 8;
  group.append(svg("rect", { class: "body", width: box.width, height: box.height, rx: radius }));
  if (box.open) drawTitle(graph, group, node, box);
  else drawText(graph, group, node, box);
  if (node.change && node.change !== "same") group.append(changeSign(node.change));
  return group;
}

function classes(node: StateNode, box: Box): string {
  const kind = box.open ? `open ${ground(node, box)}` : `closed ${isContainer(node) ? ground(node, box) : ""}`;
  return ["state", node.kind, kind.trim(), node.unknown && "unknown", node.change].filter(Boolean).join(" ");
}

/** The sign of a change at the corner of a box: plus, minus or a wave, not a colour alone. */
export function changeSign(change: "added" | "removed" | "changed"): SVGElement {
  const sign = { added: "M-4 0H4M0-4V4", removed: "M-4 0H4", changed: "M-4.5 1Q-2.2-4 0 0T4.5-1" };
  return svg("g", { class: `sign ${change}` },
    svg("circle", { r: 8 }),
    svg("path", { d: sign[change] }),
  );
}

/** The class with the colour of a container. */
function ground(node: StateNode | undefined, box: Box): string {
  if (node?.kind === "iterator") return "looping";
  if (node?.kind === "concurrence") return "parallel";
  return box.level % 2 ? "odd" : "even";
}

/** Give a state its tooltip, once: a tooltip is no part of its name for screen readers. */
export function addTooltip(element: Element, node: StateNode): void {
  if (element.querySelector(":scope > title")) return;
  const text = [node.path, node.doc, node.unknown].filter(Boolean).join("\n");
  element.prepend(svg("title", {}, text));
}

/** The name of a state for screen readers in parts: the words of its box, then what only signs show. */
function spoken(node: StateNode, box: Box): string[] {
  const words = box.open ? kindInWords(node) : boxDetail(node, node.children.length);
  const badges = node.badges.map((badge) => badge.text).join(", ");
  const parts = [[node.name, words, badges, exitsInWords(box.written)].filter(Boolean).join(" ")];
  if (node.outcomes.length) parts.push(`outcomes: ${node.outcomes.map((each) => each.name).join(", ")}`);
  if (node.change && node.change !== "same") parts.push(node.change);
  if (node.unknown) parts.push(`not known exactly: ${node.unknown}`);
  if (node.findings.length) parts.push(`findings: ${node.findings.length}`);
  return parts;
}

function drawTitle(graph: Graph, group: SVGGElement, node: StateNode, box: Box): void {
  const name = fitting(node.name, "title");
  const detail = fitting(kindInWords(node), "detail");
  group.append(
    chevron(16, TITLE_HEIGHT / 2 + 1, true),
    svg("text", { class: "title", x: 32, y: 22 }, name),
    " ",
    svg("text", { class: "detail", x: 32 + width(name, "title") + 10, y: 22 }, detail),
  );
  if (node.badges.length) group.append(" ", chipRow(node, 32 + width(name, "title") + width(detail, "detail") + 20, 10));
  if (node.findings.length) group.append(badge(graph, node, box.width - 18, 17));
}

function drawText(graph: Graph, group: SVGGElement, node: StateNode, box: Box): void {
  const middle = box.width / 2;
  const detail = fitting(boxDetail(node, node.children.length), "detail");
  const name = fitting(node.name, "name");
  const y = detail ? 21 : 23;
  group.append(svg("text", { class: "name", x: middle, y, "text-anchor": "middle" }, name));
  if (detail) {
    group.append(" ", svg("text", { class: "detail", x: middle, y: 37, "text-anchor": "middle" }, detail));
  }
  const below = y + (detail ? 16 : 0);
  if (node.badges.length) {
    group.append(" ", chipRow(node, middle - chipsOf(node).width / 2, below + 6));
  }
  if (box.written.length) {
    const exits = fitting(exitsInWords(box.written), "detail");
    const failure = box.written.every((edge) => edge.failure);
    const look = failure ? "detail written failure" : "detail written";
    group.append(" ", svg("text", { class: look, x: middle, y: below + (node.badges.length ? CHIP_HEIGHT + 5 : 0) + 16, "text-anchor": "middle" }, exits));
  }
  if (isContainer(node)) group.append(chevron(14, y - 4, false));
  if (node.findings.length) group.append(badge(graph, node, box.width - 13, 13));
}

/** The badges of a state. */
function chipRow(node: StateNode, x: number, y: number): SVGElement {
  const chips = chipsOf(node).chips.map((chip) =>
    svg("g", { class: `chip ${chip.badge.field}`, transform: `translate(${chip.x} 0)` },
      svg("rect", { width: chip.width, height: CHIP_HEIGHT, rx: CHIP_HEIGHT / 2 }),
      svg("text", { x: chip.width / 2, y: 11.5, "text-anchor": "middle" }, chip.text)));
  return svg("g", { class: "badges", transform: `translate(${x} ${y})` }, ...chips.flatMap((chip, index) => index ? [" ", chip] : [chip]));
}

/** The mark of a container: points down where it is open. */
function chevron(x: number, y: number, open: boolean): SVGElement {
  const points = open ? "-4,-2 0,3 4,-2" : "-2,-4 3,0 -2,4";
  return svg("g", { class: "toggle", transform: `translate(${x} ${y})` },
    svg("rect", { class: "hit", x: -11, y: -11, width: 22, height: 22, rx: 5 }),
    svg("polyline", { points }),
  );
}

/** The mark of a state with findings; its shape shows the severity too, not only its colour. */
function badge(graph: Graph, node: StateNode, x: number, y: number): SVGElement {
  const found = new Set(node.findings.map((index) => graph.model.findings[index]?.severity));
  const severity = found.has("error") ? "error" : found.has("warning") ? "warning" : "info";
  const shape = severity === "warning" ? "M0-7 7.5 6H-7.5Z" : "M0-7A7 7 0 1 1 0 7 7 7 0 1 1 0-7Z";
  const sign = { error: "M-2.5-2.5 2.5 2.5M2.5-2.5-2.5 2.5", warning: "M0-2.5V1.5M0 3.6V3.8", info: "M0-3.4V-3.2M0-.6V3.6" };
  return svg("g", { class: `badge ${severity}`, transform: `translate(${x} ${y})` },
    svg("path", { d: shape }),
    svg("path", { class: "stroke", d: sign[severity] }),
  );
}

function drawPiece(graph: Graph, { piece, container, x, y, width, height }: PlacedPiece): SVGElement {
  const exit = piece.what === "exit" ? piece.id.slice(exitId("").length) : null;
  const group = svg("g", {
    class: `piece ${piece.what}`,
    transform: `translate(${x} ${y})`,
    "data-exit": exit,
    "data-of": exit === null ? null : container,
  });
  group.append(svg("title", {}, piece.label));
  switch (piece.what) {
    case "start":
      group.append(svg("circle", { cx: width / 2, cy: height / 2, r: width / 2 }));
      break;
    case "fork":
    case "join":
      group.append(svg("rect", { width, height, rx: 2.5 }));
      break;
    default: {
      group.append(svg("rect", { width, height, rx: height / 2 }));
      if (piece.what === "exit" && container === graph.model.root) {
        group.append(svg("rect", { class: "ring", x: -3, y: -3, width: width + 6, height: height + 6, rx: height / 2 + 3 }));
      }
      const text = { x: width / 2, y: height / 2 + 4, "text-anchor": "middle" };
      group.append(svg("text", text, piece.label));
    }
  }
  if (piece.change) group.classList.add(piece.change);
  if (piece.failure) group.classList.add("failure");
  if (piece.success) group.classList.add("success");
  return group;
}

const CORNER = 7;

/** A path through points with round corners. */
export function roundedPath(points: Point[]): string {
  const first = points[0];
  if (!first) return "";
  let path = `M${first.x} ${first.y}`;
  for (let index = 1; index < points.length; index += 1) {
    const before = points[index - 1]!;
    const here = points[index]!;
    const next = points[index + 1];
    if (!next) {
      path += `L${here.x} ${here.y}`;
      continue;
    }
    const radius = Math.min(CORNER, distance(before, here) / 2, distance(here, next) / 2);
    const start = towards(here, before, radius);
    const end = towards(here, next, radius);
    path += `L${start.x} ${start.y}Q${here.x} ${here.y} ${end.x} ${end.y}`;
  }
  return path;
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

function towards(from: Point, to: Point, by: number): Point {
  const length = distance(from, to) || 1;
  return { x: from.x + ((to.x - from.x) * by) / length, y: from.y + ((to.y - from.y) * by) / length };
}

function look(line: PlacedLine["line"]): string {
  return [line.failure && "failure", line.implicit && "implicit", line.stop && "stop", line.change].filter(Boolean).join(" ");
}

function drawLine({ line, points }: PlacedLine): SVGGElement {
  const d = roundedPath(points);
  const group = svg("g", { class: `line ${look(line)}` });
  const end = points[points.length - 1];
  const before = points[points.length - 2];
  group.append(svg("path", { class: "stroke", d }));
  if (end && before) {
    const turn = (Math.atan2(end.y - before.y, end.x - before.x) * 180) / Math.PI;
    const transform = `translate(${end.x} ${end.y}) rotate(${turn})`;
    group.append(svg("path", { class: "head", d: "M0 0L-7.5-4Q-5.9 0-7.5 4Z", transform }));
    const [only, ...others] = line.edges;
    if (only !== undefined && !others.length) group.append(svg("path", { class: "hit", d, ...origin(only) }), svg("circle", { class: "grip", cx: end.x, cy: end.y, r: 7, ...origin(only) }));
  }
  return group;
}

/** The state and the outcome at which an edge starts, as attributes. */
function origin(edge: string): Record<string, string> {
  const [path = "", outcome = ""] = edge.split("\n");
  return { "data-from": path, "data-outcome": outcome };
}

function drawLabel(line: PlacedLine["line"], label: Area | null, ground: string): SVGElement | null {
  if (!label) return null;
  const group = svg("g", { class: `label ${ground} ${look(line)}` });
  group.append(background(label));
  line.labels.forEach((text, index) => {
    const y = label.y + 2 + LINE_HEIGHT * index + 10.5;
    const x = label.x + label.width / 2;
    const edge = line.edges.find((each) => each.split("\n")[1] === text);
    const from = edge === undefined ? {} : origin(edge);
    group.append(svg("text", { x, y, "text-anchor": "middle", ...from }, fitting(text, "label")));
  });
  return group;
}

function background({ x, y, width, height }: Area): SVGElement {
  return svg("rect", { x, y, width, height, rx: 4 });
}

/** Mark the selected state and the lines that start or end at it. `focusable` is the state that the keyboard
 * reaches. Only what changes is touched: a machine may have thousands of states. */
export function markSelection(picture: Picture, path: Path | null, focusable: Path): void {
  for (const [each, chosen] of [[picture.selected, false], [path, true]] as const) {
    if (each === null) continue;
    const element = picture.states.get(each);
    element?.classList.toggle("selected", chosen);
    element?.setAttribute("aria-selected", String(chosen));
    for (const line of picture.linesAt.get(each) ?? []) line.classList.toggle("near", chosen);
  }
  if (picture.focusable !== null) picture.states.get(picture.focusable)?.setAttribute("tabindex", "-1");
  picture.states.get(focusable)?.setAttribute("tabindex", "0");
  picture.selected = path;
  picture.focusable = focusable;
}

/** Mark what a run does. A state inside a closed container marks that container. */
export function markRun(graph: Graph, picture: Picture, run: Highlight | null): void {
  if (picture.run === run) return;
  picture.run = run;
  const active = drawnStates(graph, picture, run?.active);
  const waiting = drawnStates(graph, picture, run?.waiting);
  const breakpoints = drawnStates(graph, picture, run?.breakpoints);
  const taken = new Set(run?.taken ?? []);
  for (const [path, element] of picture.states) {
    element.classList.toggle("active", active.has(path));
    element.classList.toggle("waiting", waiting.has(path));
    setBreakpoint(element, breakpoints.has(path));
    setVisits(element, run?.visits?.get(path) ?? 0, [run?.rounds?.get(path), run?.times?.get(path)]);
  }
  for (const { line, element } of picture.lines) {
    element.classList.toggle("taken", line.line.edges.some((edge) => taken.has(edge)));
  }
}

/** The states that are drawn for some states: themselves, or the closed containers that hide them. */
function drawnStates(graph: Graph, picture: Picture, paths: Iterable<Path> = []): Set<Path> {
  const found = new Set<Path>();
  for (const path of paths) {
    let node = nearest(graph, path);
    while (node && !picture.states.has(node.path) && node.parent !== null) node = graph.nodes.get(node.parent);
    if (node) found.add(node.path);
  }
  return found;
}

function setBreakpoint(element: SVGGElement, is: boolean): void {
  element.classList.toggle("breakpoint", is);
  const mark = element.querySelector(":scope > .stop");
  if (!is) mark?.remove();
  else if (!mark) element.append(svg("circle", { class: "stop", cx: 0, cy: 0, r: 6.5 }));
}

function setVisits(element: SVGGElement, count: number, words: (string | undefined)[]): void {
  element.classList.toggle("visited", count > 0);
  let mark = element.querySelector<SVGTextElement>(":scope > .visits");
  const text = [count < 2 ? "" : `×${count}`, ...words].filter(Boolean).join(" · ");
  speakVisits(element, text && ` ${text}`);
  if (!text) {
    mark?.remove();
    return;
  }
  if (!mark) {
    // To the right of the box: lines enter it from above.
    mark = svg("text", { class: "visits" });
    const body = element.querySelector(":scope > .body")!;
    mark.setAttribute("x", String(Number(body.getAttribute("width")) + 4));
    mark.setAttribute("y", "10");
    element.append(" ", mark);
  }
  mark.textContent = text;
}

/** Put the visits of a state behind the words of its box in its name for screen readers. */
function speakVisits(element: SVGGElement, visits: string): void {
  const words = element.dataset["words"] ?? "";
  const before = element.dataset["visits"] ?? "";
  if (before === visits) return;
  const rest = (element.getAttribute("aria-label") ?? "").slice(words.length + before.length);
  element.dataset["visits"] = visits;
  element.setAttribute("aria-label", words + visits + rest);
}

/** A legend of the signs of the picture. The picture of differences marks no failures. */
export function legend({ differences, nodes }: Model): HTMLElement {
  const sign = (name: string): SVGElement =>
    svg("svg", { viewBox: "0 0 40 14", width: 40, height: 14, "aria-hidden": "true" },
      svg("g", { class: name },
        svg("path", { class: "stroke", d: "M2 7H32" }),
        svg("path", { class: "head", d: "M38 7l-7.5-4q1.6 4 0 8z" }),
      ));
  const box = (): SVGElement =>
    svg("svg", { viewBox: "0 0 40 14", width: 40, height: 14, "aria-hidden": "true" },
      svg("g", { class: "state unknown" }, svg("rect", { class: "body", x: 5, y: 1, width: 30, height: 12, rx: 4 })),
    );
  const row = (name: string, text: string): HTMLElement => html("li", {}, sign(name), html("span", {}, text));
  return html("ul", { class: "legend" },
    row("line", "outcome"),
    differences ? null : row("line failure", "outcome of failure"),
    row("line implicit", "implied, not written in the script"),
    nodes.some((node) => node.unknown) ? html("li", {}, box(), html("span", {}, "not known exactly")) : null,
  );
}
