// The viewer of smachac, built from viewer/. Apache-2.0.
"use strict";
(() => {
  // src/camera.ts
  var LEAST = 0.02;
  var MOST = 3;
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
    /** Show the surroundings of a place, which is put near the upper edge, at a scale. */
    start(place, scale) {
      this.scale = scale;
      this.x = this.frame.clientWidth / 2 - place.x * scale;
      this.y = MARGIN - place.y * scale;
      this.apply();
    }
    /** Zoom by a factor; the point (in pixels of the frame) stays where it is. */
    zoom(factor, x = this.frame.clientWidth / 2, y = this.frame.clientHeight / 2) {
      const scale = Math.min(MOST, Math.max(LEAST, this.scale * factor));
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
      const end = () => {
        this.frame.classList.remove("moving");
        this.frame.removeEventListener("pointermove", move);
        this.frame.removeEventListener("pointerup", end);
        this.frame.removeEventListener("pointercancel", end);
        if (moving) this.frame.addEventListener("click", stop, { capture: true, once: true });
        window.setTimeout(() => this.frame.removeEventListener("click", stop, { capture: true }));
      };
      const stop = (event) => event.stopPropagation();
      this.frame.addEventListener("pointermove", move);
      this.frame.addEventListener("pointerup", end);
      this.frame.addEventListener("pointercancel", end);
    }
    apply() {
      this.content.setAttribute("transform", `translate(${this.x} ${this.y}) scale(${this.scale})`);
      this.frame.classList.toggle("far", this.scale < 0.4);
    }
  };

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
  function indexed(model) {
    const graph = {
      model,
      nodes: new Map(model.nodes.map((node) => [node.path, node])),
      byShown: new Map(model.nodes.map((node) => [node.shown ?? node.path, node])),
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
    const known = map.get(key);
    if (known) known.push(value);
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
    if (node.role) return node.role;
    if (node.kind === "concurrence") return node.join === "any" ? "in parallel, first to end" : "in parallel";
    if (node.kind === "iterator" && node.items) return `for each ${node.items}`;
    if (node.kind === "sequence") return "sequence";
    if (node.kind === "machine") return "state machine";
    return node.type ?? "state";
  }
  function firstOpen(graph, depth, limit) {
    const open = /* @__PURE__ */ new Set();
    let count = 1;
    let level = [graph.model.root];
    for (let at = 0; at < depth && level.length; at += 1) {
      const next = [];
      for (const path of level) {
        const node = graph.nodes.get(path);
        if (!node || !isContainer(node) || isWrapped(graph, node)) continue;
        if (count + node.children.length > limit && at > 0) continue;
        open.add(path);
        count += node.children.length;
        next.push(...node.children);
      }
      level = next;
    }
    return open;
  }
  function isWrapped(graph, node) {
    if (!node.role) return false;
    return node.children.every((path) => {
      const child = graph.nodes.get(path);
      return child !== void 0 && (!isContainer(child) || isWrapped(graph, child));
    });
  }

  // src/text.ts
  var FAMILY = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif';
  var FONTS = {
    title: `600 14px ${FAMILY}`,
    name: `600 13px ${FAMILY}`,
    detail: `11px ${FAMILY}`,
    label: `11px ${FAMILY}`,
    exit: `600 11px ${FAMILY}`
  };
  var LONGEST = 300;
  var context = document.createElement("canvas").getContext("2d");
  var widths = /* @__PURE__ */ new Map();
  function width(text, font) {
    const key = `${font} ${text}`;
    let known = widths.get(key);
    if (known === void 0) {
      context.font = FONTS[font];
      known = Math.ceil(context.measureText(text).width);
      widths.set(key, known);
    }
    return known;
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
  function boxSize(node, count) {
    const name = width(fitting(node.name, "name"), "name") + (node.findings.length ? 20 : 0);
    const detail = boxDetail(node, count);
    const chevron2 = isContainer(node) ? 22 : 0;
    return {
      width: Math.max(96, name + chevron2 + 32, width(fitting(detail, "detail"), "detail") + 32),
      height: detail ? 48 : 36
    };
  }
  function boxDetail(node, count) {
    if (!isContainer(node)) return node.type ?? "";
    const words = kindInWords(node);
    return node.role ? words : `${words}, ${count} ${count === 1 ? "state" : "states"}`;
  }
  function contentOf(graph, path, open, sizes) {
    const container = graph.nodes.get(path);
    const pieces = [startPiece(container)];
    for (const child of container.children) {
      const node = graph.nodes.get(child);
      if (node) pieces.push({ id: child, what: "state", label: node.name, path: child, ...sizes.get(child) });
    }
    for (const outcome of container.outcomes) {
      const label = fitting(outcome.name, "exit");
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
    const add = (line, edge, label) => {
      const own = open.has(line.from) ? line.outcome : "";
      const key = JSON.stringify([line.from, line.to, line.failure, line.implicit, own]);
      const known = lines.get(key) ?? { ...line, stop: true, labels: [], edges: [] };
      lines.set(key, known);
      known.stop &&= line.outcome === "preempted";
      if (edge && !known.edges.includes(edge)) known.edges.push(edge);
      if (label && !open.has(line.from) && !known.labels.includes(label)) known.labels.push(label);
    };
    const joined = joins(container, pieces, add);
    for (const edge of graph.inside.get(path) ?? []) {
      for (const line of linesOf(container, edge, joined)) {
        add(line, edgeId(edge), labelOf(container, edge, line));
      }
    }
    return { path, pieces, lines: [...lines.values()] };
  }
  function startPiece(container) {
    if (container.kind === "concurrence") {
      const size = Math.min(260, 40 * Math.max(1, container.children.length));
      return { id: START, what: "fork", label: "all start together", width: size, height: 5 };
    }
    if (container.kind === "iterator") {
      const label = container.role ? "next try" : "next item";
      return { id: START, what: "loop", label, width: width(label, "label") + 24, height: 24 };
    }
    return { id: START, what: "start", label: "start", width: 12, height: 12 };
  }
  function joins(container, pieces, add) {
    const joined = /* @__PURE__ */ new Map();
    (container.rules ?? []).forEach((rule, index) => {
      const exit = pieces.find((each) => each.id === exitId(rule.outcome));
      if (rule.when.length < 2 || !exit) return;
      const id = `join ${index}`;
      const { failure = false, success } = exit;
      pieces.push({ id, what: "join", label: `all: ${rule.outcome}`, width: 64, height: 5, failure, success });
      for (const [child, outcome] of rule.when) {
        const key = JSON.stringify([child, outcome, rule.outcome]);
        joined.set(key, [...joined.get(key) ?? [], id]);
      }
      add({ from: id, to: exit.id, outcome: rule.outcome, failure, implicit: false }, "", "");
    });
    return joined;
  }
  function linesOf(container, edge, joined) {
    const { outcome, failure, implicit } = edge;
    const look3 = { outcome, failure, implicit };
    const from = edge.source ?? START;
    const to = typeof edge.target === "string" ? edge.target : exitId(edge.target.outcome);
    if (edge.kind === "loop") return [{ ...look3, from, to: START }];
    if (edge.kind === "exhausted") return [{ ...look3, outcome: "", failure: false, from: START, to }];
    if (edge.kind === "rule" && typeof edge.target !== "string") {
      const key = JSON.stringify([edge.source, edge.outcome, edge.target.outcome]);
      const bars = joined.get(key) ?? [];
      const alone = (container.rules ?? []).some(
        (rule) => rule.outcome === edge.target.outcome && rule.when.length < 2 && rule.when.every(([child, name]) => child === edge.source && name === edge.outcome)
      );
      return [
        ...bars.map((bar) => ({ ...look3, from, to: bar })),
        ...alone ? [{ ...look3, from, to }] : []
      ];
    }
    if (edge.kind === "default") return [{ ...look3, failure: false, from, to }];
    return [{ ...look3, from, to }];
  }
  function labelOf(container, edge, line) {
    if (edge.kind === "default") return "otherwise";
    if (edge.kind === "caught") return "exception";
    if (edge.kind === "exhausted") return edge.source === null ? "" : container.role ? "no tries left" : "no more items";
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
    return { root: svg("g", {}, tree, edges, marks, labels), states, lines };
  }
  function drawState(graph, node, box) {
    const siblings = node.parent === null ? [node.path] : graph.nodes.get(node.parent)?.children ?? [];
    const group = svg("g", {
      class: classes(node, box),
      transform: `translate(${box.x} ${box.y})`,
      role: "treeitem",
      tabindex: "-1",
      "data-path": node.path,
      "aria-label": spoken(node),
      "aria-level": box.level + 1,
      "aria-setsize": siblings.length,
      "aria-posinset": siblings.indexOf(node.path) + 1,
      "aria-expanded": isContainer(node) ? box.open : null,
      "aria-selected": "false"
    });
    const tip = [node.shown ?? node.path, node.doc].filter(Boolean).join("\n");
    group.append(svg("title", {}, tip));
    if (isContainer(node) && !box.open) {
      group.append(svg("rect", { class: "below", x: 4, y: 4, width: box.width, height: box.height, rx: 8 }));
    }
    const radius = box.open ? 12 : 8;
    group.append(svg("rect", { class: "body", width: box.width, height: box.height, rx: radius }));
    if (box.open) drawTitle(graph, group, node, box);
    else drawText(graph, group, node, box);
    return group;
  }
  function classes(node, box) {
    const kind = box.open ? `open ${ground(node, box)}` : `closed ${isContainer(node) ? ground(node, box) : ""}`;
    return `state ${node.kind} ${kind.trim()}`;
  }
  function ground(node, box) {
    if (node?.role || node?.kind === "iterator") return "looping";
    if (node?.kind === "concurrence") return "parallel";
    return box.level % 2 ? "odd" : "even";
  }
  function spoken(node) {
    const parts = [node.name, kindInWords(node)];
    if (node.outcomes.length) parts.push(`outcomes ${node.outcomes.map((each) => each.name).join(", ")}`);
    if (node.findings.length) parts.push(`${node.findings.length} findings`);
    return parts.join("; ");
  }
  function drawTitle(graph, group, node, box) {
    const name = fitting(node.name, "title");
    const detail = fitting(kindInWords(node), "detail");
    group.append(
      chevron(16, TITLE_HEIGHT / 2 + 1, true),
      svg("text", { class: "title", x: 32, y: 22 }, name),
      svg("text", { class: "detail", x: 32 + width(name, "title") + 10, y: 22 }, detail)
    );
    if (node.findings.length) group.append(badge(graph, node, box.width - 18, 17));
  }
  function drawText(graph, group, node, box) {
    const middle = box.width / 2;
    const detail = fitting(boxDetail(node, node.children.length), "detail");
    const name = fitting(node.name, "name");
    const y = detail ? 21 : 23;
    group.append(svg("text", { class: "name", x: middle, y, "text-anchor": "middle" }, name));
    if (detail) {
      group.append(svg("text", { class: "detail", x: middle, y: 37, "text-anchor": "middle" }, detail));
    }
    if (isContainer(node)) group.append(chevron(14, y - 4, false));
    if (node.findings.length) group.append(badge(graph, node, box.width - 13, 13));
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
    const group = svg("g", { class: `piece ${piece.what}`, transform: `translate(${x} ${y})` });
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
      const end = towards(here, next, radius);
      path += `L${start.x} ${start.y}Q${here.x} ${here.y} ${end.x} ${end.y}`;
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
    return [line.failure && "failure", line.implicit && "implicit", line.stop && "stop"].filter(Boolean).join(" ");
  }
  function drawLine({ line, points }) {
    const d = roundedPath(points);
    const group = svg("g", { class: `line ${look(line)}` });
    const end = points[points.length - 1];
    const before = points[points.length - 2];
    group.append(svg("path", { class: "stroke", d }));
    if (end && before) {
      const turn = Math.atan2(end.y - before.y, end.x - before.x) * 180 / Math.PI;
      const transform = `translate(${end.x} ${end.y}) rotate(${turn})`;
      group.append(svg("path", { class: "head", d: "M0 0L-7.5-4Q-5.9 0-7.5 4Z", transform }));
    }
    return group;
  }
  function drawLabel(line, label, ground2) {
    if (!label) return null;
    const group = svg("g", { class: `label ${ground2} ${look(line)}` });
    group.append(background(label));
    line.labels.forEach((text, index) => {
      const y = label.y + 2 + LINE_HEIGHT * index + 10.5;
      const x = label.x + label.width / 2;
      group.append(svg("text", { x, y, "text-anchor": "middle" }, fitting(text, "label")));
    });
    return group;
  }
  function background({ x, y, width: width2, height }) {
    return svg("rect", { x, y, width: width2, height, rx: 4 });
  }
  function markSelection(picture, path) {
    for (const [each, element] of picture.states) {
      const chosen = each === path;
      element.classList.toggle("selected", chosen);
      element.setAttribute("aria-selected", String(chosen));
      element.setAttribute("tabindex", chosen ? "0" : "-1");
    }
    for (const { line, element } of picture.lines) {
      element.classList.toggle("near", path !== null && (line.line.from === path || line.line.to === path));
    }
  }
  function markRun(graph, picture, run) {
    const active = /* @__PURE__ */ new Set();
    for (const path of run?.active ?? []) {
      let node = nearest(graph, path);
      while (node && !picture.states.has(node.path) && node.parent !== null) node = graph.nodes.get(node.parent);
      if (node) active.add(node.path);
    }
    const taken = new Set(run?.taken ?? []);
    for (const [path, element] of picture.states) {
      element.classList.toggle("active", active.has(path));
      setVisits(element, run?.visits?.get(path) ?? 0);
    }
    for (const { line, element } of picture.lines) {
      element.classList.toggle("taken", line.line.edges.some((edge) => taken.has(edge)));
    }
  }
  function setVisits(element, count) {
    element.classList.toggle("visited", count > 0);
    let mark = element.querySelector(":scope > .visits");
    if (count < 2) {
      mark?.remove();
      return;
    }
    if (!mark) {
      mark = svg("text", { class: "visits", "text-anchor": "end" });
      const body = element.querySelector(":scope > .body");
      mark.setAttribute("x", String(Number(body.getAttribute("width")) - 8));
      mark.setAttribute("y", "-4");
      element.append(mark);
    }
    mark.textContent = `\xD7${count}`;
  }
  function legend() {
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
    const row = (name, text) => html("li", {}, sign(name), html("span", {}, text));
    return html(
      "ul",
      { class: "legend" },
      row("line", "outcome"),
      row("line failure", "outcome of failure"),
      row("line implicit", "implied, not written in the script")
    );
  }

  // src/layout.ts
  var SIDE = 20;
  var MANY = 300;
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
    async scene(open) {
      const root = this.graph.model.root;
      const placed = /* @__PURE__ */ new Map();
      await this.place(root, open, placed);
      const scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
      if (!placed.has(root)) {
        const size = this.size(root);
        scene.boxes.push({ path: root, x: 0, y: 0, ...size, open: false, level: 0 });
        return { ...scene, ...size };
      }
      this.compose(root, { x: 0, y: 0 }, 0, placed, scene);
      const { full } = placed.get(root);
      return { ...scene, ...full };
    }
    /** Lay out a container and all open ones in it; the key of the layout. */
    async place(path, open, placed) {
      const node = this.graph.nodes.get(path);
      if (!node || !open.has(path)) return "";
      const inner = await Promise.all(node.children.map((child) => this.place(child, open, placed)));
      const key = JSON.stringify([path, ...inner]);
      let layout = this.known.get(key);
      if (!layout) {
        layout = this.placeContainer(path, open, placed);
        this.known.set(key, layout);
      }
      placed.set(path, await layout);
      return key;
    }
    async placeContainer(path, open, placed) {
      const node = this.graph.nodes.get(path);
      const sizes = new Map(
        node.children.map((child) => [child, placed.get(child)?.full ?? this.size(child)])
      );
      const content = contentOf(this.graph, path, open, sizes);
      const done = await this.compute(elkGraph(content, placed, this.direction));
      const title = width(fitting(node.name, "title"), "title") + width(fitting(kindInWords(node), "detail"), "detail") + 96;
      return readLayout(content, done, title, this.direction);
    }
    size(path) {
      const node = this.graph.nodes.get(path);
      return boxSize(node, node.children.length);
    }
    compose(path, at, level, placed, scene) {
      const layout = placed.get(path);
      scene.boxes.push({ path, ...at, ...layout.frame, open: true, level });
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
          scene.boxes.push({ path: piece.piece.id, x, y, width: width2, height, open: false, level: level + 1 });
        }
      }
    }
  };
  function moved(point, by) {
    return { ...point, x: point.x + by.x, y: point.y + by.y };
  }
  function elkGraph(content, placed, direction) {
    const options = content.lines.length > MANY ? FAST : ROOMY;
    const [before, after] = direction === "DOWN" ? ["NORTH", "SOUTH"] : ["WEST", "EAST"];
    const padding = direction === "DOWN" ? `bottom=0,right=${SIDE}` : `bottom=${SIDE},right=0`;
    const exits = Math.max(0, ...content.pieces.map((each) => each.what === "exit" ? each.width : 0));
    const ports = /* @__PURE__ */ new Map();
    const port = (piece, name, side) => {
      const known = ports.get(piece) ?? /* @__PURE__ */ new Map();
      ports.set(piece, known);
      const id = `${piece}
${name}`;
      if (!known.has(id)) {
        known.set(id, { id, width: 0, height: 0, layoutOptions: { "elk.port.side": side } });
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
    return {
      id: content.path,
      layoutOptions: {
        ...options,
        "elk.direction": direction,
        "elk.padding": `[top=${TITLE_HEIGHT + 14},left=${SIDE},${padding}]`
      },
      children: content.pieces.map((piece) => ({
        id: piece.id,
        ...sizeOf(piece, direction, exits),
        ...connections(piece, content, [...ports.get(piece.id)?.values() ?? []], inner(piece.id), direction)
      })),
      edges
    };
  }
  function connections(piece, content, ports, inner, direction) {
    const layoutOptions = { "elk.portConstraints": "FIXED_SIDE", "elk.spacing.portPort": "14", ...constraint(piece) };
    if (inner) {
      const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
      return { ports: portsOfOpen(piece, ports, inner), layoutOptions: fixed };
    }
    const main2 = piece.what === "state" || piece.what === "start" ? mainLine(piece, content) : null;
    if (main2 !== null) {
      const fixed = { ...layoutOptions, "elk.portConstraints": "FIXED_POS" };
      return { ports: portsAroundMain(piece, ports, `out ${main2}`, direction), layoutOptions: fixed };
    }
    const name = "elk.layered.nodePlacement.networkSimplex.nodeFlexibility";
    if (piece.what === "state" || piece.what === "fork") return { ports, layoutOptions };
    const centred = { "elk.spacing.portsSurrounding": "[top=0,left=0,bottom=0,right=0]", [name]: "NONE" };
    return { ports, layoutOptions: { ...layoutOptions, ...centred } };
  }
  function mainLine(piece, content) {
    const own = content.lines.flatMap((line, index) => line.from === piece.id ? [{ line, index }] : []);
    const good = own.filter(({ line }) => !line.failure && !line.stop);
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
      const points = section2 ? [section2.startPoint, ...section2.bendPoints ?? [], section2.endPoint] : [];
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

  // src/panel.ts
  function fillPanel(panel, graph, node, sections, actions) {
    const own = node ? stateSections(graph, node, actions) : machineSections(graph, actions);
    const added = sections.map((each) => {
      const content = each.fill(node);
      return content && section(each.title, content, each.id);
    });
    panel.replaceChildren(...[...own, ...added].filter((each) => each !== null));
    panel.scrollTop = 0;
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
      node.snippet ? section("Script", snippet(node)) : null
    ];
  }
  function heading(graph, node, actions) {
    const around = node.parent === null ? null : graph.nodes.get(node.parent);
    const made = html(
      "section",
      { "data-section": "state" },
      html("p", { class: "path" }, around ? link(around.shown ?? around.path, around.path, actions) : "machine"),
      html("h2", {}, node.name),
      html("p", { class: "kind" }, kindInWords(node), node.type && isContainer(node) && !node.role ? ` (${node.type})` : "")
    );
    if (node.doc) made.append(html("p", { class: "doc" }, node.doc));
    if (node.tags.length) {
      made.append(html("p", { class: "tags" }, ...node.tags.map((tag) => html("span", { class: "tag" }, tag))));
    }
    return made;
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
      const targets = html("span", { class: "targets" }, ...edges.map((edge) => target(graph, edge, actions)));
      return html("li", {}, name, targets);
    });
    return html("ul", { class: "rows" }, ...rows);
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
      html("p", { class: "kind" }, `${model.nodes.length} states, ${model.edges.length} transitions`),
      root?.doc ? html("p", { class: "doc" }, root.doc) : null
    );
    return [
      heading2,
      model.findings.length ? section("Findings", machineFindings(graph, actions)) : null,
      model.properties.length ? section("Properties", propertyList(graph, model.properties, actions)) : null,
      section("Legend", legend()),
      section("Keys", html("dl", { class: "keys" }, ...KEYS.flatMap(([key, text]) => [html("dt", {}, html("kbd", {}, key)), html("dd", {}, text)])))
    ];
  }
  function machineFindings(graph, actions) {
    const list = findings(graph.model.findings);
    graph.model.findings.forEach((item, index) => {
      const node = item.node === null ? void 0 : graph.nodes.get(item.node);
      if (node) list.children[index].append(html("p", { class: "chips" }, link(node.name, node.path, actions)));
    });
    return list;
  }

  // src/search.ts
  var MOST2 = 50;
  function search(graph, text) {
    const wanted = text.trim().toLowerCase();
    if (!wanted) return [];
    const hits = [];
    for (const node of graph.model.nodes) {
      const hit = match(node, wanted);
      if (hit) hits.push({ node, ...hit });
    }
    return hits.sort((a, b) => a.rank - b.rank).slice(0, MOST2);
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
    const tag = node.tags.find(has);
    if (tag) return { rank: 5, reason: `tag ${tag}` };
    if (has(node.shown ?? node.path)) return { rank: 6, reason: "path" };
    return has(node.doc) ? { rank: 7, reason: "doc" } : null;
  }
  function searchField(graph, select, leave) {
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
      const around = node.parent === null ? "" : graph().nodes.get(node.parent)?.shown ?? node.parent;
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
        leave();
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
  var READABLE = 0.55;
  async function createViewer(page, model, compute) {
    let graph = indexed(model);
    let direction = "DOWN";
    let layouts = new Layouts(graph, compute, direction);
    let open = /* @__PURE__ */ new Set([graph.model.root]);
    let selected = null;
    let scene = { width: 0, height: 0, boxes: [], pieces: [], lines: [] };
    let picture = null;
    let run = null;
    let latest = 0;
    const sections = [];
    const listeners = [];
    const world = svg("g", {});
    const frame = svg("svg", { class: "picture", role: "group", "aria-label": "State graph" }, world);
    const panel = html("aside", { "aria-label": "Details" });
    const notice = html("p", { class: "notice", role: "status" });
    const footer = html("footer", {});
    const toolbar = html("div", { class: "tools" });
    const camera = new Camera(frame, world);
    const boxOf = (path) => scene.boxes.find((box) => box.path === path);
    const whole = () => camera.fit({ x: -6, y: -6, width: scene.width + 12, height: scene.height + 12 });
    async function openFirst() {
      for (let depth = 1; ; depth += 1) {
        const deeper = firstOpen(graph, depth, SHOWN_AT_FIRST);
        if (depth > 1 && deeper.size === open.size) break;
        if (depth > 1 && camera.fitting(await layouts.scene(deeper)) < READABLE) break;
        open = deeper;
      }
      await redraw(null);
      showStart();
    }
    function showStart() {
      const start = scene.pieces.find((each) => each.container === graph.model.root && each.piece.id === "start");
      if (start && camera.fitting(scene) < READABLE / 1.5) camera.start({ x: start.x, y: 0 }, READABLE);
      else whole();
    }
    async function redraw(anchor) {
      latest += 1;
      const mine = latest;
      const before = boxOf(anchor);
      let next;
      try {
        next = await layouts.scene(open);
      } catch (error) {
        notice.textContent = `The layout failed: ${error instanceof Error ? error.message : String(error)}`;
        return;
      }
      if (mine !== latest) return;
      const focused = frame.contains(document.activeElement);
      scene = next;
      picture = draw(graph, scene);
      world.replaceChildren(picture.root);
      const after = boxOf(anchor);
      if (before && after) camera.keep(before, after);
      mark();
      if (focused) focusSelected();
    }
    function mark() {
      if (!picture) return;
      markSelection(picture, selected);
      if (selected === null) picture.states.get(graph.model.root)?.setAttribute("tabindex", "0");
      markRun(graph, picture, run);
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
      await redraw(null);
      whole();
    }
    async function turn() {
      direction = direction === "DOWN" ? "RIGHT" : "DOWN";
      layouts = new Layouts(graph, compute, direction);
      await redraw(null);
      whole();
    }
    async function setModel(next) {
      const opened = open;
      graph = indexed(next);
      layouts = new Layouts(graph, compute, direction);
      open = /* @__PURE__ */ new Set([next.root, ...[...opened].filter((path) => graph.nodes.has(path))]);
      if (selected !== null && !graph.nodes.has(selected)) selected = nearest(graph, selected)?.path ?? null;
      document.title = next.name;
      title.textContent = next.name;
      refresh();
      await redraw(selected ?? next.root);
    }
    const title = html("h1", {}, model.name);
    const field = searchField(() => graph, (path) => void select(path).then(focusSelected), focusSelected);
    const view = html(
      "div",
      { class: "tools", role: "group", "aria-label": "View" },
      button("Zoom out", "\u2212", () => camera.zoom(1 / 1.25), "Zoom out (-)"),
      button("Show the whole machine", "Fit", whole, "Show the whole machine (f)"),
      button("Zoom in", "+", () => camera.zoom(1.25), "Zoom in (+)"),
      button("Open all containers", "Open all", () => void openAll(true), "Open all containers (e)"),
      button("Close all containers", "Close all", () => void openAll(false), "Close all containers (c)"),
      button("Turn the picture: down or to the right", "Turn", () => void turn(), "Down or to the right (d)"),
      themeSwitch()
    );
    page.append(
      html("header", {}, title, toolbar, field, view),
      html("main", {}, frame, notice, footer),
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
      notice(text) {
        notice.textContent = text;
      },
      onSelect(listener) {
        listeners.push(listener);
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
  var VERSION = 1;
  async function main() {
    const model = JSON.parse(textOf("smachac-model"));
    if (model.version !== VERSION) throw new Error(`the model has version ${model.version}, not ${VERSION}`);
    await createViewer(document.body, model, startLayout(textOf("smachac-layout")));
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
