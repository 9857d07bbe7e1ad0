// The events of a trace as events of the states that are written: a state with a time limit, retries or a
// loop starts and ends once, and has tries and items in between.

import type { Part, Parts } from "./model";
import type { TraceEvent } from "./run_state";

/** One visit of a state: the tries and items that have begun, and the path in the trace of the part that started
 * first. */
interface Visit {
  first: string;
  try: number;
  item: number;
}

export class WrittenEvents {
  private readonly visits = new Map<string, Visit>();

  /** `parts` are those of the machine that is shown now. */
  constructor(private readonly parts: () => Parts) {}

  clear(): void {
    this.visits.clear();
  }

  all(events: readonly TraceEvent[]): TraceEvent[] {
    return events.map((event) => this.one(event)).filter((event) => event !== null);
  }

  /** The event of the written state, or null for one that only a part of the state has. */
  private one(event: TraceEvent): TraceEvent | null {
    const part = this.parts().of(event.path);
    const to = event.to === undefined ? {} : { to: this.place(event.to) };
    if (!part) return { ...event, ...to };
    if (part.added) return null;
    const { path } = part;
    switch (event.event) {
      case "enter":
        return this.enter(event, part);
      case "exit":
        return this.exit(event, part);
      case "transition":
        return this.visits.has(path) ? null : { ...event, path, ...to };
      case "preempt":
        return part.outer ? { ...event, path } : null;
      default:
        return { ...event, path };
    }
  }

  private enter(event: TraceEvent, part: Part): TraceEvent | null {
    const { path, begins } = part;
    const known = this.visits.get(path);
    if (part.outer || !known) {
      this.visits.set(path, { first: event.path, try: 0, item: 0 });
      return { ...event, path };
    }
    if (!begins) return null;
    known[begins] += 1;
    if (begins === "item") known.try = 0;
    return { ...event, event: begins, path, number: known[begins], of: part.count ?? undefined };
  }

  private exit(event: TraceEvent, part: Part): TraceEvent | null {
    const { path, begins } = part;
    const known = this.visits.get(path);
    if (part.outer || known?.first === event.path) {
      this.visits.delete(path);
      return { ...event, path };
    }
    return begins && known ? { ...event, event: `${begins} ended`, path, number: known[begins] } : null;
  }

  /** The target of a transition: a state, or an outcome of a container behind a colon. */
  private place(to: string): string {
    const state = this.parts().of(to);
    if (state) return state.path;
    const colon = to.lastIndexOf(":");
    const container = colon < 0 ? undefined : this.parts().of(to.slice(0, colon));
    return container ? container.path + to.slice(colon) : to;
  }
}
