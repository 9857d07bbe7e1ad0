// Copies what the page of the picture loads beside the extension.

const { copyFileSync } = require("node:fs");
const { dirname, join } = require("node:path");

copyFileSync("picture.js", join("out", "picture.js"));
const viz = dirname(require.resolve("@viz-js/viz"));
for (const folder of [viz, join(viz, "..", "lib"), join(viz, "..", "dist")]) {
  try {
    copyFileSync(join(folder, "viz-global.js"), join("out", "viz-global.js"));
    process.exit(0);
  } catch (error) {
    if (error.code !== "ENOENT") throw error;
  }
}
throw new Error("@viz-js/viz has no viz-global.js");
