// Writes the viewer into the html target: viewer.js, viewer.css, elk_worker.js and LICENSES.txt.
// `npm run build -- --outdir=FOLDER` writes elsewhere. Equal sources give equal bytes.
import { readFileSync, writeFileSync, mkdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const chosen = process.argv.find((each) => each.startsWith("--outdir="));
const out = chosen ? resolve(chosen.slice("--outdir=".length)) : join(here, "../smachac/targets/html");

const elk = join(here, "node_modules/elkjs");
const { version, license, repository } = JSON.parse(readFileSync(join(elk, "package.json"), "utf8"));
const source = repository.url.replace(/^git\+/, "");

mkdirSync(out, { recursive: true });
await build({
  entryPoints: { viewer: join(here, "src/main.ts") },
  outdir: out,
  bundle: true,
  format: "iife",
  target: "es2022",
  charset: "ascii",
  legalComments: "inline",
  logLevel: "warning",
  banner: { js: "// The viewer of smachac, built from viewer/. Apache-2.0." },
});
await build({
  entryPoints: { viewer: join(here, "src/page.css") },
  outdir: out,
  bundle: true,
  charset: "ascii",
  logLevel: "warning",
});

const notice = `// elkjs ${version}, unchanged: lib/elk-worker.min.js. License: ${license}. Source: ${source}\n`;
writeFileSync(
  join(out, "elk_worker.js"),
  notice + readFileSync(join(elk, "lib/elk-worker.min.js"), "utf8"),
);

const licence = readFileSync(join(elk, "LICENSE.md"), "utf8").trimEnd();
writeFileSync(
  join(out, "LICENSES.txt"),
  `Pages of the html target contain this program of others, unchanged:\n\n` +
    `elkjs ${version}, elk_worker.js. License: ${license}; it is used under the EPL-2.0.\n` +
    `Source: ${source}\n\n${licence}\n`,
);
