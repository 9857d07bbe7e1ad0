// The layout of a machine: each open container on its own, innermost first, then put together.
// No edge crosses the border of a container, so a change inside one leaves the others as they are.

import type { ElkExtendedEdge, ElkNode, ElkPort } from "elkjs/lib/elk-api";
import type { Graph, ModelEdge, Path } from "./model";
import type { Content, Line, Piece } from "./pieces";
import { EXIT_HEIGHT, LINE_HEIGHT, TITLE_HEIGHT, boxSize, chipsOf, contentOf, exitId, writtenExits } from "./pieces";
import { fitting, width } from "./text";
import { kindInWords } from "./model";
import { inRows } from "./rows";
import type { ComputeLayout } from "./worker";

export interface Point {
  x: number;
  y: number;
}

export interface Area extends Point {
  width: number;
  height: number;
}

/** A state in the picture. `level` is its depth, from 0. `written`: edges that it shows as text. */
export interface Box extends Area {
  path: Path;
  open: boolean;
  level: number;
  written: readonly ModelEdge[];
}

export interface PlacedPiece extends Area {
  container: Path;
  piece: Piece;
}

export interface PlacedLine {
  container: Path;
  line: Line;
  points: Point[];
  label: Area | null;
}

/** Everything that is drawn, in absolute coordinates; containers before their content. */
export interface Scene {
  width: number;
  height: number;
  boxes: Box[];
  pieces: PlacedPiece[];
  lines: PlacedLine[];
}

/** Where the picture runs to. */
export type Direction = "DOWN" | "RIGHT";

/** The layout of one container: `frame` is its box, beyond which its outcomes stand out. */
interface Placed {
  direction: Direction;
  frame: { width: number; height: number };
  full: { width: number; height: number };
  entry: number;
  pieces: PlacedPiece[];
  lines: PlacedLine[];
  far: Line[];
  written: Map<Path, ModelEdge[]>;
}

const SIDE = 20;
const TOP = TITLE_HEIGHT + 14;

/** The number of lines in a container from which its layout is simpler, and so faster. */
const MANY = 120;

/** The number of lines, and of states that they pass by, from which the states are put in rows: the
 * layout program would need minutes. */
const VERY_MANY = 300;
const FAR = 1500;

const ROOMY: Record<string, string> = {
  "elk.algorithm": "layered",
  "elk.edgeRouting": "ORTHOGONAL",
  "elk.separateConnectedComponents": "false",
  "elk.spacing.nodeNode": "28",
  "elk.spacing.edgeNode": "18",
  "elk.spacing.edgeEdge": "12",
  "elk.spacing.edgeLabel": "3",
  "elk.spacing.nodeSelfLoop": "14",
  "elk.spacing.portsSurrounding": "[top=12,left=18,bottom=12,right=18]",
  "elk.layered.spacing.nodeNodeBetweenLayers": "30",
  "elk.layered.spacing.edgeNodeBetweenLayers": "14",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "10",
  "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
  "elk.layered.cycleBreaking.strategy": "MODEL_ORDER",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
  "elk.layered.nodePlacement.favorStraightEdges": "true",
  "elk.layered.nodePlacement.networkSimplex.nodeFlexibility.default": "PORT_POSITION",
  "elk.layered.edgeLabels.centerLabelPlacementStrategy": "TAIL_LAYER",
};

const FAST: Record<string, string> = {
  ...ROOMY,
  "elk.layered.nodePlacement.strategy": "BRANDES_KOEPF",
  "elk.layered.layering.strategy": "LONGEST_PATH",
  "elk.layered.thoroughness": "1",
};

/** The space to the right of boxes for the figures of statistics. */
const BESIDE: Record<Direction, Record<string, string>> = {
  DOWN: { "elk.spacing.nodeNode": "100" },
  RIGHT: { "elk.layered.spacing.nodeNodeBetweenLayers": "100" },
};

/** How a layout goes on: `placed` is called with the number of states that have their places, `cancelled`
 * before each container. */
export interface Progress {
  placed(states: number): void;
  cancelled(): boolean;
}

export class Cancelled extends Error {}

/** Layouts of a machine; a container is laid out again only if something in it changed. */
export class Layouts {
  private readonly known = new Map<string, Promise<Placed>>();

  constructor(
    private readonly graph: Graph,
    private readonly compute: ComputeLayout,
    private readonly direction: Direction,
  ) {}

