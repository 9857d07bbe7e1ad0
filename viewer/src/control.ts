// Control of a run: pause, step, breakpoints, forced outcomes, stop.

import { act } from "./connection";
import type { ControlStatus, Place, Waiting } from "./connection";
import { button, html } from "./dom";
import type { Round, StateNode } from "./model";

export class Control {
  readonly element = html("div", { class: "control", role: "group", "aria-label": "Control of the run" });
  status: ControlStatus | null = null;
  private readonly pause = button("Pause", "Pause", () => this.pauseOrResume(), "Pause before the next state, or go on (r)");
  private readonly step = button("Step", "Step", () => this.do({ action: "step" }), "Run one state (s)");
  private readonly stop = button("Stop the run", "Stop", () => this.do({ action: "stop" }), "Request the run to stop");

  /** `changed` is called after each change, `refused` with the reason of an action that was refused. */
  constructor(
    private readonly token: string | null,
    private readonly changed: () => void,
    private readonly refused: (reason: string) => void,
  ) {
    if (token !== null) this.element.append(this.pause, this.step, this.stop);
    this.show();
  }

  received(status: ControlStatus | null): void {
    this.status = status;
    this.show();
    this.changed();
  }

  /** Whether the page may act on a run that goes on. */
  get able(): boolean {
    return this.token !== null && this.status !== null && !this.status.ended;
  }

  pauseOrResume(): void {
    this.do({ action: this.status?.paused ? "resume" : "pause" });
  }

  do(body: { action: string } & Partial<Place>): void {
    if (!this.able) return;
    void act(this.token!, "control", body).then((reason) => this.refused(reason ?? ""));
  }

  hasBreakpoint(place: Place): boolean {
    return this.status?.breakpoints.some((each) =>
      each.path === place.path && each.outcome === place.outcome && each.round === place.round) ?? false;
  }

  toggleBreakpoint(place: Place): void {
    this.do({ action: this.hasBreakpoint(place) ? "unbreak" : "break", ...place });
  }

  /** What can be done at a state: breakpoints, and for one that waits, its step and its outcomes. */
  partFor(node: StateNode): HTMLElement | null {
    if (!this.able) return null;
    const at = (outcome: string | null, round: Round | null = null): Place => ({ path: node.path, outcome, round });
    const part = html("div", { class: "breakpoints" }, this.box("Pause before it starts", at(null)));
    const rounds = new Set((node.parts ?? []).map(([, , begins]) => begins));
    if (rounds.has("item")) part.append(this.box("Pause before each item", at(null, "item")));
    if (rounds.has("try")) part.append(this.box("Pause before each try", at(null, "try")));
    const leaves = new Set(node.outcomes.map(({ name }) => name));
    for (const name of leaves) part.append(this.box(`Pause when it ends with ${name}`, at(name)));
    for (const { name } of node.repeated ?? []) {
      if (!leaves.has(name)) part.append(this.box(`Pause when a try ends with ${name}`, at(name)));
    }
    const waiting = this.status!.at.find((each) => each.path === node.path);
    if (waiting) part.prepend(this.waiting(waiting));
    return part;
  }

  private waiting({ path, outcome, round, outcomes }: Waiting): HTMLElement {
    const force = outcomes.map((name) =>
      button(`End with ${name}`, name, () => this.do({ action: "outcome", path, outcome: name })));
    const where = round === null ? "It waits before its start." : `It waits before ${round === "try" ? "a try" : "an item"}.`;
    const run = outcome === null ? (round === null ? "Run it" : `Run the ${round}`) : "Go on";
    return html("div", { class: "waiting" },
      html("p", {}, outcome === null ? where : `It has ended with ${outcome} and waits.`),
      button("Run this state", run, () => this.do({ action: "step", path })),
      html("p", {}, "Force an outcome:"),
      html("p", { class: "forced" }, ...force),
    );
  }

  private box(label: string, place: Place): HTMLElement {
    const input = html("input", { type: "checkbox" });
    input.checked = this.hasBreakpoint(place);
    input.addEventListener("change", () => this.toggleBreakpoint(place));
    return html("label", {}, input, ` ${label}`);
  }

  private show(): void {
    this.element.hidden = !this.able;
    const paused = this.status?.paused ?? false;
    this.pause.textContent = paused ? "Resume" : "Pause";
    this.pause.setAttribute("aria-label", paused ? "Resume" : "Pause");
    this.step.disabled = !this.status?.at.length;
    this.stop.disabled = this.status?.stopping ?? false;
  }
}
