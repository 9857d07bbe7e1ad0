#!/usr/bin/env bash
# Two elements in a `<finalize>` of SCXML: SCION (@scion-scxml/scxml 4.3.27 of npm) cannot load the
# document.
#
# Guess before the run: `<finalize>` has executable content, as `<onentry>` has: any number of
# elements, which run in order before the transitions for an event of the invoked service
# (W3C SCXML, 6.5).
# Seen: the guess fails. With one element the document loads. With two, the code that SCION makes of the
# document has a stray text between them, and loading ends with a SyntaxError of JavaScript that names
# no line of the document. Two elements in `<onentry>` load.
# Output of the run:
#   one element in finalize: loads
#   two elements in finalize: SyntaxError
#   two elements in onentry: loads
# The exit code is 1 if SCION behaves in another way.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
echo '{"private": true}' >package.json
npm install --silent --no-audit --no-fund @scion-scxml/scxml@4.3.27 >/dev/null 2>&1
cat >run.js <<'JS'
const scxml = require("@scion-scxml/scxml");
const assign = '<assign location="value" expr="1"/>';
const document = (entry, finalize) => `<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" datamodel="ecmascript">
  <datamodel><data id="value" expr="0"/></datamodel>
  <state id="waiting">
    <onentry>${entry}</onentry>
    <invoke type="scxml" id="service" src="service.scxml"><finalize>${finalize}</finalize></invoke>
  </state>
</scxml>`;
const load = text => new Promise(resolve => {
  scxml.documentStringToModel("document", text, problem => resolve(problem ? problem.name : "loads"));
});
(async () => {
  const found = [
    await load(document(assign, assign)),
    await load(document(assign, assign + assign)),
    await load(document(assign + assign, assign))
  ];
  console.log(`one element in finalize: ${found[0]}`);
  console.log(`two elements in finalize: ${found[1]}`);
  console.log(`two elements in onentry: ${found[2]}`);
  process.exit(found.join() === "loads,SyntaxError,loads" ? 0 : 1);
})();
JS
node run.js
