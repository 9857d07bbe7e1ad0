// The events of a trace as those of the states that are written.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Parts } from "../src/model.ts";
import { advance, emptyState, roundInWords } from "../src/run_state.ts";
import { WrittenEvents } from "../src/written_events.ts";

const DRIVE = {
  path: "sm/DRIVE",
  badges: [
    { field: "timeout", text: "limit 5 s", outcome: "timeout", again: [], count: null },
    { field: "retry", text: "3 tries", outcome: "exhausted", again: ["aborted"], count: 3 },
  ],
  parts: [
    ["sm/DRIVE (retry)", "retry", null, "sm/DRIVE"],
    ["sm/DRIVE (try)", "try", "try", "sm/DRIVE/TRY"],
    ["sm/DRIVE (try)/PAUSE", "pause", null, "sm/DRIVE/TRY/PAUSE"],
    ["sm/DRIVE (timeout)", "timeout", null, "sm/DRIVE/TRY/TIMED"],
    ["sm/DRIVE (timeout)/TIMER", "timer", null, "sm/DRIVE/TRY/TIMED/TIMER"],
    ["sm/DRIVE", "state", null, "sm/DRIVE/TRY/TIMED/DRIVE"],
  ],
};
const NODES = [{ path: "sm", badges: [] }, { path: "sm/GO", badges: [] }, DRIVE];

const enter = (path) => ({ event: "enter", path });
const exit = (path, outcome) => ({ event: "exit", path, outcome });
const transition = (path, outcome, to) => ({ event: "transition", path, outcome, to });

/** One try, with the paths of the parts: of the try, the pause, the time limit, the timer and the state. */
const one = ([attempt, pause, limit, timer, state], outcome) => [
  enter(attempt), enter(pause), exit(pause, "succeeded"), transition(pause, "succeeded", limit),
  enter(limit), enter(timer), enter(state), exit(state, outcome), exit(timer, "preempted"), exit(limit, outcome),
  transition(limit, outcome, `${attempt}:${outcome}`), exit(attempt, outcome),
];
const whole = (paths) => [
  { event: "start", path: "sm" }, enter("sm/GO"), exit("sm/GO", "ok"), transition("sm/GO", "ok", paths[0]), enter(paths[0]),
  ...one(paths.slice(1), "aborted"), transition(paths[1], "aborted", paths[1]),
  ...one(paths.slice(1), "succeeded"), transition(paths[1], "succeeded", `${paths[0]}:succeeded`),
  exit(paths[0], "succeeded"), transition(paths[0], "succeeded", "sm:done"), { event: "finish", path: "sm", outcome: "done" },
];
const shown = DRIVE.parts.map(([path]) => path);
const full = DRIVE.parts.map(([, , , path]) => path);

const folded = (events) => new WrittenEvents(() => new Parts(NODES)).all(events);
const brief = (events) => events.map(({ event, path, outcome, number, to }) => [event, path, outcome ?? number ?? "", to ?? ""].join(" ").trim());

const EXPECTED = [
  "start sm", "enter sm/GO", "exit sm/GO ok", "transition sm/GO ok sm/DRIVE", "enter sm/DRIVE",
  "try sm/DRIVE 1", "try ended sm/DRIVE aborted", "try sm/DRIVE 2", "try ended sm/DRIVE succeeded",
  "exit sm/DRIVE succeeded", "transition sm/DRIVE succeeded sm:done", "finish sm done",
];

test("a state with tries and a time limit starts and ends once", () => {
  assert.deepEqual(brief(folded(whole(shown))), EXPECTED);
});

test("an old trace with the paths of the graph gives the same events", () => {
  assert.deepEqual(brief(folded(whole(full))), EXPECTED);
});

test("the try that runs is in the state of the run", () => {
  const events = folded(whole(shown).slice(0, -14));
  const state = events.reduce(advance, emptyState());
  assert.equal(roundInWords(state, "sm/DRIVE"), "try 2 of 3");
  assert.deepEqual([...state.active.keys()], ["sm", "sm/DRIVE"]);
});

test("items count, and the tries of each item", () => {
  const each = {
    path: "sm/EACH",
    badges: [{ field: "retry", again: [], count: 2 }, { field: "for_each", again: [], count: null }],
    parts: [
      ["sm/EACH (for_each)", "for_each", null, "sm/EACH"],
      ["sm/EACH (retry)", "retry", "item", "sm/EACH/TRIES"],
      ["sm/EACH", "state", "try", "sm/EACH/TRIES/EACH"],
    ],
  };
  const item = [enter("sm/EACH (retry)"), enter("sm/EACH"), exit("sm/EACH", "bad"), enter("sm/EACH"), exit("sm/EACH", "ok"), exit("sm/EACH (retry)", "ok")];
  const events = new WrittenEvents(() => new Parts([each])).all([enter("sm/EACH (for_each)"), ...item, ...item]);
  const rounds = [];
  const state = emptyState();
  for (const event of events) {
    advance(state, event);
    if (event.event === "try") rounds.push(roundInWords(state, "sm/EACH"));
  }
  assert.deepEqual(rounds, ["item 1, try 1 of 2", "item 1, try 2 of 2", "item 2, try 1 of 2", "item 2, try 2 of 2"]);
});

test("a run that is stopped in a try ends the state", () => {
  const stopped = [enter(shown[0]), enter(shown[1]), enter(shown[2]), { event: "preempt", path: shown[0] },
    { event: "preempt", path: shown[2] }, exit(shown[2], "preempted"), exit(shown[1], "aborted"), exit(shown[0], "preempted")];
  assert.deepEqual(brief(folded(stopped)), [
    "enter sm/DRIVE", "try sm/DRIVE 1", "preempt sm/DRIVE", "try ended sm/DRIVE aborted", "exit sm/DRIVE preempted",
  ]);
});
