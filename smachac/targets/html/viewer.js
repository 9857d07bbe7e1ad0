// The viewer of smachac, built from viewer/. Apache-2.0.
"use strict";
(() => {
  // src/dom.ts
  var SVG = "http://www.w3.org/2000/svg";
  function filled(element, attributes, children2) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === null || value === void 0 || value === false) continue;
      element.setAttribute(name, value === true ? "" : String(value));
    }
    for (const child of children2) if (child) element.append(child);
    return element;
  }
  function html(tag, attributes = {}, ...children2) {
    return filled(document.createElement(tag), attributes, children2);
  }
  function svg(tag, attributes = {}, ...children2) {
    return filled(document.createElementNS(SVG, tag), attributes, children2);
  }
  function button(label, text, action, title = label) {
    const made = html("button", { type: "button", "aria-label": label, title }, text);
    made.addEventListener("click", action);
    return made;
  }

  // src/model.ts
  var SIGNS = { added: "+", removed: "\u2212", changed: "~", same: "" };
  function isNewer(next, shown) {
    return (next.revision ?? 0) > (shown.revision ?? 0);
  }
  function countOf(state, outcome) {
    return state && Object.hasOwn(state.outcomes, outcome) ? state.outcomes[outcome] : 0;
  }
  function shareOf(state, outcome) {
    const ended = Object.values(state.outcomes).reduce((sum, each) => sum + each, 0);
    return `${ended ? Number((100 * countOf(state, outcome) / ended).toFixed(1)) : 0} %`;
  }
  var Parts = class {
    known = /* @__PURE__ */ new Map();
    constructor(nodes) {
      const old = [];
      for (const node of nodes) {
        const parts = node.parts ?? [[node.path, "state", null, node.path]];
        parts.forEach(([shown, role, begins, full], index) => {
          const field = begins === "try" ? "retry" : "for_each";
          const count2 = node.badges.find((badge2) => badge2.field === field)?.count ?? null;
          const added = role === "timer" || role === "pause";
          const part = { path: node.path, outer: index === 0, added, begins, count: count2 };
          this.known.set(shown, part);
          old.push([full, part]);
        });
      }
      for (const [full, part] of old) if (!this.known.has(full)) this.known.set(full, part);
    }
    of(path) {
      return this.known.get(path);
    }
  };
  function indexed(model) {
    const graph = {
      model,
      nodes: new Map(model.nodes.map((node) => [node.path, node])),
      parts: new Parts(model.nodes),
      inside: /* @__PURE__ */ new Map(),
      leaving: /* @__PURE__ */ new Map()
    };
    for (const edge of model.edges) {
      append(graph.inside, edge.container, edge);
      if (edge.source !== null) append(graph.leaving, edge.source, edge);
    }
    return graph;
  }
  function append(map, key, value) {
    const known2 = map.get(key);
    if (known2) known2.push(value);
    else map.set(key, [value]);
  }
  function edgeId(edge) {
    const target2 = typeof edge.target === "string" ? edge.target : `${edge.container}:${edge.target.outcome}`;
    return `${edge.source ?? edge.container}
${edge.outcome}
${target2}`;
  }
  function isContainer(node) {
    return node.kind !== "leaf";
  }
  function ancestors(graph, path) {
    const found = [];
    let node = graph.nodes.get(path);
    while (node && node.parent !== null) {
      found.unshift(node.parent);
      node = graph.nodes.get(node.parent);
    }
    return found;
  }
  function nearest(graph, path) {
    let here = path;
    while (here) {
      const node = graph.nodes.get(here);
      if (node) return node;
      here = here.slice(0, Math.max(0, here.lastIndexOf("/")));
    }
    return void 0;
  }
  function kindInWords(node) {
    if (node.kind === "concurrence") return node.join === "any" ? "in parallel, first to end" : "in parallel";
    if (node.kind === "iterator" && node.items) return `for each ${node.items}`;
    if (node.kind === "sequence") return "sequence";
    if (node.kind === "machine") return "state machine";
    return node.type ?? "state";
  }
  function firstOpen(graph, depth, limit) {
    const open = /* @__PURE__ */ new Set();
    let count2 = 1;
    let level = [graph.model.root];
    for (let at = 0; at < depth && level.length; at += 1) {
      const next = [];
      for (const path of level) {
        const node = graph.nodes.get(path);
        if (!node || !isContainer(node)) continue;
        if (count2 + node.children.length > limit && at > 0) continue;
        open.add(path);
        count2 += node.children.length;
        next.push(...node.children);
      }
      level = next;
    }
    return open;
  }
  function isRetry(node) {
    return node.kind === "iterator" && node.badges.some(({ field }) => field === "retry");
  }
  function nextRound(node, outcome) {
    const badge2 = node.badges.find(({ again }) => again.includes(outcome));
    return badge2?.field === "for_each" ? "next item" : "next try";
  }

  // src/text.ts
  var FAMILY = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif';
  var FONTS = {
    title: `600 14px ${FAMILY}`,
    name: `600 13px ${FAMILY}`,
    detail: `11px ${FAMILY}`,
    label: `11px ${FAMILY}`,
    chip: `10px ${FAMILY}`,
    exit: `600 11px ${FAMILY}`
  };
  var LONGEST = 300;
  var context = document.createElement("canvas").getContext("2d");
  var widths = /* @__PURE__ */ new Map();
  function width(text, font) {
    const key = `${font} ${text}`;
    let known2 = widths.get(key);
    if (known2 === void 0) {
      context.font = FONTS[font];
      known2 = Math.ceil(context.measureText(text).width);
      widths.set(key, known2);
    }
    return known2;
  }
  function fitting(text, font, most = LONGEST) {
    if (width(text, font) <= most) return text;
    let low = 0;
    let high = text.length;
    while (low < high) {
      const middle = low + high + 1 >> 1;
      if (width(`${text.slice(0, middle)}\u2026`, font) <= most) low = middle;
      else high = middle - 1;
    }
    return `${text.slice(0, low)}\u2026`;
  }

  // src/pieces.ts
  var EXIT_HEIGHT = 22;
  var TITLE_HEIGHT = 34;
  var LINE_HEIGHT = 14;
  var exitId = (outcome) => `exit ${outcome}`;
  var START = "start";
  var MANY_LEAVE = 30;
  function writtenExits(graph, path) {
    const bySource = /* @__PURE__ */ new Map();
    const counts = /* @__PURE__ */ new Map();
    const leaving = (graph.inside.get(path) ?? []).flatMap(
      (edge) => edge.source !== null && typeof edge.target !== "string" && edge.kind !== "exhausted" ? [{ edge, source: edge.source, exit: edge.target.outcome }] : []
    );
    if (leaving.length <= MANY_LEAVE) return bySource;
    for (const { exit } of leaving) counts.set(exit, (counts.get(exit) ?? 0) + 1);
    for (const { edge, source, exit } of leaving) {
      if (counts.get(exit) <= MANY_LEAVE) continue;
      const known2 = bySource.get(source) ?? [];
      bySource.set(source, [...known2, edge]);
    }
    return bySource;
  }
  function exitsInWords(edges) {
    const byExit = /* @__PURE__ */ new Map();
    for (const { outcome, target: target2 } of edges) {
      if (typeof target2 === "string") continue;
      byExit.set(target2.outcome, [...byExit.get(target2.outcome) ?? [], outcome]);
    }
    const texts = [...byExit].map(([exit, outcomes2]) => {
      const others = [...new Set(outcomes2)].filter((each) => each !== exit);
      return others.length ? `${others.join(", ")} \u2192 ${exit}` : `\u2192 ${exit}`;
    });
    return texts.join("; ");
  }
  var WRITTEN_HEIGHT = 16;
  function boxSize(node, count2, written = []) {
    const name = width(fitting(node.name, "name"), "name") + (node.findings.length ? 20 : 0);
    const detail = boxDetail(node, count2);
    const chevron2 = isContainer(node) ? 22 : 0;
    const chips = node.badges.length ? chipsOf(node).width : 0;
    const exits = written.length ? width(fitting(exitsInWords(written), "detail"), "detail") : 0;
    return {
      width: Math.max(96, name + chevron2 + 32, width(fitting(detail, "detail"), "detail") + 32, exits + 24, chips + 20),
      height: (detail ? 48 : 36) + (chips ? CHIP_HEIGHT + 5 : 0) + (written.length ? WRITTEN_HEIGHT : 0)
    };
  }
  var CHIP_HEIGHT = 16;
  var CHIP_GAP = 4;
  function chipsOf(node) {
    let at = 0;
    const chips = node.badges.map((badge2) => {
      const text = fitting(badge2.text, "chip", 170);
      const chip = { badge: badge2, text, x: at, width: width(text, "chip") + 12 };
      at += chip.width + CHIP_GAP;
      return chip;
    });
    return { chips, width: Math.max(0, at - CHIP_GAP) };
  }
  function boxDetail(node, count2) {
    if (!isContainer(node)) return node.type ?? "";
    return `${kindInWords(node)}, ${count2} ${count2 === 1 ? "state" : "states"}`;
  }
  function contentOf(graph, path, open, sizes) {
    const container = graph.nodes.get(path);
    const pieces = [startPiece(container)];
    for (const child of container.children) {
      const node = graph.nodes.get(child);
      if (node) pieces.push({ id: child, what: "state", label: node.name, path: child, ...sizes.get(child) });
    }
    for (const outcome of exitsOf(container)) {
      const label = fitting(outcome.label, "exit");
      pieces.push({
        id: exitId(outcome.name),
        what: "exit",
        label,
        width: width(label, "exit") + 22,
        height: EXIT_HEIGHT,
        failure: outcome.failure,
        success: outcome.success
      });
    }
    const lines = /* @__PURE__ */ new Map();
    const add2 = (line, edge, label) => {
      const own = open.has(line.from) ? line.outcome : "";
      const key = JSON.stringify([line.from, line.to, line.failure, line.implicit, own, line.change]);
      const known2 = lines.get(key) ?? { ...line, stop: true, labels: [], edges: [] };
      lines.set(key, known2);
      known2.stop &&= line.outcome === "preempted";
      if (edge && !known2.edges.includes(edge)) known2.edges.push(edge);
      if (label && !open.has(line.from) && !known2.labels.includes(label)) known2.labels.push(label);
    };
    const joined = joins(container, pieces, add2);
    const written = new Set([...writtenExits(graph, path)].flatMap(([source, edges]) => open.has(source) ? [] : edges));
    for (const edge of graph.inside.get(path) ?? []) {
      if (written.has(edge)) continue;
      for (const line of linesOf(container, edge, joined)) {
        add2(line, edgeId(edge), withFigures(graph, edge, line, labelOf(container, edge, line)));
      }
    }
    const ids = new Set(pieces.map(({ id }) => id));
    const isInside = ({ from, to }) => ids.has(from) && ids.has(to);
    const all = [...lines.values()];
    return { path, pieces, lines: all.filter(isInside), far: all.filter((line) => !isInside(line)) };
  }
  function exitsOf(container) {
    const repeated = container.repeated ?? [];
    const label = (name) => repeated.some((each) => each.name === name) ? `${name} \u2192 ${nextRound(container, name)}` : name;
    const own = container.outcomes.map((each) => ({ ...each, label: label(each.name) }));
    const names = new Set(own.map(({ name }) => name));
    const others = repeated.filter(({ name }) => !names.has(name));
    return [...own, ...others.map((each) => ({ ...each, success: false, label: label(each.name) }))];
  }
  function withFigures(graph, edge, line, label) {
    if (line.change) return `${SIGNS[line.change]} ${label}`.trim();
    const state = edge.source === null ? void 0 : graph.model.statistics?.states[edge.source];
    if (!state || !edge.outcome) return label;
    return `${label} ${shareOf(state, edge.outcome)}`.trim();
  }
  function startPiece(container) {
    if (container.kind === "concurrence") {
      const size = Math.min(260, 40 * Math.max(1, container.children.length));
      return { id: START, what: "fork", label: "all start together", width: size, height: 5 };
    }
    if (container.kind === "iterator") {
      const label = isRetry(container) ? "next try" : "next item";
      return { id: START, what: "loop", label, width: width(label, "label") + 24, height: 24 };
    }
    return { id: START, what: "start", label: "start", width: 12, height: 12 };
  }
  function joins(container, pieces, add2) {
    const joined = /* @__PURE__ */ new Map();
    (container.rules ?? []).forEach((rule, index) => {
      const exit = pieces.find((each) => each.id === exitId(rule.outcome));
      if (rule.when.length < 2 || !exit) return;
      const id = `join ${index}`;
      const { change } = rule;
      const { failure = false, success } = exit;
      pieces.push({ id, what: "join", label: `all: ${rule.outcome}`, width: 64, height: 5, failure, success, change });
      for (const [child, outcome] of rule.when) {
        const key = JSON.stringify([child, outcome, rule.outcome]);
        joined.set(key, [...joined.get(key) ?? [], { id, change }]);
      }
      add2({ from: id, to: exit.id, outcome: rule.outcome, failure, implicit: false, change }, "", "");
    });
    return joined;
  }
  function linesOf(container, edge, joined) {
    const { outcome, failure, implicit } = edge;
    const look3 = { outcome, failure, implicit, change: edge.change };
    const from = edge.source ?? START;
    const to = typeof edge.target === "string" ? edge.target : exitId(edge.target.outcome);
    if (edge.kind === "loop") return [{ ...look3, from, to: START }];
    if (edge.kind === "exhausted") return [{ ...look3, outcome: "", failure: false, from: START, to }];
    if (edge.kind === "rule" && typeof edge.target !== "string") {
      const key = JSON.stringify([edge.source, edge.outcome, edge.target.outcome]);
      const { outcome: result } = edge.target;
      const alone = (container.rules ?? []).filter(
        (rule) => rule.outcome === result && rule.when.length < 2 && rule.when.every(([child, name]) => child === edge.source && name === edge.outcome)
      );
      const ends = [...joined.get(key) ?? [], ...alone.map(({ change }) => ({ id: to, change }))];
      return ends.map(({ id, change = edge.change }) => ({ ...look3, from, to: id, change }));
    }
    if (edge.kind === "default") return [{ ...look3, failure: false, from, to }];
    return [{ ...look3, from, to }];
  }
  function labelOf(container, edge, line) {
    if (edge.kind === "default") return "otherwise";
    if (edge.kind === "caught") return "exception";
    if (edge.kind === "exhausted") return edge.source === null ? "" : isRetry(container) ? "no tries left" : "no more items";
    return line.to === exitId(edge.outcome) ? "" : edge.outcome;
  }

  // src/draw.ts
  function draw(graph, scene) {
    const states = /* @__PURE__ */ new Map();
    const tree = svg("g", { role: "tree", "aria-label": `States of ${graph.model.name}` });
    for (const box of scene.boxes) {
      const node = graph.nodes.get(box.path);
      if (!node) continue;
      const element = drawState(graph, node, box);
      states.set(box.path, element);
      tree.append(element);
    }
    const lines = scene.lines.map((line) => ({ line, element: drawLine(line) }));
    const edges = svg("g", { "aria-hidden": "true" }, ...lines.map((each) => each.element));
    const grounds = new Map(scene.boxes.map((box) => [box.path, ground(graph.nodes.get(box.path), box)]));
    const labels = svg("g", { "aria-hidden": "true" }, ...scene.lines.map(({ line, label, container }) => drawLabel(line, label, grounds.get(container) ?? "")));
    const marks = svg("g", { "aria-hidden": "true" }, ...scene.pieces.map((piece) => drawPiece(graph, piece)));
    const linesAt = /* @__PURE__ */ new Map();
    for (const { line, element } of lines) {
      for (const end2 of /* @__PURE__ */ new Set([line.line.from, line.line.to])) {
        const known2 = linesAt.get(end2);
        if (known2) known2.push(element);
        else linesAt.set(end2, [element]);
      }
    }
    const root = svg("g", {}, tree, edges, marks, labels);
    return { root, states, lines, linesAt, selected: null, focusable: null, run: null };
  }
  function drawState(graph, node, box) {
    const siblings = node.parent === null ? [node.path] : graph.nodes.get(node.parent)?.children ?? [];
    const group = svg("g", {
      class: classes(node, box),
      transform: `translate(${box.x} ${box.y})`,
      role: "treeitem",
      tabindex: "-1",
      "data-path": node.path,
      "aria-label": spoken(node, box).join("; "),
      "data-words": spoken(node, box)[0],
      "aria-level": box.level + 1,
      "aria-setsize": siblings.length,
      "aria-posinset": siblings.indexOf(node.path) + 1,
      "aria-expanded": isContainer(node) ? String(box.open) : null,
      "aria-selected": "false"
    });
    if (isContainer(node) && !box.open) {
      group.append(svg("rect", { class: "below", x: 4, y: 4, width: box.width, height: box.height, rx: 8 }));
    }
    const radius = box.open ? 12 : 8;
    group.append(svg("rect", { class: "body", width: box.width, height: box.height, rx: radius }));
    if (box.open) drawTitle(graph, group, node, box);
    else drawText(graph, group, node, box);
    if (node.change && node.change !== "same") group.append(changeSign(node.change));
    return group;
  }
  function classes(node, box) {
    const kind = box.open ? `open ${ground(node, box)}` : `closed ${isContainer(node) ? ground(node, box) : ""}`;
    return ["state", node.kind, kind.trim(), node.unknown && "unknown", node.change].filter(Boolean).join(" ");
  }
  function changeSign(change) {
    const sign = { added: "M-4 0H4M0-4V4", removed: "M-4 0H4", changed: "M-4.5 1Q-2.2-4 0 0T4.5-1" };
    return svg(
      "g",
      { class: `sign ${change}` },
      svg("circle", { r: 8 }),
      svg("path", { d: sign[change] })
    );
  }
  function ground(node, box) {
    if (node?.kind === "iterator") return "looping";
    if (node?.kind === "concurrence") return "parallel";
    return box.level % 2 ? "odd" : "even";
  }
  function addTooltip(element, node) {
    if (element.querySelector(":scope > title")) return;
    const text = [node.path, node.doc, node.unknown].filter(Boolean).join("\n");
    element.prepend(svg("title", {}, text));
  }
  function spoken(node, box) {
    const words = box.open ? kindInWords(node) : boxDetail(node, node.children.length);
    const badges = node.badges.map((badge2) => badge2.text).join(", ");
    const parts = [[node.name, words, badges, exitsInWords(box.written)].filter(Boolean).join(" ")];
    if (node.outcomes.length) parts.push(`outcomes: ${node.outcomes.map((each) => each.name).join(", ")}`);
    if (node.change && node.change !== "same") parts.push(node.change);
    if (node.unknown) parts.push(`not known exactly: ${node.unknown}`);
    if (node.findings.length) parts.push(`findings: ${node.findings.length}`);
    return parts;
  }
  function drawTitle(graph, group, node, box) {
    const name = fitting(node.name, "title");
    const detail = fitting(kindInWords(node), "detail");
    group.append(
      chevron(16, TITLE_HEIGHT / 2 + 1, true),
      svg("text", { class: "title", x: 32, y: 22 }, name),
      " ",
      svg("text", { class: "detail", x: 32 + width(name, "title") + 10, y: 22 }, detail)
    );
    if (node.badges.length) group.append(" ", chipRow(node, 32 + width(name, "title") + width(detail, "detail") + 20, 10));
    if (node.findings.length) group.append(badge(graph, node, box.width - 18, 17));
  }
  function drawText(graph, group, node, box) {
    const middle = box.width / 2;
    const detail = fitting(boxDetail(node, node.children.length), "detail");
    const name = fitting(node.name, "name");
    const y = detail ? 21 : 23;
    group.append(svg("text", { class: "name", x: middle, y, "text-anchor": "middle" }, name));
    if (detail) {
      group.append(" ", svg("text", { class: "detail", x: middle, y: 37, "text-anchor": "middle" }, detail));
    }
    const below = y + (detail ? 16 : 0);
    if (node.badges.length) {
      group.append(" ", chipRow(node, middle - chipsOf(node).width / 2, below + 6));
    }
    if (box.written.length) {
      const exits = fitting(exitsInWords(box.written), "detail");
      const failure = box.written.every((edge) => edge.failure);
      const look3 = failure ? "detail written failure" : "detail written";
      group.append(" ", svg("text", { class: look3, x: middle, y: below + (node.badges.length ? CHIP_HEIGHT + 5 : 0) + 16, "text-anchor": "middle" }, exits));
    }
    if (isContainer(node)) group.append(chevron(14, y - 4, false));
    if (node.findings.length) group.append(badge(graph, node, box.width - 13, 13));
  }
  function chipRow(node, x, y) {
    const chips = chipsOf(node).chips.map((chip) => svg(
      "g",
      { class: `chip ${chip.badge.field}`, transform: `translate(${chip.x} 0)` },
      svg("rect", { width: chip.width, height: CHIP_HEIGHT, rx: CHIP_HEIGHT / 2 }),
      svg("text", { x: chip.width / 2, y: 11.5, "text-anchor": "middle" }, chip.text)
    ));
    return svg("g", { class: "badges", transform: `translate(${x} ${y})` }, ...chips.flatMap((chip, index) => index ? [" ", chip] : [chip]));
  }
  function chevron(x, y, open) {
    const points = open ? "-4,-2 0,3 4,-2" : "-2,-4 3,0 -2,4";
    return svg(
      "g",
      { class: "toggle", transform: `translate(${x} ${y})` },
      svg("rect", { class: "hit", x: -11, y: -11, width: 22, height: 22, rx: 5 }),
      svg("polyline", { points })
    );
  }
  function badge(graph, node, x, y) {
    const found = new Set(node.findings.map((index) => graph.model.findings[index]?.severity));
    const severity = found.has("error") ? "error" : found.has("warning") ? "warning" : "info";
    const shape = severity === "warning" ? "M0-7 7.5 6H-7.5Z" : "M0-7A7 7 0 1 1 0 7 7 7 0 1 1 0-7Z";
    const sign = { error: "M-2.5-2.5 2.5 2.5M2.5-2.5-2.5 2.5", warning: "M0-2.5V1.5M0 3.6V3.8", info: "M0-3.4V-3.2M0-.6V3.6" };
    return svg(
      "g",
      { class: `badge ${severity}`, transform: `translate(${x} ${y})` },
      svg("path", { d: shape }),
      svg("path", { class: "stroke", d: sign[severity] })
    );
  }
  function drawPiece(graph, { piece, container, x, y, width: width2, height }) {
    const exit = piece.what === "exit" ? piece.id.slice(exitId("").length) : null;
    const group = svg("g", {
      class: `piece ${piece.what}`,
      transform: `translate(${x} ${y})`,
      "data-exit": exit,
      "data-of": exit === null ? null : container
    });
    group.append(svg("title", {}, piece.label));
    switch (piece.what) {
      case "start":
        group.append(svg("circle", { cx: width2 / 2, cy: height / 2, r: width2 / 2 }));
        break;
      case "fork":
      case "join":
        group.append(svg("rect", { width: width2, height, rx: 2.5 }));
        break;
      default: {
        group.append(svg("rect", { width: width2, height, rx: height / 2 }));
        if (piece.what === "exit" && container === graph.model.root) {
          group.append(svg("rect", { class: "ring", x: -3, y: -3, width: width2 + 6, height: height + 6, rx: height / 2 + 3 }));
        }
        const text = { x: width2 / 2, y: height / 2 + 4, "text-anchor": "middle" };
        group.append(svg("text", text, piece.label));
      }
    }
    if (piece.change) group.classList.add(piece.change);
    if (piece.failure) group.classList.add("failure");
    if (piece.success) group.classList.add("success");
    return group;
  }
  var CORNER = 7;
  function roundedPath(points) {
    const first = points[0];
    if (!first) return "";
    let path = `M${first.x} ${first.y}`;
    for (let index = 1; index < points.length; index += 1) {
      const before = points[index - 1];
      const here = points[index];
      const next = points[index + 1];
      if (!next) {
        path += `L${here.x} ${here.y}`;
        continue;
      }
      const radius = Math.min(CORNER, distance(before, here) / 2, distance(here, next) / 2);
      const start = towards(here, before, radius);
      const end2 = towards(here, next, radius);
      path += `L${start.x} ${start.y}Q${here.x} ${here.y} ${end2.x} ${end2.y}`;
    }
    return path;
  }
  function distance(a, b) {
    return Math.hypot(a.x - b.x, a.y - b.y);
  }
  function towards(from, to, by) {
    const length = distance(from, to) || 1;
    return { x: from.x + (to.x - from.x) * by / length, y: from.y + (to.y - from.y) * by / length };
  }
  function look(line) {
    return [line.failure && "failure", line.implicit && "implicit", line.stop && "stop", line.change].filter(Boolean).join(" ");
  }
  function drawLine({ line, points }) {
    const d = roundedPath(points);
    const group = svg("g", { class: `line ${look(line)}` });
    const end2 = points[points.length - 1];
    const before = points[points.length - 2];
    group.append(svg("path", { class: "stroke", d }));
    if (end2 && before) {
      const turn = Math.atan2(end2.y - before.y, end2.x - before.x) * 180 / Math.PI;
      const transform = `translate(${end2.x} ${end2.y}) rotate(${turn})`;
      group.append(svg("path", { class: "head", d: "M0 0L-7.5-4Q-5.9 0-7.5 4Z", transform }));
      const [only, ...others] = line.edges;
      if (only !== void 0 && !others.length) group.append(svg("path", { class: "hit", d, ...origin(only) }), svg("circle", { class: "grip", cx: end2.x, cy: end2.y, r: 7, ...origin(only) }));
    }
    return group;
  }
  function origin(edge) {
    const [path = "", outcome = ""] = edge.split("\n");
    return { "data-from": path, "data-outcome": outcome };
  }
  function drawLabel(line, label, ground2) {
    if (!label) return null;
    const group = svg("g", { class: `label ${ground2} ${look(line)}` });
    group.append(background(label));
    line.labels.forEach((text, index) => {
      const y = label.y + 2 + LINE_HEIGHT * index + 10.5;
      const x = label.x + label.width / 2;
      const edge = line.edges.find((each) => each.split("\n")[1] === text);
      const from = edge === void 0 ? {} : origin(edge);
      group.append(svg("text", { x, y, "text-anchor": "middle", ...from }, fitting(text, "label")));
    });
    return group;
  }
  function background({ x, y, width: width2, height }) {
    return svg("rect", { x, y, width: width2, height, rx: 4 });
  }
  function markSelection(picture, path, focusable) {
    for (const [each, chosen] of [[picture.selected, false], [path, true]]) {
      if (each === null) continue;
      const element = picture.states.get(each);
      element?.classList.toggle("selected", chosen);
      element?.setAttribute("aria-selected", String(chosen));
      for (const line of picture.linesAt.get(each) ?? []) line.classList.toggle("near", chosen);
    }
    if (picture.focusable !== null) picture.states.get(picture.focusable)?.setAttribute("tabindex", "-1");
    picture.states.get(focusable)?.setAttribute("tabindex", "0");
    picture.selected = path;
    picture.focusable = focusable;
  }
  function markRun(graph, picture, run) {
    if (picture.run === run) return;
    picture.run = run;
    const active = drawnStates(graph, picture, run?.active);
    const waiting = drawnStates(graph, picture, run?.waiting);
    const breakpoints = drawnStates(graph, picture, run?.breakpoints);
    const taken = new Set(run?.taken ?? []);
    for (const [path, element] of picture.states) {
      element.classList.toggle("active", active.has(path));
      element.classList.toggle("waiting", waiting.has(path));
      setBreakpoint(element, breakpoints.has(path));
      setVisits(element, run?.visits?.get(path) ?? 0, [run?.rounds?.get(path), run?.times?.get(path)]);
    }
    for (const { line, element } of picture.lines) {
      element.classList.toggle("taken", line.line.edges.some((edge) => taken.has(edge)));
    }
  }
  function drawnStates(graph, picture, paths = []) {
    const found = /* @__PURE__ */ new Set();
    for (const path of paths) {
      let node = nearest(graph, path);
      while (node && !picture.states.has(node.path) && node.parent !== null) node = graph.nodes.get(node.parent);
      if (node) found.add(node.path);
    }
    return found;
  }
  function setBreakpoint(element, is) {
    element.classList.toggle("breakpoint", is);
    const mark = element.querySelector(":scope > .stop");
    if (!is) mark?.remove();
    else if (!mark) element.append(svg("circle", { class: "stop", cx: 0, cy: 0, r: 6.5 }));
  }
  function setVisits(element, count2, words) {
    element.classList.toggle("visited", count2 > 0);
    let mark = element.querySelector(":scope > .visits");
    const text = [count2 < 2 ? "" : `\xD7${count2}`, ...words].filter(Boolean).join(" \xB7 ");
    speakVisits(element, text && ` ${text}`);
    if (!text) {
      mark?.remove();
      return;
    }
    if (!mark) {
      mark = svg("text", { class: "visits" });
      const body = element.querySelector(":scope > .body");
      mark.setAttribute("x", String(Number(body.getAttribute("width")) + 4));
      mark.setAttribute("y", "10");
      element.append(" ", mark);
    }
    mark.textContent = text;
  }
  function speakVisits(element, visits) {
    const words = element.dataset["words"] ?? "";
    const before = element.dataset["visits"] ?? "";
    if (before === visits) return;
    const rest = (element.getAttribute("aria-label") ?? "").slice(words.length + before.length);
    element.dataset["visits"] = visits;
    element.setAttribute("aria-label", words + visits + rest);
  }
  function legend({ differences, nodes }) {
    const sign = (name) => svg(
      "svg",
      { viewBox: "0 0 40 14", width: 40, height: 14, "aria-hidden": "true" },
      svg(
        "g",
        { class: name },
        svg("path", { class: "stroke", d: "M2 7H32" }),
        svg("path", { class: "head", d: "M38 7l-7.5-4q1.6 4 0 8z" })
      )
    );
    const box = () => svg(
      "svg",
      { viewBox: "0 0 40 14", width: 40, height: 14, "aria-hidden": "true" },
      svg("g", { class: "state unknown" }, svg("rect", { class: "body", x: 5, y: 1, width: 30, height: 12, rx: 4 }))
    );
    const row = (name, text) => html("li", {}, sign(name), html("span", {}, text));
    return html(
      "ul",
      { class: "legend" },
      row("line", "outcome"),
      differences ? null : row("line failure", "outcome of failure"),
      row("line implicit", "implied, not written in the script"),
      nodes.some((node) => node.unknown) ? html("li", {}, box(), html("span", {}, "not known exactly")) : null
    );
  }

  // src/differences.ts
  function showDifferences(viewer) {
    const { differences } = viewer.graph.model;
    if (!differences) return;
    viewer.addSection({
      id: "differences",
      title: "Differences",
      first: true,
      fill: (node) => node ? ofState(differences, node.path) : ofMachine(viewer, differences)
    });
  }
  function ofState({ changes }, path) {
    const found = changes.filter((each) => each.path === path);
    if (!found.length) return html("p", {}, "no difference in this state itself");
    return html("ul", { class: "changes" }, ...found.map(({ text }) => html("li", {}, html("code", {}, text))));
  }
  function ofMachine(viewer, { summary, changes }) {
    const rows = changes.map(({ path, text }) => {
      const link2 = html("button", { type: "button", class: "link" }, path);
      link2.addEventListener("click", () => void viewer.select(path));
      return html("li", {}, link2, " ", html("code", {}, text));
    });
    const signs = ["added", "removed", "changed"].map((change) => html(
      "li",
      {},
      svg("svg", { viewBox: "-9 -9 18 18", width: 18, height: 18, "aria-hidden": "true" }, changeSign(change)),
      html("span", {}, change)
    ));
    return html(
      "div",
      {},
      html("p", {}, summary),
      html("ul", { class: "legend" }, ...signs),
      html("ul", { class: "changes", "aria-label": "All differences" }, ...rows)
    );
  }

  // src/connection.ts
  function connect(listener) {
    const source = new EventSource("events");
    source.addEventListener("open", () => listener.opened());
    source.addEventListener("message", (message) => listener.received(JSON.parse(message.data)));
    source.addEventListener("error", () => listener.interrupted());
    source.addEventListener("end", () => {
      source.close();
      listener.ended();
    });
  }
  var TOKEN = "smachac-token";
  function takeToken() {
    const parameters = new URLSearchParams(location.hash.slice(1));
    const given = parameters.get("token");
    if (given === null) return sessionStorage.getItem(TOKEN);
    sessionStorage.setItem(TOKEN, given);
    parameters.delete("token");
    const rest = parameters.toString().replaceAll("%2F", "/");
    history.replaceState(null, "", rest ? `#${rest}` : location.pathname + location.search);
    return given;
  }
  async function post(token, path, body) {
    try {
      const answer = await fetch(path, {
        method: "POST",
        headers: { "Content-Type": "application/json", "X-Smachac-Token": token },
        body: JSON.stringify(body)
      });
      const content = await answer.json();
      return answer.ok ? { ok: true, content } : { ok: false, reason: content.error ?? answer.statusText };
    } catch {
      return { ok: false, reason: "the server does not answer" };
    }
  }
  async function act(token, path, body) {
    const answer = await post(token, path, body);
    return answer.ok ? null : answer.reason;
  }

  // src/transition_drag.ts
  var FAR_ENOUGH = 4;
  var HANDLE_RADIUS = 6;
  function drawTransitions(viewer, drawn, clicked) {
    const { frame, world } = viewer;
    frame.classList.add("editable");
    viewer.onMark((picture) => addHandles(viewer.graph, picture, viewer.selected));
    frame.addEventListener("pointerdown", (event) => {
      const origin2 = originAt(viewer.graph, event.target);
      if (!origin2 || event.button !== 0) return;
      event.stopPropagation();
      event.preventDefault();
      drag(viewer.graph, frame, world, event, origin2, {
        dropped: (target2) => drawn(origin2.path, origin2.outcome, target2),
        clicked: () => clicked(origin2.path, origin2.outcome)
      });
    }, { capture: true });
  }
  function hasTransitions(graph, node) {
    const parent = node.parent === null ? void 0 : graph.nodes.get(node.parent);
    return parent !== void 0 && parent.kind !== "concurrence" && node.outcomes.length > 0;
  }
  function originAt(graph, element) {
    const found = element.closest("[data-from]");
    const path = found?.getAttribute("data-from") ?? "";
    const outcome = found?.getAttribute("data-outcome") ?? "";
    const node = graph.nodes.get(path);
    if (!node || !hasTransitions(graph, node)) return null;
    return node.outcomes.some(({ name }) => name === outcome) ? { path, outcome } : null;
  }
  function addHandles(graph, { root, states }, selected) {
    root.querySelector(":scope > .handles")?.remove();
    const element = selected === null ? void 0 : states.get(selected);
    const node = selected === null ? void 0 : graph.nodes.get(selected);
    const body = element?.querySelector(":scope > .body");
    if (!element || !node || !body || !hasTransitions(graph, node)) return;
    const apart = Number(body.getAttribute("width")) / (node.outcomes.length + 1);
    const handles = node.outcomes.map(({ name, failure }, index) => svg("circle", {
      class: failure ? "failure" : null,
      "data-from": node.path,
      "data-outcome": name,
      cx: apart * (index + 1),
      cy: body.getAttribute("height"),
      r: Math.min(HANDLE_RADIUS, apart / 2)
    }, svg("title", {}, `${name}: draw it to a state or an outcome`)));
    root.append(svg("g", {
      class: "handles",
      "aria-hidden": "true",
      transform: element.getAttribute("transform")
    }, ...handles));
  }
  function drag(graph, frame, world, start, origin2, ends) {
    const from = place(world, start);
    const path = svg("path", { class: "stroke" });
    const text = svg("text", { class: "words", x: 0, y: 0 });
    const line = svg("g", { class: "drawn", "aria-hidden": "true" }, path, text);
    let target2 = null;
    let moving = false;
    const move = (event) => {
      if (!moving && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < FAR_ENOUGH) return;
      if (!moving) world.append(line);
      moving = true;
      const to = place(world, event);
      target2?.element.classList.remove("drop");
      target2 = targetAt(graph, origin2, event);
      target2?.element.classList.add("drop");
      path.setAttribute("d", `M${from.x} ${from.y}L${to.x} ${to.y}`);
      text.setAttribute("x", String(to.x + 14));
      text.setAttribute("y", String(to.y - 8));
      text.textContent = target2 ? `${origin2.outcome} \u2192 ${target2.name}` : origin2.outcome;
    };
    const end2 = (event) => {
      line.remove();
      target2?.element.classList.remove("drop");
      const listeners = { pointermove: move, pointerup: end2, pointercancel: end2 };
      for (const [name, listener] of Object.entries(listeners)) window.removeEventListener(name, listener);
      document.removeEventListener("keydown", escape, { capture: true });
      if (event.type === "pointerup") {
        frame.addEventListener("click", stop, { capture: true, once: true });
        window.setTimeout(() => frame.removeEventListener("click", stop, { capture: true }));
      }
      if (event.type !== "pointerup") return;
      if (!moving) ends.clicked();
      else if (target2) ends.dropped(target2.name);
    };
    const stop = (event) => event.stopPropagation();
    const escape = (event) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      end2(event);
    };
    window.addEventListener("pointermove", move);
    window.addEventListener("pointerup", end2);
    window.addEventListener("pointercancel", end2);
    document.addEventListener("keydown", escape, { capture: true });
  }
  function place(world, event) {
    const matrix = world.getScreenCTM();
    return matrix ? new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse()) : { x: 0, y: 0 };
  }
  function targetAt(graph, origin2, event) {
    const container = graph.nodes.get(origin2.path)?.parent;
    const shown = document.elementsFromPoint(event.clientX, event.clientY).find((each) => !each.closest(".drawn, .handles, .line, .label") && each.closest("[data-path], [data-exit]"));
    const element = shown?.closest("[data-path], [data-exit]");
    if (!element || !container) return null;
    const exit = element.getAttribute("data-exit");
    if (exit !== null) return element.getAttribute("data-of") === container ? { name: exit, element } : null;
    const path = element.getAttribute("data-path") ?? "";
    if (!path.startsWith(`${container}/`)) return null;
    const name = path.slice(container.length + 1).split("/")[0];
    const state = document.querySelector(`.state[data-path="${CSS.escape(`${container}/${name}`)}"]`);
    return state && { name, element: state };
  }

  // src/edit_fields.ts
  var NOWHERE = "";
  var TRANSITION = "Change a transition";
  var BEHIND = "Add a state behind it";
  function labelled(text, control) {
    control.id = `edit-${text.toLowerCase().replaceAll(" ", "-")}`;
    return html("p", { class: "field" }, html("label", { for: control.id }, text), control);
  }
  function textField(label, value = "") {
    const input = html("input", { type: "text", required: true, autocomplete: "off", spellcheck: "false" });
    input.value = value;
    return [labelled(label, input), input];
  }
  function choice(label, options) {
    const select = html("select", {}, ...options.map(([value, text]) => html("option", { value }, text)));
    return [labelled(label, select), select];
  }
  function formsOf(graph, node, types) {
    const root = graph.nodes.get(graph.model.root);
    const state = node ?? root;
    if (!state) return [];
    const parent = state.parent === null ? void 0 : graph.nodes.get(state.parent);
    const forms = [];
    if (parent) {
      if (hasTransitions(graph, state)) forms.push(transition(graph, state, parent));
      forms.push(rename(state));
    }
    if (parent) forms.push(add(BEHIND, graph, parent, types, state));
    const last = graph.nodes.get(state.children.at(-1) ?? "");
    if (isContainer(state) && last && state.kind !== "iterator") forms.push(add("Add a state inside", graph, state, types, last));
    if (parent) {
      forms.push(remove(graph, state, parent), contain(graph, state, parent));
    }
    return forms;
  }
  function beside(graph, parent) {
    return parent.children.map((path) => graph.nodes.get(path)).filter((each) => each !== void 0);
  }
  function targets(graph, parent) {
    const states = beside(graph, parent).map((each) => [lastName(each.path), each.name]);
    const ends = parent.outcomes.map(({ name }) => [name, `${name} (outcome of ${parent.name})`]);
    return [...states, ...ends];
  }
  function lastName(path) {
    return path.slice(path.lastIndexOf("/") + 1);
  }
  function rename(state) {
    const [label, input] = textField("New name", state.name);
    return {
      title: "Rename",
      fields: [label],
      planned() {
        const name = input.value.trim();
        const path = `${state.parent}/${name}`;
        return { edit: { operation: "rename", path: state.path, arguments: { new: name } }, then: path, old: state.path };
      }
    };
  }
  function transition(graph, state, parent) {
    const [outcomeLabel, outcome] = choice("Outcome", state.outcomes.map(({ name }) => [name, name]));
    const [targetLabel, target2] = choice("Leads to", [...targets(graph, parent), [NOWHERE, "(no transition)"]]);
    const showTarget = () => {
      const edge = (graph.leaving.get(state.path) ?? []).find((each) => each.outcome === outcome.value);
      if (!edge) target2.value = NOWHERE;
      else target2.value = typeof edge.target === "string" ? lastName(edge.target) : edge.target.outcome;
    };
    outcome.addEventListener("change", showTarget);
    showTarget();
    return {
      title: TRANSITION,
      fields: [outcomeLabel, targetLabel],
      fill(name, to) {
        outcome.value = name;
        target2.value = to;
      },
      planned() {
        const led = target2.value === NOWHERE ? {} : { target: target2.value };
        return { edit: { operation: "transition", path: state.path, arguments: { outcome: outcome.value, ...led } }, then: state.path };
      }
    };
  }
  function add(title, graph, parent, types, after) {
    const [nameLabel, name] = textField("Name of the new state");
    const [typeLabel, type] = choice("State type", []);
    const doc = html("p", { class: "help" });
    const outcomes2 = parent.kind === "machine" ? after.outcomes.map(({ name: name2 }) => [name2, name2]) : [];
    const label = title === BEHIND ? "Outcome that leads to it" : `Outcome of ${after.name} that leads to it`;
    const [onLabel, on] = choice(label, [...outcomes2, [NOWHERE, "(none yet)"]]);
    on.value = outcomes2.length ? entrance(graph, after) : NOWHERE;
    void types.then((known2) => {
      const describe = () => {
        doc.textContent = known2.find((each) => each.name === type.value)?.doc ?? "";
      };
      const groups = /* @__PURE__ */ new Map();
      for (const each of known2) groups.set(each.group, [...groups.get(each.group) ?? [], each]);
      type.replaceChildren(...[...groups].map(([group, some]) => html("optgroup", { label: group }, ...some.map((each) => html("option", { value: each.name, title: each.doc }, each.name)))));
      type.addEventListener("change", describe);
      describe();
    });
    return {
      title,
      fields: [nameLabel, typeLabel, doc, ...outcomes2.length ? [onLabel] : []],
      fill(outcome) {
        on.value = outcome;
        name.focus();
      },
      planned() {
        const given = { name: name.value.trim(), type: type.value };
        given["after"] = lastName(after.path);
        if (on.value !== NOWHERE) given["on"] = on.value;
        return { edit: { operation: "add", path: parent.path, arguments: given }, then: `${parent.path}/${name.value.trim()}` };
      }
    };
  }
  function entrance(graph, state) {
    const led = new Set((graph.leaving.get(state.path) ?? []).map(({ outcome }) => outcome));
    return (state.outcomes.find(({ name }) => !led.has(name)) ?? state.outcomes.find(({ success }) => success) ?? state.outcomes[0])?.name ?? NOWHERE;
  }
  function remove(graph, state, parent) {
    const others = targets(graph, parent).filter(([value]) => value !== lastName(state.path));
    const [label, to] = choice("What led to it leads to", [[NOWHERE, "(where its best outcome leads)"], ...others]);
    return {
      title: "Remove",
      fields: parent.kind === "concurrence" ? [] : [label],
      planned() {
        const given = to.value === NOWHERE ? {} : { to: to.value };
        return { edit: { operation: "remove", path: state.path, arguments: given }, then: null };
      }
    };
  }
  function contain(graph, state, parent) {
    const [nameLabel, name] = textField("Name of the container");
    const [typeLabel, type] = choice("Type", [["StateMachine", "StateMachine"], ["Concurrence", "Concurrence: at the same time"]]);
    const boxes = beside(graph, parent).map((each) => {
      const box = html("input", { type: "checkbox" });
      box.checked = each.path === state.path;
      return [box, each];
    });
    const group = html("fieldset", {}, html("legend", {}, "States"), ...boxes.map(([box, each]) => html("label", {}, box, each.name)));
    return {
      title: "Move into a new container",
      fields: [group, nameLabel, typeLabel],
      planned() {
        const states = boxes.filter(([box]) => box.checked).map(([, each]) => each.path);
        const given = { name: name.value.trim(), type: type.value, states };
        return { edit: { operation: "contain", path: state.path, arguments: given }, then: `${parent.path}/${name.value.trim()}` };
      }
    };
  }

  // src/panel.ts
  function fillPanel(panel, graph, node, sections, actions) {
    const focused = panel.contains(document.activeElement) ? document.activeElement : null;
    const own = node ? stateSections(graph, node, actions) : machineSections(graph, actions);
    const added = (first) => sections.filter((each) => (each.first ?? false) === first).map((each) => {
      const content = each.fill(node);
      return content && section(each.title, content, each.id);
    });
    const parts = [own[0], ...added(true), ...own.slice(1), ...added(false)];
    panel.replaceChildren(...parts.filter((each) => each !== null));
    panel.scrollTop = 0;
    if (focused?.isConnected) focused.focus();
  }
  function section(title, content, id) {
    return html("section", { "data-section": id ?? title.toLowerCase() }, html("h3", {}, title), content);
  }
  function link(text, path, actions) {
    const made = html("button", { type: "button", class: "link" }, text);
    made.addEventListener("click", () => actions.select(path));
    return made;
  }
  function stateSections(graph, node, actions) {
    const properties = graph.model.properties.filter((each) => each.states.includes(node.path));
    return [
      heading(graph, node, actions),
      node.findings.length ? section("Findings", findings(node.findings.map((index) => graph.model.findings[index]))) : null,
      node.outcomes.length ? section("Outcomes", outcomes(graph, node, actions)) : null,
      node.inputs.length ? section("Inputs", keys(node.inputs, "reads")) : null,
      node.outputs.length ? section("Outputs", keys(node.outputs, "writes")) : null,
      node.userdata?.length ? section("Userdata", userdata(node)) : null,
      node.rules ? section("Rules", rules(graph, node)) : null,
      properties.length ? section("Properties", propertyList(graph, properties, actions)) : null,
      node.children.length ? section("States", children(graph, node, actions)) : null,
      node.snippet ? section(node.file?.endsWith(".py") ? "Code" : "Script", snippet(node)) : null
    ];
  }
  function heading(graph, node, actions) {
    const around = node.parent === null ? null : graph.nodes.get(node.parent);
    const made = html(
      "section",
      { "data-section": "state" },
      html("p", { class: "path" }, around ? link(around.path, around.path, actions) : "machine"),
      html("h2", {}, node.name),
      html("p", { class: "kind" }, kindInWords(node), node.type && isContainer(node) ? ` (${node.type})` : "")
    );
    if (node.badges.length) {
      made.append(html("ul", { class: "badges" }, ...node.badges.map((badge2) => html("li", {}, badgeInWords(badge2, node)))));
    }
    if (node.doc) made.append(html("p", { class: "doc" }, node.doc));
    if (node.unknown) made.append(html("p", { class: "doc" }, `Not known exactly: ${node.unknown}.`));
    if (node.tags.length) {
      made.append(html("p", { class: "tags" }, ...node.tags.map((tag) => html("span", { class: "tag" }, tag))));
    }
    return made;
  }
  function badgeInWords(badge2, node) {
    const again = badge2.again.join(" or ");
    switch (badge2.field) {
      case "timeout":
        return `${badge2.text}: then ${node.outcomes.some(({ name }) => name === badge2.outcome) ? "it" : "a try"} ends with ${badge2.outcome}`;
      case "retry":
        return `${badge2.text}: the next one after ${again}; after the last one it ends with ${badge2.outcome}`;
      case "for_each":
        return again ? `${badge2.text}: the next one after ${again}` : badge2.text;
      case "catches":
        return `an exception in it ends it with ${badge2.outcome}`;
    }
  }
  function findings(found) {
    return html("ul", { class: "findings" }, ...found.map((item) => html(
      "li",
      { class: item.severity },
      html("p", {}, html("strong", {}, `${item.severity} ${item.code}`), " ", item.message),
      item.help ? html("p", { class: "help" }, `help: ${item.help}`) : null,
      item.file ? html("p", { class: "place" }, `${item.file}:${item.line}`) : null
    )));
  }
  function outcomes(graph, node, actions) {
    const leaving = graph.leaving.get(node.path) ?? [];
    const rows = node.outcomes.map((outcome) => {
      const edges = leaving.filter((edge) => edge.outcome === outcome.name);
      const name = html("span", { class: `outcome${outcome.failure ? " failure" : outcome.success ? " success" : ""}` }, outcome.name);
      const targets2 = html("span", { class: "targets" }, ...edges.map((edge) => target(graph, edge, actions)));
      return html("li", {}, name, targets2);
    });
    const repeated = (node.repeated ?? []).map((outcome) => {
      const name = html("span", { class: `outcome${outcome.failure ? " failure" : ""}` }, outcome.name);
      return html("li", {}, name, html("span", { class: "targets" }, html("span", { class: "target" }, nextRound(node, outcome.name))));
    });
    return html("ul", { class: "rows" }, ...rows, ...repeated);
  }
  function target(graph, edge, actions) {
    const words = { default: "otherwise ", implicit: "implied: ", loop: "next item: ", exhausted: "no more items: ", rule: "by rule: " };
    const how = words[edge.kind] ?? "";
    if (typeof edge.target === "string") {
      const node = graph.nodes.get(edge.target);
      return html("span", { class: "target" }, how, link(node?.name ?? edge.target, edge.target, actions));
    }
    const around = graph.nodes.get(edge.container);
    return html("span", { class: "target" }, `${how}ends ${around?.name ?? edge.container} with ${edge.target.outcome}`);
  }
  function keys(list, verb) {
    return html("ul", { class: "rows" }, ...list.map((key) => html(
      "li",
      {},
      html("span", { class: "key", title: key.doc }, key.name),
      html("code", {}, key.type),
      key.key === key.name ? null : html("span", { class: "target" }, `${verb} ${key.key}`)
    )));
  }
  function userdata(node) {
    return html("ul", { class: "rows" }, ...(node.userdata ?? []).map((each) => html("li", {}, html("span", { class: "key" }, each.key), html("code", {}, each.type), html("code", { class: "value" }, each.value))));
  }
  function rules(graph, node) {
    const named = (path) => graph.nodes.get(path)?.name ?? path;
    const rows = (node.rules ?? []).map((rule) => html(
      "li",
      {},
      html("span", { class: "outcome" }, rule.outcome),
      html("span", { class: "target" }, rule.when.map(([path, outcome]) => `${named(path)}: ${outcome}`).join(" and ") || "always")
    ));
    if (node.default) {
      rows.push(html("li", {}, html("span", { class: "outcome" }, node.default), html("span", { class: "target" }, "otherwise")));
    }
    return html("ul", { class: "rows" }, ...rows);
  }
  function children(graph, node, actions) {
    return html("p", { class: "chips" }, ...node.children.map((path) => link(graph.nodes.get(path)?.name ?? path, path, actions)));
  }
  function snippet(node) {
    return html(
      "div",
      {},
      html("p", { class: "place" }, `${node.file}:${node.line}`),
      html("pre", { tabindex: "0", "aria-label": `script of ${node.name}` }, html("code", {}, node.snippet))
    );
  }
  function propertyList(graph, list, actions) {
    return html("ul", { class: "properties" }, ...list.map((each) => html(
      "li",
      { class: each.verdict },
      html("span", { class: "verdict" }, each.verdict),
      " ",
      each.name,
      each.name === each.text ? null : html("p", { class: "help" }, each.text),
      html("p", { class: "chips" }, ...each.states.map((path) => link(graph.nodes.get(path)?.name ?? path, path, actions)))
    )));
  }
  var KEYS = [
    ["/", "search"],
    ["arrows", "next state in that direction"],
    ["Enter", "open or close a container"],
    ["Escape", "container around the state"],
    ["f", "whole machine"],
    ["+ and -", "zoom"],
    ["e and c", "open and close all containers"],
    ["d", "down or to the right"]
  ];
  function machineSections(graph, actions) {
    const { model } = graph;
    const root = graph.nodes.get(model.root);
    const heading2 = html(
      "section",
      { "data-section": "machine" },
      html("p", { class: "path" }, model.source),
      html("h2", {}, model.name),
      html("p", { class: "kind" }, `${counted(model.nodes.length - 1, "state")}, ${counted(model.edges.length, "transition")}`),
      root?.doc ? html("p", { class: "doc" }, root.doc) : null
    );
    return [
      heading2,
      model.findings.length ? section("Findings", machineFindings(graph, actions)) : null,
      model.properties.length ? section("Properties", propertyList(graph, model.properties, actions)) : null,
      section("Legend", legend(model)),
      section("Keys", html("dl", { class: "keys" }, ...KEYS.flatMap(([key, text]) => [html("dt", {}, html("kbd", {}, key)), html("dd", {}, text)])))
    ];
  }
  function counted(count2, noun) {
    return `${count2} ${noun}${count2 === 1 ? "" : "s"}`;
  }
  function machineFindings(graph, actions) {
    const list = findings(graph.model.findings);
    graph.model.findings.forEach((item, index) => {
      const node = item.node === null ? void 0 : graph.nodes.get(item.node);
      if (node) list.children[index].append(html("p", { class: "chips" }, link(node.name, node.path, actions)));
    });
    return list;
  }

  // src/edit.ts
  function showEdits(viewer) {
    const token = viewer.graph.model.editable ? takeToken() : null;
    if (token !== null) new Editor(viewer, token);
  }
  var Editor = class {
    constructor(viewer, token) {
      this.viewer = viewer;
      this.token = token;
      this.types = stateTypes(token);
      this.form.addEventListener("submit", (event) => {
        event.preventDefault();
        void this.look();
      });
      this.kinds.addEventListener("change", () => this.showFields());
      this.fields.addEventListener("input", () => this.forget());
      this.forget();
      viewer.addSection({ id: "edit", title: "Edit", first: true, fill: (node) => this.fill(node) });
      document.addEventListener("keydown", (event) => this.key(event));
      drawTransitions(
        viewer,
        (path, outcome, target2) => void this.propose(path, outcome, target2),
        (path, outcome) => void this.insert(path, outcome)
      );
    }
    viewer;
    token;
    kinds = html("select", {});
    fields = html("div", {});
    preview = html("button", { type: "submit" }, "Preview");
    apply = button("Apply", "Apply", () => void this.write(), "Write the change into the script");
    undo = button("Undo", "Undo", () => void this.takeBack(), "Undo the last edit (u)");
    said = html("p", { class: "said", role: "status" });
    shown = html("div", {});
    form = html(
      "form",
      { class: "edit" },
      labelled("Operation", this.kinds),
      this.fields,
      html("div", { class: "acts" }, this.preview, this.apply, this.undo),
      this.said,
      this.shown
    );
    forms = [];
    types;
    filledFor = null;
    previewed = null;
    /** The state that each edit changed the path of: selected again when it is undone. */
    done = [];
    /** Show what a transition that was drawn changes. */
    async propose(path, outcome, target2) {
      await this.viewer.select(path);
      this.kinds.value = TRANSITION;
      this.showFields();
      this.chosen()?.fill?.(outcome, target2);
      await this.look();
    }
    /** Offer a new state on a transition. */
    async insert(path, outcome) {
      await this.viewer.select(path);
      this.kinds.value = BEHIND;
      this.showFields();
      this.chosen()?.fill?.(outcome, "");
    }
    /** The form of the selected state; what is typed in stays while the state and the machine stay. */
    fill(node) {
      const { graph } = this.viewer;
      const path = node?.path ?? null;
      if (this.filledFor?.graph === graph && this.filledFor.path === path) return this.form;
      if (this.filledFor?.path !== path && !this.said.classList.contains("done")) this.say("");
      const before = this.filledFor?.path === path ? this.kinds.value : "";
      this.filledFor = { graph, path };
      this.forms = formsOf(graph, node, this.types);
      this.kinds.replaceChildren(...this.forms.map(({ title }) => html("option", { value: title }, title)));
      if (this.forms.some(({ title }) => title === before)) this.kinds.value = before;
      this.showFields();
      return this.form;
    }
    showFields() {
      this.fields.replaceChildren(...this.chosen()?.fields ?? []);
      this.preview.disabled = !this.forms.length;
      this.forget();
    }
    chosen() {
      return this.forms.find(({ title }) => title === this.kinds.value);
    }
    /** Show what the edit changes. */
    async look() {
      const planned = this.chosen()?.planned();
      if (!planned) return;
      this.forget();
      const answer = await post(this.token, "edit", planned.edit);
      if (!answer.ok) {
        this.say(answer.reason, "refused");
        return;
      }
      const { content } = answer;
      this.say(content.diff ? content.proof : "The script is like this already.");
      if (!content.diff) return;
      this.shown.replaceChildren(...described(content));
      this.previewed = { planned, diff: content.diff };
      this.apply.disabled = false;
    }
    /** Write the edit that is shown. */
    async write() {
      if (!this.previewed) return;
      const { planned, diff } = this.previewed;
      this.undo.focus();
      this.forget();
      const answer = await post(this.token, "edit", { ...planned.edit, apply: true, diff });
      if (!answer.ok) {
        this.say(answer.reason, "refused");
        return;
      }
      this.done.push(planned);
      await this.show(answer.content, planned.then, planned.old);
      this.say(`Written: ${answer.content.files.join(", ")}`, "done");
    }
    async takeBack() {
      const answer = await post(this.token, "undo", {});
      if (!answer.ok) {
        this.say(answer.reason, "refused");
        return;
      }
      const undone = this.done.pop();
      this.forget();
      await this.show(answer.content, undone?.old ?? null, undone?.then ?? void 0);
      this.say(`Undone: ${answer.content.files.join(", ")}`, "done");
    }
    /** Show the machine after an edit, with the state at `path` selected. `old` is its path before. */
    async show({ model }, path, old) {
      if (path !== null) await this.viewer.expect(path, old);
      if (model) await this.viewer.setModel(model);
    }
    /** `done`: the message stays when another state is selected. */
    say(text, tone = "") {
      this.said.textContent = text;
      this.said.className = `said ${tone}`.trim();
    }
    /** Remove the preview: it is that of another edit. */
    forget() {
      this.previewed = null;
      this.apply.disabled = true;
      this.shown.replaceChildren();
    }
    key(event) {
      if (event.key !== "u" || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target.closest("input, select, textarea")) return;
      event.preventDefault();
      void this.takeBack();
    }
  };
  async function stateTypes(token) {
    const answer = await post(token, "types", {});
    return answer.ok ? answer.content.types : [];
  }
  function described(preview) {
    const texts = preview.diff.replace(/\n$/, "").split("\n");
    const lines = texts.map((line, index) => {
      const look3 = line.startsWith("+") ? "more" : line.startsWith("-") ? "less" : null;
      return html("span", { class: look3 }, ...markedWords(line, otherLine(texts, index)));
    });
    const parts = [
      html("pre", { class: "diff", tabindex: "0", role: "region", "aria-label": "Change of the script" }, html("code", {}, ...lines))
    ];
    if (preview.added.length) parts.push(html("h4", {}, "New findings"), findings(preview.added));
    if (preview.removed.length) parts.push(html("h4", {}, "Findings that disappear"), findings(preview.removed));
    return parts;
  }
  function otherLine(lines, index) {
    const line = lines[index];
    const [sign, step] = line.startsWith("-") ? ["+", 1] : ["-", -1];
    const other = lines[index + Number(step)];
    const isChange = (text) => /^[+-](?![+-]{2} )/.test(text);
    return other?.startsWith(String(sign)) && isChange(line) && isChange(other) ? other : null;
  }
  function markedWords(line, other) {
    if (other === null) return [line];
    const [words, others] = [line, other].map((text) => text.slice(1).split(/(\s+|[[\]{},:])/));
    let start = 0;
    while (start < words.length && words[start] === others[start]) start += 1;
    let end2 = 0;
    while (end2 < Math.min(words.length, others.length) - start && words.at(-1 - end2) === others.at(-1 - end2)) end2 += 1;
    const middle = words.slice(start, words.length - end2).join("");
    if (!middle) return [line];
    return [line[0] + words.slice(0, start).join(""), html("mark", {}, middle), words.slice(words.length - end2).join("")];
  }

  // src/control.ts
  var Control = class {
    /** `changed` is called after each change, `refused` with the reason of an action that was refused. */
    constructor(token, changed, refused) {
      this.token = token;
      this.changed = changed;
      this.refused = refused;
      if (token !== null) this.element.append(this.pause, this.step, this.stop);
      this.show();
    }
    token;
    changed;
    refused;
    element = html("div", { class: "control", role: "group", "aria-label": "Control of the run" });
    status = null;
    pause = button("Pause", "Pause", () => this.pauseOrResume(), "Pause before the next state, or go on (r)");
    step = button("Step", "Step", () => this.do({ action: "step" }), "Run one state (s)");
    stop = button("Stop the run", "Stop", () => this.do({ action: "stop" }), "Request the run to stop");
    received(status) {
      this.status = status;
      this.show();
      this.changed();
    }
    /** Whether the page may act on a run that goes on. */
    get able() {
      return this.token !== null && this.status !== null && !this.status.ended;
    }
    pauseOrResume() {
      this.do({ action: this.status?.paused ? "resume" : "pause" });
    }
    do(body) {
      if (!this.able) return;
      void act(this.token, "control", body).then((reason) => this.refused(reason ?? ""));
    }
    hasBreakpoint(place2) {
      return this.status?.breakpoints.some((each) => each.path === place2.path && each.outcome === place2.outcome && each.round === place2.round) ?? false;
    }
    toggleBreakpoint(place2) {
      this.do({ action: this.hasBreakpoint(place2) ? "unbreak" : "break", ...place2 });
    }
    /** What can be done at a state: breakpoints, and for one that waits, its step and its outcomes. */
    partFor(node) {
      if (!this.able) return null;
      const at = (outcome, round = null) => ({ path: node.path, outcome, round });
      const part = html("div", { class: "breakpoints" }, this.box("Pause before it starts", at(null)));
      const rounds = new Set((node.parts ?? []).map(([, , begins]) => begins));
      if (rounds.has("item")) part.append(this.box("Pause before each item", at(null, "item")));
      if (rounds.has("try")) part.append(this.box("Pause before each try", at(null, "try")));
      const leaves = new Set(node.outcomes.map(({ name }) => name));
      for (const name of leaves) part.append(this.box(`Pause when it ends with ${name}`, at(name)));
      for (const { name } of node.repeated ?? []) {
        if (!leaves.has(name)) part.append(this.box(`Pause when a try ends with ${name}`, at(name)));
      }
      const waiting = this.status.at.find((each) => each.path === node.path);
      if (waiting) part.prepend(this.waiting(waiting));
      return part;
    }
    waiting({ path, outcome, round, outcomes: outcomes2 }) {
      const force = outcomes2.map((name) => button(`End with ${name}`, name, () => this.do({ action: "outcome", path, outcome: name })));
      const where = round === null ? "It waits before its start." : `It waits before ${round === "try" ? "a try" : "an item"}.`;
      const run = outcome === null ? round === null ? "Run it" : `Run the ${round}` : "Go on";
      return html(
        "div",
        { class: "waiting" },
        html("p", {}, outcome === null ? where : `It has ended with ${outcome} and waits.`),
        button("Run this state", run, () => this.do({ action: "step", path })),
        html("p", {}, "Force an outcome:"),
        html("p", { class: "forced" }, ...force)
      );
    }
    box(label, place2) {
      const input = html("input", { type: "checkbox" });
      input.checked = this.hasBreakpoint(place2);
      input.addEventListener("change", () => this.toggleBreakpoint(place2));
      return html("label", {}, input, ` ${label}`);
    }
    show() {
      this.element.hidden = !this.able;
      const paused = this.status?.paused ?? false;
      this.pause.textContent = paused ? "Resume" : "Pause";
      this.pause.setAttribute("aria-label", paused ? "Resume" : "Pause");
      this.step.disabled = !this.status?.at.length;
      this.stop.disabled = this.status?.stopping ?? false;
    }
  };

  // src/film.ts
  var Film = class {
    constructor(data) {
      this.data = data;
      this.film = this.load();
      void this.update();
    }
    data;
    caption = html("figcaption", {}, "The film is loaded");
    frame = html("div", { class: "frame" });
    element = html("figure", { class: "film", "aria-label": "Film of the run" }, this.frame, this.caption);
    film;
    wanted = 0;
    shown = -1;
    busy = false;
    /** Show the frame of a time of the run, in seconds. */
    show(t) {
      this.wanted = Math.max(0, Math.floor(t * this.data.rate + 1e-6));
      void this.update();
    }
    async load() {
      try {
        const answer = await fetch("film");
        if (!answer.ok) throw new Error("the server has no film");
        const content = await answer.blob();
        return this.data.type === "image/gif" ? await this.gif(content) : await this.video(content);
      } catch (error) {
        this.caption.textContent = `The film cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
        return null;
      }
    }
    /** Show the latest frame that is wanted; those that were wanted in the meantime are left out. */
    async update() {
      if (this.busy) return;
      this.busy = true;
      const film = await this.film;
      while (film && this.shown !== this.wanted) {
        const index = this.wanted;
        const frame = await film(index);
        this.shown = index;
        this.element.dataset["frame"] = String(frame);
        this.caption.textContent = `Film at ${(frame / this.data.rate).toFixed(1)} s`;
      }
      this.busy = false;
    }
    async gif(content) {
      if (typeof ImageDecoder === "undefined") {
        throw new Error("this browser shows single frames of .mp4 only, not of .gif");
      }
      const decoder = new ImageDecoder({ data: await content.arrayBuffer(), type: this.data.type });
      await decoder.tracks.ready;
      await decoder.completed;
      const starts = await this.starts(decoder);
      if (starts.length < 2) throw new Error("it has no image");
      const last = starts.pop() - 1;
      const canvas = html("canvas", {});
      this.frame.replaceChildren(canvas);
      return async (wanted) => {
        const index = Math.min(wanted, last);
        const { image } = await decoder.decode({ frameIndex: starts.filter((each) => each <= index).length - 1 });
        if (canvas.width !== image.displayWidth) canvas.width = image.displayWidth;
        if (canvas.height !== image.displayHeight) canvas.height = image.displayHeight;
        canvas.getContext("2d")?.drawImage(image, 0, 0);
        image.close();
        return index;
      };
    }
    /** The number of the first frame that each image of a GIF stands for, and their count: equal frames are
     * one image, which is shown longer. The last frame is shown for two seconds (`Gif` in sim/video.py). */
    async starts(decoder) {
      const count2 = decoder.tracks.selectedTrack?.frameCount ?? 0;
      const frame = Math.floor(1e3 / this.data.speed);
      const starts = [0];
      for (let index = 0; index < count2; index += 1) {
        const { image } = await decoder.decode({ frameIndex: index });
        const shown = (image.duration ?? 0) / 1e3 - (index === count2 - 1 ? 2e3 - frame : 0);
        image.close();
        starts.push(starts[index] + Math.max(1, Math.round(shown / frame)));
      }
      return starts;
    }
    async video(content) {
      const video = html("video", { muted: true, playsinline: true, preload: "auto" });
      this.frame.replaceChildren(video);
      const failed = () => new Error("this browser cannot play it");
      await new Promise((resolve, reject) => {
        video.addEventListener("loadeddata", () => resolve(), { once: true });
        video.addEventListener("error", () => reject(failed()), { once: true });
        video.src = URL.createObjectURL(content);
      });
      return async (wanted) => {
        const last = Math.max(0, Math.round(video.duration * this.data.speed) - 1);
        const index = Math.min(wanted, last);
        await new Promise((resolve) => {
          video.addEventListener("seeked", () => resolve(), { once: true });
          video.currentTime = (index + 0.5) / this.data.speed;
        });
        return index;
      };
    }
  };

  // src/run_state.ts
  function emptyState() {
    return {
      active: /* @__PURE__ */ new Map(),
      visited: /* @__PURE__ */ new Map(),
      rounds: /* @__PURE__ */ new Map(),
      taken: /* @__PURE__ */ new Map(),
      written: /* @__PURE__ */ new Map(),
      error: null,
      root: null,
      outcome: null,
      ended: false,
      t: 0,
      count: 0,
      writes: 0
    };
  }
  function copyState(state) {
    const visited = /* @__PURE__ */ new Map();
    for (const [path, each] of state.visited) visited.set(path, { ...each, outcomes: new Map(each.outcomes) });
    return {
      ...state,
      active: new Map(state.active),
      visited,
      rounds: new Map(state.rounds),
      taken: new Map(state.taken),
      written: new Map(state.written)
    };
  }
  function transitionKey(path, outcome, to) {
    return `${path}
${outcome}
${to}`;
  }
  function advance(state, event) {
    if (event.event === "start") {
      Object.assign(state, emptyState(), { root: event.path });
    }
    state.count += 1;
    state.t = event.t ?? state.t;
    const { path } = event;
    switch (event.event) {
      case "start":
      case "enter":
        enter(state, path);
        break;
      case "try":
      case "item": {
        const others = (state.rounds.get(path) ?? []).filter(({ what }) => what === "item" && event.event === "try");
        state.rounds.set(path, [...others, { what: event.event, number: event.number ?? 1, of: event.of }]);
        break;
      }
      case "exit":
      case "finish":
        leave(state, path, event.outcome ?? null);
        if (event.event === "finish") end(state, event.outcome ?? null);
        break;
      case "transition":
        count(state.taken, transitionKey(path, event.outcome ?? "", event.to ?? ""));
        break;
      case "write": {
        state.writes += 1;
        const key = event.key ?? "";
        state.written.set(`${path}
${key}`, { path, key, value: event.value, t: state.t, order: state.writes });
        break;
      }
      case "error":
        state.error = { path, message: event.message ?? "" };
        break;
    }
    return state;
  }
  function enter(state, path) {
    state.active.set(path, state.t);
    const known2 = state.visited.get(path);
    if (known2) known2.visits += 1;
    else state.visited.set(path, { visits: 1, seconds: 0, outcomes: /* @__PURE__ */ new Map(), lastOutcome: null });
  }
  function leave(state, path, outcome) {
    const since = state.active.get(path);
    state.active.delete(path);
    state.rounds.delete(path);
    const visited = state.visited.get(path);
    if (!visited) return;
    if (since !== void 0) visited.seconds += state.t - since;
    if (outcome !== null) count(visited.outcomes, outcome);
    visited.lastOutcome = outcome;
  }
  function end(state, outcome) {
    state.ended = true;
    state.outcome = outcome;
    state.active.clear();
    state.rounds.clear();
  }
  function count(counts, key) {
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  function roundInWords(state, path) {
    const rounds = state.rounds.get(path) ?? [];
    return rounds.map(({ what, number, of }) => `${what} ${number}${of === void 0 ? "" : ` of ${of}`}`).join(", ");
  }
  function activeLeaves(state) {
    const containers = /* @__PURE__ */ new Set();
    for (const path of state.active.keys()) {
      for (let at = path.lastIndexOf("/"); at > 0; at = path.lastIndexOf("/", at - 1)) containers.add(path.slice(0, at));
    }
    return [...state.active.keys()].filter((path) => !containers.has(path));
  }

  // src/recording.ts
  var MOST = 3e5;
  var PART = 1e5;
  var APART = 2e3;
  var Recording = class {
    constructor(most = MOST, part = PART) {
      this.most = most;
      this.part = part;
    }
    most;
    part;
    events = [];
    /** The number of events that are no longer kept, or never arrived. */
    dropped = 0;
    first = emptyState();
    last = emptyState();
    kept = [];
    cursor = { position: 0, state: emptyState() };
    add(events) {
      for (const event of events) {
        advance(this.last, event);
        this.events.push(event);
        if (this.events.length % APART === 0) this.kept.push(copyState(this.last));
      }
      if (this.events.length > this.most) this.forget();
    }
    clear() {
      this.events.length = 0;
      this.dropped = 0;
      this.kept = [];
      this.first = emptyState();
      this.last = emptyState();
      this.cursor = { position: 0, state: emptyState() };
    }
    /** The state after the first `position` events. It must not be changed. */
    at(position) {
      if (position >= this.events.length) return this.last;
      const before = Math.floor(position / APART);
      const { cursor } = this;
      if (cursor.position > position || cursor.position < before * APART) {
        const start = before ? this.kept[before - 1] : this.first;
        this.cursor = { position: before * APART, state: copyState(start) };
      }
      while (this.cursor.position < position) {
        advance(this.cursor.state, this.events[this.cursor.position]);
        this.cursor.position += 1;
      }
      return this.cursor.state;
    }
    /** The time of the first event that is kept, and of the last one, in seconds. */
    get times() {
      return [this.events[0]?.t ?? 0, this.events[this.events.length - 1]?.t ?? 0];
    }
    /** The number of events up to a time. Two runs in one trace start at zero: the first one counts. */
    until(t) {
      let low = 0;
      let high = this.events.length;
      while (low < high) {
        const middle = low + high >> 1;
        if ((this.events[middle].t ?? 0) <= t) low = middle + 1;
        else high = middle;
      }
      return low;
    }
    forget() {
      const part = Math.floor(this.part / APART) * APART || this.part;
      for (const event of this.events.slice(0, part)) advance(this.first, event);
      this.events.splice(0, part);
      this.dropped += part;
      this.kept = [];
      const state = copyState(this.first);
      this.events.forEach((event, index) => {
        advance(state, event);
        if ((index + 1) % APART === 0) this.kept.push(copyState(state));
      });
      this.cursor = { position: 0, state: copyState(this.first) };
    }
  };

  // src/simulation.ts
  var Simulation = class {
    /** `changed` is called after each change; `round` gives the try or item of a state in words. */
    constructor(viewer, token, changed, round) {
      this.viewer = viewer;
      this.token = token;
      this.changed = changed;
      this.round = round;
      if (token === null || !viewer.graph.model.simulated) return;
      viewer.toolbar.append(this.start);
      this.element.append(
        this.back,
        button("Restart the simulation", "Restart", () => void this.act({ action: "start" }), "Stand before the first state again"),
        button("End the simulation", "End", () => void this.act({ action: "end" }))
      );
      viewer.addSection({ id: "simulate", title: "Simulate", first: true, fill: (node) => this.fill(node) });
      document.addEventListener("keydown", (event) => this.key(event));
      this.show();
    }
    viewer;
    token;
    changed;
    round;
    /** The buttons that act on a simulation that runs. */
    element = html("div", { class: "control", role: "group", "aria-label": "Simulation" });
    status = { state: "off" };
    start = button("Simulate the machine", "Simulate", () => void this.act({ action: "start" }), "Choose the outcome of each state");
    back = button("Step back", "Step back", () => void this.act({ action: "back" }), "Take back the last choice (z)");
    said = html("p", { class: "said", role: "status" });
    shown = null;
    get runs() {
      return this.status.state !== "off";
    }
    /** The states that wait for a choice. */
    get at() {
      return this.status.state === "off" ? [] : this.status.at;
    }
    received(status) {
      this.status = status;
      this.say("");
      this.show();
      this.changed();
      this.viewer.refresh();
    }
    /** Select a state that waits; after the end, the machine. */
    async follow() {
      const { selected } = this.viewer;
      if (this.status.state === "off" || this.at.some(({ path }) => path === selected)) return;
      await this.viewer.select(this.at[0]?.path ?? null);
    }
    /** The machine has changed: its states may have other names. */
    async remodelled() {
      this.shown = null;
      this.viewer.refresh();
      await this.follow();
    }
    show() {
      this.element.hidden = this.token === null || !this.runs;
      this.start.disabled = this.runs;
      this.back.disabled = this.status.state === "off" || !this.status.steps.length;
    }
    async act(body) {
      const at = this.status.state === "off" ? 0 : this.status.steps.length;
      const answer = await post(this.token, "simulate", { at, ...body });
      if (!answer.ok) {
        this.say(answer.reason, "refused");
        if (!this.runs) this.viewer.notice(answer.reason);
      } else if (answer.content.file !== void 0) {
        this.say(`Written: ${answer.content.file}
${answer.content.command}`, "done");
      }
      return answer.ok;
    }
    say(text, tone = "") {
      this.said.textContent = text;
      this.said.className = `said ${tone}`.trim();
    }
    /** The section of the panel; what is typed in stays while the simulation stands where it is. */
    fill(node) {
      if (this.status.state === "off") return null;
      const path = node?.path ?? null;
      if (this.shown?.status !== this.status || this.shown.path !== path) {
        const element = html("div", { class: "edit simulate" });
        this.shown = { status: this.status, path, element };
        element.append(...this.parts(path));
      }
      return this.shown.element;
    }
    parts(path) {
      if (this.status.state === "off") return [];
      const { note, at, steps, state, outcome } = this.status;
      const parts = [];
      if (note) parts.push(html("p", { class: "said refused" }, note));
      const standing = at.find((each) => each.path === path);
      if (standing) parts.push(this.choices(standing));
      const others = at.filter((each) => each !== standing);
      if (others.length) {
        parts.push(html(
          "p",
          {},
          standing ? "These wait too: " : "Choose the outcome of: ",
          ...others.map((each) => this.link(this.name(each.path), each.path))
        ));
      }
      if (!at.length) parts.push(this.saving(state === "failed" ? "The machine has failed." : `The machine has ended with ${outcome}.`, outcome));
      parts.push(this.said);
      if (steps.length) parts.push(this.history(steps));
      return parts;
    }
    name(path) {
      return this.viewer.graph.nodes.get(path)?.name ?? path;
    }
    link(text, path) {
      const made = html("button", { type: "button", class: "link" }, text);
      made.addEventListener("click", () => void this.viewer.select(path));
      return made;
    }
    /** What a state that waits can do. */
    choices(standing) {
      const stop = html("input", { type: "checkbox" });
      const takes = html("input", { type: "text", placeholder: "0 s", spellcheck: "false", "aria-label": "Time that it takes" });
      const message = html("input", { type: "text", placeholder: "message", spellcheck: "false", "aria-label": "Message of the error" });
      const choose = (body) => {
        void this.act({ action: "choose", path: standing.path, stop: stop.checked, ...body });
      };
      const outcomes2 = standing.outcomes.map((each) => this.outcome(standing.path, each, (set) => choose({ outcome: each.name, set, ...takes.value.trim() ? { after: takes.value } : {} })));
      const other = [
        standing.run && button(`Let it ${standing.run}`, standing.run, () => choose({ run: true })),
        standing.wait && button(standing.wait, standing.wait, () => choose({ wait: true }), "Let time pass")
      ].filter((each) => each !== "");
      const stopWords = standing.stops ? "A stop request arrives first: it ends with preempted" : "A stop request arrives first";
      const form = html(
        "div",
        { class: "waiting" },
        html("p", {}, `${standing.stopped ? "It has a stop request. " : ""}${capital(this.round(standing.path) || "it")} ends with:`),
        ...outcomes2,
        other.length ? html("p", {}, "Or:") : null,
        other.length ? html("p", { class: "forced" }, ...other) : null,
        html(
          "details",
          {},
          html("summary", {}, "more"),
          html("label", { class: "more-field" }, "It takes", takes),
          standing.stopped ? null : html("label", { class: "more-field" }, stop, stopWords),
          html("p", { class: "more-field" }, button("Let it fail with an error", "error", () => choose({ error: message.value })), message)
        )
      );
      form.addEventListener("input", () => this.say(""));
      return form;
    }
    /** An outcome with the keys that the state writes. */
    outcome(path, { name, keys: keys2 }, choose) {
      const fields = keys2.map((key) => keyField(key));
      const end2 = button(`End with ${name}`, name, () => choose(Object.fromEntries(fields.filter(({ used }) => used.checked).map(({ key, value }) => [key.name, value.value]))));
      const node = this.viewer.graph.nodes.get(path);
      const look3 = node?.outcomes.find((each) => each.name === name) ?? node?.repeated?.find((each) => each.name === name);
      if (look3?.failure) end2.classList.add("failure");
      return html("div", { class: "ending", role: "group", "aria-label": name }, end2, ...fields.map(({ element }) => element));
    }
    saving(words, outcome) {
      const name = html("input", { type: "text", required: true, spellcheck: "false", autocomplete: "off" });
      name.value = outcome?.replaceAll(/[^\w-]/g, "_") ?? "failure";
      const form = html(
        "form",
        {},
        html("p", {}, words),
        html("p", { class: "field" }, html("label", {}, "Name of the scenario", name)),
        html("div", { class: "acts" }, html("button", { type: "submit" }, "Save as a scenario"))
      );
      form.addEventListener("submit", (event) => {
        event.preventDefault();
        void this.act({ action: "save", name: name.value.trim() });
      });
      return form;
    }
    /** The choices so far; a click on one goes back to where it was made. */
    history(steps) {
      const rows = steps.map(({ path, text }, index) => {
        const back = button(`Back to the choice of ${this.name(path)}, step ${index + 1}`, this.name(path), () => void this.act({ action: "back", to: index }), "Go back to this choice");
        back.classList.add("link");
        return html("li", {}, back, html("span", {}, ` ${text}`));
      });
      const list = html("ol", { class: "steps", tabindex: "0", "aria-label": "Steps" }, ...rows);
      requestAnimationFrame(() => list.scrollTop = list.scrollHeight);
      return html("details", { open: true }, html("summary", {}, "steps"), list);
    }
    key(event) {
      if (event.key !== "z" || event.ctrlKey || event.metaKey || event.altKey || this.back.disabled || !this.runs) return;
      if (event.target.closest("input, select, textarea")) return;
      void this.act({ action: "back" });
    }
  };
  function capital(text) {
    return text.slice(0, 1).toUpperCase() + text.slice(1);
  }
  function keyField(key) {
    const used = html("input", { type: "checkbox", "aria-label": `Write ${key.name}`, title: "Write this key" });
    used.checked = true;
    const label = { "aria-label": `Value of ${key.name}`, title: key.type };
    const value = key.choices.length ? html("select", label, ...key.choices.map((each) => html("option", { value: each }, each))) : html("input", { ...label, type: "text", spellcheck: "false", autocomplete: "off" });
    value.value = key.value;
    value.addEventListener("input", () => used.checked = true);
    const element = html("div", { class: "key-field" }, used, html("span", { class: "key", title: key.type }, key.name, " ", html("small", {}, key.type)), value);
    return { key, used, value, element };
  }

  // src/run_marks.ts
  function nodeAt(graph, path) {
    return graph.nodes.get(path);
  }
  function highlightOf(graph, state, control) {
    const visits = /* @__PURE__ */ new Map();
    for (const [path, each] of state.visited) {
      const node = nodeAt(graph, path);
      if (node && node.path !== graph.model.root) visits.set(node.path, each.visits);
    }
    return {
      active: known(graph, activeLeaves(state)).filter((path) => !isContainer(graph.nodes.get(path))),
      taken: takenEdges(graph, state),
      visits,
      rounds: new Map([...state.rounds.keys()].map((path) => [path, roundInWords(state, path)])),
      waiting: known(graph, control?.at.map((each) => each.path) ?? []),
      breakpoints: known(graph, control?.breakpoints.map((each) => each.path) ?? [])
    };
  }
  function foreignPlace(graph, state) {
    const place2 = [...state.visited.keys()].find((path) => !nodeAt(graph, path));
    if (place2 === void 0) return "";
    const [machine = ""] = place2.split("/");
    const { root } = graph.model;
    if (machine !== root) return `This is the trace of the machine ${machine}, not of ${root}.`;
    return `The script has no state ${place2}: it is not the version that ran.`;
  }
  function known(graph, paths) {
    return paths.map((path) => nodeAt(graph, path)?.path).filter((path) => path !== void 0);
  }
  function takenEdges(graph, state) {
    const found = /* @__PURE__ */ new Set();
    for (const key of state.taken.keys()) {
      const [path = "", outcome = "", to = ""] = key.split("\n");
      if (nodeAt(graph, path)) found.add(`${path}
${outcome}
${to}`);
    }
    for (const [path, visited] of state.visited) {
      const node = nodeAt(graph, path);
      if (!node || !isContainer(node)) continue;
      for (const edge of graph.inside.get(node.path) ?? []) {
        const end2 = typeof edge.target === "string" ? edge.target : null;
        if (edge.source === null) {
          if (end2 !== null && state.visited.has(end2)) found.add(edgeId(edge));
        } else if (node.kind === "concurrence" && end2 === null) {
          const branch = state.visited.get(edge.source);
          const outcome = edge.target.outcome;
          if (branch?.lastOutcome === edge.outcome && visited.lastOutcome === outcome) found.add(edgeId(edge));
        }
      }
    }
    return found;
  }
  function keyValues(graph, state) {
    const found = /* @__PURE__ */ new Map();
    for (const written of state.written.values()) {
      const node = nodeAt(graph, written.path);
      if (!node) continue;
      const place2 = placeOf(graph, node, written.key);
      const id = `${place2.scope}
${place2.key}`;
      const before = found.get(id);
      if (!before || before.written.order < written.order) found.set(id, { ...place2, written });
    }
    return [...found.values()].sort((a, b) => b.written.order - a.written.order);
  }
  function placeOf(graph, node, key) {
    let here = node;
    let name = key;
    let type = "";
    let secret = false;
    for (; ; ) {
      const declared = [...here.outputs, ...here.inputs].find((each) => each.name === name);
      if (declared) {
        type = declared.type;
        secret ||= declared.secret ?? false;
      }
      const around = here.parent === null ? void 0 : graph.nodes.get(here.parent);
      if (!around || !declared && (here !== node || isContainer(here))) return { scope: here.path, key: name, type, secret };
      name = declared?.key ?? name;
      here = around;
    }
  }
  var SHORT = 90;
  function inline(value, most = SHORT) {
    const text = JSON.stringify(value, (_, each) => typeof each === "number" && !Number.isInteger(each) ? Number(each.toPrecision(6)) : each) ?? "";
    return text.length > most ? `${text.slice(0, most)}\u2026` : text;
  }
  function inWords(graph, event) {
    const node = nodeAt(graph, event.path);
    const name = node?.name ?? event.path;
    const outcomes2 = [...node?.outcomes ?? [], ...node?.repeated ?? []];
    const failure = outcomes2.find((each) => each.name === event.outcome)?.failure ?? false;
    const tone = failure ? "bad" : "good";
    switch (event.event) {
      case "start":
        return { text: `${name} starts`, tone: "" };
      case "enter":
        return { text: `${name} starts`, tone: "" };
      case "exit": {
        const kind = node?.parent ? graph.nodes.get(node.parent)?.kind : void 0;
        if (!event.forced && (kind === "machine" || kind === "sequence")) return null;
        return { text: `${name} ends${withOutcome(event)}${event.forced ? " (forced)" : ""}`, tone };
      }
      case "transition": {
        const to = event.to ?? "";
        const target2 = nodeAt(graph, to)?.name ?? `end of ${to.replace(":", " with ").split("/").pop()}`;
        return { text: `${name}: ${event.outcome} \u2192 ${target2}`, tone };
      }
      case "write":
        return { text: `${name} writes ${event.key} = ${inline(event.value)}`, tone: "" };
      case "try":
      case "item":
        return { text: `${name}: ${event.event} ${event.number}${event.of === void 0 ? "" : ` of ${event.of}`}`, tone: "" };
      case "try ended":
      case "item ended": {
        const [what] = event.event.split(" ");
        return { text: `${name}: ${what} ${event.number} ends${withOutcome(event)}`, tone };
      }
      case "preempt":
        return { text: `${name} is requested to stop`, tone: "" };
      case "error":
        return { text: `${name}: error: ${event.message}`, tone: "bad" };
      case "fault":
        return { text: `injected fault: ${event.fault}`, tone: "bad" };
      case "finish":
        return { text: `${name} ends${withOutcome(event)}`, tone };
      default:
        return { text: `${name}: ${event.event}`, tone: "" };
    }
  }
  function withOutcome({ outcome }) {
    return outcome === void 0 ? "" : ` with ${outcome}`;
  }
  function seconds(t) {
    if (t < 1) return `${Math.round(t * 1e3)} ms`;
    if (t < 100) return `${t.toFixed(1)} s`;
    const minutes = Math.floor(t / 60);
    return minutes < 60 ? `${minutes} min ${Math.floor(t % 60)} s` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
  }

  // src/timeline.ts
  var SPEEDS = [0.25, 1, 4, 16, 64];
  var EVENTS_A_SECOND = 4;
  var Timeline = class {
    /** `moved` is called when the position has changed through the user or the replay. */
    constructor(recording, moved2) {
      this.recording = recording;
      this.moved = moved2;
      this.slider.addEventListener("input", () => this.goTo(Number(this.slider.value)));
      this.element = html(
        "div",
        { class: "timeline", role: "group", "aria-label": "Time line" },
        button("First event", "First", () => this.goTo(0), "Go to the start"),
        button("Previous event", "\u2039", () => this.step(-1), "Previous event (,)"),
        this.play,
        button("Next event", "\u203A", () => this.step(1), "Next event (.)"),
        this.latest,
        this.slider,
        this.label,
        this.speed
      );
    }
    recording;
    moved;
    element;
    /** The number of events before the position. */
    position = 0;
    /** Called with the time of the run that is shown, in seconds; in a replay also between events. */
    timeShown = () => {
    };
    /** Whether the position moves with the run. */
    follows = true;
    playing = false;
    /** The time of the replay: seconds of the run, or a number of events. */
    clock = 0;
    last = 0;
    slider = html("input", {
      type: "range",
      min: 0,
      max: 0,
      value: 0,
      step: 1,
      "aria-label": "Position in the run"
    });
    label = html("span", { class: "position" });
    play = button("Play", "Play", () => this.toggle(), "Play the recorded run (p)");
    latest = button("Latest event", "Latest", () => this.goTo(Infinity), "Go to the latest event");
    speed = html(
      "select",
      { "aria-label": "Speed" },
      ...SPEEDS.map((each) => html("option", { value: each, selected: each === 1 }, `${each} \xD7`))
    );
    /** Follow the run after new events. */
    update() {
      if (this.follows) this.position = this.recording.events.length;
      this.position = Math.min(this.position, this.recording.events.length);
      this.show();
    }
    goTo(position) {
      this.playing = false;
      this.move(position);
    }
    step(by) {
      this.goTo(this.position + by);
    }
    /** Start or stop the replay; at the end it starts at the first event. */
    toggle() {
      this.playing = !this.playing;
      if (this.playing) {
        if (this.position >= this.recording.events.length) this.move(0);
        this.clock = this.timed ? this.timeAt(this.position) : this.position;
        this.last = performance.now();
        requestAnimationFrame((now) => this.tick(now));
      }
      this.show();
    }
    tick(now) {
      if (!this.playing) return;
      const passed = Math.min(1, (now - this.last) / 1e3) * Number(this.speed.value);
      this.last = now;
      this.clock += this.timed ? passed : passed * EVENTS_A_SECOND;
      const next = this.timed ? this.recording.until(this.clock) : Math.floor(this.clock);
      if (next > this.position) this.move(next);
      if (this.position >= this.recording.events.length) this.playing = false;
      else requestAnimationFrame((then) => this.tick(then));
      this.show();
    }
    get timed() {
      const [first, last] = this.recording.times;
      return last > first;
    }
    timeAt(position) {
      return this.recording.events[Math.max(0, position - 1)]?.t ?? this.recording.times[0];
    }
    move(position) {
      const end2 = this.recording.events.length;
      this.position = Math.max(0, Math.min(position, end2));
      this.follows = this.position === end2 && !this.playing;
      this.show();
      this.moved();
    }
    show() {
      const end2 = this.recording.events.length;
      this.slider.max = String(end2);
      this.slider.value = String(this.position);
      const { dropped } = this.recording;
      const time = end2 ? `, ${seconds(this.position ? this.timeAt(this.position) : 0)} of ${seconds(this.recording.times[1])}` : "";
      this.label.textContent = `event ${this.position + dropped} of ${end2 + dropped}${time}`;
      this.slider.setAttribute("aria-valuetext", this.label.textContent);
      this.play.textContent = this.playing ? "Stop" : "Play";
      this.play.setAttribute("aria-label", this.playing ? "Stop the replay" : "Play");
      this.latest.setAttribute("aria-pressed", String(this.follows));
      if (end2) this.timeShown(this.playing && this.timed ? this.clock : this.timeAt(this.position));
    }
  };

  // src/written_events.ts
  var WrittenEvents = class {
    /** `parts` are those of the machine that is shown now. */
    constructor(parts) {
      this.parts = parts;
    }
    parts;
    visits = /* @__PURE__ */ new Map();
    clear() {
      this.visits.clear();
    }
    all(events) {
      return events.map((event) => this.one(event)).filter((event) => event !== null);
    }
    /** The event of the written state, or null for one that only a part of the state has. */
    one(event) {
      const part = this.parts().of(event.path);
      const to = event.to === void 0 ? {} : { to: this.place(event.to) };
      if (!part) return { ...event, ...to };
      if (part.added) return null;
      const { path } = part;
      switch (event.event) {
        case "enter":
          return this.enter(event, part);
        case "exit":
          return this.exit(event, part);
        case "transition":
          return this.visits.has(path) ? null : { ...event, path, ...to };
        case "preempt":
          return part.outer ? { ...event, path } : null;
        default:
          return { ...event, path };
      }
    }
    enter(event, part) {
      const { path, begins } = part;
      const known2 = this.visits.get(path);
      if (part.outer || !known2) {
        this.visits.set(path, { first: event.path, try: 0, item: 0 });
        return { ...event, path };
      }
      if (!begins) return null;
      known2[begins] += 1;
      if (begins === "item") known2.try = 0;
      return { ...event, event: begins, path, number: known2[begins], of: part.count ?? void 0 };
    }
    exit(event, part) {
      const { path, begins } = part;
      const known2 = this.visits.get(path);
      if (part.outer || known2?.first === event.path) {
        this.visits.delete(path);
        return { ...event, path };
      }
      return begins && known2 ? { ...event, event: `${begins} ended`, path, number: known2[begins] } : null;
    }
    /** The target of a transition: a state, or an outcome of a container behind a colon. */
    place(to) {
      const state = this.parts().of(to);
      if (state) return state.path;
      const colon = to.lastIndexOf(":");
      const container = colon < 0 ? void 0 : this.parts().of(to.slice(0, colon));
      return container ? container.path + to.slice(colon) : to;
    }
  };

  // src/run_view.ts
  var APART2 = 80;
  var FOLLOW_APART = 400;
  var LOG_LINES = 200;
  var KEY_ROWS = 60;
  function showRuns(viewer, trace, film) {
    const { live } = viewer.graph.model;
    const token = live ? takeToken() : null;
    if (!live && !trace) return;
    const view = new RunView(viewer, token, live);
    if (trace) view.replay(JSON.parse(trace));
    if (film) view.addFilm(new Film(JSON.parse(film)));
    if (live) view.connect();
  }
  var RunView = class {
    constructor(viewer, token, live) {
      this.viewer = viewer;
      this.live = live;
      this.written = new WrittenEvents(() => viewer.graph.parts);
      this.timeline = new Timeline(this.recording, () => this.draw());
      this.control = new Control(token, () => this.controlled(), (reason) => viewer.notice(reason));
      this.simulation = new Simulation(
        viewer,
        token,
        () => this.simulated(),
        (path) => roundInWords(this.recording.at(Infinity), path)
      );
      this.bar = html(
        "div",
        { class: "run-bar" },
        this.foreign,
        this.status,
        this.control.element,
        this.simulation.element,
        this.follow,
        this.timeline.element
      );
      this.details = html("div", { class: "run-details", hidden: true }, this.log, this.keys);
      viewer.footer.append(this.bar, this.details);
      viewer.addSection({ id: "run", title: "Run", first: true, fill: (node) => this.fill(node) });
      viewer.addSection({ id: "errors", title: "Errors in the script now", first: true, fill: (node) => node ? null : this.errorList() });
      document.addEventListener("keydown", (event) => this.key(event));
      setInterval(() => this.tick(), 500);
      this.draw();
    }
    viewer;
    live;
    recording = new Recording();
    written;
    timeline;
    control;
    simulation;
    status = html("p", { class: "run-status", role: "status" });
    foreign = html("p", { class: "run-foreign", role: "status" });
    log = html("ol", { class: "log", tabindex: "0", "aria-label": "Log" });
    keys = html("div", { class: "values", tabindex: "0", "aria-label": "Values of keys" });
    bar;
    details;
    part = html("div", { class: "run-part" });
    follow = button("Follow", "Follow", () => this.toggleFollow(), "Select the state that runs (o)");
    follows = false;
    followed = 0;
    shownNode = null;
    filledFor = "";
    errors = [];
    link = "";
    arrived = performance.now();
    drawn = 0;
    waiting = false;
    loggedTo = -1;
    replay(events) {
      this.recording.add(this.written.all(events));
      this.timeline.update();
      this.draw();
    }
    /** Show a film in step with the time line. */
    addFilm(film) {
      this.details.classList.add("filmed");
      this.details.append(film.element);
      this.timeline.timeShown = (t) => film.show(t);
    }
    connect() {
      connect({
        opened: () => {
          this.link = "";
          this.recording.clear();
          this.written.clear();
          this.loggedTo = -1;
          this.timeline.follows = true;
          if (this.simulation.runs) this.simulation.received({ state: "off" });
          this.changed();
        },
        received: (message) => this.received(message),
        interrupted: () => this.disconnected("The connection is interrupted."),
        ended: () => this.disconnected("")
      });
    }
    disconnected(link2) {
      this.link = link2;
      if (!link2 && this.control.status) this.control.received({ ...this.control.status, ended: true });
      this.changed();
    }
    received(message) {
      switch (message.kind) {
        case "model":
          void this.remodel(message.model);
          break;
        case "report":
          this.report(message.broken, message.outdated, message.findings);
          break;
        case "trace":
          this.recording.add(this.written.all(message.events));
          this.arrived = performance.now();
          this.timeline.update();
          this.changed();
          break;
        case "dropped":
          this.recording.dropped += message.count;
          break;
        case "source":
          this.link = message.waits;
          this.changed();
          break;
        case "control":
          this.control.received(message);
          break;
        case "simulation":
          this.simulation.received(message);
          void this.simulation.follow();
      }
    }
    /** Show the run of the simulation as far as it is chosen. */
    simulated() {
      const { status } = this.simulation;
      this.recording.clear();
      this.written.clear();
      if (status.state !== "off") this.recording.add(this.written.all(status.events));
      this.details.hidden = status.state === "off" || this.details.hidden;
      this.loggedTo = -1;
      this.timeline.goTo(Infinity);
      this.changed();
    }
    async remodel(model) {
      await this.viewer.setModel(model);
      if (this.simulation.runs) {
        this.simulated();
        await this.simulation.remodelled();
      }
      this.loggedTo = -1;
      this.draw();
    }
    report(broken, outdated, findings2) {
      this.errors = broken ? findings2.filter((each) => each.severity === "error") : [];
      const [first] = this.errors;
      const more = this.errors.length > 1 ? ` (and ${this.errors.length - 1} more)` : "";
      const picture = outdated ? ". The picture is that of the last version without errors." : "";
      const text = first ? `${first.file}:${first.line}: error ${first.code}: ${first.message}${more}${picture}` : "";
      this.viewer.notice(text, this.errorList());
      this.viewer.refresh();
    }
    errorList() {
      if (!this.errors.length) return null;
      return html("ul", { class: "findings" }, ...this.errors.map((each) => html(
        "li",
        { class: "error" },
        html("p", {}, html("strong", {}, `error ${each.code}`), " ", each.message),
        each.help ? html("p", { class: "help" }, `help: ${each.help}`) : null,
        ...each.related.map(({ file, line, message }) => html("p", { class: "help" }, `${file}:${line}: ${message}`)),
        each.file ? html("p", { class: "place" }, `${each.file}:${each.line}`) : null
      )));
    }
    controlled() {
      const [first] = this.control.status?.at ?? [];
      const node = first && nodeAt(this.viewer.graph, first.path);
      if (node && this.control.able && this.viewer.selected !== node.path) void this.viewer.select(node.path);
      this.fillPart(this.shownNode);
      this.changed();
    }
    /** Draw soon: at once if nothing was drawn lately, else after a short time, once for all changes. */
    changed() {
      if (this.waiting) return;
      this.waiting = true;
      setTimeout(() => requestAnimationFrame(() => this.draw()), Math.max(0, APART2 - (performance.now() - this.drawn)));
    }
    draw() {
      this.waiting = false;
      this.drawn = performance.now();
      const any = this.recording.events.length > 0 || this.control.status !== null;
      if (any && this.details.hidden) this.open();
      this.bar.hidden = !any && !this.link;
      const state = this.recording.at(this.timeline.position);
      const { at } = this.simulation;
      const simulated = this.simulation.runs ? { at: at.map(({ path }) => ({ path, outcome: null, round: null, outcomes: [] })), breakpoints: [] } : null;
      const control = this.timeline.follows ? simulated ?? this.control.status : null;
      this.viewer.highlight(any ? highlightOf(this.viewer.graph, state, control) : null);
      this.status.textContent = this.inWords(state);
      const foreign = foreignPlace(this.viewer.graph, this.recording.at(Infinity));
      if (this.foreign.textContent !== foreign) this.foreign.textContent = foreign;
      this.drawLog();
      this.drawKeys(state);
      this.fillPart(this.shownNode);
      this.followRun(state);
    }
    /** Show what belongs to a run: the picture gets smaller. */
    open() {
      this.details.hidden = false;
      this.bar.hidden = false;
      this.viewer.fit();
    }
    /** Count the seconds of the active states on, also without events. What has changed is drawn as a whole. */
    tick() {
      if (this.live && !this.simulation.runs && this.timeline.follows && !this.bar.hidden && !this.waiting) {
        this.status.textContent = this.inWords(this.recording.at(this.timeline.position));
      }
    }
    toggleFollow() {
      this.follows = !this.follows;
      this.follow.setAttribute("aria-pressed", String(this.follows));
      this.draw();
    }
    /** Select the state that runs, if that is wanted, and not more often than one can see. */
    followRun(state) {
      const [path] = activeLeaves(state);
      const node = path === void 0 ? void 0 : nodeAt(this.viewer.graph, path);
      if (!this.follows || !node || node.path === this.viewer.selected) return;
      if (performance.now() - this.followed < FOLLOW_APART) return;
      this.followed = performance.now();
      void this.viewer.select(node.path);
    }
    inWords(state) {
      const { graph } = this.viewer;
      const name = (path) => nodeAt(graph, path)?.name ?? path;
      if (this.link) return this.link;
      if (state.ended) return `ended with ${state.outcome}`;
      if (state.error && !state.active.size) return `failed in ${name(state.error.path)}`;
      const status = this.timeline.follows ? this.control.status : null;
      if (status?.ended) return state.error ? `failed in ${name(state.error.path)}: ${state.error.message}` : "ended";
      const round = (path) => state.rounds.has(path) ? ` (${roundInWords(state, path)})` : "";
      if (this.simulation.runs && this.timeline.follows) {
        const { at } = this.simulation;
        if (at.length) return `${at.map(({ path }) => `${name(path)}${round(path)}`).join(", ")}: choose an outcome`;
        if (state.error) return `failed in ${name(state.error.path)}: ${state.error.message}`;
      }
      const running = activeLeaves(state).map((path) => `${name(path)}${round(path)} ${this.since(state, path)}`);
      const waits = (status?.at ?? []).map(({ path, outcome, round: round2 }) => outcome === null ? `paused before ${round2 === null ? "" : `${round2 === "try" ? "a try" : "an item"} of `}${name(path)}` : `paused after ${name(path)}: ${outcome}`);
      if (waits.length) return waits.join(", ");
      if (status?.stopping) return `stopping: ${running.join(", ")}`;
      if (status?.paused) return `pauses before the next state: ${running.join(", ")}`;
      if (!running.length || state.root === null) return "not started";
      return running.join(", ");
    }
    since(state, path) {
      const waited = this.live && !this.simulation.runs && this.timeline.follows ? (performance.now() - this.arrived) / 1e3 : 0;
      return seconds(state.t - (state.active.get(path) ?? state.t) + waited);
    }
    drawLog() {
      const { position } = this.timeline;
      if (position === this.loggedTo) return;
      this.loggedTo = position;
      const { graph } = this.viewer;
      const rows = [];
      for (let index = position - 1; index >= 0 && rows.length < LOG_LINES; index -= 1) {
        const event = this.recording.events[index];
        const words = inWords(graph, event);
        if (!words) continue;
        const row = html(
          "li",
          { class: words.tone, title: event.src ?? "" },
          html("time", {}, (event.t ?? 0).toFixed(2)),
          " ",
          words.text
        );
        row.addEventListener("click", () => void this.viewer.select(nodeAt(graph, event.path)?.path ?? null));
        rows.push(row);
      }
      this.log.replaceChildren(...rows.reverse());
      this.log.scrollTop = this.log.scrollHeight;
    }
    drawKeys(state) {
      const rows = keyValues(this.viewer.graph, state).slice(0, KEY_ROWS).map((each) => {
        const value = each.secret ? "(secret)" : inline(each.written.value, 300);
        const where = `${each.scope}, written by ${each.written.path} at ${each.written.t.toFixed(2)} s`;
        return html(
          "tr",
          { title: where },
          html("th", { scope: "row" }, each.key),
          html("td", { class: "type" }, each.type),
          html("td", {}, html("code", {}, value))
        );
      });
      const caption = rows.length ? "Values of keys, the newest first" : "No key was written yet";
      this.keys.replaceChildren(html("table", {}, html("caption", {}, caption), html("tbody", {}, ...rows)));
    }
    fill(node) {
      this.shownNode = node;
      this.fillPart(node);
      return node && (this.recording.events.length || this.control.able) ? this.part : null;
    }
    /** The section of the selected state; it is filled again as the run goes on. */
    fillPart(node) {
      if (!node) return;
      const focused = this.filledFor === node.path && this.part.contains(document.activeElement);
      this.filledFor = node.path;
      const control = this.control.partFor(node);
      if (!focused || !control) this.part.replaceChildren(...control ? [control] : []);
      else this.part.querySelector(".facts")?.remove();
      this.part.append(this.facts(node));
    }
    facts(node) {
      const { graph } = this.viewer;
      const state = this.recording.at(this.timeline.position);
      const { path } = node;
      const visited = state.visited.get(path);
      const rows = [];
      const row = (name, value) => {
        rows.push(html("li", {}, html("span", { class: "key" }, name), html("code", {}, value)));
      };
      if (visited) {
        row("visits", String(visited.visits));
        if (state.active.has(path)) row("in it since", this.since(state, path));
        const done = [...visited.outcomes.values()].reduce((a, b) => a + b, 0);
        if (done) row("mean time", seconds(visited.seconds / done));
        for (const [outcome, count2] of visited.outcomes) row(outcome, `${count2} of ${done}`);
      } else {
        row("visits", "0");
      }
      const values = new Map(keyValues(graph, state).map((each) => [`${each.scope}
${each.key}`, each]));
      for (const key of new Set([...node.inputs, ...node.outputs].map((each) => each.name))) {
        const place2 = placeOf(graph, node, key);
        const found = values.get(`${place2.scope}
${place2.key}`);
        if (found) row(key, place2.secret || found.secret ? "(secret)" : inline(found.written.value, 500));
      }
      return html("ul", { class: "rows facts" }, ...rows);
    }
    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target.closest("input, select, textarea")) return;
      const path = this.viewer.selected;
      const actions = {
        ",": () => this.timeline.step(-1),
        ".": () => this.timeline.step(1),
        p: () => this.timeline.toggle(),
        s: () => this.control.do({ action: "step" }),
        o: () => this.toggleFollow(),
        r: () => this.control.pauseOrResume(),
        b: () => path !== null && this.control.toggleBreakpoint({ path, outcome: null, round: null })
      };
      actions[event.key]?.();
    }
  };

  // src/statistics.ts
  function showStatistics(viewer) {
    const { statistics } = viewer.graph.model;
    if (!statistics) return;
    const { graph } = viewer;
    const visits = new Map(Object.entries(statistics.states).map(([path, each]) => [path, each.visits]));
    visits.delete(graph.model.root);
    const taken = graph.model.edges.filter((edge) => isTaken(graph, statistics, edge)).map(edgeId);
    const times = new Map([...visits.keys()].flatMap((path) => {
      const { mean, rounds } = statistics.states[path];
      const words = [rounds, mean ? seconds(mean) : ""].filter(Boolean).join(" \xB7 ");
      return words ? [[path, words]] : [];
    }));
    viewer.highlight({ active: [], taken, visits, times });
    viewer.onMark((picture) => markNever(graph, statistics, picture));
    viewer.addSection({
      id: "statistics",
      title: "Statistics",
      first: true,
      fill: (node) => html(
        "div",
        {},
        figures(statistics, node?.path ?? graph.model.root),
        node ? null : neverTaken(viewer, statistics)
      )
    });
  }
  function isTaken(graph, statistics, edge) {
    if (edge.source === null) return typeof edge.target === "string" && edge.target in statistics.states;
    const kind = graph.nodes.get(edge.container)?.kind;
    const known2 = kind === "machine" || kind === "sequence";
    return known2 && countOf(statistics.states[edge.source], edge.outcome) > 0;
  }
  function markNever(graph, statistics, picture) {
    for (const [path, element] of picture.states) {
      element.classList.toggle("never", path !== graph.model.root && !(path in statistics.states));
    }
    for (const { line, element } of picture.lines) {
      const never = line.line.edges.length > 0 && line.line.edges.every((id) => {
        const [source = "", outcome = ""] = id.split("\n");
        const start = outcome === "" && source === line.container;
        return !start && !countOf(statistics.states[source], outcome);
      });
      element.classList.toggle("never", never);
    }
  }
  function figures(statistics, path) {
    const found = statistics.states[path];
    const row = (name, value) => html("li", {}, html("span", { class: "key" }, name), html("code", {}, value));
    if (!found) return html("ul", { class: "rows" }, row("visits", "0: no run entered it"));
    const outcomes2 = Object.entries(found.outcomes).map(([name, count2]) => row(name, `${count2} (${shareOf(found, name)})`));
    const unfinished = found.unfinished ? [row("not ended", String(found.unfinished))] : [];
    return html(
      "ul",
      { class: "rows" },
      row("visits", String(found.visits)),
      ...found.rounds ? [row("tries and items", found.rounds)] : [],
      row("mean time", seconds(found.mean)),
      row("longest", seconds(found.longest)),
      ...outcomes2,
      ...unfinished
    );
  }
  function neverTaken(viewer, { never, transitions }) {
    const taken = transitions - never.length;
    const failures = never.filter(({ failure }) => failure).length;
    const rows = never.map(({ path, text, failure }) => {
      const link2 = html("button", { type: "button", class: "link" }, text);
      link2.addEventListener("click", () => void viewer.select(path));
      return html("li", {}, link2, failure ? html("span", { class: "failure" }, " failure") : null);
    });
    return html(
      "div",
      {},
      html("p", {}, `${taken} of ${transitions} transitions taken; grey and dotted: never`),
      failures ? html("p", {}, `${failures} of the others ${failures === 1 ? "follows a failure that was" : "follow failures that were"} never exercised`) : null,
      rows.length ? html("ul", { class: "rows never-taken", "aria-label": "Transitions never taken" }, ...rows) : null
    );
  }

  // src/camera.ts
  var LEAST = 0.02;
  var MOST2 = 3;
  var MARGIN = 24;
  var Camera = class {
    constructor(frame, content) {
      this.frame = frame;
      this.content = content;
      frame.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
      frame.addEventListener("pointerdown", (event) => this.drag(event));
    }
    frame;
    content;
    scale = 1;
    x = 0;
    y = 0;
    /** The scale at which an area is seen as a whole. */
    fitting(area) {
      const { clientWidth, clientHeight } = this.frame;
      const across = (clientWidth - 2 * MARGIN) / Math.max(1, area.width);
      const down = (clientHeight - 2 * MARGIN) / Math.max(1, area.height);
      return Math.min(1.25, Math.max(LEAST, Math.min(across, down)));
    }
    /** Show an area as a whole, hardly enlarged. */
    fit(area) {
      const { clientWidth, clientHeight } = this.frame;
      this.scale = this.fitting(area);
      this.x = (clientWidth - area.width * this.scale) / 2 - area.x * this.scale;
      this.y = (clientHeight - area.height * this.scale) / 2 - area.y * this.scale;
      this.apply();
    }
    /** Show the upper part of a picture around a place, at a scale: no space is left of a wide picture. */
    start(place2, width2, scale) {
      const half = this.frame.clientWidth / 2;
      this.scale = scale;
      this.x = half - Math.max(place2.x, Math.min(width2 / 2, half / scale)) * scale;
      this.y = MARGIN;
      this.apply();
    }
    /** Zoom by a factor; the point (in pixels of the frame) stays where it is. */
    zoom(factor, x = this.frame.clientWidth / 2, y = this.frame.clientHeight / 2) {
      const scale = Math.min(MOST2, Math.max(LEAST, this.scale * factor));
      this.x = x - (x - this.x) * scale / this.scale;
      this.y = y - (y - this.y) * scale / this.scale;
      this.scale = scale;
      this.apply();
    }
    pan(dx, dy) {
      this.x += dx;
      this.y += dy;
      this.apply();
    }
    /** Pan as little as is needed to show an area; at least its upper left corner. */
    reveal(area) {
      const { clientWidth, clientHeight } = this.frame;
      if (this.scale < 0.35) this.zoom(0.6 / this.scale);
      const left = area.x * this.scale + this.x;
      const top = area.y * this.scale + this.y;
      const right = Math.min(left + area.width * this.scale, left + clientWidth - 2 * MARGIN);
      const bottom = Math.min(top + area.height * this.scale, top + clientHeight - 2 * MARGIN);
      const dx = left < MARGIN ? MARGIN - left : Math.min(0, clientWidth - MARGIN - right);
      const dy = top < MARGIN ? MARGIN - top : Math.min(0, clientHeight - MARGIN - bottom);
      if (dx || dy) this.pan(dx, dy);
    }
    /** Move the picture so that what was at one place of it is where another place was. */
    keep(before, after) {
      this.pan((before.x - after.x) * this.scale, (before.y - after.y) * this.scale);
    }
    wheel(event) {
      event.preventDefault();
      const box = this.frame.getBoundingClientRect();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      const factor = Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 15e-4));
      this.zoom(factor, event.clientX - box.left, event.clientY - box.top);
    }
    drag(start) {
      if (start.button !== 0) return;
      let { clientX, clientY } = start;
      let moving = false;
      const move = (event) => {
        if (!moving && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 4) return;
        if (!moving) this.frame.setPointerCapture(start.pointerId);
        moving = true;
        this.frame.classList.add("moving");
        this.pan(event.clientX - clientX, event.clientY - clientY);
        ({ clientX, clientY } = event);
      };
      const end2 = () => {
        this.frame.classList.remove("moving");
        this.frame.removeEventListener("pointermove", move);
        this.frame.removeEventListener("pointerup", end2);
        this.frame.removeEventListener("pointercancel", end2);
        if (moving) this.frame.addEventListener("click", stop, { capture: true, once: true });
        window.setTimeout(() => this.frame.removeEventListener("click", stop, { capture: true }));
      };
      const stop = (event) => event.stopPropagation();
      this.frame.addEventListener("pointermove", move);
      this.frame.addEventListener("pointerup", end2);
      this.frame.addEventListener("pointercancel", end2);
    }
    apply() {
      this.content.setAttribute("transform", `translate(${this.x} ${this.y}) scale(${this.scale})`);
      this.frame.classList.toggle("far", this.scale < 0.4);
    }
  };

  // src/rows.ts
  var MARGIN2 = 12;
  var TRACK = 5;
  var ROW_TRACKS = 6;
  var COLUMN_TRACKS = 4;
  var RATIO = 1.5;
  var lengthOf = (each, down) => (down ? each.width : each.height) ?? 0;
  var depthOf = (each, down) => (down ? each.height : each.width) ?? 0;
  function inRows(graph, down, origin2) {
    const cells = cellsOf(graph.children ?? [], down);
    const edges = graph.edges ?? [];
    const grid = placeCells(cells, edges, down, down ? [origin2.x, origin2.y] : [origin2.y, origin2.x]);
    const ports = portsOf(cells, down);
    const stacked = /* @__PURE__ */ new Map();
    const place2 = (along, across) => down ? { x: along, y: across } : { x: across, y: along };
    return {
      id: graph.id,
      ...down ? { width: grid.size.along, height: grid.size.across } : { width: grid.size.across, height: grid.size.along },
      children: [...cells.values()].map(({ node, along, across }) => ({ ...node, ...place2(along, across) })),
      edges: edges.map((edge) => {
        const route = routeOf(edge, grid, ports);
        const points = route.map(([along, across]) => place2(along, across));
        return {
          ...edge,
          sections: [{ id: edge.id, startPoint: points[0], bendPoints: points.slice(1, -1), endPoint: points.at(-1) }],
          labels: (edge.labels ?? []).map((label) => {
            const [along, across] = labelPlace(edge, label, route, grid, stacked);
            return { ...label, ...place2(along - lengthOf(label, down) / 2, across) };
          })
        };
      })
    };
  }
  var pieceOf = (port) => port.slice(0, port.indexOf("\n"));
  var sourceOf = (edge) => pieceOf(edge.sources[0]);
  var targetOf = (edge) => pieceOf(edge.targets[0]);
  function cellsOf(nodes, down) {
    const isExit = (node) => node.id.startsWith(exitId(""));
    const [first, ...others] = nodes;
    const inside = others.filter((node) => !isExit(node));
    const mean = (size) => inside.reduce((sum, node) => sum + size(node), 0) / Math.max(1, inside.length) + 50;
    const ratio = (down ? RATIO : 1 / RATIO) * (mean((node) => depthOf(node, down)) / mean((node) => lengthOf(node, down)));
    const columns = Math.max(1, Math.round(Math.sqrt(inside.length * ratio)));
    const rows = [[first]];
    for (let at = 0; at < inside.length; at += columns) rows.push(inside.slice(at, at + columns));
    rows.push(others.filter(isExit));
    const cells = rows.flatMap((nodes2, row) => nodes2.map((node, column) => ({ node, row, column, along: 0, across: 0 })));
    return new Map(cells.map((cell) => [cell.node.id, cell]));
  }
  function placeCells(cells, edges, down, [left, top]) {
    const lengths = [];
    const depths = [];
    for (const { node, row, column } of cells.values()) {
      lengths[column] = Math.max(lengths[column] ?? 0, lengthOf(node, down));
      depths[row] = Math.max(depths[row] ?? 0, depthOf(node, down));
    }
    const gaps = lengths.map(() => 2 * MARGIN2 + COLUMN_TRACKS * TRACK);
    const stacks = /* @__PURE__ */ new Map();
    const labels = depths.map(() => 0);
    for (const edge of edges) {
      const [source, target2, label] = [cells.get(sourceOf(edge)), cells.get(targetOf(edge)), edge.labels?.[0]];
      if (!label) continue;
      if (areNeighbours(source, target2)) {
        gaps[target2.column] = Math.max(gaps[target2.column], lengthOf(label, down) + 2 * MARGIN2);
      } else {
        const depth = (stacks.get(source.node.id) ?? 0) + depthOf(label, down);
        stacks.set(source.node.id, depth);
        labels[source.row] = Math.max(labels[source.row], depth);
      }
    }
    const grid = { down, cells, ends: [], labelEnds: [], before: [], size: { along: left, across: top } };
    const starts = [];
    const columns = lengths.map((length, column) => {
      grid.before.push(grid.size.along);
      const start = grid.size.along + (gaps[column] ?? 0);
      grid.size.along = start + length;
      return start;
    });
    depths.forEach((depth, row) => {
      starts.push(grid.size.across);
      grid.ends.push(grid.size.across + depth);
      grid.labelEnds.push(grid.size.across + depth + labels[row] + 4);
      grid.size.across = row === depths.length - 1 ? grid.ends[row] : grid.labelEnds[row] + 2 * MARGIN2 + ROW_TRACKS * TRACK;
    });
    grid.size.along += left;
    for (const cell of cells.values()) {
      cell.along = columns[cell.column] + (lengths[cell.column] - lengthOf(cell.node, down)) / 2;
      cell.across = starts[cell.row];
    }
    return grid;
  }
  function areNeighbours(source, target2) {
    return source.row === target2.row && source.column + 1 === target2.column;
  }
  function portsOf(cells, down) {
    const places = /* @__PURE__ */ new Map();
    for (const { node } of cells.values()) {
      const evenly = (ports) => ports.forEach((port, index) => {
        const given = down ? port.x : port.y;
        places.set(port.id, given ?? lengthOf(node, down) * (index + 1) / (ports.length + 1));
      });
      const isOut = (port) => port.id.startsWith(`${node.id}
out `);
      evenly((node.ports ?? []).filter(isOut));
      evenly((node.ports ?? []).filter((port) => !isOut(port)));
    }
    return places;
  }
  function routeOf(edge, grid, ports) {
    const { down } = grid;
    const source = grid.cells.get(sourceOf(edge));
    const target2 = grid.cells.get(targetOf(edge));
    if (areNeighbours(source, target2)) {
      const across = source.across + Math.min(depthOf(source.node, down), depthOf(target2.node, down)) / 2;
      return [[source.along + lengthOf(source.node, down), across], [target2.along, across]];
    }
    const start = source.along + ports.get(edge.sources[0]);
    const end2 = target2.along + ports.get(edge.targets[0]);
    const track = (row) => row < 0 ? target2.across - MARGIN2 / 2 : grid.labelEnds[row] + MARGIN2 + target2.column % ROW_TRACKS * TRACK;
    const leave2 = track(source.row);
    const from = [[start, source.across + depthOf(source.node, down)], [start, leave2]];
    const to = [[end2, target2.across]];
    if (target2.row === source.row + 1) return [...from, [end2, leave2], ...to];
    const arrive = track(target2.row - 1);
    const aside = grid.before[target2.column] + MARGIN2 + target2.row % COLUMN_TRACKS * TRACK;
    return [...from, [aside, leave2], [aside, arrive], [end2, arrive], ...to];
  }
  function labelPlace(edge, label, route, { cells, ends, down }, stacked) {
    const source = cells.get(sourceOf(edge));
    const [[start, first], [end2]] = route;
    if (areNeighbours(source, cells.get(targetOf(edge)))) return [(start + end2) / 2, first - depthOf(label, down) / 2];
    const before = stacked.get(source.node.id) ?? 0;
    stacked.set(source.node.id, before + depthOf(label, down));
    return [start, ends[source.row] + 2 + before];
  }

  // src/layout.ts
  var SIDE = 20;
  var TOP = TITLE_HEIGHT + 14;
  var MANY = 120;
  var VERY_MANY = 300;
  var FAR = 1500;
  var ROOMY = {
    "elk.algorithm": "layered",
    "elk.edgeRouting": "ORTHOGONAL",
    "elk.separateConnectedComponents": "false",
    "elk.spacing.nodeNode": "28",
    "elk.spacing.edgeNode": "18",
    "elk.spacing.edgeEdge": "12",
    "elk.spacing.edgeLabel": "3",
    "elk.spacing.nodeSelfLoop": "14",
    "elk.spacing.portsSurrounding": "[top=12,left=18,bottom=12,right=18]",
    "elk.layered.spacing.nodeNodeBetweenLayers": "30",
    "elk.layered.spacing.edgeNodeBetweenLayers": "14",
    "elk.layered.spacing.edgeEdgeBetweenLayers": "10",
    "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
    "elk.layered.cycleBreaking.strategy": "MODEL_ORDER",
    "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
    "elk.layered.nodePlacement.favorStraightEdges": "true",
    "elk.layered.nodePlacement.networkSimplex.nodeFlexibility.default": "PORT_POSITION",
    "elk.layered.edgeLabels.centerLabelPlacementStrategy": "TAIL_LAYER"
  };
  var FAST = {
    ...ROOMY,
    "elk.layered.nodePlacement.strategy": "BRANDES_KOEPF",
    "elk.layered.layering.strategy": "LONGEST_PATH",
    "elk.layered.thoroughness": "1"
  };
  var BESIDE = {
    DOWN: { "elk.spacing.nodeNode": "100" },
    RIGHT: { "elk.layered.spacing.nodeNodeBetweenLayers": "100" }
  };
  var Cancelled = class extends Error {
  };
  var Layouts = class {
    constructor(graph, compute, direction) {
      this.graph = graph;
      this.compute = compute;
      this.direction = direction;
    }
    graph;
    compute;
    direction;
    known = /* @__PURE__ */ new Map();
    /** The scene with some containers open; throws `Cancelled`. */
    async scene(open, progress) {
      const root = this.graph.model.root;
      const placed = /* @__PURE__ */ new Map();
      await this.place(root, open, placed, progress);
      const scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
      if (!placed.has(root)) {
        const size = this.size(root);
        scene.boxes.push({ path: root, x: 0, y: 0, ...size, open: false, level: 0, written: [] });
        return { ...scene, ...size };
      }
      this.compose(root, { x: 0, y: 0 }, 0, placed, scene);
      for (const [container, { far }] of placed) {
        scene.lines.push(...far.flatMap((line) => this.straight(container, line, scene)));
      }
      const { full } = placed.get(root);
      return { ...scene, ...full };
    }
    /** Lay out a container and all open ones in it, one after the other; the key of the layout. */
    async place(path, open, placed, progress) {
      const node = this.graph.nodes.get(path);
      if (!node || !open.has(path)) return "";
      const inner = [];
      for (const child of node.children) if (open.has(child)) inner.push(await this.place(child, open, placed, progress));
      if (progress?.cancelled()) throw new Cancelled();
      const key = JSON.stringify([path, ...inner]);
      let layout = this.known.get(key);
      if (!layout) {
        layout = this.placeContainer(path, open, placed);
        this.known.set(key, layout);
        layout.catch(() => this.known.delete(key));
      }
      placed.set(path, await layout);
      progress?.placed(node.children.length);
      return key;
    }
    async placeContainer(path, open, placed) {
      const node = this.graph.nodes.get(path);
      const written = writtenExits(this.graph, path);
      const sizes = new Map(
        node.children.map((child) => [child, placed.get(child)?.full ?? this.size(child, written.get(child))])
      );
      const content = contentOf(this.graph, path, open, sizes);
      const done = await this.computed(content, placed);
      const title = width(fitting(node.name, "title"), "title") + width(fitting(kindInWords(node), "detail"), "detail") + chipsOf(node).width + 106;
      return { ...readLayout(content, done, title, this.direction), far: content.far, written };
    }
    async computed(content, placed) {
      const graph = (fast) => elkGraph(content, placed, this.direction, fast, Boolean(this.graph.model.statistics));
      const rows = () => inRows(graph(true), this.direction === "DOWN", { x: SIDE, y: TOP });
      if (content.lines.length > VERY_MANY || reach(content) > FAR) return rows();
      const simple = () => this.compute(graph(true)).catch(rows);
      return content.lines.length > MANY ? simple() : this.compute(graph(false)).catch(simple);
    }
    /** A line from one part of the scene to another one; none where both are in one closed container. */
    straight(container, line, scene) {
      const from = this.placeOf(container, line.from, scene);
      const to = this.placeOf(container, line.to, scene);
      if (!from || !to || from === to) return [];
      const points = straightLine(from, to);
      const [start, end2] = [points[0], points[1]];
      const widest = Math.max(0, ...line.labels.map((text) => width(fitting(text, "label"), "label")));
      const size = { width: widest + 10, height: LINE_HEIGHT * line.labels.length + 4 };
      const label = line.labels.length ? { x: (start.x + end2.x - size.width) / 2, y: (start.y + end2.y - size.height) / 2, ...size } : null;
      return [{ container, line, points, label }];
    }
    /** Where an end of a line is: a state, the closed container that hides it, or a mark of the container. */
    placeOf(container, id, scene) {
      const mark = scene.pieces.find((each) => each.container === container && each.piece.id === id);
      if (mark) return mark;
      for (let node = this.graph.nodes.get(id); node; node = node.parent === null ? void 0 : this.graph.nodes.get(node.parent)) {
        const { path } = node;
        const box = scene.boxes.find((each) => each.path === path);
        if (box) return box;
      }
      return void 0;
    }
    size(path, written = []) {
      const node = this.graph.nodes.get(path);
      return boxSize(node, node.children.length, written);
    }
    compose(path, at, level, placed, scene) {
      const layout = placed.get(path);
      scene.boxes.push({ path, ...at, ...layout.frame, open: true, level, written: [] });
      for (const { container, line, points, label } of layout.lines) {
        scene.lines.push({
          container,
          line,
          points: points.map((point) => moved(point, at)),
          label: label && moved(label, at)
        });
      }
      for (const piece of layout.pieces) {
        const here = moved(piece, at);
        if (piece.piece.what !== "state") scene.pieces.push(here);
        else if (placed.has(piece.piece.id)) this.compose(piece.piece.id, here, level + 1, placed, scene);
        else {
          const { x, y, width: width2, height } = here;
          const path2 = piece.piece.id;
          const written = layout.written.get(path2) ?? [];
          scene.boxes.push({ path: path2, x, y, width: width2, height, open: false, level: level + 1, written });
        }
      }
    }
  };
  function straightLine(from, to) {
    const centre = ({ x, y, width: width2, height }) => ({ x: x + width2 / 2, y: y + height / 2 });
    const border = (area, other) => {
      const { x, y } = centre(area);
      const [dx, dy] = [other.x - x, other.y - y];
      const scale = Math.min(1, ...[dx ? area.width / 2 / Math.abs(dx) : 1, dy ? area.height / 2 / Math.abs(dy) : 1]);
      return { x: x + dx * scale, y: y + dy * scale };
    };
    return [border(from, centre(to)), border(to, centre(from))];
  }
  function moved(point, by) {
    return { ...point, x: point.x + by.x, y: point.y + by.y };
  }
  function reach(content) {
    const order = new Map(content.pieces.flatMap((each, index) => each.what === "state" ? [[each.id, index]] : []));
    return content.lines.reduce((sum, { from, to }) => {
      const [start, end2] = [order.get(from), order.get(to)];
      return start === void 0 || end2 === void 0 ? sum : sum + Math.abs(end2 - start);
    }, 0);
  }
  function elkGraph(content, placed, direction, fast, figures2) {
    const options = fast ? FAST : ROOMY;
    const [before, after] = direction === "DOWN" ? ["NORTH", "SOUTH"] : ["WEST", "EAST"];
    const padding = direction === "DOWN" ? `bottom=0,right=${SIDE}` : `bottom=${SIDE},right=0`;
    const exits = Math.max(0, ...content.pieces.map((each) => each.what === "exit" ? each.width : 0));
    const ports = /* @__PURE__ */ new Map();
    const port = (piece, name, side) => {
      const known2 = ports.get(piece) ?? /* @__PURE__ */ new Map();
      ports.set(piece, known2);
      const id = `${piece}
${name}`;
      if (!known2.has(id)) {
        known2.set(id, { id, width: 0, height: 0, layoutOptions: { "elk.port.side": side } });
      }
      return id;
    };
    const inner = (piece) => placed.get(piece);
    const edges = content.lines.map((line, index) => ({
      id: `line ${index}`,
      sources: [port(line.from, inner(line.from) ? `out ${line.outcome}` : `out ${index}`, after)],
      targets: [port(line.to, inner(line.to) ? "in" : `in ${look2(line)}`, before)],
      labels: line.labels.length ? [labelBox(line)] : [],
      layoutOptions: priorities(line)
    }));
    const leaving = /* @__PURE__ */ new Map();
    content.lines.forEach((line, index) => {
      const known2 = leaving.get(line.from);
      if (known2) known2.push({ line, index });
      else leaving.set(line.from, [{ line, index }]);
    });
    const portsOf2 = (piece) => [...ports.get(piece)?.values() ?? []];
    return {
      id: content.path,
      layoutOptions: {
        ...options,
        ...figures2 ? BESIDE[direction] : {},
        "elk.direction": direction,
        "elk.padding": `[top=${TOP},left=${SIDE},${padding}]`
      },
      children: content.pieces.map((piece) => ({
        id: piece.id,
        ...sizeOf(piece, direction, exits),
        ...connections(piece, leaving.get(piece.id) ?? [], portsOf2(piece.id), inner(piece.id), direction)
      })),
      edges
    };
  }
  function connections(piece, leaving, ports, inner, direction) {
    const layoutOptions = { "elk.portConstraints": "FIXED_SIDE", "elk.spacing.portPort": "14", ...constraint(piece) };
    if (inner) {
      const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
      return { ports: portsOfOpen(piece, ports, inner), layoutOptions: fixed };
    }
    const main2 = piece.what === "state" || piece.what === "start" ? mainLine(leaving) : null;
    if (main2 !== null) {
      const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
      return { ports: portsAroundMain(piece, ports, `out ${main2}`, direction), layoutOptions: fixed };
    }
    if (piece.what === "state" || piece.what === "fork") {
      const loops = leaving.some(({ line }) => line.to === piece.id);
      const free = { "elk.layered.nodePlacement.networkSimplex.nodeFlexibility": "PORT_POSITION" };
      return { ports, layoutOptions: { ...layoutOptions, ...loops ? {} : free } };
    }
    const centred = { "elk.spacing.portsSurrounding": "[top=0,left=0,bottom=0,right=0]" };
    return { ports, layoutOptions: { ...layoutOptions, ...centred } };
  }
  function mainLine(leaving) {
    const good = leaving.filter(({ line }) => !line.failure && !line.stop);
    return good.length === 1 ? good[0].index : null;
  }
  var STEP = 18;
  function portsAroundMain(piece, ports, main2, direction) {
    const size = direction === "DOWN" ? piece.width : piece.height;
    const outs = ports.filter((port) => nameOf(port, piece).startsWith("out "));
    const ins = ports.filter((port) => !outs.includes(port));
    const step = Math.min(STEP, (size / 2 - 8) / Math.max(1, outs.length - 1));
    let others = 0;
    return ports.map((port) => {
      const name = nameOf(port, piece);
      let along = size / 2;
      if (outs.includes(port)) along += name === main2 ? 0 : (others += 1) * step;
      else if (ins.length > 1) along += { plain: 0, failure: 1, implicit: -1 }[name.slice(3)] * Math.min(STEP, size / 4);
      const far = outs.includes(port);
      const [x, y] = direction === "DOWN" ? [along, far ? piece.height : 0] : [far ? piece.width : 0, along];
      return { ...port, x, y };
    });
  }
  var nameOf = (port, piece) => port.id.slice(piece.id.length + 1);
  function sizeOf(piece, direction, exits) {
    const { width: width2, height } = piece;
    if (direction === "DOWN") return { width: width2, height };
    if (piece.what === "exit") return { width: exits, height };
    if (piece.what === "join" || piece.what === "fork") return { width: height, height: width2 };
    return { width: width2, height };
  }
  var look2 = (line) => line.failure ? "failure" : line.implicit ? "implicit" : "plain";
  function constraint(piece) {
    const name = "elk.layered.layering.layerConstraint";
    if (piece.what === "exit") return { [name]: "LAST_SEPARATE" };
    return piece.what === "start" || piece.what === "fork" ? { [name]: "FIRST_SEPARATE" } : {};
  }
  function priorities(line) {
    const main2 = !line.failure && !line.implicit && !line.stop;
    return {
      "elk.layered.priority.straightness": main2 ? "100" : "1",
      "elk.layered.priority.shortness": main2 ? "5" : "1"
    };
  }
  function labelBox(line) {
    const widest = Math.max(...line.labels.map((text) => width(fitting(text, "label"), "label")));
    return {
      id: `${line.from} ${line.to} label`,
      text: line.labels.join("\n"),
      width: widest + 10,
      height: LINE_HEIGHT * line.labels.length + 4,
      layoutOptions: { "elk.edgeLabels.inline": "true", "elk.edgeLabels.placement": "CENTER" }
    };
  }
  function portsOfOpen(piece, ports, inner) {
    const down = inner.direction === "DOWN";
    const exits = new Map(
      inner.pieces.filter((each) => each.piece.what === "exit").map((each) => [each.piece.id, down ? each.x + each.width / 2 : each.y + each.height / 2])
    );
    return ports.map((port) => {
      const name = nameOf(port, piece);
      if (name === "in") {
        const side2 = { "elk.port.side": down ? "NORTH" : "WEST" };
        return { ...port, layoutOptions: side2, x: down ? inner.entry : 0, y: down ? 0 : inner.entry };
      }
      const along = exits.get(exitId(name.slice("out ".length))) ?? inner.full.width / 2;
      const side = { "elk.port.side": down ? "SOUTH" : "EAST" };
      const [x, y] = down ? [along, inner.full.height] : [inner.full.width, along];
      return { ...port, layoutOptions: side, x, y };
    });
  }
  function readLayout(content, done, title, direction) {
    const places = new Map((done.children ?? []).map((each) => [each.id, each]));
    const down = direction === "DOWN";
    const least = Math.max(title, 120);
    const spare = Math.max(0, least - (done.width ?? 0));
    const shift = { x: down ? spare / 2 : spare, y: 0 };
    const pieces = content.pieces.map((piece) => {
      const { x = 0, y = 0, width: width2 = 0, height = 0 } = places.get(piece.id) ?? {};
      return { container: content.path, piece, ...moved({ x, y }, shift), width: width2, height };
    });
    const lines = (done.edges ?? []).map((edge, index) => {
      const section2 = edge.sections?.[0];
      const { from, to } = content.lines[index];
      const points = section2 ? [section2.startPoint, ...section2.bendPoints ?? [], section2.endPoint] : straightLine(areaOf(places.get(from)), areaOf(places.get(to)));
      const box = edge.labels?.[0];
      const label = box && { x: box.x ?? 0, y: box.y ?? 0, width: box.width ?? 0, height: box.height ?? 0 };
      return {
        container: content.path,
        line: content.lines[index],
        points: points.map((point) => moved(point, shift)),
        label: label ? moved(label, shift) : null
      };
    });
    const start = pieces[0];
    const entry = down ? start.x + start.width / 2 : start.y + start.height / 2;
    return { direction, ...frames(pieces, done, least, down), entry, pieces, lines };
  }
  function areaOf({ x = 0, y = 0, width: width2 = 0, height = 0 } = {}) {
    return { x, y, width: width2, height };
  }
  function frames(pieces, done, least, down) {
    const exits = pieces.filter((each) => each.piece.what === "exit");
    const width2 = Math.max(least, done.width ?? 0);
    const height = done.height ?? 0;
    if (down) {
      const bottom = Math.max(0, ...exits.map((each) => each.y + each.height));
      const frame2 = { width: width2, height: exits.length ? bottom - EXIT_HEIGHT / 2 : height + SIDE };
      return { frame: frame2, full: { width: width2, height: Math.max(bottom, frame2.height) } };
    }
    const right = Math.max(0, ...exits.map((each) => each.x + each.width));
    const widest = Math.max(0, ...exits.map((each) => each.width));
    const frame = { width: exits.length ? right - widest / 2 : width2 + SIDE, height };
    return { frame, full: { width: Math.max(right, frame.width), height } };
  }

  // src/navigation.ts
  function readDirection(key) {
    const words = {
      ArrowUp: "up",
      ArrowDown: "down",
      ArrowLeft: "left",
      ArrowRight: "right"
    };
    return words[key] ?? null;
  }
  function neighbour(boxes, from, direction, graph) {
    const here = boxes.find((box) => box.path === from);
    const node = graph.nodes.get(from);
    if (!here || !node) return null;
    if (here.open && direction === "down" && node.children.length) return node.initial ?? node.children[0];
    if (node.parent === null) return null;
    const siblings = new Set(graph.nodes.get(node.parent)?.children);
    const best = nearestBox(boxes.filter((box) => siblings.has(box.path)), here, direction);
    if (best) return best.path;
    return direction === "up" ? node.parent : null;
  }
  function nearestBox(boxes, here, direction) {
    let best = null;
    let least = Infinity;
    for (const box of boxes) {
      const dx = box.x + box.width / 2 - here.x - here.width / 2;
      const dy = box.y + box.height / 2 - here.y - here.height / 2;
      const [along, across] = {
        up: [-dy, dx],
        down: [dy, dx],
        left: [-dx, dy],
        right: [dx, dy]
      }[direction];
      if (along <= 1) continue;
      const cost = along + 2 * Math.abs(across);
      if (cost < least) [best, least] = [box, cost];
    }
    return best;
  }

  // src/search.ts
  var MOST3 = 50;
  function search(graph, text) {
    const wanted = text.trim().toLowerCase();
    if (!wanted) return [];
    const hits = [];
    for (const node of graph.model.nodes) {
      const hit = match(node, wanted);
      if (hit) hits.push({ node, ...hit });
    }
    return hits.sort((a, b) => a.rank - b.rank).slice(0, MOST3);
  }
  function match(node, wanted) {
    const name = node.name.toLowerCase();
    if (name === wanted) return { rank: 0, reason: "" };
    if (name.startsWith(wanted)) return { rank: 1, reason: "" };
    if (name.includes(wanted)) return { rank: 2, reason: "" };
    const has = (value) => value !== null && value.toLowerCase().includes(wanted);
    if (has(node.type)) return { rank: 3, reason: `type ${node.type}` };
    for (const key of [...node.inputs, ...node.outputs]) {
      if (has(key.name) || has(key.key)) return { rank: 4, reason: `key ${has(key.name) ? key.name : key.key}` };
    }
    const outcome = node.outcomes.find((each) => has(each.name));
    if (outcome) return { rank: 5, reason: `outcome ${outcome.name}` };
    const badge2 = node.badges.find((each) => has(each.text) || has(each.field));
    if (badge2) return { rank: 5, reason: badge2.text };
    const tag = node.tags.find(has);
    if (tag) return { rank: 5, reason: `tag ${tag}` };
    if (has(node.path)) return { rank: 6, reason: "path" };
    return has(node.doc) ? { rank: 7, reason: "doc" } : null;
  }
  function searchField(graph, select, leave2) {
    const list = html("ul", { id: "hits", role: "listbox", "aria-label": "States found", hidden: true });
    const field = html("input", {
      type: "search",
      id: "search",
      placeholder: "Search  /",
      autocomplete: "off",
      spellcheck: "false",
      role: "combobox",
      "aria-label": "Search states, types, keys and outcomes",
      "aria-controls": "hits",
      "aria-expanded": "false",
      "aria-autocomplete": "list"
    });
    let hits = [];
    let chosen = 0;
    const show = () => {
      const open = field.value.trim() !== "";
      list.hidden = !open;
      field.setAttribute("aria-expanded", String(open));
      if (hits.length) field.setAttribute("aria-activedescendant", `hit-${chosen}`);
      else field.removeAttribute("aria-activedescendant");
      list.replaceChildren(...hits.map(row));
      if (open && !hits.length) {
        list.append(html("li", { role: "option", "aria-disabled": "true", "aria-selected": "false" }, "nothing found"));
      }
      list.children[chosen]?.scrollIntoView({ block: "nearest" });
    };
    const go = (index) => {
      const hit = hits[index];
      if (!hit) return;
      clear();
      select(hit.node.path);
    };
    const clear = () => {
      field.value = "";
      hits = [];
      show();
    };
    const row = ({ node, reason }, index) => {
      const around = node.parent === null ? "" : node.parent;
      const item = html(
        "li",
        { id: `hit-${index}`, role: "option", "aria-selected": String(index === chosen) },
        html("strong", {}, node.name),
        " ",
        html("span", {}, [reason, around].filter(Boolean).join(", "))
      );
      item.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        go(index);
      });
      return item;
    };
    field.addEventListener("input", () => {
      hits = search(graph(), field.value);
      chosen = 0;
      show();
    });
    field.addEventListener("blur", () => {
      list.hidden = true;
      field.setAttribute("aria-expanded", "false");
    });
    field.addEventListener("focus", () => show());
    field.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Escape") {
        clear();
        leave2();
      } else if (event.key === "Enter") go(chosen);
      else if ((event.key === "ArrowDown" || event.key === "ArrowUp") && hits.length) {
        event.preventDefault();
        chosen = (chosen + (event.key === "ArrowDown" ? 1 : hits.length - 1)) % hits.length;
        show();
      }
    });
    return html("div", { class: "search" }, field, list);
  }

  // src/theme.ts
  var KEY = "smachac-theme";
  function themeSwitch() {
    const system = window.matchMedia("(prefers-color-scheme: dark)");
    let theme = stored() ?? (system.matches ? "dark" : "light");
    const made = button("Dark colours", "\u25D0", () => {
      apply(theme === "dark" ? "light" : "dark");
      store(theme);
    }, "Light or dark");
    const apply = (next) => {
      theme = next;
      document.documentElement.dataset["theme"] = next;
      made.setAttribute("aria-pressed", String(next === "dark"));
    };
    system.addEventListener("change", () => stored() ?? apply(system.matches ? "dark" : "light"));
    apply(theme);
    return made;
  }
  function stored() {
    try {
      const value = localStorage.getItem(KEY);
      return value === "light" || value === "dark" ? value : null;
    } catch {
      return null;
    }
  }
  function store(theme) {
    try {
      localStorage.setItem(KEY, theme);
    } catch {
    }
  }

  // src/viewer.ts
  var SHOWN_AT_FIRST = 150;
  var TINY = 0.1;
  var SLOW = 300;
  var READABLE = 0.55;
  async function createViewer(page, model, compute) {
    let graph = indexed(model);
    let direction = "DOWN";
    let layouts = new Layouts(graph, compute, direction);
    let open = /* @__PURE__ */ new Set([graph.model.root]);
    let kept = /* @__PURE__ */ new Set();
    let selected = null;
    let scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
    let picture = null;
    let run = null;
    let latest = 0;
    let expected = null;
    const sections = [];
    const listeners = [];
    const markers = [];
    const world = svg("g", {});
    const frame = svg("svg", { class: "picture", role: "group", "aria-label": "State graph" }, world);
    const panel = html("aside", { "aria-label": "Details" });
    const notice = html("div", { class: "notice", role: "status" });
    const progressText = html("span", { role: "status" });
    const progress = html(
      "p",
      { class: "notice progress", hidden: true },
      progressText,
      " ",
      button("Cancel the layout", "Cancel", () => cancel(), "Keep the picture as it is (Escape)")
    );
    const footer = html("footer", {});
    const toolbar = html("div", { class: "tools" });
    const camera = new Camera(frame, world);
    const boxOf = (path) => scene.boxes.find((box) => box.path === path);
    const whole = () => camera.fit({ x: -6, y: -6, width: scene.width + 12, height: scene.height + 12 });
    async function openReadable() {
      for (let depth = 1; ; depth += 1) {
        const deeper = firstOpen(graph, depth, SHOWN_AT_FIRST);
        if (depth > 1 && deeper.size === open.size) break;
        const readable = camera.fitting(await arranged(deeper)) >= READABLE;
        if (depth === 1 || readable) open = kept = deeper;
        if (!readable) break;
      }
    }
    async function openFirst() {
      try {
        await openReadable();
      } catch (error) {
        if (!(error instanceof Cancelled)) throw error;
      }
      await redraw(null);
      showStart(READABLE / 1.5);
    }
    function showStart(least) {
      const start = scene.pieces.find((each) => each.container === graph.model.root && each.piece.id === "start");
      if (start && camera.fitting(scene) < least) camera.start(start, scene.width, READABLE);
      else whole();
    }
    async function arranged(paths) {
      latest += 1;
      const mine = latest;
      const count2 = [...paths].reduce((sum, path) => sum + (graph.nodes.get(path)?.children.length ?? 0), 0);
      let done = 0;
      frame.setAttribute("aria-busy", "true");
      const slow = window.setTimeout(() => progress.hidden = false, SLOW);
      const report = () => {
        const numbers = [done, count2].map((each) => each.toLocaleString("en"));
        progressText.textContent = `Laying out ${numbers[0]} of ${numbers[1]} states`;
      };
      report();
      try {
        const cancelled = () => mine !== latest;
        const placed = (states) => {
          done += states;
          if (!cancelled()) report();
        };
        const next = await layouts.scene(paths, { placed, cancelled });
        if (cancelled()) throw new Cancelled();
        return next;
      } finally {
        window.clearTimeout(slow);
        if (mine === latest) {
          progress.hidden = true;
          frame.removeAttribute("aria-busy");
        }
      }
    }
    function cancel() {
      latest += 1;
      open = new Set(kept);
      progress.hidden = true;
      frame.removeAttribute("aria-busy");
    }
    async function redraw(anchor) {
      const before = boxOf(anchor);
      const paths = new Set(open);
      let next;
      try {
        next = await arranged(paths);
      } catch (error) {
        if (error instanceof Cancelled) return false;
        notice.textContent = `The layout failed: ${error instanceof Error ? error.message : String(error)}`;
        return false;
      }
      const focused = frame.contains(document.activeElement);
      scene = next;
      kept = paths;
      picture = draw(graph, scene);
      world.replaceChildren(picture.root);
      const after = boxOf(anchor);
      if (before && after) camera.keep(before, after);
      mark();
      if (focused) focusSelected();
      return true;
    }
    function mark() {
      if (!picture) return;
      markSelection(picture, selected, selected ?? graph.model.root);
      markRun(graph, picture, run);
      for (const each of markers) each(picture);
    }
    function focusSelected() {
      picture?.states.get(selected ?? graph.model.root)?.focus({ preventScroll: true });
    }
    function refresh() {
      const node = selected === null ? null : graph.nodes.get(selected) ?? null;
      fillPanel(panel, graph, node, sections, { select: (path) => void select(path), toggle: (path) => void toggle(path) });
    }
    async function select(path) {
      selected = path !== null && graph.nodes.has(path) ? path : null;
      expected = null;
      const closed = selected === null ? [] : ancestors(graph, selected).filter((each) => !open.has(each));
      closed.forEach((each) => open.add(each));
      writeFragment(selected);
      refresh();
      if (closed.length) await redraw(closed[0]);
      else mark();
      const box = boxOf(selected);
      if (box) camera.reveal(box);
      for (const listener of listeners) listener(selected);
    }
    async function toggle(path) {
      const node = graph.nodes.get(path);
      if (!node || !isContainer(node)) return;
      if (open.has(path)) open.delete(path);
      else open.add(path);
      if (selected !== null && ancestors(graph, selected).includes(path) && !open.has(path)) selected = path;
      await redraw(path);
    }
    async function openAll(all) {
      const containers = graph.model.nodes.filter(isContainer).map((node) => node.path);
      open = new Set(all ? containers : [graph.model.root]);
      if (selected !== null && !all) selected = ancestors(graph, selected)[1] ?? selected;
      if (await redraw(null)) showStart(TINY);
    }
    async function turn() {
      direction = direction === "DOWN" ? "RIGHT" : "DOWN";
      layouts = new Layouts(graph, compute, direction);
      if (await redraw(null)) showStart(TINY);
    }
    async function setModel(next) {
      if (!isNewer(next, graph.model)) return;
      const opened = [...open].map(newPath);
      graph = indexed(next);
      layouts = new Layouts(graph, compute, direction);
      open = /* @__PURE__ */ new Set([next.root, ...opened.filter((path) => graph.nodes.has(path))]);
      if (selected !== null) selected = newPath(selected);
      if (selected !== null && !graph.nodes.has(selected)) selected = nearest(graph, selected)?.path ?? null;
      document.title = next.name;
      title.textContent = next.name;
      refresh();
      await redraw(selected ?? next.root);
      if (expected) await expect(expected.path, expected.old);
    }
    function newPath(path) {
      const { path: next, old } = expected ?? {};
      if (next === void 0 || old === void 0 || !`${path}/`.startsWith(`${old}/`)) return path;
      return next + path.slice(old.length);
    }
    async function expect(path, old) {
      expected = graph.nodes.has(path) ? null : { path, old };
      if (!expected) await select(path);
    }
    const title = html("h1", {}, model.name);
    const field = searchField(() => graph, (path) => void select(path).then(focusSelected), focusSelected);
    const view = html(
      "div",
      { class: "tools", role: "group", "aria-label": "View" },
      button("Zoom out", "\u2212", () => camera.zoom(1 / 1.25), "Zoom out (-)"),
      button("Fit: show the whole machine", "Fit", whole, "Show the whole machine (f)"),
      button("Zoom in", "+", () => camera.zoom(1.25), "Zoom in (+)"),
      button("Open all containers", "Open all", () => void openAll(true), "Open all containers (e)"),
      button("Close all containers", "Close all", () => void openAll(false), "Close all containers (c)"),
      button("Turn the picture: down or to the right", "Turn", () => void turn(), "Down or to the right (d)"),
      themeSwitch()
    );
    page.append(
      html("header", {}, title, toolbar, field, view),
      html("main", {}, frame, notice, progress, footer),
      panel
    );
    frame.addEventListener("click", (event) => {
      const element = event.target;
      const path = element.closest("[data-path]")?.getAttribute("data-path") ?? null;
      if (path !== null && element.closest(".toggle")) {
        void toggle(path).then(() => select(path));
        return;
      }
      void select(path).then(() => path !== null && focusSelected());
    });
    frame.addEventListener("pointerover", (event) => {
      const element = event.target.closest("[data-path]");
      const node = graph.nodes.get(element?.getAttribute("data-path") ?? "");
      if (element && node) addTooltip(element, node);
    });
    frame.addEventListener("dblclick", (event) => {
      const path = event.target.closest("[data-path]")?.getAttribute("data-path");
      if (path) void toggle(path);
    });
    frame.addEventListener("focusin", (event) => {
      const path = event.target.getAttribute("data-path");
      if (path !== null && path !== selected && event.target.matches(":focus-visible")) void select(path);
    });
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const typing = event.target.closest("input, select, textarea, [contenteditable]");
      if (typing) return;
      const inPicture = frame.contains(event.target) || event.target === document.body;
      if (key(event, inPicture)) event.preventDefault();
    });
    window.addEventListener("hashchange", () => {
      const path = readFragment();
      if (path !== selected) void select(path);
    });
    function key(event, inPicture) {
      const direction2 = readDirection(event.key);
      if (direction2 && inPicture) {
        const next = neighbour(scene.boxes, selected ?? graph.model.root, direction2, graph);
        if (next !== null) void select(next).then(focusSelected);
        return true;
      }
      if ((event.key === "Enter" || event.key === " ") && inPicture) {
        void toggle(selected ?? graph.model.root);
        return true;
      }
      if (event.key === "Escape" && !progress.hidden) {
        cancel();
        return true;
      }
      if (event.key === "Escape") {
        const parent = selected === null ? null : graph.nodes.get(selected)?.parent ?? null;
        void select(parent).then(focusSelected);
        return true;
      }
      const actions = {
        "/": () => page.querySelector("#search")?.focus(),
        "+": () => camera.zoom(1.25),
        "=": () => camera.zoom(1.25),
        "-": () => camera.zoom(1 / 1.25),
        f: whole,
        "0": whole,
        e: () => void openAll(true),
        c: () => void openAll(false),
        d: () => void turn()
      };
      actions[event.key]?.();
      return event.key in actions;
    }
    refresh();
    await openFirst();
    await select(readFragment());
    return {
      get graph() {
        return graph;
      },
      get selected() {
        return selected;
      },
      toolbar,
      footer,
      frame,
      world,
      select,
      highlight(next) {
        run = next;
        if (picture) markRun(graph, picture, run);
      },
      addSection(section2) {
        sections.push(section2);
        refresh();
      },
      refresh,
      setModel,
      expect,
      fit: whole,
      notice(text, more = null) {
        if (text && more) notice.replaceChildren(html("details", {}, html("summary", {}, text), more));
        else notice.textContent = text;
      },
      onSelect(listener) {
        listeners.push(listener);
      },
      onMark(listener) {
        markers.push(listener);
        mark();
      }
    };
  }
  function readFragment() {
    return new URLSearchParams(location.hash.slice(1)).get("state");
  }
  function writeFragment(path) {
    const parameters = new URLSearchParams(location.hash.slice(1));
    if (path === null) parameters.delete("state");
    else parameters.set("state", path);
    const text = parameters.toString().replaceAll("%2F", "/");
    if (text !== location.hash.slice(1)) history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
  }

  // src/worker.ts
  function startLayout(source) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    const worker = new Worker(url);
    const waiting = /* @__PURE__ */ new Map();
    let last = 0;
    worker.onmessage = ({ data }) => {
      const call = waiting.get(data.id);
      waiting.delete(data.id);
      if (!call) return;
      if (data.error) call.reject(new Error(typeof data.error === "string" ? data.error : data.error.message));
      else call.resolve(data.data);
    };
    worker.onerror = (event) => {
      for (const call of waiting.values()) call.reject(new Error(event.message));
      waiting.clear();
    };
    worker.postMessage({ id: 0, cmd: "register", algorithms: ["layered"] });
    return (graph) => new Promise((resolve, reject) => {
      last += 1;
      waiting.set(last, { resolve, reject });
      worker.postMessage({ id: last, cmd: "layout", graph, layoutOptions: {}, options: {} });
    });
  }

  // src/main.ts
  var VERSION = 2;
  async function main() {
    const model = JSON.parse(textOf("smachac-model"));
    if (model.version !== VERSION) throw new Error(`the model has version ${model.version}, not ${VERSION}`);
    const viewer = await createViewer(document.body, model, startLayout(textOf("smachac-layout")));
    showRuns(viewer, textOf("smachac-trace"), textOf("smachac-film"));
    showEdits(viewer);
    showStatistics(viewer);
    showDifferences(viewer);
    document.documentElement.dataset["ready"] = "true";
  }
  function textOf(id) {
    return document.getElementById(id)?.textContent ?? "";
  }
  main().catch((error) => {
    const line = document.createElement("p");
    line.setAttribute("role", "alert");
    line.textContent = `The viewer cannot show this page: ${String(error)}`;
    document.body.prepend(line);
  });
})();
