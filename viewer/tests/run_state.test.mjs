// The fold of trace events into the state of a run.
import assert from "node:assert/strict";
import { test } from "node:test";
import { activeLeaves, advance, copyState, emptyState, transitionKey } from "../src/run_state.ts";

const folded = (events, state = emptyState()) => events.reduce(advance, state);
const start = (path, t = 0) => ({ event: "start", path, t });
const enter = (path, t) => ({ event: "enter", path, t });
const exit = (path, outcome, t) => ({ event: "exit", path, outcome, t });
const transition = (path, outcome, to, t) => ({ event: "transition", path, outcome, to, t });
const write = (path, key, value, t) => ({ event: "write", path, key, value, t });

test("nested containers: the innermost state is the active leaf", () => {
  const state = folded([start("sm"), enter("sm/OUTER", 1), enter("sm/OUTER/INNER", 2), enter("sm/OUTER/INNER/LEAF", 3)]);
  assert.deepEqual([...state.active], [["sm", 0], ["sm/OUTER", 1], ["sm/OUTER/INNER", 2], ["sm/OUTER/INNER/LEAF", 3]]);
  assert.deepEqual(activeLeaves(state), ["sm/OUTER/INNER/LEAF"]);
  folded([exit("sm/OUTER/INNER/LEAF", "done", 4)], state);
  assert.deepEqual(activeLeaves(state), ["sm/OUTER/INNER"]);
  folded([exit("sm/OUTER/INNER", "done", 5), transition("sm/OUTER/INNER", "done", "sm/OUTER:done", 5)], state);
  assert.equal(state.visited.get("sm/OUTER/INNER").seconds, 3);
  assert.equal(state.taken.get(transitionKey("sm/OUTER/INNER", "done", "sm/OUTER:done")), 1);
});

test("a state whose name is the beginning of another name is no container of it", () => {
  const state = folded([start("sm"), enter("sm/PICK", 1), enter("sm/PICK_UP", 1)]);
  assert.deepEqual(activeLeaves(state), ["sm/PICK", "sm/PICK_UP"]);
});

test("a concurrence has several active leaves, in the order of their starts", () => {
  const state = folded([
    start("sm"), enter("sm/BOTH", 1), enter("sm/BOTH/B", 1), enter("sm/BOTH/A", 2), enter("sm/BOTH/A/X", 3),
  ]);
  assert.deepEqual(activeLeaves(state), ["sm/BOTH/B", "sm/BOTH/A/X"]);
  folded([exit("sm/BOTH/B", "ok", 4)], state);
  assert.deepEqual(activeLeaves(state), ["sm/BOTH/A/X"]);
  folded([exit("sm/BOTH/A/X", "ok", 5), exit("sm/BOTH/A", "ok", 5), exit("sm/BOTH", "all", 5)], state);
  assert.deepEqual(activeLeaves(state), ["sm"]);
  assert.deepEqual([...state.visited.get("sm/BOTH").outcomes], [["all", 1]]);
});

test("visits, times and outcomes of a state add up", () => {
  const visit = (t, outcome) => [enter("sm/A", t), exit("sm/A", outcome, t + 2)];
  const state = folded([start("sm"), ...visit(1, "ok"), ...visit(5, "bad"), ...visit(9, "ok"), enter("sm/A", 20)]);
  const known = state.visited.get("sm/A");
  assert.deepEqual(
    [known.visits, known.seconds, known.lastOutcome, [...known.outcomes]],
    [4, 6, "ok", [["ok", 2], ["bad", 1]]],
  );
});

test("a key has the last value that each state wrote", () => {
  const state = folded([
    start("sm"), write("sm/A", "n", 1, 1), write("sm/B", "n", 2, 2), write("sm/A", "n", { x: [3] }, 3),
  ]);
  const rows = [...state.written.values()].map(({ path, value, order }) => [path, value, order]);
  assert.deepEqual(rows, [["sm/A", { x: [3] }, 3], ["sm/B", 2, 2]]);
});

test("an end leaves no state active, also those whose exits are missing", () => {
  const state = folded([
    start("sm"), enter("sm/A", 1), { event: "error", path: "sm/A", message: "no plan", t: 2 },
    { event: "finish", path: "sm", outcome: "failed", t: 3 },
  ]);
  assert.deepEqual([activeLeaves(state), state.ended, state.outcome], [[], true, "failed"]);
  assert.deepEqual(state.error, { path: "sm/A", message: "no plan" });
});

test("a start begins anew", () => {
  const state = folded([
    start("sm"), enter("sm/A", 1), write("sm/A", "n", 1, 1), { event: "finish", path: "sm", outcome: "done", t: 2 },
    start("other", 0),
  ]);
  const fresh = folded([start("other", 0)]);
  assert.deepEqual(state, fresh);
});

test("a late reader: events from the middle of a run", () => {
  const state = folded([
    exit("sm/BOTH/A", "ok", 7), // its start is not kept any more
    transition("sm/BOTH/A", "ok", "sm/BOTH:all", 7),
    enter("sm/C", 8),
    { event: "a kind of a later version", path: "sm/C", t: 9 },
  ]);
  assert.deepEqual(activeLeaves(state), ["sm/C"]);
  assert.equal(state.visited.has("sm/BOTH/A"), false, "how often it was visited is not known");
  assert.equal(state.root, null);
  assert.equal(state.count, 4);
  assert.equal(state.t, 9);
});

test("an end without an outcome, from the status of a node, counts for none", () => {
  const state = folded([start("sm"), enter("sm/A", 1), { event: "exit", path: "sm/A", t: 3 }]);
  const known = state.visited.get("sm/A");
  assert.deepEqual([known.seconds, known.outcomes.size, known.lastOutcome], [2, 0, null]);
  assert.deepEqual(activeLeaves(state), ["sm"]);
});

test("a copy does not change with the state", () => {
  const state = folded([start("sm"), enter("sm/A", 1), exit("sm/A", "ok", 2), write("sm/A", "n", 1, 2)]);
  const copy = copyState(state);
  const before = structuredClone(copy);
  folded([enter("sm/A", 3), exit("sm/A", "bad", 4), write("sm/A", "n", 2, 4), transition("sm/A", "bad", "sm/B", 4)], state);
  assert.deepEqual(copy, before);
});
