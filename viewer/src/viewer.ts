// The viewer: the page's parts and their state. Other modules extend it through `Viewer`.

import { Camera } from "./camera";
import { button, html, svg } from "./dom";
import type { Highlight, Picture } from "./draw";
import { addTooltip, draw, markRun, markSelection } from "./draw";
import type { Box, Direction, Scene } from "./layout";
import { Cancelled, Layouts } from "./layout";
import type { Graph, Model, Path } from "./model";
import { ancestors, firstOpen, indexed, isContainer, isNewer, nearest } from "./model";
import { neighbour, readDirection } from "./navigation";
import type { Section } from "./panel";
import { fillPanel } from "./panel";
import { searchField } from "./search";
import { themeSwitch } from "./theme";
import type { ComputeLayout } from "./worker";

/** What other modules use: the run of a machine, replay, edits. */
export interface Viewer {
  /** The machine that is shown. */
  readonly graph: Graph;
  /** The selected state, null for the machine. */
  readonly selected: Path | null;
  /** Places for the elements of other modules: in the bar at the top, and below the picture. */
  readonly toolbar: HTMLElement;
  readonly footer: HTMLElement;
  /** The picture: its frame, and the part of it that zoom and pan move. */
  readonly frame: SVGSVGElement;
  readonly world: SVGGElement;
  /** Select a state, open the containers around it and show it. */
  select(path: Path | null): Promise<void>;
  /** Mark active states and transitions that were taken; null removes the marks. */
  highlight(run: Highlight | null): void;
  /** Add a section to the panel; `refresh` fills all sections again. */
  addSection(section: Section): void;
  refresh(): void;
  /** Show a later version of the machine: selection, zoom and open containers stay. Nothing changes if
   * that version or a later one is shown. */
  setModel(model: Model): Promise<void>;
  /** Select a state as soon as the machine has it. `old` is the path that it has before. */
  expect(path: Path, old?: Path): Promise<void>;
  /** Zoom so that the whole machine is seen. */
  fit(): void;
  /** A message in the line below the picture, with more that is shown on a click; empty removes it. */
  notice(text: string, more?: Node | null): void;
  /** Call a function after each selection. */
  onSelect(listener: (path: Path | null) => void): void;
  /** Call a function now, and after the picture was drawn or another state was selected. */
  onMark(listener: (picture: Picture) => void): void;
}

/** The number of states that are shown at first, if the machine has more. */
const SHOWN_AT_FIRST = 150;

/** The scale from which on states are seen at all. */
const TINY = 0.1;

/** The time after which the progress of a layout is shown, in milliseconds. */
const SLOW = 300;

/** The least scale at first: containers that would make the picture smaller are closed. */
const READABLE = 0.55;

