// A host for documents of `smachac build --target scxml` on SCION (@scion-scxml/scxml, npm).
//
//   node scion_host.js MACHINE.scxml STATES.js [--inputs '{"key": value}']
//
// STATES.js exports a function for each state type that is not in the document. It gets the state
// and returns its outcome, or a promise of it; what it throws is a fault of the state:
//
//   exports.Grasp = async ({inputs, variables, outputs, signal}) => {
//     outputs.width = await gripper.close(inputs.pose, {signal});
//     return signal.aborted ? "preempted" : "succeeded";
//   };
//
// `signal` is an AbortSignal: a request to stop aborts it. The outcome `preempted` answers the
// request, as does a call of `answer`; `stop` requests a stop of the machine. SIGINT and SIGTERM request a stop of the machine; its exit codes are those of smachac.
"use strict";

/** Waits and other work of a real machine. A test passes a virtual clock. */
const REAL_CLOCK = {
  set: (seconds, action) => setTimeout(action, 1000 * seconds),
  clear: handle => clearTimeout(handle),
  soon: action => setImmediate(action)
};

/** Inputs of a state: reading a key that is not there throws. */
function strict(inputs) {
  return new Proxy(inputs, {
    get(held, key) {
      if (typeof key === "string" && !(key in held)) throw new ReferenceError(`the input "${key}" holds nothing`);
      return held[key];
    }
  });
}

/** The usual outcome: the first one with the name of a success, else the first one. */
function usual(outcomes) {
  const good = ["succeeded", "success", "done", "ok", "true"];
  return outcomes.find(outcome => good.includes(outcome)) || outcomes[0];
}

/** The built-in state types that are not in documents. */
const BUILT_IN = {
  ScriptedState({variables, outcomes, outputs, signal, visit}) {
    if (signal.aborted && outcomes.includes("preempted")) return "preempted";
    const steps = variables.steps || [];
    if (steps.length === 0) return outcomes[0];
    const step = steps[Math.min(visit, steps.length) - 1];
    Object.assign(outputs, step.set);
    return step.outcome || usual(outcomes);
  },
  PrintUserdataState({inputs, outcomes, signal}) {
    if (signal.aborted && outcomes.includes("preempted")) return "preempted";
    for (const key of Object.keys(inputs).sort()) console.log(`${key}: ${JSON.stringify(inputs[key])}`);
    return usual(outcomes);
  },
  RandomOutcomeState({outcomes}) {
    return outcomes[Math.floor(Math.random() * outcomes.length)];
  }
};

/**
 * Runs a prepared model (see `load`) with a table of functions. `options`: `inputs` of the machine;
 * `stopped`, whether a request to stop comes first; `onEvent`, gets the events of a document that
 * was built with `--option trace=true`, with `seq` and `t` (s); `clock`.
 * Returns `{ended, stop}`: a promise of the outcome (null after a fault), and the function that
 * requests a stop.
 */
