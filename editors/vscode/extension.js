// The extension: starts `smachac lsp`, runs commands in a terminal, shows the picture of a machine.

const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;
let started;
let panel;

function program() {
  return vscode.workspace.getConfiguration("smachac").get("command", "smachac");
}

async function activate(context) {
  const run = { command: program(), args: ["lsp"] };
  const options = {
    documentSelector: [
      { scheme: "file", language: "yaml" },
      { scheme: "file", language: "python" },
      { scheme: "file", pattern: "**/{smachac,pyproject}.toml" },
    ],
    synchronize: {
      fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{yml,yaml,toml,py,hpp}"),
    },
  };
  client = new LanguageClient("smachac", "smachac", { run, debug: run }, options);
  context.subscriptions.push(
    vscode.commands.registerCommand("smachac.run", (uri) => inTerminal("run", uri, [])),
    vscode.commands.registerCommand("smachac.build", (uri) =>
      inTerminal("build", uri, ["--target", "python"])),
    vscode.commands.registerCommand("smachac.draw", (uri) => draw(context, uri)),
    vscode.workspace.onDidSaveTextDocument((document) => redraw(document)),
    vscode.workspace.onDidOpenTextDocument(startFor),
    vscode.workspace.onDidChangeTextDocument(({ document }) => startFor(document)),
  );
  const projects = await vscode.workspace.findFiles("**/smachac.toml", undefined, 1);
  if (projects.length > 0) await start();
  vscode.workspace.textDocuments.forEach(startFor);
}

function deactivate() {
  return started && started.then(() => client.stop());
}

function start() {
  return started ??= client.start();
}

// Without a project, a Python file starts the server if its text can build a machine.
function startFor(document) {
  if (started || document.uri.scheme !== "file" || document.languageId !== "python") return;
  if (/smach|yasmin|flexbe/.test(document.getText())) start();
}

function fileOf(uri) {
  return uri ? vscode.Uri.parse(uri) : vscode.window.activeTextEditor?.document.uri;
}

// The words are separate arguments of the program, so that no shell reads the name of a file.
async function inTerminal(command, uri, words) {
  const file = fileOf(uri);
  if (!file) return;
  await vscode.workspace.saveAll(false);
  const terminal = vscode.window.createTerminal({
    name: `smachac ${command}`,
    cwd: path.dirname(file.fsPath),
    shellPath: program(),
    shellArgs: [command, file.fsPath, ...words],
  });
  terminal.show();
}

async function draw(context, uri) {
  const file = fileOf(uri);
  if (!file) return;
  await start();
  const media = vscode.Uri.joinPath(context.extensionUri, "out");
  if (!panel) {
    panel = vscode.window.createWebviewPanel("smachac", "smachac", vscode.ViewColumn.Beside, {
      enableScripts: true,
      localResourceRoots: [media],
    });
    panel.onDidDispose(() => (panel = undefined), undefined, context.subscriptions);
    panel.webview.onDidReceiveMessage((place) => show(place), undefined, context.subscriptions);
    panel.webview.html = page(panel.webview, media);
  }
  panel.file = file.toString();
  const editor = vscode.window.activeTextEditor;
  panel.line = editor?.document.uri.toString() === panel.file ? editor.selection.active.line : null;
  panel.ready ??= new Promise((resolve) => {
    const once = panel.webview.onDidReceiveMessage((message) => {
      if (message === "ready") resolve(once.dispose());
    });
  });
  await panel.ready;
  await redraw({ uri: file });
}

async function redraw(document) {
  if (!panel || !panel.file || document.uri.scheme !== "file") return;
  const found = await client.sendRequest("workspace/executeCommand", {
    command: "smachac.picture",
    arguments: [panel.file, panel.line],
  });
  if (found && panel) panel.webview.postMessage(found);
}

async function show(place) {
  if (!place || !place.uri) return;
  const at = new vscode.Position(place.line, place.character);
  const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(place.uri));
  await vscode.window.showTextDocument(document, {
    viewColumn: vscode.ViewColumn.One,
    selection: new vscode.Range(at, at),
  });
}

function page(webview, media) {
  const source = (name) => webview.asWebviewUri(vscode.Uri.joinPath(media, name));
  const policy = `default-src 'none'; style-src ${webview.cspSource} 'unsafe-inline';`
    + ` script-src ${webview.cspSource} 'wasm-unsafe-eval';`;
  return `<!DOCTYPE html>
<html><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<style>body { background: white } .node, .cluster { cursor: pointer } svg { max-width: 100%; height: auto }</style>
</head><body><div id="picture"></div>
<script src="${source("viz-global.js")}"></script><script src="${source("picture.js")}"></script>
</body></html>`;
}

module.exports = { activate, deactivate };
