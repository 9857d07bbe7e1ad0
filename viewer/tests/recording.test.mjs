// The events that a page keeps, and the state of the run after any of them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Recording } from "../src/recording.ts";
import { advance, emptyState } from "../src/run_state.ts";

/** A run of a loop of two states, one in a concurrence; `visits` visits of four events, 10,000 events a second. */
function* run(visits) {
  let seq = 0;
  const event = (kind, path, more) => ({ event: kind, path, seq: ++seq, t: seq / 10_000, ...more });
  yield event("start", "sm");
  yield event("enter", "sm/BOTH");
  for (let visit = 0; visit < visits; visit += 1) {
    const [path, other] = visit % 2 ? ["sm/BOTH/A", "sm/BOTH/B"] : ["sm/BOTH/B", "sm/BOTH/A"];
    yield event("enter", path);
    yield event("write", path, { key: "n", value: visit });
    yield event("exit", path, { outcome: visit % 7 ? "ok" : "bad" });
    yield event("transition", path, { outcome: visit % 7 ? "ok" : "bad", to: other });
  }
}

const folded = (events) => events.reduce(advance, emptyState());

function recorded(events, size, ...limits) {
  const recording = new Recording(...limits);
  for (let at = 0; at < events.length; at += size) recording.add(events.slice(at, at + size));
  return recording;
}

test("the state at each position is the fold of the events before it, whatever the order of the jumps", () => {
  const events = [...run(2_000)];
  const recording = recorded(events, 333);
  for (const position of [0, 1, 5_000, 4_999, 2_000, 2_001, 8_001, 3, 6_000, events.length, 1_999]) {
    assert.deepEqual(recording.at(position), folded(events.slice(0, position)), `at ${position}`);
  }
  assert.deepEqual(recording.at(Infinity), folded(events));
});

test("a minute of 10,000 events a second: the memory is limited, and no event is missing from the state", () => {
  const events = [...run(150_000)];
  assert.equal(events.length, 600_002);
  const recording = recorded(events, 500);
  assert.equal(recording.events.length + recording.dropped, events.length);
  assert.ok(recording.events.length <= 300_000);
  const last = recording.at(Infinity);
  assert.deepEqual(last, folded(events));
  assert.equal(last.visited.get("sm/BOTH/A").visits, 75_000);
  assert.deepEqual([last.visited.size, last.taken.size, last.written.size], [4, 4, 2]);
});

test("after events were dropped, positions count from the first one that is kept", () => {
  const events = [...run(5_000)];
  const recording = recorded(events, 100, 6_000, 2_000);
  const { dropped } = recording;
  assert.ok(dropped > 0);
  assert.deepEqual(recording.events, events.slice(dropped));
  for (const position of [0, 1, 2_500, 1_000, recording.events.length]) {
    assert.deepEqual(recording.at(position), folded(events.slice(0, dropped + position)), `at ${position}`);
  }
});

test("the number of events up to a time", () => {
  const recording = recorded([...run(10)], 7);
  assert.deepEqual(recording.times, [0.0001, 0.0042]);
  assert.deepEqual([0, 0.0001, 0.00205, 1].map((t) => recording.until(t)), [0, 1, 20, 42]);
});

test("a stream that begins again replaces the run", () => {
  const events = [...run(3_000)];
  const recording = recorded(events, 1_000);
  recording.at(4_321);
  recording.clear();
  assert.deepEqual(recording.at(Infinity), emptyState());
  recording.add(events.slice(0, 10));
  assert.deepEqual(recording.at(4), folded(events.slice(0, 4)));
});
