// The layout of a container with very many lines, in time linear in them: its states in rows, in the
// order of the script. Lines run between the rows and the columns, so that they cross no state.

import type { ElkExtendedEdge, ElkNode, ElkPort } from "elkjs/lib/elk-api";
import { exitId } from "./pieces";

/** The widths of the spaces for lines between rows and between columns, of which each has tracks. */
const MARGIN = 12;
const TRACK = 5;
const ROW_TRACKS = 6;
const COLUMN_TRACKS = 4;

/** The ratio of the width of the picture to its height. */
const RATIO = 1.5;

/** `along` is the place in a row, `across` that of the row: x and y, if the picture runs down. */
interface Cell {
  node: ElkNode;
  row: number;
  column: number;
  along: number;
  across: number;
}

interface Grid {
  down: boolean;
  cells: Map<string, Cell>;
  /** The end of each row, of the labels below it, and the start of the space before each column. */
  ends: number[];
  labelEnds: number[];
  before: number[];
  size: { along: number; across: number };
}

type Size = { width?: number; height?: number };
const lengthOf = (each: Size, down: boolean): number => (down ? each.width : each.height) ?? 0;
const depthOf = (each: Size, down: boolean): number => (down ? each.height : each.width) ?? 0;

/** The graph with the places of its nodes, edges and labels, as the layout program returns it. The first
 * node is the start of the container. */
export function inRows(graph: ElkNode, down: boolean, origin: { x: number; y: number }): ElkNode {
  const cells = cellsOf(graph.children ?? [], down);
  const edges = graph.edges ?? [];
  const grid = placeCells(cells, edges, down, down ? [origin.x, origin.y] : [origin.y, origin.x]);
  const ports = portsOf(cells, down);
  const stacked = new Map<string, number>();
  const place = (along: number, across: number): { x: number; y: number } =>
    down ? { x: along, y: across } : { x: across, y: along };
  return {
    id: graph.id,
    ...(down
      ? { width: grid.size.along, height: grid.size.across }
      : { width: grid.size.across, height: grid.size.along }),
    children: [...cells.values()].map(({ node, along, across }) => ({ ...node, ...place(along, across) })),
    edges: edges.map((edge) => {
      const route = routeOf(edge, grid, ports);
      const points = route.map(([along, across]) => place(along, across));
      return {
        ...edge,
        sections: [{ id: edge.id, startPoint: points[0]!, bendPoints: points.slice(1, -1), endPoint: points.at(-1)! }],
        labels: (edge.labels ?? []).map((label) => {
          const [along, across] = labelPlace(edge, label, route, grid, stacked);
          return { ...label, ...place(along - lengthOf(label, down) / 2, across) };
        }),
      };
    }),
  };
}

const pieceOf = (port: string): string => port.slice(0, port.indexOf("\n"));
const sourceOf = (edge: ElkExtendedEdge): string => pieceOf(edge.sources[0]!);
const targetOf = (edge: ElkExtendedEdge): string => pieceOf(edge.targets[0]!);

/** The rows: the start, the states, the outcomes of the container. */
function cellsOf(nodes: ElkNode[], down: boolean): Map<string, Cell> {
  const isExit = (node: ElkNode): boolean => node.id.startsWith(exitId(""));
  const [first, ...others] = nodes;
  const inside = others.filter((node) => !isExit(node));
  const mean = (size: (node: ElkNode) => number): number =>
    inside.reduce((sum, node) => sum + size(node), 0) / Math.max(1, inside.length) + 50;
  const ratio = (down ? RATIO : 1 / RATIO) * (mean((node) => depthOf(node, down)) / mean((node) => lengthOf(node, down)));
  const columns = Math.max(1, Math.round(Math.sqrt(inside.length * ratio)));
  const rows = [[first!]];
  for (let at = 0; at < inside.length; at += columns) rows.push(inside.slice(at, at + columns));
  rows.push(others.filter(isExit));
  const cells = rows.flatMap((nodes, row) => nodes.map((node, column) => ({ node, row, column, along: 0, across: 0 })));
  return new Map(cells.map((cell) => [cell.node.id, cell]));
}

