// The content of an open container as a graph for the layout: nodes with sizes, lines with labels.

import type { Badge, Change, Graph, ModelEdge, Path, StateNode } from "./model";
import { SIGNS, edgeId, isContainer, isRetry, kindInWords, nextRound, shareOf } from "./model";
import { fitting, width } from "./text";

/** A drawn node: a state, an outcome of the container, its start, or the join of a rule. */
export interface Piece {
  id: string;
  what: "state" | "exit" | "start" | "fork" | "loop" | "join";
  label: string;
  width: number;
  height: number;
  path?: Path;
  failure?: boolean;
  success?: boolean;
  change?: Change;
}

/** A drawn line: all edges between two nodes with one look. `from` and `to` are ids of pieces. */
export interface Line {
  from: string;
  to: string;
  outcome: string;
  labels: string[];
  failure: boolean;
  implicit: boolean;
  /** Whether all its outcomes follow requests to stop: it is drawn lighter. */
  stop: boolean;
  edges: string[];
  change?: Change;
}

type Drawn = Omit<Line, "edges" | "labels" | "stop">;

export interface Content {
  path: Path;
  pieces: Piece[];
  lines: Line[];
  /** The lines that start or end outside of the container, as in the picture of a comparison: they are drawn straight. */
  far: Line[];
}

export const EXIT_HEIGHT = 22;
export const TITLE_HEIGHT = 34;
export const LINE_HEIGHT = 14;

export const exitId = (outcome: string): string => `exit ${outcome}`;
const START = "start";

/** An outcome of the container to which so many states lead is written into them instead of drawn. */
const MANY_LEAVE = 30;

/** The outcomes of a state that end the container and are written into its box: there are many. */
export function writtenExits(graph: Graph, path: Path): Map<Path, ModelEdge[]> {
  const bySource = new Map<Path, ModelEdge[]>();
  const counts = new Map<string, number>();
  const leaving = (graph.inside.get(path) ?? []).flatMap((edge) =>
    edge.source !== null && typeof edge.target !== "string" && edge.kind !== "exhausted"
      ? [{ edge, source: edge.source, exit: edge.target.outcome }]
      : [],
  );
  if (leaving.length <= MANY_LEAVE) return bySource;
  for (const { exit } of leaving) counts.set(exit, (counts.get(exit) ?? 0) + 1);
  for (const { edge, source, exit } of leaving) {
    if (counts.get(exit)! <= MANY_LEAVE) continue;
    const known = bySource.get(source) ?? [];
    bySource.set(source, [...known, edge]);
  }
  return bySource;
}

/** Edges that leave the container, as the text in the box of their state. */
export function exitsInWords(edges: readonly ModelEdge[]): string {
  const byExit = new Map<string, string[]>();
  for (const { outcome, target } of edges) {
    if (typeof target === "string") continue;
    byExit.set(target.outcome, [...(byExit.get(target.outcome) ?? []), outcome]);
  }
  const texts = [...byExit].map(([exit, outcomes]) => {
    const others = [...new Set(outcomes)].filter((each) => each !== exit);
    return others.length ? `${others.join(", ")} \u2192 ${exit}` : `\u2192 ${exit}`;
  });
  return texts.join("; ");
}

export const WRITTEN_HEIGHT = 16;

/** The size of a state as a box without content. `written` are the edges that are written into it. */
export function boxSize(
  node: StateNode,
  count: number,
  written: readonly ModelEdge[] = [],
): { width: number; height: number } {
  const name = width(fitting(node.name, "name"), "name") + (node.findings.length ? 20 : 0);
  const detail = boxDetail(node, count);
  const chevron = isContainer(node) ? 22 : 0;
  const chips = node.badges.length ? chipsOf(node).width : 0;
  const exits = written.length ? width(fitting(exitsInWords(written), "detail"), "detail") : 0;
  return {
    width: Math.max(96, name + chevron + 32, width(fitting(detail, "detail"), "detail") + 32, exits + 24, chips + 20),
    height: (detail ? 48 : 36) + (chips ? CHIP_HEIGHT + 5 : 0) + (written.length ? WRITTEN_HEIGHT : 0),
  };
}

