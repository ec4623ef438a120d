// The crease pattern: colours show letters, marks show vertex signs; both can be clicked.

import { NAMES, seen, turned } from "./choose.js";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 26;
const MOST_INDICES = 60;
const ASKED = [undefined, "M", "V"];
const FILE_NAMES = { M: "mountain in the file", V: "valley in the file", F: "flat in the file", U: "no letter in the file" };

export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

// A line as pictures draw it (`LOOK` is made from them). `share` is that of the largest angle; null if not known.
function drawLine(node, letter, share, scale = 1) {
  const { width, least, most, dash, cap } = LOOK.letters[letter];
  const wide = share === null || !"MVU".includes(letter) ? width : least + share * (most - least);
  node.setAttribute("class", `line ${letter}`);
  node.setAttribute("stroke-width", (scale * wide).toFixed(2));
  node.setAttribute("stroke-linecap", cap);
  node.setAttribute("stroke-dasharray", dash.map((x) => (Math.max(scale, 0.5) * x).toFixed(2)).join(" ") || "none");
  return node;
}

export function createPattern(holder, sheet, store, { onVertex, onAsk, onHint, poppable }) {
  const picture = svg("svg", { role: "group", "aria-label": "Crease pattern" });
  holder.append(picture);
  let folds = [], vertices = [], place = null, scale = 1, held = false, after = null, own = null;
  const over = svg("g", {});

  function layout() {
    const width = holder.clientWidth, height = holder.clientHeight;
    if (!width || !height) return;
    if (!held || !place) place = fitted(sheet.points, width, height);
    picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const at = sheet.points.map(place);
    const d = (corners) => corners.map((v, k) => `${k ? "L" : "M"}${at[v][0]} ${at[v][1]}`).join("");
    const room = roomOf(sheet, at);
    const size = Math.max(2.5, Math.min(8.5, room / 7));
    scale = Math.min(Math.max(room / LOOK.full, LOOK.smallest), 1);
    const focus = document.activeElement?.dataset;
    const kept = focus && (focus.fold ? ["fold", focus.fold] : focus.vertex ? ["vertex", focus.vertex] : null);
    folds = sheet.folds.map((edge, k) => foldNode(edge, k, at, d(edge), size));
    vertices = sheet.interior.map((v, k) => vertexNode(v, k, at, size, sheet));
    const faces = svg("path", { class: "face", d: sheet.faces.map((face) => `${d(face)}Z`).join("") });
    const border = drawLine(svg("path", { d: sheet.boundary.map(d).join("") }), "B", null, scale);
    picture.replaceChildren(
      faces,
      svg("g", { role: "group", "aria-label": "Folds: ask for a mountain or a valley" }, ...folds),
      border,
      svg("g", { role: "group", "aria-label": "Vertices: pop one through" }, ...vertices),
      over,
    );
    for (const nodes of [folds, vertices]) nodes.find((node) => node.hasAttribute("tabindex"))?.setAttribute("tabindex", 0);
    if (kept) picture.querySelector(`[data-${kept[0]}="${kept[1]}"]`)?.focus({ preventScroll: true });
    paint();
    after?.();
  }

  function paint() {
    const { ways, way, mirrored, asks } = store.get();
    const shown = ways[way];
    const side = shown ? seen(shown, mirrored) : { letters: sheet.letters, signs: "" };
    const largest = (shown?.angles ?? []).reduce((most, angle) => Math.max(most, Math.abs(angle)), 1e-9);
    folds.forEach((node, k) => {
      const letter = (own ?? side.letters)[k] ?? "U", asked = asks.get(k);
      const part = !own && shown?.angles.length ? Math.abs(shown.angles[k]) / largest : null;
      drawLine(node.querySelector(".line"), letter, part, scale);
      const badge = node.querySelector(".badge");
      badge.toggleAttribute("hidden", !asked);
      badge.querySelector("text").textContent = asked ?? "";
      badge.querySelector("circle").setAttribute("class", asked ?? "");
      const [i, j] = sheet.folds[k];
      const wish = asked ? `, asked to be a ${NAMES[asked]}` : "";
      const next = { M: "valley", V: "either" }[asked] ?? "mountain";
      const click = !ways.length ? "" : next === "either" ? " Click: no longer ask." : ` Click: ask for a ${next}.`;
      name(node, `Fold ${i}–${j}: ${shown || own ? NAMES[letter] : FILE_NAMES[letter]}${wish}.${click}`);
    });
    vertices.forEach((node, k) => {
      const sign = side.signs[k];
      node.querySelector(".mark").replaceWith(mark(sign, Number(node.dataset.size), sheet.foldable.has(sheet.interior[k])));
      const words = { "+": "popped up", "-": "popped down", "0": "flat" };
      const click = node.classList.contains("still") || !shown ? "" : !poppable(k) ? " No listed branch differs here only." : ` Click: pop it ${sign === "+" ? "down" : "up"}.`;
      const noted = sheet.marks.get(sheet.interior[k]);
      const note = noted ? ` ${noted.text}.` : "";
      name(node, `Vertex ${sheet.interior[k]}${sign ? `: ${words[sign] ?? "undecided"}` : ""}.${note}${click}`);
    });
  }

  function ask(k) {
    const asks = new Map(store.get().asks);
    const next = ASKED[(ASKED.indexOf(asks.get(k)) + 1) % ASKED.length];
    if (next) asks.set(k, next);
    else asks.delete(k);
    onAsk({ asks });
  }

  function act(target) {
    const node = target.closest?.("[data-fold], [data-vertex]");
    if (!node || node.classList.contains("still")) return;
    if (node.dataset.fold) ask(Number(node.dataset.place));
    else onVertex(Number(node.dataset.place));
  }

  // Say what is under the pointer or has the focus, and what a click does there.
  function hint({ target }) {
    onHint(target?.closest?.("[data-fold], [data-vertex]")?.getAttribute("aria-label") ?? "");
  }

  for (const kind of ["pointerover", "focusin"]) holder.addEventListener(kind, hint);
  for (const kind of ["pointerleave", "focusout"]) holder.addEventListener(kind, () => hint({}));
  picture.addEventListener("click", (event) => (act(event.target), hint(event)));
  picture.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const nodes = event.target.dataset.fold ? folds : vertices.filter((node) => node.hasAttribute("tabindex"));
    if (event.key === "Enter" || event.key === " ") {
      act(event.target);
      hint(event);
    }
    else if (step) roam(nodes, nodes.indexOf(event.target), step);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  store.on(["way", "mirrored", "asks", "ways"], paint);
  new ResizeObserver(layout).observe(holder);
  layout();

  return {
    place: (point) => place(point),
    back: (pixel) => place.back(pixel),
    hold: (yes) => (held = yes),  // the scale is kept while a vertex moves
    redraw: layout,
    letters: (text) => ((own = text), paint()),  // those of a flat-folded state; null for those of the way
    onLayout: (call) => (after = call),
    overlay: (nodes) => over.replaceChildren(...nodes),
    mark(marks) {
      sheet.marks = new Map(marks.map((one) => [one.vertex, one]));
      layout();
    },
  };
}