  /** The scene with some containers open; throws `Cancelled`. */
  async scene(open: ReadonlySet<Path>, progress?: Progress): Promise<Scene> {
    const root = this.graph.model.root;
    const placed = new Map<Path, Placed>();
    await this.place(root, open, placed, progress);
    const scene: Scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
    if (!placed.has(root)) {
      const size = this.size(root);
      scene.boxes.push({ path: root, x: 0, y: 0, ...size, open: false, level: 0, written: [] });
      return { ...scene, ...size };
    }
    this.compose(root, { x: 0, y: 0 }, 0, placed, scene);
    for (const [container, { far }] of placed) {
      scene.lines.push(...far.flatMap((line) => this.straight(container, line, scene)));
    }
    const { full } = placed.get(root)!;
    return { ...scene, ...full };
  }

  /** Lay out a container and all open ones in it, one after the other; the key of the layout. */
  private async place(
    path: Path,
    open: ReadonlySet<Path>,
    placed: Map<Path, Placed>,
    progress?: Progress,
  ): Promise<string> {
    const node = this.graph.nodes.get(path);
    if (!node || !open.has(path)) return "";
    const inner: string[] = [];
    for (const child of node.children) if (open.has(child)) inner.push(await this.place(child, open, placed, progress));
    if (progress?.cancelled()) throw new Cancelled();
    const key = JSON.stringify([path, ...inner]);
    let layout = this.known.get(key);
    if (!layout) {
      layout = this.placeContainer(path, open, placed);
      this.known.set(key, layout);
      layout.catch(() => this.known.delete(key));
    }
    placed.set(path, await layout);
    progress?.placed(node.children.length);
    return key;
  }

  private async placeContainer(
    path: Path,
    open: ReadonlySet<Path>,
    placed: Map<Path, Placed>,
  ): Promise<Placed> {
    const node = this.graph.nodes.get(path)!;
    const written = writtenExits(this.graph, path);
    const sizes = new Map(
      node.children.map((child) => [child, placed.get(child)?.full ?? this.size(child, written.get(child))]),
    );
    const content = contentOf(this.graph, path, open, sizes);
    const done = await this.computed(content, placed);
    const title =
      width(fitting(node.name, "title"), "title") +
      width(fitting(kindInWords(node), "detail"), "detail") +
      chipsOf(node).width +
      106;
    return { ...readLayout(content, done, title, this.direction), far: content.far, written };
  }

  private async computed(content: Content, placed: Map<Path, Placed>): Promise<ElkNode> {
    const graph = (fast: boolean): ElkNode => elkGraph(content, placed, this.direction, fast, Boolean(this.graph.model.statistics));
    const rows = (): ElkNode => inRows(graph(true), this.direction === "DOWN", { x: SIDE, y: TOP });
    if (content.lines.length > VERY_MANY || reach(content) > FAR) return rows();
    // ELK fails on a few graphs; it does so less often with fewer options. What it refuses is drawn in rows.
    const simple = (): Promise<ElkNode> => this.compute(graph(true)).catch(rows);
    return content.lines.length > MANY ? simple() : this.compute(graph(false)).catch(simple);
  }

  /** A line from one part of the scene to another one; none where both are in one closed container. */
  private straight(container: Path, line: Line, scene: Scene): PlacedLine[] {
    const from = this.placeOf(container, line.from, scene);
    const to = this.placeOf(container, line.to, scene);
    if (!from || !to || from === to) return [];
    const points = straightLine(from, to);
    const [start, end] = [points[0]!, points[1]!];
    const widest = Math.max(0, ...line.labels.map((text) => width(fitting(text, "label"), "label")));
    const size = { width: widest + 10, height: LINE_HEIGHT * line.labels.length + 4 };
    const label = line.labels.length
      ? { x: (start.x + end.x - size.width) / 2, y: (start.y + end.y - size.height) / 2, ...size }
      : null;
    return [{ container, line, points, label }];
  }

  /** Where an end of a line is: a state, the closed container that hides it, or a mark of the container. */
  private placeOf(container: Path, id: string, scene: Scene): Area | undefined {
    const mark = scene.pieces.find((each) => each.container === container && each.piece.id === id);
    if (mark) return mark;
    for (let node = this.graph.nodes.get(id); node; node = node.parent === null ? undefined : this.graph.nodes.get(node.parent)) {
      const { path } = node;
      const box = scene.boxes.find((each) => each.path === path);
      if (box) return box;
    }
    return undefined;
  }