export const CHIP_HEIGHT = 16;
const CHIP_GAP = 4;

export interface Chip {
  badge: Badge;
  text: string;
  x: number;
  width: number;
}

/** The badges of a state in a row, and the width of the row. */
export function chipsOf(node: StateNode): { chips: Chip[]; width: number } {
  let at = 0;
  const chips = node.badges.map((badge) => {
    const text = fitting(badge.text, "chip", 170);
    const chip = { badge, text, x: at, width: width(text, "chip") + 12 };
    at += chip.width + CHIP_GAP;
    return chip;
  });
  return { chips, width: Math.max(0, at - CHIP_GAP) };
}

/** The second line of a box. */
export function boxDetail(node: StateNode, count: number): string {
  if (!isContainer(node)) return node.type ?? "";
  return `${kindInWords(node)}, ${count} ${count === 1 ? "state" : "states"}`;
}

/** The content of a container. `sizes` are the sizes of its children, `open` those that are open. */
export function contentOf(
  graph: Graph,
  path: Path,
  open: ReadonlySet<Path>,
  sizes: ReadonlyMap<Path, { width: number; height: number }>,
): Content {
  const container = graph.nodes.get(path)!;
  const pieces: Piece[] = [startPiece(container)];
  for (const child of container.children) {
    const node = graph.nodes.get(child);
    if (node) pieces.push({ id: child, what: "state", label: node.name, path: child, ...sizes.get(child)! });
  }
  for (const outcome of exitsOf(container)) {
    const label = fitting(outcome.label, "exit");
    pieces.push({
      id: exitId(outcome.name),
      what: "exit",
      label,
      width: width(label, "exit") + 22,
      height: EXIT_HEIGHT,
      failure: outcome.failure,
      success: outcome.success,
    });
  }
  const lines = new Map<string, Line>();
  const add = (line: Drawn, edge: string, label: string): void => {
    // The lines of an open state start at its outcomes, so that each outcome has lines of its own.
    const own = open.has(line.from) ? line.outcome : "";
    const key = JSON.stringify([line.from, line.to, line.failure, line.implicit, own, line.change]);
    const known = lines.get(key) ?? { ...line, stop: true, labels: [], edges: [] };
    lines.set(key, known);
    known.stop &&= line.outcome === "preempted";
    if (edge && !known.edges.includes(edge)) known.edges.push(edge);
    if (label && !open.has(line.from) && !known.labels.includes(label)) known.labels.push(label);
  };
  const joined = joins(container, pieces, add);
  const written = new Set([...writtenExits(graph, path)].flatMap(([source, edges]) => (open.has(source) ? [] : edges)));
  for (const edge of graph.inside.get(path) ?? []) {
    if (written.has(edge)) continue;
    for (const line of linesOf(container, edge, joined)) {
      add(line, edgeId(edge), withFigures(graph, edge, line, labelOf(container, edge, line)));
    }
  }
  const ids = new Set(pieces.map(({ id }) => id));
  const isInside = ({ from, to }: Line): boolean => ids.has(from) && ids.has(to);
  const all = [...lines.values()];
  return { path, pieces, lines: all.filter(isInside), far: all.filter((line) => !isInside(line)) };
}

interface Exit {
  name: string;
  label: string;
  failure: boolean;
  success: boolean;
}

/** The ends of an open container: its outcomes, and those after which the next try or item begins. */
function exitsOf(container: StateNode): Exit[] {
  const repeated = container.repeated ?? [];
  const label = (name: string): string =>
    repeated.some((each) => each.name === name) ? `${name} \u2192 ${nextRound(container, name)}` : name;
  const own = container.outcomes.map((each) => ({ ...each, label: label(each.name) }));
  const names = new Set(own.map(({ name }) => name));
  const others = repeated.filter(({ name }) => !names.has(name));
  return [...own, ...others.map((each) => ({ ...each, success: false, label: label(each.name) }))];
}

