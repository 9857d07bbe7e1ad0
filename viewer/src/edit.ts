// Edits of the script: the section of the panel with the forms, the preview, and undoing.

import { post, takeToken } from "./connection";
import { button, html } from "./dom";
import type { EditForm, Planned, StateType } from "./edit_fields";
import { BEHIND, TRANSITION, formsOf, labelled } from "./edit_fields";
import type { Finding, Graph, Model, Path, StateNode } from "./model";
import { findings } from "./panel";
import { drawTransitions } from "./transition_drag";
import type { Viewer } from "./viewer";

interface Preview {
  diff: string;
  files: string[];
  added: Finding[];
  removed: Finding[];
  proof: string;
}

/** What is written, and the machine that it makes; no machine if nothing had to be written. */
interface Written {
  files: string[];
  model?: Model;
}

/** Show edits if the server takes them and the page has the token. */
export function showEdits(viewer: Viewer): void {
  const token = viewer.graph.model.editable ? takeToken() : null;
  if (token !== null) new Editor(viewer, token);
}

class Editor {
  private readonly kinds = html("select", {});
  private readonly fields = html("div", {});
  private readonly preview = html("button", { type: "submit" }, "Preview");
  private readonly apply = button("Apply", "Apply", () => void this.write(), "Write the change into the script");
  private readonly undo = button("Undo", "Undo", () => void this.takeBack(), "Undo the last edit (u)");
  private readonly said = html("p", { class: "said", role: "status" });
  private readonly shown = html("div", {});
  private readonly form = html("form", { class: "edit" },
    labelled("Operation", this.kinds),
    this.fields,
    html("div", { class: "acts" }, this.preview, this.apply, this.undo),
    this.said,
    this.shown,
  );
  private forms: EditForm[] = [];
  private readonly types: Promise<StateType[]>;
  private filledFor: { graph: Graph; path: string | null } | null = null;
  private previewed: { planned: Planned; diff: string } | null = null;
  /** The state that each edit changed the path of: selected again when it is undone. */
  private readonly done: Planned[] = [];

  constructor(private readonly viewer: Viewer, private readonly token: string) {
    this.types = stateTypes(token);
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.look();
    });
    this.kinds.addEventListener("change", () => this.showFields());
    this.fields.addEventListener("input", () => this.forget());
    this.forget();
    viewer.addSection({ id: "edit", title: "Edit", first: true, fill: (node) => this.fill(node) });
    document.addEventListener("keydown", (event) => this.key(event));
    drawTransitions(
      viewer,
      (path, outcome, target) => void this.propose(path, outcome, target),
      (path, outcome) => void this.insert(path, outcome),
    );
  }

  /** Show what a transition that was drawn changes. */
  private async propose(path: Path, outcome: string, target: string): Promise<void> {
    await this.viewer.select(path);
    this.kinds.value = TRANSITION;
    this.showFields();
    this.chosen()?.fill?.(outcome, target);
    await this.look();
  }

  /** Offer a new state on a transition. */
  private async insert(path: Path, outcome: string): Promise<void> {
    await this.viewer.select(path);
    this.kinds.value = BEHIND;
    this.showFields();
    this.chosen()?.fill?.(outcome, "");
  }

  /** The form of the selected state; what is typed in stays while the state and the machine stay. */
  private fill(node: StateNode | null): HTMLElement {
    const { graph } = this.viewer;
    const path = node?.path ?? null;
    if (this.filledFor?.graph === graph && this.filledFor.path === path) return this.form;
    if (this.filledFor?.path !== path && !this.said.classList.contains("done")) this.say("");
    const before = this.filledFor?.path === path ? this.kinds.value : "";
    this.filledFor = { graph, path };
    this.forms = formsOf(graph, node, this.types);
    this.kinds.replaceChildren(...this.forms.map(({ title }) => html("option", { value: title }, title)));
    if (this.forms.some(({ title }) => title === before)) this.kinds.value = before;
    this.showFields();
    return this.form;
  }

  private showFields(): void {
    this.fields.replaceChildren(...(this.chosen()?.fields ?? []));
    this.preview.disabled = !this.forms.length;
    this.forget();
  }

  private chosen(): EditForm | undefined {
    return this.forms.find(({ title }) => title === this.kinds.value);
  }

  /** Show what the edit changes. */
  private async look(): Promise<void> {
    const planned = this.chosen()?.planned();
    if (!planned) return;
    this.forget();
    const answer = await post<Preview>(this.token, "edit", planned.edit);
    if (!answer.ok) {
      this.say(answer.reason, "refused");
      return;
    }
    const { content } = answer;
    this.say(content.diff ? content.proof : "The script is like this already.");
    if (!content.diff) return;
    this.shown.replaceChildren(...described(content));
    this.previewed = { planned, diff: content.diff };
    this.apply.disabled = false;
  }

  /** Write the edit that is shown. */
  private async write(): Promise<void> {
    if (!this.previewed) return;
    const { planned, diff } = this.previewed;
    this.undo.focus();
    this.forget();
    const answer = await post<Written>(this.token, "edit", { ...planned.edit, apply: true, diff });
    if (!answer.ok) {
      this.say(answer.reason, "refused");
      return;
    }
    this.done.push(planned);
    await this.show(answer.content, planned.then, planned.old);
    this.say(`Written: ${answer.content.files.join(", ")}`, "done");
  }

  private async takeBack(): Promise<void> {
    const answer = await post<Written>(this.token, "undo", {});
    if (!answer.ok) {
      this.say(answer.reason, "refused");
      return;
    }
    const undone = this.done.pop();
    this.forget();
    await this.show(answer.content, undone?.old ?? null, undone?.then ?? undefined);
    this.say(`Undone: ${answer.content.files.join(", ")}`, "done");
  }

  /** Show the machine after an edit, with the state at `path` selected. `old` is its path before. */
  private async show({ model }: Written, path: string | null, old: string | undefined): Promise<void> {
    if (path !== null) await this.viewer.expect(path, old);
    if (model) await this.viewer.setModel(model);
  }

  /** `done`: the message stays when another state is selected. */
  private say(text: string, tone: "" | "refused" | "done" = ""): void {
    this.said.textContent = text;
    this.said.className = `said ${tone}`.trim();
  }

  /** Remove the preview: it is that of another edit. */
  private forget(): void {
    this.previewed = null;
    this.apply.disabled = true;
    this.shown.replaceChildren();
  }

  private key(event: KeyboardEvent): void {
    if (event.key !== "u" || event.ctrlKey || event.metaKey || event.altKey) return;
    if ((event.target as Element).closest("input, select, textarea")) return;
    event.preventDefault();
    void this.takeBack();
  }
}