  private size(path: Path, written: readonly ModelEdge[] = []): { width: number; height: number } {
    const node = this.graph.nodes.get(path)!;
    return boxSize(node, node.children.length, written);
  }

  private compose(path: Path, at: Point, level: number, placed: Map<Path, Placed>, scene: Scene): void {
    const layout = placed.get(path)!;
    scene.boxes.push({ path, ...at, ...layout.frame, open: true, level, written: [] });
    for (const { container, line, points, label } of layout.lines) {
      scene.lines.push({
        container,
        line,
        points: points.map((point) => moved(point, at)),
        label: label && moved(label, at),
      });
    }
    for (const piece of layout.pieces) {
      const here = moved(piece, at);
      if (piece.piece.what !== "state") scene.pieces.push(here);
      else if (placed.has(piece.piece.id)) this.compose(piece.piece.id, here, level + 1, placed, scene);
      else {
        const { x, y, width, height } = here;
        const path = piece.piece.id;
        const written = layout.written.get(path) ?? [];
        scene.boxes.push({ path, x, y, width, height, open: false, level: level + 1, written });
      }
    }
  }
}

/** The line between two areas, from border to border, along the line of their centres. */
export function straightLine(from: Area, to: Area): [Point, Point] {
  const centre = ({ x, y, width, height }: Area): Point => ({ x: x + width / 2, y: y + height / 2 });
  const border = (area: Area, other: Point): Point => {
    const { x, y } = centre(area);
    const [dx, dy] = [other.x - x, other.y - y];
    const scale = Math.min(1, ...[dx ? area.width / 2 / Math.abs(dx) : 1, dy ? area.height / 2 / Math.abs(dy) : 1]);
    return { x: x + dx * scale, y: y + dy * scale };
  };
  return [border(from, centre(to)), border(to, centre(from))];
}

function moved<P extends Point>(point: P, by: Point): P {
  return { ...point, x: point.x + by.x, y: point.y + by.y };
}

/** The number of states that the lines pass by, if the states are in the order of the script. */
function reach(content: Content): number {
  const order = new Map(content.pieces.flatMap((each, index) => (each.what === "state" ? [[each.id, index]] : [])));
  return content.lines.reduce((sum, { from, to }) => {
    const [start, end] = [order.get(from), order.get(to)];
    return start === undefined || end === undefined ? sum : sum + Math.abs(end - start);
  }, 0);
}

/** The graph of a container for ELK. */
function elkGraph(
  content: Content,
  placed: Map<Path, Placed>,
  direction: Direction,
  fast: boolean,
  figures: boolean,
): ElkNode {
  const options = fast ? FAST : ROOMY;
  const [before, after] = direction === "DOWN" ? (["NORTH", "SOUTH"] as const) : (["WEST", "EAST"] as const);
  const padding = direction === "DOWN" ? `bottom=0,right=${SIDE}` : `bottom=${SIDE},right=0`;
  // The outcomes stand on one edge of the container.
  const exits = Math.max(0, ...content.pieces.map((each) => (each.what === "exit" ? each.width : 0)));
  const ports = new Map<string, Map<string, ElkPort>>();
  const port = (piece: string, name: string, side: "NORTH" | "SOUTH" | "WEST" | "EAST"): string => {
    const known = ports.get(piece) ?? new Map<string, ElkPort>();
    ports.set(piece, known);
    const id = `${piece}\n${name}`;
    if (!known.has(id)) {
      known.set(id, { id, width: 0, height: 0, layoutOptions: { "elk.port.side": side } });
    }
    return id;
  };
  const inner = (piece: string): Placed | undefined => placed.get(piece);
  const edges: ElkExtendedEdge[] = content.lines.map((line, index) => ({
    id: `line ${index}`,
    sources: [port(line.from, inner(line.from) ? `out ${line.outcome}` : `out ${index}`, after)],
    targets: [port(line.to, inner(line.to) ? "in" : `in ${look(line)}`, before)],
    labels: line.labels.length ? [labelBox(line)] : [],
    layoutOptions: priorities(line),
  }));
  const leaving = new Map<string, Numbered[]>();
  content.lines.forEach((line, index) => {
    const known = leaving.get(line.from);
    if (known) known.push({ line, index });
    else leaving.set(line.from, [{ line, index }]);
  });
  const portsOf = (piece: string): ElkPort[] => [...(ports.get(piece)?.values() ?? [])];
  return {
    id: content.path,
    layoutOptions: {
      ...options,
      ...(figures ? BESIDE[direction] : {}),
      "elk.direction": direction,
      "elk.padding": `[top=${TOP},left=${SIDE},${padding}]`,
    },
    children: content.pieces.map((piece) => ({
      id: piece.id,
      ...sizeOf(piece, direction, exits),
      ...connections(piece, leaving.get(piece.id) ?? [], portsOf(piece.id), inner(piece.id), direction),
    })),
    edges,
  };
}

