// What a run marks in the picture, and its events in words.

import type { Highlight } from "./draw";
import type { ControlStatus } from "./connection";
import type { Graph, Path, StateNode } from "./model";
import { edgeId, isContainer } from "./model";
import type { RunState, TraceEvent, Written } from "./run_state";
import { activeLeaves, roundInWords } from "./run_state";

/** The state at a path. */
export function nodeAt(graph: Graph, path: string): StateNode | undefined {
  return graph.nodes.get(path);
}

export function highlightOf(graph: Graph, state: RunState, control: Pick<ControlStatus, "at" | "breakpoints"> | null): Highlight {
  const visits = new Map<Path, number>();
  for (const [path, each] of state.visited) {
    const node = nodeAt(graph, path);
    if (node && node.path !== graph.model.root) visits.set(node.path, each.visits);
  }
  return {
    active: known(graph, activeLeaves(state)).filter((path) => !isContainer(graph.nodes.get(path)!)),
    taken: takenEdges(graph, state),
    visits,
    rounds: new Map([...state.rounds.keys()].map((path) => [path, roundInWords(state, path)])),
    waiting: known(graph, control?.at.map((each) => each.path) ?? []),
    breakpoints: known(graph, control?.breakpoints.map((each) => each.path) ?? []),
  };
}

/** What shows that a run is one of another machine, or of another version of it; else empty. */
export function foreignPlace(graph: Graph, state: RunState): string {
  const place = [...state.visited.keys()].find((path) => !nodeAt(graph, path));
  if (place === undefined) return "";
  const [machine = ""] = place.split("/");
  const { root } = graph.model;
  if (machine !== root) return `This is the trace of the machine ${machine}, not of ${root}.`;
  return `The script has no state ${place}: it is not the version that ran.`;
}

function known(graph: Graph, paths: string[]): Path[] {
  return paths.map((path) => nodeAt(graph, path)?.path).filter((path) => path !== undefined);
}

/** The ids of the edges that were taken: those of transitions, those from the start of a container, and
 * in concurrences those from the branches to the outcome that they led to. */
function takenEdges(graph: Graph, state: RunState): Set<string> {
  const found = new Set<string>();
  for (const key of state.taken.keys()) {
    const [path = "", outcome = "", to = ""] = key.split("\n");
    if (nodeAt(graph, path)) found.add(`${path}\n${outcome}\n${to}`);
  }
  for (const [path, visited] of state.visited) {
    const node = nodeAt(graph, path);
    if (!node || !isContainer(node)) continue;
    for (const edge of graph.inside.get(node.path) ?? []) {
      const end = typeof edge.target === "string" ? edge.target : null;
      if (edge.source === null) {
        if (end !== null && state.visited.has(end)) found.add(edgeId(edge));
      } else if (node.kind === "concurrence" && end === null) {
        const branch = state.visited.get(edge.source);
        const outcome = (edge.target as { outcome: string }).outcome;
        if (branch?.lastOutcome === edge.outcome && visited.lastOutcome === outcome) found.add(edgeId(edge));
      }
    }
  }
  return found;
}

/** A key in the userdata of a container, with its last value. `scope` is the container. */
export interface KeyValue {
  scope: Path;
  key: string;
  type: string;
  secret: boolean;
  written: Written;
}

/** The keys of the run with their last values, newest first. A key that a container shares with the one
 * around it is listed there. */
export function keyValues(graph: Graph, state: RunState): KeyValue[] {
  const found = new Map<string, KeyValue>();
  for (const written of state.written.values()) {
    const node = nodeAt(graph, written.path);
    if (!node) continue;
    const place = placeOf(graph, node, written.key);
    const id = `${place.scope}\n${place.key}`;
    const before = found.get(id);
    if (!before || before.written.order < written.order) found.set(id, { ...place, written });
  }
  return [...found.values()].sort((a, b) => b.written.order - a.written.order);
}

/** The container whose userdata holds a key of a state, and its name there. */
export function placeOf(graph: Graph, node: StateNode, key: string): Omit<KeyValue, "written"> {
  let here = node;
  let name = key;
  let type = "";
  let secret = false;
  for (;;) {
    const declared = [...here.outputs, ...here.inputs].find((each) => each.name === name);
    if (declared) {
      type = declared.type;
      secret ||= declared.secret ?? false;
    }
    const around = here.parent === null ? undefined : graph.nodes.get(here.parent);
    if (!around || (!declared && (here !== node || isContainer(here)))) return { scope: here.path, key: name, type, secret };
    name = declared?.key ?? name;
    here = around;
  }
}

const SHORT = 90;

/** A value as one line of limited length, its numbers with six digits. */
export function inline(value: unknown, most = SHORT): string {
  const text = JSON.stringify(value, (_, each: unknown) =>
    typeof each === "number" && !Number.isInteger(each) ? Number(each.toPrecision(6)) : each) ?? "";
  return text.length > most ? `${text.slice(0, most)}…` : text;
}

/** An event in words; null for one that another event says as well. */
export function inWords(graph: Graph, event: TraceEvent): { text: string; tone: "" | "good" | "bad" } | null {
  const node = nodeAt(graph, event.path);
  const name = node?.name ?? event.path;
  const outcomes = [...(node?.outcomes ?? []), ...(node?.repeated ?? [])];
  const failure = outcomes.find((each) => each.name === event.outcome)?.failure ?? false;
  const tone = failure ? "bad" : "good";
  switch (event.event) {
    case "start":
      return { text: `${name} starts`, tone: "" };
    case "enter":
      return { text: `${name} starts`, tone: "" };
    case "exit": {
      const kind = node?.parent ? graph.nodes.get(node.parent)?.kind : undefined;
      if (!event.forced && (kind === "machine" || kind === "sequence")) return null;
      return { text: `${name} ends${withOutcome(event)}${event.forced ? " (forced)" : ""}`, tone };
    }
    case "transition": {
      const to = event.to ?? "";
      const target = nodeAt(graph, to)?.name ?? `end of ${to.replace(":", " with ").split("/").pop()}`;
      return { text: `${name}: ${event.outcome} → ${target}`, tone };
    }
    case "write":
      return { text: `${name} writes ${event.key} = ${inline(event.value)}`, tone: "" };
    case "try":
    case "item":
      return { text: `${name}: ${event.event} ${event.number}${event.of === undefined ? "" : ` of ${event.of}`}`, tone: "" };
    case "try ended":
    case "item ended": {
      const [what] = event.event.split(" ");
      return { text: `${name}: ${what} ${event.number} ends${withOutcome(event)}`, tone };
    }
    case "preempt":
      return { text: `${name} is requested to stop`, tone: "" };
    case "error":
      return { text: `${name}: error: ${event.message}`, tone: "bad" };
    case "fault":
      return { text: `injected fault: ${event.fault}`, tone: "bad" };
    case "finish":
      return { text: `${name} ends${withOutcome(event)}`, tone };
    default:
      return { text: `${name}: ${event.event}`, tone: "" };
  }
}

function withOutcome({ outcome }: TraceEvent): string {
  return outcome === undefined ? "" : ` with ${outcome}`;
}

/** A time in seconds, with as many digits as matter. */
export function seconds(t: number): string {
  if (t < 1) return `${Math.round(t * 1000)} ms`;
  if (t < 100) return `${t.toFixed(1)} s`;
  const minutes = Math.floor(t / 60);
  return minutes < 60 ? `${minutes} min ${Math.floor(t % 60)} s` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}
