// The forms of the edits: which operations a state has, their fields, the edit that they describe.

import { html } from "./dom";
import type { Graph, Path, StateNode } from "./model";
import { isContainer } from "./model";
import { hasTransitions } from "./transition_drag";

export type Arguments = Record<string, string | string[]>;

/** An edit as the server gets it. */
export interface Edit {
  operation: "rename" | "transition" | "add" | "remove" | "contain";
  path: Path;
  arguments: Arguments;
}

/** An edit, and the state to select after it: its path, and the one that it has before. */
export interface Planned {
  edit: Edit;
  then: Path | null;
  old?: Path;
}

export interface StateType {
  name: string;
  doc: string;
  /** Where it comes from, as the heading of its group. */
  group: string;
}

/** One kind of edit: its name in the list, its labelled fields, and what they describe now. */
export interface EditForm {
  title: string;
  fields: HTMLElement[];
  planned(): Planned;
  /** Set the fields: of a transition, or of a state on it. */
  fill?(outcome: string, target: string): void;
}

const NOWHERE = "";

/** The name of the form of a transition. */
export const TRANSITION = "Change a transition";

/** The name of the form of a state on a transition. */
export const BEHIND = "Add a state behind it";

/** A control with its label. */
export function labelled(text: string, control: HTMLElement): HTMLElement {
  control.id = `edit-${text.toLowerCase().replaceAll(" ", "-")}`;
  return html("p", { class: "field" }, html("label", { for: control.id }, text), control);
}

function textField(label: string, value = ""): [HTMLElement, HTMLInputElement] {
  const input = html("input", { type: "text", required: true, autocomplete: "off", spellcheck: "false" });
  input.value = value;
  return [labelled(label, input), input];
}

function choice(label: string, options: [value: string, text: string][]): [HTMLElement, HTMLSelectElement] {
  const select = html("select", {}, ...options.map(([value, text]) => html("option", { value }, text)));
  return [labelled(label, select), select];
}

/** The edits of a state; null is the machine. */
export function formsOf(graph: Graph, node: StateNode | null, types: Promise<StateType[]>): EditForm[] {
  const root = graph.nodes.get(graph.model.root);
  const state = node ?? root;
  if (!state) return [];
  const parent = state.parent === null ? undefined : graph.nodes.get(state.parent);
  const forms: EditForm[] = [];
  if (parent) {
    if (hasTransitions(graph, state)) forms.push(transition(graph, state, parent));
    forms.push(rename(state));
  }
  if (parent) forms.push(add(BEHIND, graph, parent, types, state));
  const last = graph.nodes.get(state.children.at(-1) ?? "");
  if (isContainer(state) && last && state.kind !== "iterator") forms.push(add("Add a state inside", graph, state, types, last));
  if (parent) {
    forms.push(remove(graph, state, parent), contain(graph, state, parent));
  }
  return forms;
}

function beside(graph: Graph, parent: StateNode): StateNode[] {
  return parent.children.map((path) => graph.nodes.get(path)).filter((each) => each !== undefined);
}

/** Where transitions inside a container can lead: its states and its outcomes. */
function targets(graph: Graph, parent: StateNode): [string, string][] {
  const states = beside(graph, parent).map((each): [string, string] => [lastName(each.path), each.name]);
  const ends = parent.outcomes.map(({ name }): [string, string] => [name, `${name} (outcome of ${parent.name})`]);
  return [...states, ...ends];
}

function lastName(path: Path): string {
  return path.slice(path.lastIndexOf("/") + 1);
}

function rename(state: StateNode): EditForm {
  const [label, input] = textField("New name", state.name);
  return {
    title: "Rename",
    fields: [label],
    planned() {
      const name = input.value.trim();
      const path = `${state.parent}/${name}`;
      return { edit: { operation: "rename", path: state.path, arguments: { new: name } }, then: path, old: state.path };
    },
  };
}

