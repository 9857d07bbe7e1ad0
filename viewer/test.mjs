// Runs the tests in tests/, which need no page: `npm test`. They import TypeScript, so esbuild bundles them first.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const tests = join(dirname(fileURLToPath(import.meta.url)), "tests");
const folder = mkdtempSync(join(tmpdir(), "smachac-viewer-"));
try {
  const built = await build({
    entryPoints: readdirSync(tests).filter((name) => name.endsWith(".test.mjs")).map((name) => join(tests, name)),
    outdir: folder,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "es2022",
    sourcemap: "inline",
    metafile: true,
    logLevel: "warning",
  });
  const files = Object.keys(built.metafile.outputs);
  const options = ["--enable-source-maps", "--test", "--test-reporter=tap"];
  process.exitCode = spawnSync(process.execPath, [...options, ...files], { stdio: "inherit" }).status ?? 1;
} finally {
  rmSync(folder, { recursive: true });
}
