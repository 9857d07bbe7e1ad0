// A run, from the events of its trace (docs/semantics.md, Traces). No part of this file touches the page.

import type { Round } from "./model";

/** An event of a trace of written states (written_events.ts). */
export interface TraceEvent {
  event: string;
  path: string;
  /** The number of a try or an item, and the number of all of them. */
  number?: number;
  of?: number;
  t?: number;
  seq?: number;
  outcome?: string;
  to?: string;
  key?: string;
  value?: unknown;
  message?: string;
  fault?: string;
  forced?: boolean;
  src?: string;
}

export interface Visit {
  /** Time of the start, in seconds. */
  since: number;
}

export interface Written {
  path: string;
  key: string;
  value: unknown;
  t: number;
  /** The number of writes of the run up to this one. */
  order: number;
}

/** What is known of each state that ran. */
export interface Visited {
  visits: number;
  /** Seconds in it, of all visits that have ended. */
  seconds: number;
  outcomes: Map<string, number>;
  lastOutcome: string | null;
}

export interface RunState {
  /** The states that run now, containers too, with the time of their start. */
  active: Map<string, number>;
  visited: Map<string, Visited>;
  /** The last try or item of each state that runs: its number, and that of all. */
  rounds: Map<string, { what: Round; number: number; of: number | undefined }[]>;
  /** How often each transition was taken, by `transitionKey`. */
  taken: Map<string, number>;
  /** The last write of each key by each state, by path and key. */
  written: Map<string, Written>;
  /** The path and the message of the last error. */
  error: { path: string; message: string } | null;
  root: string | null;
  outcome: string | null;
  ended: boolean;
  /** The time of the last event, in seconds. */
  t: number;
  /** The numbers of events and of writes of this run so far. */
  count: number;
  writes: number;
}

export function emptyState(): RunState {
  return {
    active: new Map(),
    visited: new Map(),
    rounds: new Map(),
    taken: new Map(),
    written: new Map(),
    error: null,
    root: null,
    outcome: null,
    ended: false,
    t: 0,
    count: 0,
    writes: 0,
  };
}

export function copyState(state: RunState): RunState {
  const visited = new Map<string, Visited>();
  for (const [path, each] of state.visited) visited.set(path, { ...each, outcomes: new Map(each.outcomes) });
  return {
    ...state,
    active: new Map(state.active),
    visited,
    rounds: new Map(state.rounds),
    taken: new Map(state.taken),
    written: new Map(state.written),
  };
}

export function transitionKey(path: string, outcome: string, to: string): string {
  return `${path}\n${outcome}\n${to}`;
}

/** The state after one more event. The given state is changed, and returned; a `start` begins anew. */
export function advance(state: RunState, event: TraceEvent): RunState {
  if (event.event === "start") {
    Object.assign(state, emptyState(), { root: event.path });
  }
  state.count += 1;
  state.t = event.t ?? state.t;
  const { path } = event;
  switch (event.event) {
    case "start":
    case "enter":
      enter(state, path);
      break;
    case "try":
    case "item": {
      const others = (state.rounds.get(path) ?? []).filter(({ what }) => what === "item" && event.event === "try");
      state.rounds.set(path, [...others, { what: event.event, number: event.number ?? 1, of: event.of }]);
      break;
    }
    case "exit":
    case "finish":
      leave(state, path, event.outcome ?? null);
      if (event.event === "finish") end(state, event.outcome ?? null);
      break;
    case "transition":
      count(state.taken, transitionKey(path, event.outcome ?? "", event.to ?? ""));
      break;
    case "write": {
      state.writes += 1;
      const key = event.key ?? "";
      state.written.set(`${path}\n${key}`, { path, key, value: event.value, t: state.t, order: state.writes });
      break;
    }
    case "error":
      state.error = { path, message: event.message ?? "" };
      break;
  }
  return state;
}

function enter(state: RunState, path: string): void {
  state.active.set(path, state.t);
  const known = state.visited.get(path);
  if (known) known.visits += 1;
  else state.visited.set(path, { visits: 1, seconds: 0, outcomes: new Map(), lastOutcome: null });
}

/** A state ends; the outcome is null where the statuses of a ROS node do not show it. */
function leave(state: RunState, path: string, outcome: string | null): void {
  const since = state.active.get(path);
  state.active.delete(path);
  state.rounds.delete(path);
  const visited = state.visited.get(path);
  if (!visited) return;
  if (since !== undefined) visited.seconds += state.t - since;
  if (outcome !== null) count(visited.outcomes, outcome);
  visited.lastOutcome = outcome;
}

function end(state: RunState, outcome: string | null): void {
  state.ended = true;
  state.outcome = outcome;
  state.active.clear();
  state.rounds.clear();
}

function count(counts: Map<string, number>, key: string): void {
  counts.set(key, (counts.get(key) ?? 0) + 1);
}

/** The tries and items that run, in words: `item 2 of 5, try 1 of 3`. */
export function roundInWords(state: RunState, path: string): string {
  const rounds = state.rounds.get(path) ?? [];
  return rounds.map(({ what, number, of }) => `${what} ${number}${of === undefined ? "" : ` of ${of}`}`).join(", ");
}

/** The states that run now and have no state that runs inside, in the order of their starts. */
export function activeLeaves(state: RunState): string[] {
  const containers = new Set<string>();
  for (const path of state.active.keys()) {
    for (let at = path.lastIndexOf("/"); at > 0; at = path.lastIndexOf("/", at - 1)) containers.add(path.slice(0, at));
  }
  return [...state.active.keys()].filter((path) => !containers.has(path));
}
