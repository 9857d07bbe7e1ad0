// A transition drawn with the mouse: from an outcome of a state to another state or to an outcome of the
// container around it.

import { svg } from "./dom";
import type { Picture } from "./draw";
import type { Point } from "./layout";
import type { Graph, Path, StateNode } from "./model";
import type { Viewer } from "./viewer";

/** The state and the outcome at which a transition starts. */
interface Origin {
  path: Path;
  outcome: string;
}

/** Where a transition leads: a name in its container, and the element that shows it. */
interface Target {
  name: string;
  element: Element;
}

/** The distance that makes a drag of a click, in pixels. */
const FAR_ENOUGH = 4;

const HANDLE_RADIUS = 6;

/** Let transitions be drawn; `drawn` is called with each one at its end, `clicked` with one that is not moved. */
export function drawTransitions(
  viewer: Viewer,
  drawn: (path: Path, outcome: string, target: string) => void,
  clicked: (path: Path, outcome: string) => void,
): void {
  const { frame, world } = viewer;
  frame.classList.add("editable");
  viewer.onMark((picture) => addHandles(viewer.graph, picture, viewer.selected));
  // Before the camera, which moves the picture.
  frame.addEventListener("pointerdown", (event) => {
    const origin = originAt(viewer.graph, event.target as Element);
    if (!origin || event.button !== 0) return;
    event.stopPropagation();
    event.preventDefault();
    drag(viewer.graph, frame, world, event, origin, {
      dropped: (target) => drawn(origin.path, origin.outcome, target),
      clicked: () => clicked(origin.path, origin.outcome),
    });
  }, { capture: true });
}

/** Whether the transitions of a state are those of its outcomes. */
export function hasTransitions(graph: Graph, node: StateNode): boolean {
  const parent = node.parent === null ? undefined : graph.nodes.get(node.parent);
  return parent !== undefined && parent.kind !== "concurrence" && node.outcomes.length > 0;
}

/** The outcome that an element stands for: a handle, the label of a line, or its end. */
function originAt(graph: Graph, element: Element): Origin | null {
  const found = element.closest("[data-from]");
  const path = found?.getAttribute("data-from") ?? "";
  const outcome = found?.getAttribute("data-outcome") ?? "";
  const node = graph.nodes.get(path);
  if (!node || !hasTransitions(graph, node)) return null;
  return node.outcomes.some(({ name }) => name === outcome) ? { path, outcome } : null;
}

/** A handle for each outcome of the selected state, at the lower border of its box. */
function addHandles(graph: Graph, { root, states }: Picture, selected: Path | null): void {
  root.querySelector(":scope > .handles")?.remove();
  const element = selected === null ? undefined : states.get(selected);
  const node = selected === null ? undefined : graph.nodes.get(selected);
  const body = element?.querySelector(":scope > .body");
  if (!element || !node || !body || !hasTransitions(graph, node)) return;
  const apart = Number(body.getAttribute("width")) / (node.outcomes.length + 1);
  const handles = node.outcomes.map(({ name, failure }, index) => svg("circle", {
    class: failure ? "failure" : null,
    "data-from": node.path,
    "data-outcome": name,
    cx: apart * (index + 1),
    cy: body.getAttribute("height"),
    r: Math.min(HANDLE_RADIUS, apart / 2),
  }, svg("title", {}, `${name}: draw it to a state or an outcome`)));
  root.append(svg("g", {
    class: "handles",
    "aria-hidden": "true",
    transform: element.getAttribute("transform"),
  }, ...handles));
}

interface Ends {
  dropped(target: string): void;
  clicked(): void;
}

/** Draw a line from the origin to the pointer until it is released. Escape ends it without effect. */
function drag(
  graph: Graph,
  frame: SVGSVGElement,
  world: SVGGElement,
  start: PointerEvent,
  origin: Origin,
  ends: Ends,
): void {
  const from = place(world, start);
  const path = svg("path", { class: "stroke" });
  const text = svg("text", { class: "words", x: 0, y: 0 });
  const line = svg("g", { class: "drawn", "aria-hidden": "true" }, path, text);
  let target: Target | null = null;
  let moving = false;
  const move = (event: PointerEvent): void => {
    if (!moving && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < FAR_ENOUGH) return;
    if (!moving) world.append(line);
    moving = true;
    const to = place(world, event);
    target?.element.classList.remove("drop");
    target = targetAt(graph, origin, event);
    target?.element.classList.add("drop");
    path.setAttribute("d", `M${from.x} ${from.y}L${to.x} ${to.y}`);
    text.setAttribute("x", String(to.x + 14));
    text.setAttribute("y", String(to.y - 8));
    text.textContent = target ? `${origin.outcome} → ${target.name}` : origin.outcome;
  };
  const end = (event: Event): void => {
    line.remove();
    target?.element.classList.remove("drop");
    const listeners = { pointermove: move, pointerup: end, pointercancel: end };
    for (const [name, listener] of Object.entries(listeners)) window.removeEventListener(name, listener as EventListener);
    document.removeEventListener("keydown", escape, { capture: true });
    if (event.type === "pointerup") {
      // The click at the end selects nothing.
      frame.addEventListener("click", stop, { capture: true, once: true });
      window.setTimeout(() => frame.removeEventListener("click", stop, { capture: true }));
    }
    if (event.type !== "pointerup") return;
    if (!moving) ends.clicked();
    else if (target) ends.dropped(target.name);
  };
  const stop = (event: Event): void => event.stopPropagation();
  const escape = (event: KeyboardEvent): void => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    end(event);
  };
  window.addEventListener("pointermove", move);
  window.addEventListener("pointerup", end);
  window.addEventListener("pointercancel", end);
  document.addEventListener("keydown", escape, { capture: true });
}

/** The place of the pointer in the coordinates of the picture. */
function place(world: SVGGElement, event: PointerEvent): Point {
  const matrix = world.getScreenCTM();
  return matrix ? new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse()) : { x: 0, y: 0 };
}

/** Where a transition from the origin can lead at the pointer: a state of its container, also where the
 * pointer is on a state inside that one, or an outcome of the container. */
function targetAt(graph: Graph, origin: Origin, event: PointerEvent): Target | null {
  const container = graph.nodes.get(origin.path)?.parent;
  const shown = document.elementsFromPoint(event.clientX, event.clientY).find((each) =>
    !each.closest(".drawn, .handles, .line, .label") && each.closest("[data-path], [data-exit]"));
  const element = shown?.closest("[data-path], [data-exit]");
  if (!element || !container) return null;
  const exit = element.getAttribute("data-exit");
  if (exit !== null) return element.getAttribute("data-of") === container ? { name: exit, element } : null;
  const path = element.getAttribute("data-path") ?? "";
  if (!path.startsWith(`${container}/`)) return null;
  const name = path.slice(container.length + 1).split("/")[0]!;
  const state = document.querySelector(`.state[data-path="${CSS.escape(`${container}/${name}`)}"]`);
  return state && { name, element: state };
}