/** The state types that a new state can have. */
async function stateTypes(token: string): Promise<StateType[]> {
  const answer = await post<{ types: StateType[] }>(token, "types", {});
  return answer.ok ? answer.content.types : [];
}

function described(preview: Preview): HTMLElement[] {
  const texts = preview.diff.replace(/\n$/, "").split("\n");
  const lines = texts.map((line, index) => {
    const look = line.startsWith("+") ? "more" : line.startsWith("-") ? "less" : null;
    return html("span", { class: look }, ...markedWords(line, otherLine(texts, index)));
  });
  const parts: HTMLElement[] = [
    html("pre", { class: "diff", tabindex: "0", role: "region", "aria-label": "Change of the script" }, html("code", {}, ...lines)),
  ];
  if (preview.added.length) parts.push(html("h4", {}, "New findings"), findings(preview.added));
  if (preview.removed.length) parts.push(html("h4", {}, "Findings that disappear"), findings(preview.removed));
  return parts;
}

/** The line before or behind a changed line of a patch, if it is the same line in the other version; else null. */
function otherLine(lines: string[], index: number): string | null {
  const line = lines[index]!;
  const [sign, step] = line.startsWith("-") ? ["+", 1] : ["-", -1];
  const other = lines[index + Number(step)];
  const isChange = (text: string): boolean => /^[+-](?![+-]{2} )/.test(text);
  return other?.startsWith(String(sign)) && isChange(line) && isChange(other) ? other : null;
}

/** A line with marks on the words that the other version of it does not have. */
export function markedWords(line: string, other: string | null): (string | HTMLElement)[] {
  if (other === null) return [line];
  const [words, others] = [line, other].map((text) => text.slice(1).split(/(\s+|[[\]{},:])/)) as [string[], string[]];
  let start = 0;
  while (start < words.length && words[start] === others[start]) start += 1;
  let end = 0;
  while (end < Math.min(words.length, others.length) - start && words.at(-1 - end) === others.at(-1 - end)) end += 1;
  const middle = words.slice(start, words.length - end).join("");
  if (!middle) return [line];
  return [line[0]! + words.slice(0, start).join(""), html("mark", {}, middle), words.slice(words.length - end).join("")];
}
