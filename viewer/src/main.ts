// The start of the page: the model in it, the layout program, the viewer.

import { showDifferences } from "./differences";
import { showEdits } from "./edit";
import type { Model } from "./model";
import { showRuns } from "./run_view";
import { showStatistics } from "./statistics";
import { createViewer } from "./viewer";
import { startLayout } from "./worker";

const VERSION = 2;

async function main(): Promise<void> {
  const model = JSON.parse(textOf("smachac-model")) as Model;
  if (model.version !== VERSION) throw new Error(`the model has version ${model.version}, not ${VERSION}`);
  const viewer = await createViewer(document.body, model, startLayout(textOf("smachac-layout")));
  showRuns(viewer, textOf("smachac-trace"), textOf("smachac-film"));
  showEdits(viewer);
  showStatistics(viewer);
  showDifferences(viewer);
  document.documentElement.dataset["ready"] = "true";
}

function textOf(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

main().catch((error: unknown) => {
  const line = document.createElement("p");
  line.setAttribute("role", "alert");
  line.textContent = `The viewer cannot show this page: ${String(error)}`;
  document.body.prepend(line);
});