function start(scxml, model, states, options) {
  const {inputs = {}, stopped = false, onEvent = () => {}, clock = REAL_CLOCK} = options || {};
  const events = [], timers = {}, running = {}, visits = {};
  const began = clock.now ? clock.now() : Date.now() / 1000;
  let seq = 0, busy = false, ended = false, result = null, error = null;

  function note(event) {
    if (event.event === "finish") result = event.outcome;
    const now = clock.now ? clock.now() : Date.now() / 1000;
    onEvent(Object.assign({seq: ++seq}, event, {t: now - began}));
  }

  function post(event) {
    if (ended) return;
    events.push(event);
    if (!busy) clock.soon(pump);
  }

  function pump() {
    while (!busy && events.length > 0 && !ended) {
      busy = true;
      try { machine.gen(events.shift()); } finally { busy = false; }
    }
  }

  function run(call) {
    const {id, src, params} = call;
    if (ended || !machine.isIn(id)) return;
    const visit = visits[id] = (visits[id] || 0) + 1;
    const outcomes = params.outcomes, outputs = {}, abort = running[id].abort;
    let served = false;
    const answer = (name, data) => post({name, invokeid: id, data});
    const finished = outcome => {
      if (!outcomes.includes(outcome)) throw new Error(`"${outcome}" is not one of its outcomes`);
      const answered = served || (abort.signal.aborted && outcome === "preempted");
      delete running[id];
      answer(`${id}.${outcome}`, {outputs, answered});
    };
    const failed = reason => {
      delete running[id];
      error = error || reason;
      answer(`fault.${id}`, {outputs, answered: served, message: String(reason && reason.message || reason)});
    };
    try {
      const work = (states[src] || BUILT_IN[src]);
      if (!work) throw new Error(`the table has no function for the state type "${src}"`);
      const found = work({
        id, visit, outcomes, outputs, signal: abort.signal, stop: request,
        answer: () => { served = true; },
        inputs: strict(params.inputs || {}), variables: params.variables || {}
      });
      if (found && typeof found.then === "function") found.then(finished).catch(failed);
      else finished(found);
    } catch (reason) {
      failed(reason);
    }
  }

  const invokers = {
    smachac(session, call, context, done) {
      const abort = new AbortController();
      running[call.id] = {abort};
      if (call.params.stopped) abort.abort();
      done(null, {cancel() {}});  // a state ends by itself, also after a request to stop
      clock.soon(() => run(call));
    }
  };

  function customSend(event, {delay}) {
    if (event.target === "#_internal") {
      this.raise(event);
    } else if (event.target) {
      const state = running[event.target.slice(2)];
      if (state) state.abort.abort();
    } else {
      timers[event.sendid] = clock.set((delay || 0) / 1000, () => post({name: event.name, data: event.data}));
    }
  }

  const request = () => post({name: "preempt"});
  const params = {inputs, preempted: stopped};
  const machine = new scxml.core.Statechart(model, {
    params, invokers, customSend,
    customCancel: id => clock.clear(timers[id]),
    console: {log: (label, text) => (label === "trace" ? [].concat(JSON.parse(text)).forEach(note) : console.log(label, text))}
  });
  const done = new Promise((resolve, reject) => {
    machine.on("onExitInterpreter", () => {
      ended = true;
      const final = machine.getConfiguration()[0];
      if (final === "fault") reject(error || new Error("an expression of the document has no value"));
      else resolve(result || final);
    });
  });
  machine.start();
  return {ended: done, stop: request, machine};
}

/** The model of a document, from its file or its text. */
function load(scxml, path, text) {
  return new Promise((resolve, reject) => {
    const prepare = (failure, model) => {
      if (failure) return reject(failure);
      model.prepare((problem, factory) => (problem ? reject(problem) : resolve(factory)));
    };
    if (text === undefined) scxml.pathToModel(path, prepare, {});
    else scxml.documentStringToModel(path, text, prepare, {});
  });
}

async function main([file, table, option, given]) {
  if (!table || (option && option !== "--inputs")) {
    console.error("usage: node scion_host.js MACHINE.scxml STATES.js [--inputs JSON]");
    process.exitCode = 2;
    return;
  }
  const path = require("path");
  const scxml = require(require.resolve("@scion-scxml/scxml", {paths: [process.cwd(), __dirname]}));
  const states = require(path.resolve(table));
  const model = await load(scxml, path.resolve(file));
  const run = start(scxml, model, states, {
    inputs: given ? JSON.parse(given) : {},
    onEvent: event => console.log(JSON.stringify(event))
  });
  const codes = {SIGINT: 130, SIGTERM: 143};
  let code = 0;
  for (const signal of Object.keys(codes)) {
    process.once(signal, () => { code = codes[signal]; run.stop(); });
  }
  try {
    console.log(`outcome: ${await run.ended}`);
  } catch (reason) {
    console.error(`the run failed: ${reason.message || reason}`);
    code = code || 1;
  }
  process.exit(code);
}

module.exports = {start, load};
if (require.main === module) {
  main(process.argv.slice(2)).catch(problem => {
    console.error(String(problem.message || problem));
    process.exitCode = 1;
  });
}