interface Numbered {
  line: Line;
  index: number;
}

/** The ports of a piece with the lines that leave it, and how free the layout is to move them. */
function connections(
  piece: Piece,
  leaving: Numbered[],
  ports: ElkPort[],
  inner: Placed | undefined,
  direction: Direction,
): Pick<ElkNode, "ports" | "layoutOptions"> {
  const layoutOptions = { "elk.portConstraints": "FIXED_SIDE", "elk.spacing.portPort": "14", ...constraint(piece) };
  if (inner) {
    const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
    return { ports: portsOfOpen(piece, ports, inner), layoutOptions: fixed };
  }
  const main = piece.what === "state" || piece.what === "start" ? mainLine(leaving) : null;
  if (main !== null) {
    const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
    return { ports: portsAroundMain(piece, ports, `out ${main}`, direction), layoutOptions: fixed };
  }
  if (piece.what === "state" || piece.what === "fork") {
    // ELK fails where ports of a node with an edge to itself are free to move.
    const loops = leaving.some(({ line }) => line.to === piece.id);
    const free = { "elk.layered.nodePlacement.networkSimplex.nodeFlexibility": "PORT_POSITION" };
    return { ports, layoutOptions: { ...layoutOptions, ...(loops ? {} : free) } };
  }
  const centred = { "elk.spacing.portsSurrounding": "[top=0,left=0,bottom=0,right=0]" };
  return { ports, layoutOptions: { ...layoutOptions, ...centred } };
}

/** The number of the only one of the lines that is neither of failure nor of a stop request. */
function mainLine(leaving: Numbered[]): number | null {
  const good = leaving.filter(({ line }) => !line.failure && !line.stop);
  return good.length === 1 ? good[0]!.index : null;
}

const STEP = 18;

/** The ports of a state with one successful outcome: that in the middle, the others on one side. */
function portsAroundMain(piece: Piece, ports: ElkPort[], main: string, direction: Direction): ElkPort[] {
  const size = direction === "DOWN" ? piece.width : piece.height;
  const outs = ports.filter((port) => nameOf(port, piece).startsWith("out "));
  const ins = ports.filter((port) => !outs.includes(port));
  const step = Math.min(STEP, (size / 2 - 8) / Math.max(1, outs.length - 1));
  let others = 0;
  return ports.map((port) => {
    const name = nameOf(port, piece);
    let along = size / 2;
    if (outs.includes(port)) along += name === main ? 0 : (others += 1) * step;
    else if (ins.length > 1) along += { plain: 0, failure: 1, implicit: -1 }[name.slice(3)]! * Math.min(STEP, size / 4);
    const far = outs.includes(port);
    const [x, y] = direction === "DOWN" ? [along, far ? piece.height : 0] : [far ? piece.width : 0, along];
    return { ...port, x, y };
  });
}

const nameOf = (port: ElkPort, piece: Piece): string => port.id.slice(piece.id.length + 1);

/** The size of a piece; bars stand across the direction. */
function sizeOf(piece: Piece, direction: Direction, exits: number): { width: number; height: number } {
  const { width, height } = piece;
  if (direction === "DOWN") return { width, height };
  if (piece.what === "exit") return { width: exits, height };
  if (piece.what === "join" || piece.what === "fork") return { width: height, height: width };
  return { width, height };
}

const look = (line: Line): string => (line.failure ? "failure" : line.implicit ? "implicit" : "plain");

function constraint(piece: Piece): Record<string, string> {
  const name = "elk.layered.layering.layerConstraint";
  if (piece.what === "exit") return { [name]: "LAST_SEPARATE" };
  return piece.what === "start" || piece.what === "fork" ? { [name]: "FIRST_SEPARATE" } : {};
}

function priorities(line: Line): Record<string, string> {
  const main = !line.failure && !line.implicit && !line.stop;
  return {
    "elk.layered.priority.straightness": main ? "100" : "1",
    "elk.layered.priority.shortness": main ? "5" : "1",
  };
}

