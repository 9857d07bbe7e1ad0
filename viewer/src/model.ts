// The model of a machine as the page gets it (docs/targets.md), and look-ups in it.

export type Path = string;

export type Round = "try" | "item";

export type BadgeField = "timeout" | "retry" | "for_each" | "catches";

/** What a field of the script adds to a state: an outcome, or after the outcomes `again` the next of
 * `count` tries or items. */
export interface Badge {
  field: BadgeField;
  text: string;
  outcome: string | null;
  again: string[];
  count: number | null;
}

export interface Outcome {
  name: string;
  failure: boolean;
  success: boolean;
  doc: string;
  /** The field that adds it. */
  field?: BadgeField;
}

export interface Key {
  name: string;
  key: string;
  type: string;
  doc: string;
  secret?: boolean;
}

export interface Preset {
  key: string;
  type: string;
  value: string;
}

/** What a comparison of two machines finds of a state or an edge. */
export type Change = "added" | "removed" | "changed" | "same";

/** The signs of changes, so that colours are not all that shows them. */
export const SIGNS: Record<Change, string> = { added: "+", removed: "\u2212", changed: "~", same: "" };

export interface Rule {
  outcome: string;
  when: [Path, string][];
  change?: Change;
}

export interface StateNode {
  path: Path;
  name: string;
  kind: "leaf" | "machine" | "sequence" | "concurrence" | "iterator";
  parent: Path | null;
  children: Path[];
  initial: Path | null;
  type: string | null;
  badges: Badge[];
  /** The nodes of the graph that are this state, outermost first: their paths in traces, their roles, what
   * begins with each of their starts, and their paths in old traces. */
  parts?: [shown: string, role: string, begins: Round | null, full: string][];
  /** The outcomes of one try or item after which the next one begins. */
  repeated?: { name: string; failure: boolean }[];
  doc: string;
  file: string | null;
  line: number | null;
  snippet: string;
  outcomes: Outcome[];
  inputs: Key[];
  outputs: Key[];
  findings: number[];
  tags: string[];
  userdata?: Preset[];
  join?: "all" | "any";
  default?: string | null;
  rules?: Rule[];
  items?: string;
  change?: Change;
  /** Why a state that was read from Python is not known exactly. */
  unknown?: string;
}

export interface ModelEdge {
  container: Path;
  source: Path | null;
  outcome: string;
  target: Path | { outcome: string };
  kind: string;
  implicit: boolean;
  failure: boolean;
  change?: Change;
}

export interface Finding {
  code: string;
  severity: "error" | "warning" | "info";
  message: string;
  help: string | null;
  file: string | null;
  line: number | null;
  node: Path | null;
  related: { file: string | null; line: number | null; message: string }[];
}

export interface Property {
  name: string;
  text: string;
  verdict: string;
  states: Path[];
}

/** The visits of a state in many runs; times in seconds. */
export interface StateStatistics {
  visits: number;
  unfinished: number;
  mean: number;
  longest: number;
  outcomes: Record<string, number>;
  /** The numbers of tries and items, in words. */
  rounds: string;
}

/** Statistics of many runs, by the path of a state. `never` are the transitions that no run took. */
export interface Statistics {
  states: Record<Path, StateStatistics>;
  transitions: number;
  never: { path: Path; text: string; failure: boolean }[];
}

/** The differences of two machines that are drawn as one: each with the state that it is about. */
export interface Differences {
  summary: string;
  changes: { path: Path; kind: string; text: string }[];
}

export interface Model {
  version: number;
  name: string;
  source: string;
  digest: string;
  root: Path;
  live: boolean;
  editable?: boolean;
  simulated?: boolean;
  /** Of a served model: greater than that of every earlier one. */
  revision?: number;
  nodes: StateNode[];
  edges: ModelEdge[];
  findings: Finding[];
  properties: Property[];
  statistics?: Statistics;
  differences?: Differences;
}

/** Whether a model that has arrived takes the place of the one that is shown: models may arrive in any order. */
export function isNewer(next: Pick<Model, "revision">, shown: Pick<Model, "revision">): boolean {
  return (next.revision ?? 0) > (shown.revision ?? 0);
}

/** How often a state ended with an outcome. */
export function countOf(state: StateStatistics | undefined, outcome: string): number {
  return state && Object.hasOwn(state.outcomes, outcome) ? state.outcomes[outcome]! : 0;
}

/** The frequency of an outcome of a state, as text. */
export function shareOf(state: StateStatistics, outcome: string): string {
  const ended = Object.values(state.outcomes).reduce((sum, each) => sum + each, 0);
  return `${ended ? Number(((100 * countOf(state, outcome)) / ended).toFixed(1)) : 0} %`;
}

