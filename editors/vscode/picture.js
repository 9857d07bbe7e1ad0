// The page of the picture: draws the DOT text that arrives, and reports clicks on states.

const vscode = acquireVsCodeApi();
let viz;

window.addEventListener("message", async ({ data }) => {
  viz ??= await Viz.instance();
  const picture = document.getElementById("picture");
  picture.replaceChildren(viz.renderSVGElement(data.dot));
  for (const part of picture.querySelectorAll(".node, .cluster")) {
    const name = part.querySelector("title")?.textContent.replace(/^cluster_/, "");
    const place = data.places[name];
    if (place) {
      part.addEventListener("click", (event) => {
        event.stopPropagation();
        vscode.postMessage(place);
      });
    }
  }
});

vscode.postMessage("ready");