function labelBox(line: Line): { id: string; text: string; width: number; height: number; layoutOptions: Record<string, string> } {
  const widest = Math.max(...line.labels.map((text) => width(fitting(text, "label"), "label")));
  return {
    id: `${line.from} ${line.to} label`,
    text: line.labels.join("\n"),
    width: widest + 10,
    height: LINE_HEIGHT * line.labels.length + 4,
    layoutOptions: { "elk.edgeLabels.inline": "true", "elk.edgeLabels.placement": "CENTER" },
  };
}

/** The ports of an open container: at its start and at its outcomes. */
function portsOfOpen(piece: Piece, ports: ElkPort[], inner: Placed): ElkPort[] {
  const down = inner.direction === "DOWN";
  const exits = new Map(
    inner.pieces
      .filter((each) => each.piece.what === "exit")
      .map((each) => [each.piece.id, down ? each.x + each.width / 2 : each.y + each.height / 2]),
  );
  return ports.map((port) => {
    const name = nameOf(port, piece);
    if (name === "in") {
      const side = { "elk.port.side": down ? "NORTH" : "WEST" };
      return { ...port, layoutOptions: side, x: down ? inner.entry : 0, y: down ? 0 : inner.entry };
    }
    const along = exits.get(exitId(name.slice("out ".length))) ?? inner.full.width / 2;
    const side = { "elk.port.side": down ? "SOUTH" : "EAST" };
    const [x, y] = down ? [along, inner.full.height] : [inner.full.width, along];
    return { ...port, layoutOptions: side, x, y };
  });
}

/** The layout of a container from the answer of ELK. `title` is the width that its title needs. */
function readLayout(content: Content, done: ElkNode, title: number, direction: Direction): Omit<Placed, "far" | "written"> {
  const places = new Map((done.children ?? []).map((each) => [each.id, each]));
  const down = direction === "DOWN";
  const least = Math.max(title, 120);
  const spare = Math.max(0, least - (done.width ?? 0));
  const shift = { x: down ? spare / 2 : spare, y: 0 };
  const pieces = content.pieces.map((piece) => {
    const { x = 0, y = 0, width = 0, height = 0 } = places.get(piece.id) ?? {};
    return { container: content.path, piece, ...moved({ x, y }, shift), width, height };
  });
  const lines = (done.edges ?? []).map((edge, index) => {
    const section = edge.sections?.[0];
    const { from, to } = content.lines[index]!;
    // An edge that the library leaves without a route is drawn straight.
    const points = section
      ? [section.startPoint, ...(section.bendPoints ?? []), section.endPoint]
      : straightLine(areaOf(places.get(from)), areaOf(places.get(to)));
    const box = edge.labels?.[0];
    const label = box && { x: box.x ?? 0, y: box.y ?? 0, width: box.width ?? 0, height: box.height ?? 0 };
    return {
      container: content.path,
      line: content.lines[index]!,
      points: points.map((point) => moved(point, shift)),
      label: label ? moved(label, shift) : null,
    };
  });
  const start = pieces[0]!;
  const entry = down ? start.x + start.width / 2 : start.y + start.height / 2;
  return { direction, ...frames(pieces, done, least, down), entry, pieces, lines };
}

function areaOf({ x = 0, y = 0, width = 0, height = 0 }: Partial<Area> = {}): Area {
  return { x, y, width, height };
}

/** The frame of a container, and its size with the outcomes that stand out. */
function frames(
  pieces: PlacedPiece[],
  done: ElkNode,
  least: number,
  down: boolean,
): Pick<Placed, "frame" | "full"> {
  const exits = pieces.filter((each) => each.piece.what === "exit");
  const width = Math.max(least, done.width ?? 0);
  const height = done.height ?? 0;
  if (down) {
    const bottom = Math.max(0, ...exits.map((each) => each.y + each.height));
    const frame = { width, height: exits.length ? bottom - EXIT_HEIGHT / 2 : height + SIDE };
    return { frame, full: { width, height: Math.max(bottom, frame.height) } };
  }
  const right = Math.max(0, ...exits.map((each) => each.x + each.width));
  const widest = Math.max(0, ...exits.map((each) => each.width));
  const frame = { width: exits.length ? right - widest / 2 : width + SIDE, height };
  return { frame, full: { width: Math.max(right, frame.width), height } };
}
