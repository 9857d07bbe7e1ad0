// Plays test cases on SCION, in virtual time: the player of the target scxml (players/scxml.py).
//
// The input is one JSON object: `host` and `scion`, the paths of scion_host.js and of the package;
// `documents`, texts of SCXML; `cases`. A case has `document` (its number), `inputs`, `stopped`,
// `most` (the limit on visits), and by the identifier of each leaf: its path in `paths`, its steps
// in `rows` (those of verify, or `exact` ones that say whether they answer a request), and the
// inputs that it records in `reads`. `asked`: the path of a state and the number of the visit in
// which the machine gets a request to stop. `scripted`: the leaves perform their steps; otherwise
// the host has their functions. The trace of each case is printed as lines of JSON, and then `--`.
"use strict";

const given = JSON.parse(require("fs").readFileSync(0, "utf-8"));
const {start, load} = require(given.host);
const scxml = require(given.scion);

/** A clock that jumps to the next timer where nothing else is left to do. */
function virtualClock() {
  let time = 0, number = 0;
  const ready = [], timers = [];
  return {
    now: () => time,
    soon: action => { ready.push(action); },
    set: (seconds, action) => {
      const timer = {at: time + seconds, number: ++number, action};
      timers.push(timer);
      return timer;
    },
    clear: timer => {
      const at = timers.indexOf(timer);
      if (at >= 0) timers.splice(at, 1);
    },
    async run(most) {
      for (let steps = 0; steps < most; steps += 1) {
        if (ready.length > 0) {
          ready.shift()();
        } else if (timers.length > 0) {
          timers.sort((one, other) => one.at - other.at || one.number - other.number);
          const timer = timers.shift();
          time = timer.at;
          timer.action();
        } else {
          return;
        }
        for (let tick = 0; tick < 4; tick += 1) await null;
      }
    }
  };
}

/** The function of every leaf: it performs the steps of the case. */
function player(one, events, clock) {
  let left = one.most;
  const wait = signal => new Promise(resolve => {
    if (signal.aborted) resolve();
    else signal.addEventListener("abort", resolve, {once: true});
  });
  const soon = () => new Promise(resolve => clock.soon(resolve));
  return ({id, visit, inputs, outputs, outcomes, signal, stop, answer}) => {
    const able = outcomes.includes("preempted"), path = one.paths[id], row = one.rows[id];
    for (const key of one.reads[id] || []) {
      if (key in inputs && inputs[key] !== null) events.push({event: "read", path, key, value: inputs[key]});
    }
    left -= 1;
    const step = row[visit - 1];
    if (step === undefined || left < 0) throw new Error("is not in the script");
    const perform = () => {
      if (step.answered) answer();
      else if (signal.aborted && able && !step.exact) return "preempted";
      Object.assign(outputs, step.writes);
      if (step.error) throw new Error(step.error);
      return step.outcome;
    };
    if (!step.stop && !(step.wait && !signal.aborted)) return perform();
    return (async () => {
      if (step.stop) {
        stop();
        await soon();
        await soon();
      }
      if (step.wait) await wait(signal);
      return perform();
    })();
  };
}

async function main() {
  const models = [];
  let session = null;
  scxml.core.on("new", created => { session = created; });
  for (const [at, text] of given.documents.entries()) models.push(await load(scxml, `document${at}`, text));
  for (const one of given.cases) {
    const clock = virtualClock(), events = [];
    const play = player(one, events, clock);
    let [path, visits] = one.asked || ["", 0];
    const states = given.scripted ? new Proxy({}, {get: () => play}) : {};
    const run = start(scxml, models[one.document], states, {
      inputs: one.inputs, stopped: one.stopped, clock,
      onEvent: event => {
        events.push(event);
        if (event.event === "enter" && event.path === path && --visits === 0) {
          session._internalEventQueue.push({name: "preempt"});  // while the state is entered
        }
      }
    });
    run.ended.catch(() => {});
    await clock.run(one.steps || 100000);
    for (const event of events) console.log(JSON.stringify(event));
    console.log("--");
  }
}

main();
