// Models that come from a server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { isNewer } from "../src/model.ts";

test("of models that arrive in any order the one with the greatest revision stays", () => {
  const arriving = [3, 1, 2, 5, 4].map((revision) => ({ revision }));
  const shown = arriving.reduce((now, next) => (isNewer(next, now) ? next : now));
  assert.equal(shown.revision, 5);
});

test("the same revision is drawn once, and one without a revision replaces none", () => {
  assert.equal(isNewer({ revision: 2 }, { revision: 2 }), false);
  assert.equal(isNewer({}, { revision: 2 }), false);
  assert.equal(isNewer({ revision: 1 }, {}), true);
});
