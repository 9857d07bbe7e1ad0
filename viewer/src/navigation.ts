// Moves between states with the arrow keys.

import type { Box } from "./layout";
import type { Graph, Path } from "./model";

export type Direction = "up" | "down" | "left" | "right";

export function readDirection(key: string): Direction | null {
  const words: Record<string, Direction> = {
    ArrowUp: "up",
    ArrowDown: "down",
    ArrowLeft: "left",
    ArrowRight: "right",
  };
  return words[key] ?? null;
}

/**
 * The state next to another one: among those of its container the nearest in the direction. Down
 * from an open container leads to its first state, up from the highest state to the container.
 */
export function neighbour(boxes: readonly Box[], from: Path, direction: Direction, graph: Graph): Path | null {
  const here = boxes.find((box) => box.path === from);
  const node = graph.nodes.get(from);
  if (!here || !node) return null;
  if (here.open && direction === "down" && node.children.length) return node.initial ?? node.children[0]!;
  if (node.parent === null) return null;
  const siblings = new Set(graph.nodes.get(node.parent)?.children);
  const best = nearestBox(boxes.filter((box) => siblings.has(box.path)), here, direction);
  if (best) return best.path;
  return direction === "up" ? node.parent : null;
}

function nearestBox(boxes: readonly Box[], here: Box, direction: Direction): Box | null {
  let best: Box | null = null;
  let least = Infinity;
  for (const box of boxes) {
    const dx = box.x + box.width / 2 - here.x - here.width / 2;
    const dy = box.y + box.height / 2 - here.y - here.height / 2;
    const [along, across] = {
      up: [-dy, dx],
      down: [dy, dx],
      left: [-dx, dy],
      right: [dx, dy],
    }[direction] as [number, number];
    if (along <= 1) continue;
    const cost = along + 2 * Math.abs(across);
    if (cost < least) [best, least] = [box, cost];
  }
  return best;
}
