#!/usr/bin/env bash
# A script of SCXML with a line break beside its CDATA: SCION (@scion-scxml/scxml 4.3.27 of npm) drops
# the script, without a message.
#
# Guess before the run: `<script>`, a line break, `<![CDATA[...]]>`, a line break, `</script>` is the
# script in the CDATA: for XML the white space is a part of the text of the element, and for
# ECMAScript it means nothing.
# Seen: the guess fails. The text of the element is its last piece, here the line break. The document
# loads, the functions of the script do not exist, and each call of one is an error.execution. Without
# white space beside the CDATA the same document works.
# Output of the run:
#   beside the tags: answer
#   on lines of its own: error
# The exit code is 1 if SCION behaves in another way.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
echo '{"private": true}' >package.json
npm install --silent --no-audit --no-fund @scion-scxml/scxml@4.3.27 >/dev/null 2>&1
cat >run.js <<'JS'
const scxml = require("@scion-scxml/scxml");
const document = (before, after) => `<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" datamodel="ecmascript">
  <script>${before}<![CDATA[function answer() { return "answer"; }]]>${after}</script>
  <state id="asking">
    <onentry><send target="#_internal" eventexpr="answer()"/></onentry>
    <transition event="answer" target="answer"/>
    <transition event="error.execution" target="error"/>
  </state>
  <final id="answer"/>
  <final id="error"/>
</scxml>`;
const end = text => new Promise((resolve, reject) => {
  scxml.documentStringToModel("document", text, (failure, model) => {
    if (failure) return reject(failure);
    model.prepare((problem, factory) => {
      if (problem) return reject(problem);
      resolve(new scxml.core.Statechart(factory).start()[0]);
    });
  });
});
(async () => {
  const close = await end(document("", "")), apart = await end(document("\n  ", "\n  "));
  console.log(`beside the tags: ${close}`);
  console.log(`on lines of its own: ${apart}`);
  process.exit(close === "answer" && apart === "error" ? 0 : 1);
})();
JS
node run.js