/** A label with the sign of the change of its line, or the frequency of its outcome, where there is one. */
function withFigures(graph: Graph, edge: ModelEdge, line: Drawn, label: string): string {
  if (line.change) return `${SIGNS[line.change]} ${label}`.trim();
  const state = edge.source === null ? undefined : graph.model.statistics?.states[edge.source];
  if (!state || !edge.outcome) return label;
  return `${label} ${shareOf(state, edge.outcome)}`.trim();
}

function startPiece(container: StateNode): Piece {
  if (container.kind === "concurrence") {
    const size = Math.min(260, 40 * Math.max(1, container.children.length));
    return { id: START, what: "fork", label: "all start together", width: size, height: 5 };
  }
  if (container.kind === "iterator") {
    const label = isRetry(container) ? "next try" : "next item";
    return { id: START, what: "loop", label, width: width(label, "label") + 24, height: 24 };
  }
  return { id: START, what: "start", label: "start", width: 12, height: 12 };
}

/** The bar of a rule, or the outcome to which a rule with one condition leads. */
interface Join {
  id: string;
  change?: Change;
}

/** The joins of a concurrence: a bar for each rule with several conditions. */
function joins(
  container: StateNode,
  pieces: Piece[],
  add: (line: Drawn, edge: string, label: string) => void,
): Map<string, Join[]> {
  const joined = new Map<string, Join[]>();
  (container.rules ?? []).forEach((rule, index) => {
    const exit = pieces.find((each) => each.id === exitId(rule.outcome));
    if (rule.when.length < 2 || !exit) return;
    const id = `join ${index}`;
    const { change } = rule;
    const { failure = false, success } = exit;
    pieces.push({ id, what: "join", label: `all: ${rule.outcome}`, width: 64, height: 5, failure, success, change });
    for (const [child, outcome] of rule.when) {
      const key = JSON.stringify([child, outcome, rule.outcome]);
      joined.set(key, [...(joined.get(key) ?? []), { id, change }]);
    }
    add({ from: id, to: exit.id, outcome: rule.outcome, failure, implicit: false, change }, "", "");
  });
  return joined;
}

/** The lines that show an edge. */
function linesOf(
  container: StateNode,
  edge: ModelEdge,
  joined: Map<string, Join[]>,
): Drawn[] {
  const { outcome, failure, implicit } = edge;
  const look = { outcome, failure, implicit, change: edge.change };
  const from = edge.source ?? START;
  const to = typeof edge.target === "string" ? edge.target : exitId(edge.target.outcome);
  if (edge.kind === "loop") return [{ ...look, from, to: START }];
  if (edge.kind === "exhausted") return [{ ...look, outcome: "", failure: false, from: START, to }];
  if (edge.kind === "rule" && typeof edge.target !== "string") {
    const key = JSON.stringify([edge.source, edge.outcome, edge.target.outcome]);
    const { outcome: result } = edge.target;
    const alone = (container.rules ?? []).filter(
      (rule) =>
        rule.outcome === result &&
        rule.when.length < 2 &&
        rule.when.every(([child, name]) => child === edge.source && name === edge.outcome),
    );
    const ends: Join[] = [...(joined.get(key) ?? []), ...alone.map(({ change }) => ({ id: to, change }))];
    return ends.map(({ id, change = edge.change }) => ({ ...look, from, to: id, change }));
  }
  if (edge.kind === "default") return [{ ...look, failure: false, from, to }];
  return [{ ...look, from, to }];
}

/** The label of an edge on its line; empty where the end of the line has the same name. */
function labelOf(container: StateNode, edge: ModelEdge, line: { from: string; to: string }): string {
  if (edge.kind === "default") return "otherwise";
  if (edge.kind === "caught") return "exception";
  if (edge.kind === "exhausted") return edge.source === null ? "" : isRetry(container) ? "no tries left" : "no more items";
  return line.to === exitId(edge.outcome) ? "" : edge.outcome;
}