function transition(graph: Graph, state: StateNode, parent: StateNode): EditForm {
  const [outcomeLabel, outcome] = choice("Outcome", state.outcomes.map(({ name }) => [name, name]));
  const [targetLabel, target] = choice("Leads to", [...targets(graph, parent), [NOWHERE, "(no transition)"]]);
  const showTarget = (): void => {
    const edge = (graph.leaving.get(state.path) ?? []).find((each) => each.outcome === outcome.value);
    if (!edge) target.value = NOWHERE;
    else target.value = typeof edge.target === "string" ? lastName(edge.target) : edge.target.outcome;
  };
  outcome.addEventListener("change", showTarget);
  showTarget();
  return {
    title: TRANSITION,
    fields: [outcomeLabel, targetLabel],
    fill(name, to) {
      outcome.value = name;
      target.value = to;
    },
    planned() {
      const led: Arguments = target.value === NOWHERE ? {} : { target: target.value };
      return { edit: { operation: "transition", path: state.path, arguments: { outcome: outcome.value, ...led } }, then: state.path };
    },
  };
}

function add(title: string, graph: Graph, parent: StateNode, types: Promise<StateType[]>, after: StateNode): EditForm {
  const [nameLabel, name] = textField("Name of the new state");
  const [typeLabel, type] = choice("State type", []);
  const doc = html("p", { class: "help" });
  const outcomes = parent.kind === "machine" ? after.outcomes.map(({ name }): [string, string] => [name, name]) : [];
  const label = title === BEHIND ? "Outcome that leads to it" : `Outcome of ${after.name} that leads to it`;
  const [onLabel, on] = choice(label, [...outcomes, [NOWHERE, "(none yet)"]]);
  on.value = outcomes.length ? entrance(graph, after) : NOWHERE;
  void types.then((known) => {
    const describe = (): void => {
      doc.textContent = known.find((each) => each.name === type.value)?.doc ?? "";
    };
    const groups = new Map<string, StateType[]>();
    for (const each of known) groups.set(each.group, [...(groups.get(each.group) ?? []), each]);
    type.replaceChildren(...[...groups].map(([group, some]) =>
      html("optgroup", { label: group }, ...some.map((each) => html("option", { value: each.name, title: each.doc }, each.name)))));
    type.addEventListener("change", describe);
    describe();
  });
  return {
    title,
    fields: [nameLabel, typeLabel, doc, ...(outcomes.length ? [onLabel] : [])],
    fill(outcome) {
      on.value = outcome;
      name.focus();
    },
    planned() {
      const given: Arguments = { name: name.value.trim(), type: type.value };
      given["after"] = lastName(after.path);
      if (on.value !== NOWHERE) given["on"] = on.value;
      return { edit: { operation: "add", path: parent.path, arguments: given }, then: `${parent.path}/${name.value.trim()}` };
    },
  };
}

/** The outcome that leads to a new state behind another one at first: one without a transition, else the first one. */
function entrance(graph: Graph, state: StateNode): string {
  const led = new Set((graph.leaving.get(state.path) ?? []).map(({ outcome }) => outcome));
  return (state.outcomes.find(({ name }) => !led.has(name)) ?? state.outcomes.find(({ success }) => success) ?? state.outcomes[0])?.name ?? NOWHERE;
}

function remove(graph: Graph, state: StateNode, parent: StateNode): EditForm {
  const others = targets(graph, parent).filter(([value]) => value !== lastName(state.path));
  const [label, to] = choice("What led to it leads to", [[NOWHERE, "(where its best outcome leads)"], ...others]);
  return {
    title: "Remove",
    fields: parent.kind === "concurrence" ? [] : [label],
    planned() {
      const given: Arguments = to.value === NOWHERE ? {} : { to: to.value };
      return { edit: { operation: "remove", path: state.path, arguments: given }, then: null };
    },
  };
}

function contain(graph: Graph, state: StateNode, parent: StateNode): EditForm {
  const [nameLabel, name] = textField("Name of the container");
  const [typeLabel, type] = choice("Type", [["StateMachine", "StateMachine"], ["Concurrence", "Concurrence: at the same time"]]);
  const boxes = beside(graph, parent).map((each): [HTMLInputElement, StateNode] => {
    const box = html("input", { type: "checkbox" });
    box.checked = each.path === state.path;
    return [box, each];
  });
  const group = html("fieldset", {}, html("legend", {}, "States"), ...boxes.map(([box, each]) => html("label", {}, box, each.name)));
  return {
    title: "Move into a new container",
    fields: [group, nameLabel, typeLabel],
    planned() {
      const states = boxes.filter(([box]) => box.checked).map(([, each]) => each.path);
      const given: Arguments = { name: name.value.trim(), type: type.value, states };
      return { edit: { operation: "contain", path: state.path, arguments: given }, then: `${parent.path}/${name.value.trim()}` };
    },
  };
}
