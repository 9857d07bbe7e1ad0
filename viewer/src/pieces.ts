// The content of an open container as a graph for the layout: nodes with sizes, lines with labels.

import type { Graph, ModelEdge, Path, StateNode } from "./model";
import { edgeId, isContainer, kindInWords } from "./model";
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
}

type Drawn = Omit<Line, "edges" | "labels" | "stop">;

export interface Content {
  path: Path;
  pieces: Piece[];
  lines: Line[];
}

export const EXIT_HEIGHT = 22;
export const TITLE_HEIGHT = 34;
export const LINE_HEIGHT = 14;

export const exitId = (outcome: string): string => `exit ${outcome}`;
const START = "start";

/** The size of a state as a box without content. */
export function boxSize(node: StateNode, count: number): { width: number; height: number } {
  const name = width(fitting(node.name, "name"), "name") + (node.findings.length ? 20 : 0);
  const detail = boxDetail(node, count);
  const chevron = isContainer(node) ? 22 : 0;
  return {
    width: Math.max(96, name + chevron + 32, width(fitting(detail, "detail"), "detail") + 32),
    height: detail ? 48 : 36,
  };
}

/** The second line of a box. */
export function boxDetail(node: StateNode, count: number): string {
  if (!isContainer(node)) return node.type ?? "";
  const words = kindInWords(node);
  return node.role ? words : `${words}, ${count} ${count === 1 ? "state" : "states"}`;
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
  for (const outcome of container.outcomes) {
    const label = fitting(outcome.name, "exit");
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
    const key = JSON.stringify([line.from, line.to, line.failure, line.implicit, own]);
    const known = lines.get(key) ?? { ...line, stop: true, labels: [], edges: [] };
    lines.set(key, known);
    known.stop &&= line.outcome === "preempted";
    if (edge && !known.edges.includes(edge)) known.edges.push(edge);
    if (label && !open.has(line.from) && !known.labels.includes(label)) known.labels.push(label);
  };
  const joined = joins(container, pieces, add);
  for (const edge of graph.inside.get(path) ?? []) {
    for (const line of linesOf(container, edge, joined)) {
      add(line, edgeId(edge), labelOf(container, edge, line));
    }
  }
  return { path, pieces, lines: [...lines.values()] };
}

function startPiece(container: StateNode): Piece {
  if (container.kind === "concurrence") {
    const size = Math.min(260, 40 * Math.max(1, container.children.length));
    return { id: START, what: "fork", label: "all start together", width: size, height: 5 };
  }
  if (container.kind === "iterator") {
    const label = container.role ? "next try" : "next item";
    return { id: START, what: "loop", label, width: width(label, "label") + 24, height: 24 };
  }
  return { id: START, what: "start", label: "start", width: 12, height: 12 };
}

/** The joins of a concurrence: a bar for each rule with several conditions. */
function joins(
  container: StateNode,
  pieces: Piece[],
  add: (line: Drawn, edge: string, label: string) => void,
): Map<string, string[]> {
  const joined = new Map<string, string[]>();
  (container.rules ?? []).forEach((rule, index) => {
    const exit = pieces.find((each) => each.id === exitId(rule.outcome));
    if (rule.when.length < 2 || !exit) return;
    const id = `join ${index}`;
    const { failure = false, success } = exit;
    pieces.push({ id, what: "join", label: `all: ${rule.outcome}`, width: 64, height: 5, failure, success });
    for (const [child, outcome] of rule.when) {
      const key = JSON.stringify([child, outcome, rule.outcome]);
      joined.set(key, [...(joined.get(key) ?? []), id]);
    }
    add({ from: id, to: exit.id, outcome: rule.outcome, failure, implicit: false }, "", "");
  });
  return joined;
}

/** The lines that show an edge. */
function linesOf(
  container: StateNode,
  edge: ModelEdge,
  joined: Map<string, string[]>,
): Drawn[] {
  const { outcome, failure, implicit } = edge;
  const look = { outcome, failure, implicit };
  const from = edge.source ?? START;
  const to = typeof edge.target === "string" ? edge.target : exitId(edge.target.outcome);
  if (edge.kind === "loop") return [{ ...look, from, to: START }];
  if (edge.kind === "exhausted") return [{ ...look, outcome: "", failure: false, from: START, to }];
  if (edge.kind === "rule" && typeof edge.target !== "string") {
    const key = JSON.stringify([edge.source, edge.outcome, edge.target.outcome]);
    const bars = joined.get(key) ?? [];
    const alone = (container.rules ?? []).some(
      (rule) =>
        rule.outcome === (edge.target as { outcome: string }).outcome &&
        rule.when.length < 2 &&
        rule.when.every(([child, name]) => child === edge.source && name === edge.outcome),
    );
    return [
      ...bars.map((bar) => ({ ...look, from, to: bar })),
      ...(alone ? [{ ...look, from, to }] : []),
    ];
  }
  if (edge.kind === "default") return [{ ...look, failure: false, from, to }];
  return [{ ...look, from, to }];
}

/** The label of an edge on its line; empty where the end of the line has the same name. */
function labelOf(container: StateNode, edge: ModelEdge, line: { from: string; to: string }): string {
  if (edge.kind === "default") return "otherwise";
  if (edge.kind === "caught") return "exception";
  if (edge.kind === "exhausted") return edge.source === null ? "" : container.role ? "no tries left" : "no more items";
  return line.to === exitId(edge.outcome) ? "" : edge.outcome;
}
