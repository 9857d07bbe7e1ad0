// The view of a run beside the picture: its state in words, the time line, the log, values of keys.

import type { Message } from "./connection";
import { connect, takeToken } from "./connection";
import { Control } from "./control";
import { button, html } from "./dom";
import type { Finding, StateNode } from "./model";
import type { FilmData } from "./film";
import { Film } from "./film";
import { Recording } from "./recording";
import { Simulation } from "./simulation";
import { foreignPlace, highlightOf, inWords, inline, keyValues, nodeAt, placeOf, seconds } from "./run_marks";
import type { RunState, TraceEvent } from "./run_state";
import { activeLeaves, roundInWords } from "./run_state";
import { Timeline } from "./timeline";
import type { Viewer } from "./viewer";
import { WrittenEvents } from "./written_events";

/** The least time between two drawings, and between two states that are followed, in milliseconds; the
 * most lines of the log and keys on the page. */
const APART = 80;
const FOLLOW_APART = 400;
const LOG_LINES = 200;
const KEY_ROWS = 60;

/** Show runs: those of a server if the model is live, and the recorded one of `trace` (JSON). `film` is
 * the data of a film of it (JSON), or empty. */
export function showRuns(viewer: Viewer, trace: string, film: string): void {
  const { live } = viewer.graph.model;
  const token = live ? takeToken() : null;
  if (!live && !trace) return;
  const view = new RunView(viewer, token, live);
  if (trace) view.replay(JSON.parse(trace) as TraceEvent[]);
  if (film) view.addFilm(new Film(JSON.parse(film) as FilmData));
  if (live) view.connect();
}

class RunView {
  private readonly recording = new Recording();
  private readonly written: WrittenEvents;
  private readonly timeline: Timeline;
  private readonly control: Control;
  private readonly simulation: Simulation;
  private readonly status = html("p", { class: "run-status", role: "status" });
  private readonly foreign = html("p", { class: "run-foreign", role: "status" });
  private readonly log = html("ol", { class: "log", tabindex: "0", "aria-label": "Log" });
  private readonly keys = html("div", { class: "values", tabindex: "0", "aria-label": "Values of keys" });
  private readonly bar: HTMLElement;
  private readonly details: HTMLElement;
  private readonly part = html("div", { class: "run-part" });
  private readonly follow = button("Follow", "Follow", () => this.toggleFollow(), "Select the state that runs (o)");
  private follows = false;
  private followed = 0;
  private shownNode: StateNode | null = null;
  private filledFor = "";
  private errors: Finding[] = [];
  private link = "";
  private arrived = performance.now();
  private drawn = 0;
  private waiting = false;
  private loggedTo = -1;

  constructor(private readonly viewer: Viewer, token: string | null, private readonly live: boolean) {
    this.written = new WrittenEvents(() => viewer.graph.parts);
    this.timeline = new Timeline(this.recording, () => this.draw());
    this.control = new Control(token, () => this.controlled(), (reason) => viewer.notice(reason));
    this.simulation = new Simulation(viewer, token, () => this.simulated(),
      (path) => roundInWords(this.recording.at(Infinity), path));
    this.bar = html("div", { class: "run-bar" },
      this.foreign, this.status, this.control.element, this.simulation.element, this.follow, this.timeline.element);
    this.details = html("div", { class: "run-details", hidden: true }, this.log, this.keys);
    viewer.footer.append(this.bar, this.details);
    viewer.addSection({ id: "run", title: "Run", first: true, fill: (node) => this.fill(node) });
    viewer.addSection({ id: "errors", title: "Errors in the script now", first: true, fill: (node) => (node ? null : this.errorList()) });
    document.addEventListener("keydown", (event) => this.key(event));
    setInterval(() => this.tick(), 500);
    this.draw();
  }

  replay(events: TraceEvent[]): void {
    this.recording.add(this.written.all(events));
    this.timeline.update();
    this.draw();
  }