// The Tab key stops at only one node of a group; the arrow keys go to the others.
function roam(nodes, from, step) {
  const to = nodes[(from + step + nodes.length) % nodes.length];
  nodes[from].setAttribute("tabindex", -1);
  to.setAttribute("tabindex", 0);
  to.focus();
}

function fitted(points, width, height) {
  const extreme = (choose, c) => points.reduce((found, point) => choose(found, point[c]), points[0][c]);
  const low = [0, 1].map((c) => extreme(Math.min, c)), high = [0, 1].map((c) => extreme(Math.max, c));
  const scale = Math.min((width - 2 * MARGIN) / (high[0] - low[0]), (height - 2 * MARGIN) / (high[1] - low[1]));
  const left = (width - scale * (high[0] - low[0])) / 2, top = (height - scale * (high[1] - low[1])) / 2;
  const there = ([x, y]) => [left + scale * (x - low[0]), height - top - scale * (y - low[1])].map((c) => Math.round(c * 100) / 100);
  there.back = ([x, y]) => [low[0] + (x - left) / scale, low[1] + (height - top - y) / scale];
  return there;
}

// The pixels between neighbouring vertices; they limit the size of lines and marks.
function roomOf(sheet, at) {
  const lengths = sheet.folds.map(([i, j]) => Math.hypot(at[i][0] - at[j][0], at[i][1] - at[j][1])).sort((a, b) => a - b);
  return lengths[Math.floor(lengths.length / 5)] ?? 100;
}