function placeCells(cells: Map<string, Cell>, edges: ElkExtendedEdge[], down: boolean, [left, top]: number[]): Grid {
  const lengths: number[] = [];
  const depths: number[] = [];
  for (const { node, row, column } of cells.values()) {
    lengths[column] = Math.max(lengths[column] ?? 0, lengthOf(node, down));
    depths[row] = Math.max(depths[row] ?? 0, depthOf(node, down));
  }
  const gaps = lengths.map(() => 2 * MARGIN + COLUMN_TRACKS * TRACK);
  const stacks = new Map<string, number>();
  const labels = depths.map(() => 0);
  for (const edge of edges) {
    const [source, target, label] = [cells.get(sourceOf(edge))!, cells.get(targetOf(edge))!, edge.labels?.[0]];
    if (!label) continue;
    if (areNeighbours(source, target)) {
      gaps[target.column] = Math.max(gaps[target.column]!, lengthOf(label, down) + 2 * MARGIN);
    } else {
      const depth = (stacks.get(source.node.id) ?? 0) + depthOf(label, down);
      stacks.set(source.node.id, depth);
      labels[source.row] = Math.max(labels[source.row]!, depth);
    }
  }
  const grid: Grid = { down, cells, ends: [], labelEnds: [], before: [], size: { along: left!, across: top! } };
  const starts: number[] = [];
  const columns = lengths.map((length, column) => {
    grid.before.push(grid.size.along);
    const start = grid.size.along + (gaps[column] ?? 0);
    grid.size.along = start + length;
    return start;
  });
  depths.forEach((depth, row) => {
    starts.push(grid.size.across);
    grid.ends.push(grid.size.across + depth);
    grid.labelEnds.push(grid.size.across + depth + labels[row]! + 4);
    grid.size.across = row === depths.length - 1 ? grid.ends[row]! : grid.labelEnds[row]! + 2 * MARGIN + ROW_TRACKS * TRACK;
  });
  grid.size.along += left!;
  for (const cell of cells.values()) {
    cell.along = columns[cell.column]! + (lengths[cell.column]! - lengthOf(cell.node, down)) / 2;
    cell.across = starts[cell.row]!;
  }
  return grid;
}

/** Whether a line is straight: from a state to the one after it in its row. */
function areNeighbours(source: Cell, target: Cell): boolean {
  return source.row === target.row && source.column + 1 === target.column;
}

/** The place of each port along its node. */
function portsOf(cells: Map<string, Cell>, down: boolean): Map<string, number> {
  const places = new Map<string, number>();
  for (const { node } of cells.values()) {
    const evenly = (ports: ElkPort[]): void =>
      ports.forEach((port, index) => {
        const given = down ? port.x : port.y;
        places.set(port.id, given ?? (lengthOf(node, down) * (index + 1)) / (ports.length + 1));
      });
    const isOut = (port: ElkPort): boolean => port.id.startsWith(`${node.id}\nout `);
    evenly((node.ports ?? []).filter(isOut));
    evenly((node.ports ?? []).filter((port) => !isOut(port)));
  }
  return places;
}

type Route = [number, number][];

/** The points of a line. Lines to one state have the same track, and so end as one. */
function routeOf(edge: ElkExtendedEdge, grid: Grid, ports: Map<string, number>): Route {
  const { down } = grid;
  const source = grid.cells.get(sourceOf(edge))!;
  const target = grid.cells.get(targetOf(edge))!;
  if (areNeighbours(source, target)) {
    const across = source.across + Math.min(depthOf(source.node, down), depthOf(target.node, down)) / 2;
    return [[source.along + lengthOf(source.node, down), across], [target.along, across]];
  }
  const start = source.along + ports.get(edge.sources[0]!)!;
  const end = target.along + ports.get(edge.targets[0]!)!;
  const track = (row: number): number =>
    row < 0 ? target.across - MARGIN / 2 : grid.labelEnds[row]! + MARGIN + (target.column % ROW_TRACKS) * TRACK;
  const leave = track(source.row);
  const from: Route = [[start, source.across + depthOf(source.node, down)], [start, leave]];
  const to: Route = [[end, target.across]];
  if (target.row === source.row + 1) return [...from, [end, leave], ...to];
  const arrive = track(target.row - 1);
  const aside = grid.before[target.column]! + MARGIN + (target.row % COLUMN_TRACKS) * TRACK;
  return [...from, [aside, leave], [aside, arrive], [end, arrive], ...to];
}

/** The middle of a label along, and its start across: on a straight line, or below its state. */
function labelPlace(
  edge: ElkExtendedEdge,
  label: Size,
  route: Route,
  { cells, ends, down }: Grid,
  stacked: Map<string, number>,
): [number, number] {
  const source = cells.get(sourceOf(edge))!;
  const [[start, first], [end]] = route as [[number, number], [number, number]];
  if (areNeighbours(source, cells.get(targetOf(edge))!)) return [(start + end) / 2, first - depthOf(label, down) / 2];
  const before = stacked.get(source.node.id) ?? 0;
  stacked.set(source.node.id, before + depthOf(label, down));
  return [start, ends[source.row]! + 2 + before];
}