  /** Show a film in step with the time line. */
  addFilm(film: Film): void {
    this.details.classList.add("filmed");
    this.details.append(film.element);
    this.timeline.timeShown = (t) => film.show(t);
  }

  connect(): void {
    connect({
      opened: () => {
        this.link = "";
        this.recording.clear();
        this.written.clear();
        this.loggedTo = -1;
        this.timeline.follows = true;
        if (this.simulation.runs) this.simulation.received({ state: "off" });
        this.changed();
      },
      received: (message) => this.received(message),
      interrupted: () => this.disconnected("The connection is interrupted."),
      ended: () => this.disconnected(""),
    });
  }

  private disconnected(link: string): void {
    this.link = link;
    if (!link && this.control.status) this.control.received({ ...this.control.status, ended: true });
    this.changed();
  }

  private received(message: Message): void {
    switch (message.kind) {
      case "model":
        void this.remodel(message.model);
        break;
      case "report":
        this.report(message.broken, message.outdated, message.findings);
        break;
      case "trace":
        this.recording.add(this.written.all(message.events));
        this.arrived = performance.now();
        this.timeline.update();
        this.changed();
        break;
      case "dropped":
        this.recording.dropped += message.count;
        break;
      case "source":
        this.link = message.waits;
        this.changed();
        break;
      case "control":
        this.control.received(message);
        break;
      case "simulation":
        this.simulation.received(message);
        void this.simulation.follow();
    }
  }

  /** Show the run of the simulation as far as it is chosen. */
  private simulated(): void {
    const { status } = this.simulation;
    this.recording.clear();
    this.written.clear();
    if (status.state !== "off") this.recording.add(this.written.all(status.events));
    this.details.hidden = status.state === "off" || this.details.hidden;
    this.loggedTo = -1;
    this.timeline.goTo(Infinity);
    this.changed();
  }

  private async remodel(model: Viewer["graph"]["model"]): Promise<void> {
    await this.viewer.setModel(model);
    if (this.simulation.runs) {
      this.simulated(); // its states are those of the machine now
      await this.simulation.remodelled();
    }
    this.loggedTo = -1;
    this.draw();
  }

  private report(broken: boolean, outdated: boolean, findings: Finding[]): void {
    this.errors = broken ? findings.filter((each) => each.severity === "error") : [];
    const [first] = this.errors;
    const more = this.errors.length > 1 ? ` (and ${this.errors.length - 1} more)` : "";
    const picture = outdated ? ". The picture is that of the last version without errors." : "";
    const text = first ? `${first.file}:${first.line}: error ${first.code}: ${first.message}${more}${picture}` : "";
    this.viewer.notice(text, this.errorList());
    this.viewer.refresh();
  }

  private errorList(): HTMLElement | null {
    if (!this.errors.length) return null;
    return html("ul", { class: "findings" }, ...this.errors.map((each) =>
      html("li", { class: "error" },
        html("p", {}, html("strong", {}, `error ${each.code}`), " ", each.message),
        each.help ? html("p", { class: "help" }, `help: ${each.help}`) : null,
        ...each.related.map(({ file, line, message }) => html("p", { class: "help" }, `${file}:${line}: ${message}`)),
        each.file ? html("p", { class: "place" }, `${each.file}:${each.line}`) : null)));
  }

  private controlled(): void {
    const [first] = this.control.status?.at ?? [];
    const node = first && nodeAt(this.viewer.graph, first.path);
    if (node && this.control.able && this.viewer.selected !== node.path) void this.viewer.select(node.path);
    this.fillPart(this.shownNode);
    this.changed();
  }