function foldNode([i, j], k, at, d, size) {
  const [x, y] = [(at[i][0] + at[j][0]) / 2, (at[i][1] + at[j][1]) / 2];
  const reach = svg("path", { class: "reach", d });
  if (size < 6) reach.style.strokeWidth = `${2.2 * size}`;
  const node = svg("g", { class: "fold", role: "button", tabindex: -1, "data-fold": `${i}-${j}`, "data-place": k },
    svg("title"), reach, svg("path", { class: "line", d }),
    svg("g", { class: "badge", hidden: "" }, svg("circle", { cx: x, cy: y, r: 9 }), svg("text", { x, y: y + 0.5 })));
  return node;
}

function vertexNode(v, k, at, size, sheet) {
  const still = !sheet.foldable.has(v);
  const [x, y] = at[v];
  const node = svg("g", { class: still ? "vertex still" : "vertex", transform: `translate(${x} ${y})`, "data-vertex": v, "data-place": k, "data-size": size },
    svg("title"), svg("circle", { class: "reach", r: Math.max(size * 1.9, Math.min(15, size * 2.5)) }), svg("path", { class: "mark" }));
  const noted = sheet.marks.get(v);
  if (noted) node.insertBefore(ring(noted.kind, size), node.lastChild);
  node.setAttribute("role", still ? "img" : "button");
  if (!still || noted) node.setAttribute("tabindex", -1);
  if (sheet.interior.length <= MOST_INDICES && size > 4) {
    const angle = widestGap(sheet.folds.filter((edge) => edge.includes(v)).map(([i, j]) => {
      const other = at[i === v ? j : i];
      return Math.atan2(other[1] - y, other[0] - x);
    }));
    const away = size + 10;
    node.append(svg("text", { class: "index", x: away * Math.cos(angle), y: away * Math.sin(angle) }, String(v)));
  }
  return node;
}

// The middle of the widest angle between directions.
function widestGap(angles) {
  const sorted = [...angles].sort((a, b) => a - b);
  let best = [0, 0];
  sorted.forEach((angle, k) => {
    const gap = (sorted[k + 1] ?? sorted[0] + 2 * Math.PI) - angle;
    if (gap > best[0]) best = [gap, angle + gap / 2];
  });
  return best[1];
}

// The mark of a vertex: a filled triangle for up or down, an empty circle for flat, a dot without a sign.
export function mark(sign, size, foldable = true) {
  const s = size;
  const paths = {
    "+": `M0 ${-s}L${0.866 * s} ${0.5 * s}H${-0.866 * s}Z`,
    "-": `M0 ${s}L${0.866 * s} ${-0.5 * s}H${-0.866 * s}Z`,
  };
  const r = sign === undefined || !foldable ? 0.4 * s : 0.75 * s;
  const level = !(sign in paths) && sign !== undefined && foldable;
  const round = `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
  return svg("path", { class: level ? "mark level" : "mark", d: paths[sign] ?? round });
}

// The ring round a vertex to look at.
function ring(kind, size) {
  return svg("circle", { class: `ring ${kind}`, r: 1.45 * size });
}

function name(node, text) {
  node.setAttribute("aria-label", text);
  node.querySelector("title").textContent = text;
}

// `letters` and `signs` are all that are shown. Without ways to fold, `letters` are those of the file.
export function legendItems(letters, signs, ofFile, kinds = []) {
  const line = (letter, text) => [svg("svg", { "aria-hidden": "true" }, drawLine(svg("path", { d: "M0 5H24" }), letter, null)), text];
  const point = (sign, text) => [svg("svg", { "aria-hidden": "true", class: "small", viewBox: "-6 -6 12 12" }, mark(sign, 5)), text];
  const noted = (kind, text) => [svg("svg", { "aria-hidden": "true", class: "small", viewBox: "-6 -6 12 12" }, ring(kind, 3.4)), text];
  const names = { M: "mountain", V: "valley", F: "flat", U: ofFile ? "no letter" : "undecided" };
  const kindNames = { refuted: "vertex that cannot start to fold", open: "vertex that is open", flat: "vertex that does not fold flat" };
  const marks = { "+": "vertex up", "-": "vertex down", "0": "vertex flat" };
  const seenBoth = (text) => text + turned(text);  // the mirror image can be shown, too
  return [
    ...Object.keys(names).filter((letter) => seenBoth(letters).includes(letter)).map((letter) => line(letter, names[letter])),
    ...Object.keys(marks).filter((sign) => seenBoth(signs).includes(sign)).map((sign) => point(sign, marks[sign])),
    ...Object.keys(kindNames).filter((kind) => kinds.includes(kind)).map((kind) => noted(kind, kindNames[kind])),
  ];
}
