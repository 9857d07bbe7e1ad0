// The simulation of the machine: its states stand and wait for outcomes that the user chooses. The server
// plays it; this file only shows where it stands.

import { post } from "./connection";
import { button, html } from "./dom";
import type { Path, StateNode } from "./model";
import type { TraceEvent } from "./run_state";
import type { Viewer } from "./viewer";

/** An output key of a state, with a value by its type. `text`: the value is a text, else YAML. */
interface KeyField {
  name: string;
  type: string;
  text: boolean;
  choices: string[];
  value: string;
}

interface Choosable {
  name: string;
  keys: KeyField[];
}

/** A state that waits for a choice. `run` and `wait` are what else it can do, in words or empty. `stopped`: it has
 * a request to stop; `stops`: it ends with `preempted` after one. */
interface Standing {
  path: Path;
  stopped: boolean;
  stops: boolean;
  outcomes: Choosable[];
  run: string;
  wait: string;
}

export type SimulationStatus =
  | { state: "off" }
  | {
    state: "waits" | "ended" | "failed";
    note: string;
    t: number;
    events: TraceEvent[];
    steps: { path: Path; text: string }[];
    at: Standing[];
    outcome: string | null;
  };

interface Saved {
  file: string;
  command: string;
}

export class Simulation {
  /** The buttons that act on a simulation that runs. */
  readonly element = html("div", { class: "control", role: "group", "aria-label": "Simulation" });
  status: SimulationStatus = { state: "off" };
  private readonly start = button("Simulate the machine", "Simulate", () => void this.act({ action: "start" }), "Choose the outcome of each state");
  private readonly back = button("Step back", "Step back", () => void this.act({ action: "back" }), "Take back the last choice (z)");
  private readonly said = html("p", { class: "said", role: "status" });
  private shown: { status: SimulationStatus; path: Path | null; element: HTMLElement } | null = null;

  /** `changed` is called after each change; `round` gives the try or item of a state in words. */
  constructor(
    private readonly viewer: Viewer,
    private readonly token: string | null,
    private readonly changed: () => void,
    private readonly round: (path: Path) => string,
  ) {
    if (token === null || !viewer.graph.model.simulated) return;
    viewer.toolbar.append(this.start);
    this.element.append(this.back,
      button("Restart the simulation", "Restart", () => void this.act({ action: "start" }), "Stand before the first state again"),
      button("End the simulation", "End", () => void this.act({ action: "end" })));
    viewer.addSection({ id: "simulate", title: "Simulate", first: true, fill: (node) => this.fill(node) });
    document.addEventListener("keydown", (event) => this.key(event));
    this.show();
  }

  get runs(): boolean {
    return this.status.state !== "off";
  }

  /** The states that wait for a choice. */
  get at(): Standing[] {
    return this.status.state === "off" ? [] : this.status.at;
  }

  received(status: SimulationStatus): void {
    this.status = status;
    this.say("");
    this.show();
    this.changed();
    this.viewer.refresh();
  }

  /** Select a state that waits; after the end, the machine. */
  async follow(): Promise<void> {
    const { selected } = this.viewer;
    if (this.status.state === "off" || this.at.some(({ path }) => path === selected)) return;
    await this.viewer.select(this.at[0]?.path ?? null);
  }

  /** The machine has changed: its states may have other names. */
  async remodelled(): Promise<void> {
    this.shown = null;
    this.viewer.refresh();
    await this.follow();
  }

  private show(): void {
    this.element.hidden = this.token === null || !this.runs;
    this.start.disabled = this.runs;
    this.back.disabled = this.status.state === "off" || !this.status.steps.length;
  }

  private async act(body: object): Promise<boolean> {
    const at = this.status.state === "off" ? 0 : this.status.steps.length;
    const answer = await post<Partial<Saved>>(this.token!, "simulate", { at, ...body });
    if (!answer.ok) {
      this.say(answer.reason, "refused");
      if (!this.runs) this.viewer.notice(answer.reason);
    } else if (answer.content.file !== undefined) {
      this.say(`Written: ${answer.content.file}\n${answer.content.command}`, "done");
    }
    return answer.ok;
  }

  private say(text: string, tone: "" | "refused" | "done" = ""): void {
    this.said.textContent = text;
    this.said.className = `said ${tone}`.trim();
  }

  /** The section of the panel; what is typed in stays while the simulation stands where it is. */
  private fill(node: StateNode | null): HTMLElement | null {
    if (this.status.state === "off") return null;
    const path = node?.path ?? null;
    if (this.shown?.status !== this.status || this.shown.path !== path) {
      const element = html("div", { class: "edit simulate" });
      this.shown = { status: this.status, path, element };
      element.append(...this.parts(path));
    }
    return this.shown.element;
  }

  private parts(path: Path | null): HTMLElement[] {
    if (this.status.state === "off") return [];
    const { note, at, steps, state, outcome } = this.status;
    const parts: HTMLElement[] = [];
    if (note) parts.push(html("p", { class: "said refused" }, note));
    const standing = at.find((each) => each.path === path);
    if (standing) parts.push(this.choices(standing));
    const others = at.filter((each) => each !== standing);
    if (others.length) {
      parts.push(html("p", {}, standing ? "These wait too: " : "Choose the outcome of: ",
        ...others.map((each) => this.link(this.name(each.path), each.path))));
    }
    if (!at.length) parts.push(this.saving(state === "failed" ? "The machine has failed." : `The machine has ended with ${outcome}.`, outcome));
    parts.push(this.said);
    if (steps.length) parts.push(this.history(steps));
    return parts;
  }

