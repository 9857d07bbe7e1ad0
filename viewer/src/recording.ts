// The events of a run as far as the page keeps them, and the state of the run after any of them.

import type { RunState, TraceEvent } from "./run_state";
import { advance, copyState, emptyState } from "./run_state";

/** The most events that are kept; the oldest are dropped in parts. */
const MOST = 300_000;
const PART = 100_000;

/** The number of events between two states that are kept for jumps. */
const APART = 2_000;

export class Recording {
  readonly events: TraceEvent[] = [];
  /** The number of events that are no longer kept, or never arrived. */
  dropped = 0;
  private first = emptyState();
  private last = emptyState();
  private kept: RunState[] = [];
  private cursor = { position: 0, state: emptyState() };

  constructor(
    private readonly most = MOST,
    private readonly part = PART,
  ) {}

  add(events: readonly TraceEvent[]): void {
    for (const event of events) {
      advance(this.last, event);
      this.events.push(event);
      if (this.events.length % APART === 0) this.kept.push(copyState(this.last));
    }
    if (this.events.length > this.most) this.forget();
  }

  clear(): void {
    this.events.length = 0;
    this.dropped = 0;
    this.kept = [];
    this.first = emptyState();
    this.last = emptyState();
    this.cursor = { position: 0, state: emptyState() };
  }

  /** The state after the first `position` events. It must not be changed. */
  at(position: number): RunState {
    if (position >= this.events.length) return this.last;
    const before = Math.floor(position / APART);
    const { cursor } = this;
    if (cursor.position > position || cursor.position < before * APART) {
      const start = before ? this.kept[before - 1]! : this.first;
      this.cursor = { position: before * APART, state: copyState(start) };
    }
    while (this.cursor.position < position) {
      advance(this.cursor.state, this.events[this.cursor.position]!);
      this.cursor.position += 1;
    }
    return this.cursor.state;
  }

  /** The time of the first event that is kept, and of the last one, in seconds. */
  get times(): [number, number] {
    return [this.events[0]?.t ?? 0, this.events[this.events.length - 1]?.t ?? 0];
  }

  /** The number of events up to a time. Two runs in one trace start at zero: the first one counts. */
  until(t: number): number {
    let low = 0;
    let high = this.events.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.events[middle]!.t ?? 0) <= t) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  private forget(): void {
    const part = Math.floor(this.part / APART) * APART || this.part;
    for (const event of this.events.slice(0, part)) advance(this.first, event);
    this.events.splice(0, part);
    this.dropped += part;
    this.kept = [];
    const state = copyState(this.first);
    this.events.forEach((event, index) => {
      advance(state, event);
      if ((index + 1) % APART === 0) this.kept.push(copyState(state));
    });
    this.cursor = { position: 0, state: copyState(this.first) };
  }
}
