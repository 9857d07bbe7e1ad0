// Search over states, types, keys and outcomes.

import { html } from "./dom";
import type { Graph, Path, StateNode } from "./model";

export interface Hit {
  node: StateNode;
  /** What of the state has the text, if that is not its name. */
  reason: string;
  rank: number;
}

const MOST = 50;

/** The states that match a text, the best first. */
export function search(graph: Graph, text: string): Hit[] {
  const wanted = text.trim().toLowerCase();
  if (!wanted) return [];
  const hits: Hit[] = [];
  for (const node of graph.model.nodes) {
    const hit = match(node, wanted);
    if (hit) hits.push({ node, ...hit });
  }
  return hits.sort((a, b) => a.rank - b.rank).slice(0, MOST);
}

function match(node: StateNode, wanted: string): { rank: number; reason: string } | null {
  const name = node.name.toLowerCase();
  if (name === wanted) return { rank: 0, reason: "" };
  if (name.startsWith(wanted)) return { rank: 1, reason: "" };
  if (name.includes(wanted)) return { rank: 2, reason: "" };
  const has = (value: string | null): boolean => value !== null && value.toLowerCase().includes(wanted);
  if (has(node.type)) return { rank: 3, reason: `type ${node.type}` };
  for (const key of [...node.inputs, ...node.outputs]) {
    if (has(key.name) || has(key.key)) return { rank: 4, reason: `key ${has(key.name) ? key.name : key.key}` };
  }
  const outcome = node.outcomes.find((each) => has(each.name));
  if (outcome) return { rank: 5, reason: `outcome ${outcome.name}` };
  const badge = node.badges.find((each) => has(each.text) || has(each.field));
  if (badge) return { rank: 5, reason: badge.text };
  const tag = node.tags.find(has);
  if (tag) return { rank: 5, reason: `tag ${tag}` };
  if (has(node.path)) return { rank: 6, reason: "path" };
  return has(node.doc) ? { rank: 7, reason: "doc" } : null;
}

/** The field with its list of hits: arrows choose one, Enter goes to it, Escape leaves. */
export function searchField(graph: () => Graph, select: (path: Path) => void, leave: () => void): HTMLElement {
  const list = html("ul", { id: "hits", role: "listbox", "aria-label": "States found", hidden: true });
  const field = html("input", {
    type: "search", id: "search", placeholder: "Search  /", autocomplete: "off", spellcheck: "false",
    role: "combobox", "aria-label": "Search states, types, keys and outcomes",
    "aria-controls": "hits", "aria-expanded": "false", "aria-autocomplete": "list",
  });
  let hits: Hit[] = [];
  let chosen = 0;
  const show = (): void => {
    const open = field.value.trim() !== "";
    list.hidden = !open;
    field.setAttribute("aria-expanded", String(open));
    if (hits.length) field.setAttribute("aria-activedescendant", `hit-${chosen}`);
    else field.removeAttribute("aria-activedescendant");
    list.replaceChildren(...hits.map(row));
    if (open && !hits.length) {
      list.append(html("li", { role: "option", "aria-disabled": "true", "aria-selected": "false" }, "nothing found"));
    }
    list.children[chosen]?.scrollIntoView({ block: "nearest" });
  };
  const go = (index: number): void => {
    const hit = hits[index];
    if (!hit) return;
    clear();
    select(hit.node.path);
  };
  const clear = (): void => {
    field.value = "";
    hits = [];
    show();
  };
  const row = ({ node, reason }: Hit, index: number): HTMLElement => {
    const around = node.parent === null ? "" : node.parent;
    const item = html("li", { id: `hit-${index}`, role: "option", "aria-selected": String(index === chosen) },
      html("strong", {}, node.name), " ", html("span", {}, [reason, around].filter(Boolean).join(", ")));
    item.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      go(index);
    });
    return item;
  };
  field.addEventListener("input", () => {
    hits = search(graph(), field.value);
    chosen = 0;
    show();
  });
  field.addEventListener("blur", () => {
    list.hidden = true;
    field.setAttribute("aria-expanded", "false");
  });
  field.addEventListener("focus", () => show());
  field.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.key === "Escape") {
      clear();
      leave();
    } else if (event.key === "Enter") go(chosen);
    else if ((event.key === "ArrowDown" || event.key === "ArrowUp") && hits.length) {
      event.preventDefault();
      chosen = (chosen + (event.key === "ArrowDown" ? 1 : hits.length - 1)) % hits.length;
      show();
    }
  });
  return html("div", { class: "search" }, field, list);
}