  private name(path: Path): string {
    return this.viewer.graph.nodes.get(path)?.name ?? path;
  }

  private link(text: string, path: Path): HTMLElement {
    const made = html("button", { type: "button", class: "link" }, text);
    made.addEventListener("click", () => void this.viewer.select(path));
    return made;
  }

  /** What a state that waits can do. */
  private choices(standing: Standing): HTMLElement {
    const stop = html("input", { type: "checkbox" });
    const takes = html("input", { type: "text", placeholder: "0 s", spellcheck: "false", "aria-label": "Time that it takes" });
    const message = html("input", { type: "text", placeholder: "message", spellcheck: "false", "aria-label": "Message of the error" });
    const choose = (body: object): void => {
      void this.act({ action: "choose", path: standing.path, stop: stop.checked, ...body });
    };
    const outcomes = standing.outcomes.map((each) => this.outcome(standing.path, each, (set) =>
      choose({ outcome: each.name, set, ...(takes.value.trim() ? { after: takes.value } : {}) })));
    const other = [
      standing.run && button(`Let it ${standing.run}`, standing.run, () => choose({ run: true })),
      standing.wait && button(standing.wait, standing.wait, () => choose({ wait: true }), "Let time pass"),
    ].filter((each) => each !== "");
    const stopWords = standing.stops ? "A stop request arrives first: it ends with preempted" : "A stop request arrives first";
    const form = html("div", { class: "waiting" },
      html("p", {}, `${standing.stopped ? "It has a stop request. " : ""}${capital(this.round(standing.path) || "it")} ends with:`),
      ...outcomes,
      other.length ? html("p", {}, "Or:") : null,
      other.length ? html("p", { class: "forced" }, ...other) : null,
      html("details", {}, html("summary", {}, "more"),
        html("label", { class: "more-field" }, "It takes", takes),
        standing.stopped ? null : html("label", { class: "more-field" }, stop, stopWords),
        html("p", { class: "more-field" }, button("Let it fail with an error", "error", () => choose({ error: message.value })), message)));
    form.addEventListener("input", () => this.say(""));
    return form;
  }

  /** An outcome with the keys that the state writes. */
  private outcome(path: Path, { name, keys }: Choosable, choose: (set: Record<string, string>) => void): HTMLElement {
    const fields = keys.map((key) => keyField(key));
    const end = button(`End with ${name}`, name, () =>
      choose(Object.fromEntries(fields.filter(({ used }) => used.checked).map(({ key, value }) => [key.name, value.value]))));
    const node = this.viewer.graph.nodes.get(path);
    const look = node?.outcomes.find((each) => each.name === name) ?? node?.repeated?.find((each) => each.name === name);
    if (look?.failure) end.classList.add("failure");
    return html("div", { class: "ending", role: "group", "aria-label": name }, end, ...fields.map(({ element }) => element));
  }

  private saving(words: string, outcome: string | null): HTMLElement {
    const name = html("input", { type: "text", required: true, spellcheck: "false", autocomplete: "off" });
    name.value = outcome?.replaceAll(/[^\w-]/g, "_") ?? "failure";
    const form = html("form", {},
      html("p", {}, words),
      html("p", { class: "field" }, html("label", {}, "Name of the scenario", name)),
      html("div", { class: "acts" }, html("button", { type: "submit" }, "Save as a scenario")));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.act({ action: "save", name: name.value.trim() });
    });
    return form;
  }

  /** The choices so far; a click on one goes back to where it was made. */
  private history(steps: { path: Path; text: string }[]): HTMLElement {
    const rows = steps.map(({ path, text }, index) => {
      const back = button(`Back to the choice of ${this.name(path)}, step ${index + 1}`, this.name(path), () =>
        void this.act({ action: "back", to: index }), "Go back to this choice");
      back.classList.add("link");
      return html("li", {}, back, html("span", {}, ` ${text}`));
    });
    const list = html("ol", { class: "steps", tabindex: "0", "aria-label": "Steps" }, ...rows);
    requestAnimationFrame(() => list.scrollTop = list.scrollHeight);
    return html("details", { open: true }, html("summary", {}, "steps"), list);
  }

  private key(event: KeyboardEvent): void {
    if (event.key !== "z" || event.ctrlKey || event.metaKey || event.altKey || this.back.disabled || !this.runs) return;
    if ((event.target as Element).closest("input, select, textarea")) return;
    void this.act({ action: "back" });
  }
}

function capital(text: string): string {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}

interface Field {
  key: KeyField;
  used: HTMLInputElement;
  value: HTMLInputElement | HTMLSelectElement;
  element: HTMLElement;
}

/** The field of a key: whether it is written, and its value. */
function keyField(key: KeyField): Field {
  const used = html("input", { type: "checkbox", "aria-label": `Write ${key.name}`, title: "Write this key" });
  used.checked = true;
  const label = { "aria-label": `Value of ${key.name}`, title: key.type };
  const value = key.choices.length
    ? html("select", label, ...key.choices.map((each) => html("option", { value: each }, each)))
    : html("input", { ...label, type: "text", spellcheck: "false", autocomplete: "off" });
  value.value = key.value;
  value.addEventListener("input", () => used.checked = true);
  const element = html("div", { class: "key-field" }, used, html("span", { class: "key", title: key.type }, key.name, " ", html("small", {}, key.type)), value);
  return { key, used, value, element };
}