  /** Draw soon: at once if nothing was drawn lately, else after a short time, once for all changes. */
  private changed(): void {
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => requestAnimationFrame(() => this.draw()), Math.max(0, APART - (performance.now() - this.drawn)));
  }

  private draw(): void {
    this.waiting = false;
    this.drawn = performance.now();
    const any = this.recording.events.length > 0 || this.control.status !== null;
    if (any && this.details.hidden) this.open();
    this.bar.hidden = !any && !this.link;
    const state = this.recording.at(this.timeline.position);
    const { at } = this.simulation;
    const simulated = this.simulation.runs ? { at: at.map(({ path }) => ({ path, outcome: null, round: null, outcomes: [] })), breakpoints: [] } : null;
    const control = this.timeline.follows ? (simulated ?? this.control.status) : null;
    this.viewer.highlight(any ? highlightOf(this.viewer.graph, state, control) : null);
    this.status.textContent = this.inWords(state);
    const foreign = foreignPlace(this.viewer.graph, this.recording.at(Infinity));
    if (this.foreign.textContent !== foreign) this.foreign.textContent = foreign;
    this.drawLog();
    this.drawKeys(state);
    this.fillPart(this.shownNode);
    this.followRun(state);
  }

  /** Show what belongs to a run: the picture gets smaller. */
  private open(): void {
    this.details.hidden = false;
    this.bar.hidden = false;
    this.viewer.fit();
  }

  /** Count the seconds of the active states on, also without events. What has changed is drawn as a whole. */
  private tick(): void {
    if (this.live && !this.simulation.runs && this.timeline.follows && !this.bar.hidden && !this.waiting) {
      this.status.textContent = this.inWords(this.recording.at(this.timeline.position));
    }
  }

  private toggleFollow(): void {
    this.follows = !this.follows;
    this.follow.setAttribute("aria-pressed", String(this.follows));
    this.draw();
  }

  /** Select the state that runs, if that is wanted, and not more often than one can see. */
  private followRun(state: RunState): void {
    const [path] = activeLeaves(state);
    const node = path === undefined ? undefined : nodeAt(this.viewer.graph, path);
    if (!this.follows || !node || node.path === this.viewer.selected) return;
    if (performance.now() - this.followed < FOLLOW_APART) return;
    this.followed = performance.now();
    void this.viewer.select(node.path);
  }

  private inWords(state: RunState): string {
    const { graph } = this.viewer;
    const name = (path: string): string => nodeAt(graph, path)?.name ?? path;
    if (this.link) return this.link;
    if (state.ended) return `ended with ${state.outcome}`;
    if (state.error && !state.active.size) return `failed in ${name(state.error.path)}`;
    const status = this.timeline.follows ? this.control.status : null;
    if (status?.ended) return state.error ? `failed in ${name(state.error.path)}: ${state.error.message}` : "ended";
    const round = (path: string): string => (state.rounds.has(path) ? ` (${roundInWords(state, path)})` : "");
    if (this.simulation.runs && this.timeline.follows) {
      const { at } = this.simulation;
      if (at.length) return `${at.map(({ path }) => `${name(path)}${round(path)}`).join(", ")}: choose an outcome`;
      if (state.error) return `failed in ${name(state.error.path)}: ${state.error.message}`;
    }
    const running = activeLeaves(state).map((path) => `${name(path)}${round(path)} ${this.since(state, path)}`);
    const waits = (status?.at ?? []).map(({ path, outcome, round }) =>
      outcome === null ? `paused before ${round === null ? "" : `${round === "try" ? "a try" : "an item"} of `}${name(path)}` : `paused after ${name(path)}: ${outcome}`);
    if (waits.length) return waits.join(", ");
    if (status?.stopping) return `stopping: ${running.join(", ")}`;
    if (status?.paused) return `pauses before the next state: ${running.join(", ")}`;
    if (!running.length || state.root === null) return "not started";
    return running.join(", ");
  }

  private since(state: RunState, path: string): string {
    const waited = this.live && !this.simulation.runs && this.timeline.follows ? (performance.now() - this.arrived) / 1000 : 0;
    return seconds(state.t - (state.active.get(path) ?? state.t) + waited);
  }

  private drawLog(): void {
    const { position } = this.timeline;
    if (position === this.loggedTo) return;
    this.loggedTo = position;
    const { graph } = this.viewer;
    const rows: HTMLElement[] = [];
    for (let index = position - 1; index >= 0 && rows.length < LOG_LINES; index -= 1) {
      const event = this.recording.events[index]!;
      const words = inWords(graph, event);
      if (!words) continue;
      const row = html("li", { class: words.tone, title: event.src ?? "" },
        html("time", {}, (event.t ?? 0).toFixed(2)), " ", words.text);
      row.addEventListener("click", () => void this.viewer.select(nodeAt(graph, event.path)?.path ?? null));
      rows.push(row);
    }
    this.log.replaceChildren(...rows.reverse());
    this.log.scrollTop = this.log.scrollHeight;
  }

  private drawKeys(state: RunState): void {
    const rows = keyValues(this.viewer.graph, state).slice(0, KEY_ROWS).map((each) => {
      const value = each.secret ? "(secret)" : inline(each.written.value, 300);
      const where = `${each.scope}, written by ${each.written.path} at ${each.written.t.toFixed(2)} s`;
      return html("tr", { title: where },
        html("th", { scope: "row" }, each.key),
        html("td", { class: "type" }, each.type),
        html("td", {}, html("code", {}, value)));
    });
    const caption = rows.length ? "Values of keys, the newest first" : "No key was written yet";
    this.keys.replaceChildren(html("table", {}, html("caption", {}, caption), html("tbody", {}, ...rows)));
  }

  private fill(node: StateNode | null): Node | null {
    this.shownNode = node;
    this.fillPart(node);
    return node && (this.recording.events.length || this.control.able) ? this.part : null;
  }

  /** The section of the selected state; it is filled again as the run goes on. */
  private fillPart(node: StateNode | null): void {
    if (!node) return;
    const focused = this.filledFor === node.path && this.part.contains(document.activeElement);
    this.filledFor = node.path;
    const control = this.control.partFor(node);
    if (!focused || !control) this.part.replaceChildren(...(control ? [control] : []));
    else this.part.querySelector(".facts")?.remove();
    this.part.append(this.facts(node));
  }

  private facts(node: StateNode): HTMLElement {
    const { graph } = this.viewer;
    const state = this.recording.at(this.timeline.position);
    const { path } = node;
    const visited = state.visited.get(path);
    const rows: HTMLElement[] = [];
    const row = (name: string, value: string): void => {
      rows.push(html("li", {}, html("span", { class: "key" }, name), html("code", {}, value)));
    };
    if (visited) {
      row("visits", String(visited.visits));
      if (state.active.has(path)) row("in it since", this.since(state, path));
      const done = [...visited.outcomes.values()].reduce((a, b) => a + b, 0);
      if (done) row("mean time", seconds(visited.seconds / done));
      for (const [outcome, count] of visited.outcomes) row(outcome, `${count} of ${done}`);
    } else {
      row("visits", "0");
    }
    const values = new Map(keyValues(graph, state).map((each) => [`${each.scope}\n${each.key}`, each]));
    for (const key of new Set([...node.inputs, ...node.outputs].map((each) => each.name))) {
      const place = placeOf(graph, node, key);
      const found = values.get(`${place.scope}\n${place.key}`);
      if (found) row(key, place.secret || found.secret ? "(secret)" : inline(found.written.value, 500));
    }
    return html("ul", { class: "rows facts" }, ...rows);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if ((event.target as Element).closest("input, select, textarea")) return;
    const path = this.viewer.selected;
    const actions: Record<string, () => void> = {
      ",": () => this.timeline.step(-1),
      ".": () => this.timeline.step(1),
      p: () => this.timeline.toggle(),
      s: () => this.control.do({ action: "step" }),
      o: () => this.toggleFollow(),
      r: () => this.control.pauseOrResume(),
      b: () => path !== null && this.control.toggleBreakpoint({ path, outcome: null, round: null }),
    };
    actions[event.key]?.();
  }
}