/** A part of a written state in traces. `begins`: each of its starts is a try or an item. `added`: a timer or a
 * pause. `outer`: it starts and ends with the state. */
export interface Part {
  path: Path;
  outer: boolean;
  added: boolean;
  begins: Round | null;
  count: number | null;
}

/** The parts of written states by their paths in traces. */
export class Parts {
  private readonly known = new Map<string, Part>();

  constructor(nodes: readonly StateNode[]) {
    const old: [string, Part][] = [];
    for (const node of nodes) {
      const parts = node.parts ?? [[node.path, "state", null, node.path] as const];
      parts.forEach(([shown, role, begins, full], index) => {
        const field = begins === "try" ? "retry" : "for_each";
        const count = node.badges.find((badge) => badge.field === field)?.count ?? null;
        const added = role === "timer" || role === "pause";
        const part = { path: node.path, outer: index === 0, added, begins, count };
        this.known.set(shown, part);
        old.push([full, part]);
      });
    }
    for (const [full, part] of old) if (!this.known.has(full)) this.known.set(full, part);
  }

  of(path: string): Part | undefined {
    return this.known.get(path);
  }
}

/** A model with its look-ups. */
export interface Graph {
  model: Model;
  nodes: Map<Path, StateNode>;
  parts: Parts;
  inside: Map<Path, ModelEdge[]>;
  leaving: Map<Path, ModelEdge[]>;
}

export function indexed(model: Model): Graph {
  const graph: Graph = {
    model,
    nodes: new Map(model.nodes.map((node) => [node.path, node])),
    parts: new Parts(model.nodes),
    inside: new Map(),
    leaving: new Map(),
  };
  for (const edge of model.edges) {
    append(graph.inside, edge.container, edge);
    if (edge.source !== null) append(graph.leaving, edge.source, edge);
  }
  return graph;
}

function append<K, V>(map: Map<K, V[]>, key: K, value: V): void {
  const known = map.get(key);
  if (known) known.push(value);
  else map.set(key, [value]);
}

/** The id of an edge: equal in two models of one machine. `source` is its container at the start. */
export function edgeId(edge: ModelEdge): string {
  const target = typeof edge.target === "string" ? edge.target : `${edge.container}:${edge.target.outcome}`;
  return `${edge.source ?? edge.container}\n${edge.outcome}\n${target}`;
}

export function isContainer(node: StateNode): boolean {
  return node.kind !== "leaf";
}

/** The containers around a state, outermost first. */
export function ancestors(graph: Graph, path: Path): Path[] {
  const found: Path[] = [];
  let node = graph.nodes.get(path);
  while (node && node.parent !== null) {
    found.unshift(node.parent);
    node = graph.nodes.get(node.parent);
  }
  return found;
}

/** The state at a path, or the nearest container around where it would be. */
export function nearest(graph: Graph, path: Path): StateNode | undefined {
  let here = path;
  while (here) {
    const node = graph.nodes.get(here);
    if (node) return node;
    here = here.slice(0, Math.max(0, here.lastIndexOf("/")));
  }
  return undefined;
}

/** What a state is, in words: its kind or type. */
export function kindInWords(node: StateNode): string {
  if (node.kind === "concurrence") return node.join === "any" ? "in parallel, first to end" : "in parallel";
  if (node.kind === "iterator" && node.items) return `for each ${node.items}`;
  if (node.kind === "sequence") return "sequence";
  if (node.kind === "machine") return "state machine";
  return node.type ?? "state";
}

/**
 * The containers that are open at first: down to a depth, breadth first, while no more than `limit`
 * states show.
 */
export function firstOpen(graph: Graph, depth: number, limit: number): Set<Path> {
  const open = new Set<Path>();
  let count = 1;
  let level: Path[] = [graph.model.root];
  for (let at = 0; at < depth && level.length; at += 1) {
    const next: Path[] = [];
    for (const path of level) {
      const node = graph.nodes.get(path);
      if (!node || !isContainer(node)) continue;
      if (count + node.children.length > limit && at > 0) continue;
      open.add(path);
      count += node.children.length;
      next.push(...node.children);
    }
    level = next;
  }
  return open;
}

/** Whether the items of a container are tries of a state: in the picture of the generated states. */
export function isRetry(node: StateNode): boolean {
  return node.kind === "iterator" && node.badges.some(({ field }) => field === "retry");
}

/** What begins after an outcome of one try or item of a state. */
export function nextRound(node: StateNode, outcome: string): string {
  const badge = node.badges.find(({ again }) => again.includes(outcome));
  return badge?.field === "for_each" ? "next item" : "next try";
}
