// The connection to the layout program, which runs in a worker.

import type { ElkNode } from "elkjs/lib/elk-api";

export type ComputeLayout = (graph: ElkNode) => Promise<ElkNode>;

interface Reply {
  id: number;
  data?: ElkNode;
  error?: { message?: string } | string;
}

/** Start the layout program from its source text. */
export function startLayout(source: string): ComputeLayout {
  const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  const worker = new Worker(url);
  const waiting = new Map<number, { resolve: (graph: ElkNode) => void; reject: (error: Error) => void }>();
  let last = 0;
  worker.onmessage = ({ data }: MessageEvent<Reply>) => {
    const call = waiting.get(data.id);
    waiting.delete(data.id);
    if (!call) return;
    if (data.error) call.reject(new Error(typeof data.error === "string" ? data.error : data.error.message));
    else call.resolve(data.data!);
  };
  worker.onerror = (event) => {
    for (const call of waiting.values()) call.reject(new Error(event.message));
    waiting.clear();
  };
  worker.postMessage({ id: 0, cmd: "register", algorithms: ["layered"] });
  return (graph) =>
    new Promise((resolve, reject) => {
      last += 1;
      waiting.set(last, { resolve, reject });
      worker.postMessage({ id: last, cmd: "layout", graph, layoutOptions: {}, options: {} });
    });
}
