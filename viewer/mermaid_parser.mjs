// Parses the state diagrams of standard input, a JSON list of texts, with Mermaid's own parser.
// Prints for each text its error, or its states with their lines of text, its edges and the
// states that are drawn dashed.
import { JSDOM } from "jsdom";

const { window } = new JSDOM("<!DOCTYPE html><body></body>");
globalThis.window = window;
globalThis.document = window.document;

const { default: mermaid } = await import("mermaid");

const shown = (text) =>
  text.replace(/ﬂ°°(\d+)¶ß/g, (_, code) => String.fromCodePoint(Number(code)));

// All statements of a document and of the composite states in it; a concurrence has one for each
// region.
const statements = (document) =>
  document.flatMap((each) => [each, ...statements(each.doc ?? [])]);

const states = (document) =>
  statements(document)
    .filter((each) => each.stmt === "state" && each.description)
    .map((each) => [each.id, shown([each.description].flat()[0])]);

const edges = (document) =>
  statements(document)
    .filter((each) => each.stmt === "relation")
    .map((each) => [each.state1.id, each.state2.id, shown(each.description ?? "")]);

const chunks = [];
for await (const chunk of process.stdin) chunks.push(chunk);
const answers = [];
for (const text of JSON.parse(Buffer.concat(chunks).toString())) {
  try {
    await mermaid.parse(text);
    const diagram = await mermaid.mermaidAPI.getDiagramFromText(text);
    const document = diagram.db.getRootDocV2().doc;
    const dashed = diagram.db.getData().nodes
      .filter((node) => node.cssClasses?.split(" ").includes("unknown"))
      .map((node) => node.id);
    answers.push({ states: states(document), edges: edges(document), dashed });
  } catch (error) {
    answers.push({ error: String(error) });
  }
}
console.log(JSON.stringify(answers));