export async function createViewer(page: HTMLElement, model: Model, compute: ComputeLayout): Promise<Viewer> {
  let graph = indexed(model);
  let direction: Direction = "DOWN";
  let layouts = new Layouts(graph, compute, direction);
  let open = new Set<Path>([graph.model.root]);
  let kept = new Set<Path>();
  let selected: Path | null = null;
  let scene: Scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
  let picture: Picture | null = null;
  let run: Highlight | null = null;
  let latest = 0;
  let expected: { path: Path; old: Path | undefined } | null = null;
  const sections: Section[] = [];
  const listeners: ((path: Path | null) => void)[] = [];
  const markers: ((picture: Picture) => void)[] = [];

  const world = svg("g", {});
  const frame = svg("svg", { class: "picture", role: "group", "aria-label": "State graph" }, world);
  const panel = html("aside", { "aria-label": "Details" });
  const notice = html("div", { class: "notice", role: "status" });
  const progressText = html("span", { role: "status" });
  const progress = html("p", { class: "notice progress", hidden: true }, progressText, " ",
    button("Cancel the layout", "Cancel", () => cancel(), "Keep the picture as it is (Escape)"));
  const footer = html("footer", {});
  const toolbar = html("div", { class: "tools" });
  const camera = new Camera(frame, world);

  const boxOf = (path: Path | null): Box | undefined => scene.boxes.find((box) => box.path === path);
  const whole = (): void => camera.fit({ x: -6, y: -6, width: scene.width + 12, height: scene.height + 12 });

  /** Open as many levels of containers as can be read without moving the picture. */
  async function openReadable(): Promise<void> {
    for (let depth = 1; ; depth += 1) {
      const deeper = firstOpen(graph, depth, SHOWN_AT_FIRST);
      if (depth > 1 && deeper.size === open.size) break;
      // A picture becomes no smaller when containers open.
      const readable = camera.fitting(await arranged(deeper)) >= READABLE;
      if (depth === 1 || readable) open = kept = deeper;
      if (!readable) break;
    }
  }

  async function openFirst(): Promise<void> {
    try {
      await openReadable();
    } catch (error) {
      if (!(error instanceof Cancelled)) throw error;
    }
    await redraw(null);
    showStart(READABLE / 1.5);
  }

  /** Show the whole machine, or its start if the machine is seen as a whole at less than a scale only. */
  function showStart(least: number): void {
    const start = scene.pieces.find((each) => each.container === graph.model.root && each.piece.id === "start");
    if (start && camera.fitting(scene) < least) camera.start(start, scene.width, READABLE);
    else whole();
  }

  /** The scene with some containers open. Its progress is a message; a later layout cancels this one. */
  async function arranged(paths: ReadonlySet<Path>): Promise<Scene> {
    latest += 1;
    const mine = latest;
    const count = [...paths].reduce((sum, path) => sum + (graph.nodes.get(path)?.children.length ?? 0), 0);
    let done = 0;
    frame.setAttribute("aria-busy", "true");
    const slow = window.setTimeout(() => progress.hidden = false, SLOW);
    const report = (): void => {
      const numbers = [done, count].map((each) => each.toLocaleString("en"));
      progressText.textContent = `Laying out ${numbers[0]} of ${numbers[1]} states`;
    };
    report();
    try {
      const cancelled = (): boolean => mine !== latest;
      const placed = (states: number): void => {
        done += states;
        if (!cancelled()) report();
      };
      const next = await layouts.scene(paths, { placed, cancelled });
      if (cancelled()) throw new Cancelled();
      return next;
    } finally {
      window.clearTimeout(slow);
      if (mine === latest) {
        progress.hidden = true;
        frame.removeAttribute("aria-busy");
      }
    }
  }

  /** End the layout that goes on; what is drawn stays. */
  function cancel(): void {
    latest += 1;
    open = new Set(kept);
    progress.hidden = true;
    frame.removeAttribute("aria-busy");
  }

  /** Lay out and draw again; `anchor` is the state that stays where it is on the screen. Whether it was
   * drawn. */
  async function redraw(anchor: Path | null): Promise<boolean> {
    const before = boxOf(anchor);
    const paths = new Set(open);
    let next: Scene;
    try {
      next = await arranged(paths);
    } catch (error) {
      if (error instanceof Cancelled) return false;
      notice.textContent = `The layout failed: ${error instanceof Error ? error.message : String(error)}`;
      return false;
    }
    const focused = frame.contains(document.activeElement);
    scene = next;
    kept = paths;
    picture = draw(graph, scene);
    world.replaceChildren(picture.root);
    const after = boxOf(anchor);
    if (before && after) camera.keep(before, after);
    mark();
    if (focused) focusSelected();
    return true;
  }

  function mark(): void {
    if (!picture) return;
    markSelection(picture, selected, selected ?? graph.model.root);
    markRun(graph, picture, run);
    for (const each of markers) each(picture);
  }

  function focusSelected(): void {
    picture?.states.get(selected ?? graph.model.root)?.focus({ preventScroll: true });
  }

  function refresh(): void {
    const node = selected === null ? null : (graph.nodes.get(selected) ?? null);
    fillPanel(panel, graph, node, sections, { select: (path) => void select(path), toggle: (path) => void toggle(path) });
  }

  async function select(path: Path | null): Promise<void> {
    selected = path !== null && graph.nodes.has(path) ? path : null;
    expected = null;
    const closed = selected === null ? [] : ancestors(graph, selected).filter((each) => !open.has(each));
    closed.forEach((each) => open.add(each));
    writeFragment(selected);
    refresh();
    if (closed.length) await redraw(closed[0]!);
    else mark();
    const box = boxOf(selected);
    if (box) camera.reveal(box);
    for (const listener of listeners) listener(selected);
  }

  async function toggle(path: Path): Promise<void> {
    const node = graph.nodes.get(path);
    if (!node || !isContainer(node)) return;
    if (open.has(path)) open.delete(path);
    else open.add(path);
    if (selected !== null && ancestors(graph, selected).includes(path) && !open.has(path)) selected = path;
    await redraw(path);
  }

  async function openAll(all: boolean): Promise<void> {
    const containers = graph.model.nodes.filter(isContainer).map((node) => node.path);
    open = new Set(all ? containers : [graph.model.root]);
    if (selected !== null && !all) selected = ancestors(graph, selected)[1] ?? selected;
    if (await redraw(null)) showStart(TINY);
  }

  async function turn(): Promise<void> {
    direction = direction === "DOWN" ? "RIGHT" : "DOWN";
    layouts = new Layouts(graph, compute, direction);
    if (await redraw(null)) showStart(TINY);
  }

  async function setModel(next: Model): Promise<void> {
    if (!isNewer(next, graph.model)) return;
    const opened = [...open].map(newPath);
    graph = indexed(next);
    layouts = new Layouts(graph, compute, direction);
    open = new Set([next.root, ...opened.filter((path) => graph.nodes.has(path))]);
    if (selected !== null) selected = newPath(selected);
    if (selected !== null && !graph.nodes.has(selected)) selected = nearest(graph, selected)?.path ?? null;
    document.title = next.name;
    title.textContent = next.name;
    refresh();
    await redraw(selected ?? next.root);
    if (expected) await expect(expected.path, expected.old);
  }

  /** The path of a state in the next version, which may rename the expected one. */
  function newPath(path: Path): Path {
    const { path: next, old } = expected ?? {};
    if (next === undefined || old === undefined || !`${path}/`.startsWith(`${old}/`)) return path;
    return next + path.slice(old.length);
  }

  async function expect(path: Path, old?: Path): Promise<void> {
    expected = graph.nodes.has(path) ? null : { path, old };
    if (!expected) await select(path);
  }

  const title = html("h1", {}, model.name);
  const field = searchField(() => graph, (path) => void select(path).then(focusSelected), focusSelected);
  const view = html("div", { class: "tools", role: "group", "aria-label": "View" },
    button("Zoom out", "−", () => camera.zoom(1 / 1.25), "Zoom out (-)"),
    button("Fit: show the whole machine", "Fit", whole, "Show the whole machine (f)"),
    button("Zoom in", "+", () => camera.zoom(1.25), "Zoom in (+)"),
    button("Open all containers", "Open all", () => void openAll(true), "Open all containers (e)"),
    button("Close all containers", "Close all", () => void openAll(false), "Close all containers (c)"),
    button("Turn the picture: down or to the right", "Turn", () => void turn(), "Down or to the right (d)"),
    themeSwitch(),
  );
  page.append(
    html("header", {}, title, toolbar, field, view),
    html("main", {}, frame, notice, progress, footer),
    panel,
  );

  frame.addEventListener("click", (event) => {
    const element = event.target as Element;
    const path = element.closest("[data-path]")?.getAttribute("data-path") ?? null;
    if (path !== null && element.closest(".toggle")) {
      void toggle(path).then(() => select(path));
      return;
    }
    void select(path).then(() => path !== null && focusSelected());
  });
  frame.addEventListener("pointerover", (event) => {
    const element = (event.target as Element).closest("[data-path]");
    const node = graph.nodes.get(element?.getAttribute("data-path") ?? "");
    if (element && node) addTooltip(element, node);
  });
  frame.addEventListener("dblclick", (event) => {
    const path = (event.target as Element).closest("[data-path]")?.getAttribute("data-path");
    if (path) void toggle(path);
  });
  frame.addEventListener("focusin", (event) => {
    const path = (event.target as Element).getAttribute("data-path");
    if (path !== null && path !== selected && (event.target as Element).matches(":focus-visible")) void select(path);
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = (event.target as Element).closest("input, select, textarea, [contenteditable]");
    if (typing) return;
    const inPicture = frame.contains(event.target as Node) || event.target === document.body;
    if (key(event, inPicture)) event.preventDefault();
  });
  window.addEventListener("hashchange", () => {
    const path = readFragment();
    if (path !== selected) void select(path);
  });

  /** Handle a key; whether it means something here. */
  function key(event: KeyboardEvent, inPicture: boolean): boolean {
    const direction = readDirection(event.key);
    if (direction && inPicture) {
      const next = neighbour(scene.boxes, selected ?? graph.model.root, direction, graph);
      if (next !== null) void select(next).then(focusSelected);
      return true;
    }
    if ((event.key === "Enter" || event.key === " ") && inPicture) {
      void toggle(selected ?? graph.model.root);
      return true;
    }
    if (event.key === "Escape" && !progress.hidden) {
      cancel();
      return true;
    }
    if (event.key === "Escape") {
      const parent = selected === null ? null : (graph.nodes.get(selected)?.parent ?? null);
      void select(parent).then(focusSelected);
      return true;
    }
    const actions: Record<string, () => void> = {
      "/": () => page.querySelector<HTMLInputElement>("#search")?.focus(),
      "+": () => camera.zoom(1.25),
      "=": () => camera.zoom(1.25),
      "-": () => camera.zoom(1 / 1.25),
      f: whole,
      "0": whole,
      e: () => void openAll(true),
      c: () => void openAll(false),
      d: () => void turn(),
    };
    actions[event.key]?.();
    return event.key in actions;
  }

  refresh();
  await openFirst();
  await select(readFragment());

  return {
    get graph() {
      return graph;
    },
    get selected() {
      return selected;
    },
    toolbar,
    footer,
    frame,
    world,
    select,
    highlight(next) {
      run = next;
      if (picture) markRun(graph, picture, run);
    },
    addSection(section) {
      sections.push(section);
      refresh();
    },
    refresh,
    setModel,
    expect,
    fit: whole,
    notice(text, more = null) {
      if (text && more) notice.replaceChildren(html("details", {}, html("summary", {}, text), more));
      else notice.textContent = text;
    },
    onSelect(listener) {
      listeners.push(listener);
    },
    onMark(listener) {
      markers.push(listener);
      mark();
    },
  };
}

/** The state in the fragment of the address, which may hold other parameters too. */
function readFragment(): Path | null {
  return new URLSearchParams(location.hash.slice(1)).get("state");
}

function writeFragment(path: Path | null): void {
  const parameters = new URLSearchParams(location.hash.slice(1));
  if (path === null) parameters.delete("state");
  else parameters.set("state", path);
  const text = parameters.toString().replaceAll("%2F", "/");
  if (text !== location.hash.slice(1)) history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
}
