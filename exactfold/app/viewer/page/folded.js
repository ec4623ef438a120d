// The sheet folded flat: its states from both sides, or why there is none.

import { turned } from "./choose.js";
import { sentence } from "./facts.js";
import { svg } from "./pattern.js";

const ROUND = 16, CAPTION = 22;  // pixels round a view, and below it for its name
const NAMES_OF = { drawn: "Letters of the file", any: "Any letters" };

// Shows states in `box`. The store has `folded`: null while the motion is shown, else the place of
// the sheet in `page.folded.sheets` (or -1: where the way that is shown ends) and of the state.
export function createFolded(box, page, sheet, store) {
  const part = (name) => box.querySelector(`.${name}`);
  const views = part("folded-views"), which = part("folded-which"), state = part("folded-state");
  const slider = state.querySelector("input"), why = part("folded-why");
  let drawn = null;

  const endOf = (way) => (page.folded?.ends ?? []).find((end) => end.way === way) ?? null;

  // Where the way that is shown ends: the place of a state in a list if it has a number there.
  function ending() {
    const { way, mirrored } = store.get();
    const end = endOf(way);
    if (!end?.stack) return null;  // not known, or not proved
    const number = mirrored ? end.mirrored : end.state;
    const at = page.folded.sheets.findIndex(({ letters }) => letters === end.letters);
    if (number !== null && page.folded.sheets[at]?.stacks[number]) return { sheet: at, state: number };
    return { sheet: -1, state: 0 };
  }

  function open() {
    const first = page.folded.sheets.findIndex(({ stacks }) => stacks.length);
    store.set({ folded: ending() ?? { sheet: Math.max(first, 0), state: 0 }, playing: false });
  }

  // What is drawn: the state, its shapes, and whether it is seen from the other side of the sheet.
  function chosen() {
    const { folded, way, mirrored } = store.get();
    if (!folded) return null;
    if (folded.sheet < 0) {
      const end = endOf(way);
      return end?.stack ? { shapes: end.shapes, stack: seenFrom(end.stack, mirrored) } : null;
    }
    const found = page.folded.sheets[folded.sheet];
    return { shapes: found.shapes, stack: found.stacks[folded.state] ?? null, found };
  }

  function refresh() {
    const { folded } = store.get();
    box.hidden = !folded || !page.folded;
    if (box.hidden) return;
    const options = page.folded.sheets.map((one, k) => [k, `${NAMES_OF[one.letters]}: ${numberOf(one)}`]);
    const end = ending();
    if (end?.sheet === -1) options.push([-1, `Where ${store.get().ways[store.get().way].name} ends`]);
    if (folded.sheet < 0 && end?.sheet !== -1) {
      open();
      return;
    }
    which.replaceChildren(...options.map(([value, text]) => new Option(text, value, false, value === folded.sheet)));
    which.disabled = options.length < 2;
    drawn = chosen();
    const found = drawn?.found;
    part("folded-answer").replaceChildren(...answerOf(found, found ? null : endOf(store.get().way)));
    const most = found?.stacks.length ?? 0;
    state.hidden = most < 2;
    slider.max = Math.max(most - 1, 0);
    slider.value = folded.state;
    slider.setAttribute("aria-valuetext", `state ${folded.state}`);
    state.querySelector("output").textContent = `state ${folded.state}`;
    part("folded-more").textContent = found && found.states > most && most ? `The first ${most} of ${found.states} states, numbered from 0` : "";
    explain(found);
    layout();
  }

  // Why there is no state: a picture and the reasons, whose numbers stand in the picture.
  function explain(found) {
    const none = Boolean(found && !found.stacks.length);
    why.hidden = !none;
    views.hidden = none;
    if (!none) return;
    const parts = [];
    if (found.picture) {
      parts.push(Object.assign(document.createElement("img"), { src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(found.picture)}`, alt: "The crease pattern; the numbers are those of the reasons" }));
    }
    const list = document.createElement("ol");
    list.append(...found.reasons.map((text) => Object.assign(document.createElement("li"), { textContent: sentence(text) })));
    why.replaceChildren(...parts, list);
  }

  function layout() {
    const width = views.clientWidth, height = views.clientHeight;
    if (!drawn?.stack || !width || !height) {
      views.replaceChildren();
      return;
    }
    views.replaceChildren(stackPicture(drawn, sheet, width, height));
  }

  function step(by) {
    const { folded } = store.get();
    const most = page.folded.sheets[folded.sheet]?.stacks.length ?? 1;
    store.set({ folded: { ...folded, state: Math.min(Math.max(folded.state + by, 0), most - 1) } });
  }

  // Another way is shown: the state in which it ends, if that is known.
  function follow() {
    if (!store.get().folded) return;
    const end = ending();
    if (end) store.set({ folded: end });
    else refresh();
  }

  // The picture as a canvas, for a file.
  async function picture(ground) {
    const node = views.querySelector("svg");
    if (!node) return null;
    const scale = 2, out = document.createElement("canvas");
    [out.width, out.height] = [views.clientWidth * scale, views.clientHeight * scale];
    const image = new Image(out.width, out.height);
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(node))}`;
    await image.decode();
    const pen = out.getContext("2d");
    pen.fillStyle = ground;
    pen.fillRect(0, 0, out.width, out.height);
    pen.drawImage(image, 0, 0, out.width, out.height);
    return out;
  }

  which.addEventListener("change", () => store.set({ folded: Number(which.value) < 0 ? ending() : { sheet: Number(which.value), state: 0 } }));
  slider.addEventListener("input", () => store.set({ folded: { ...store.get().folded, state: Number(slider.value) } }));
  for (const [name, by] of [["folded-back", -1], ["folded-next", 1]]) part(name).addEventListener("click", () => step(by));
  store.on(["folded"], refresh);
  store.on(["way", "mirrored"], follow);
  new ResizeObserver(layout).observe(views);
  return { open, close: () => store.set({ folded: null }), step, endOf, ending, refresh, picture, letters: () => (store.get().folded ? chosen()?.stack?.letters ?? null : null) };
}

function numberOf({ states, stacks, status }) {
  if (states === null) return stacks.length ? `at least ${stacks.length} states` : "open";
  return `${states === 0 ? "no state" : states === 1 ? "1 state" : `${states} states`}${status === "undecided" ? "?" : ""}`;
}

function answerOf(found, end) {
  const text = found?.answer ?? (end ? `${sentence(end.said)} - PROVED` : "");
  return sentence(text).split(/\b(PROVED|REFUTED|UNDECIDED)\b/).map((part) => {
    if (!/^(PROVED|REFUTED|UNDECIDED)$/.test(part)) return part.replace(/ - $/, " – ");
    return Object.assign(document.createElement("b"), { textContent: part, className: part === "UNDECIDED" ? "open" : "" });
  });
}

// A state as the mirror image of the motion reaches it.
function seenFrom(stack, mirrored) {
  if (!mirrored) return stack;
  return { letters: turned(stack.letters), layers: [...stack.layers].reverse() };
}

// Both views of a state, side by side or one above the other, whichever is larger.
function stackPicture({ shapes, stack }, sheet, width, height) {
  const places = stack.layers.flatMap((k) => pairsOf(shapes[k].corners));
  const low = [0, 1].map((c) => places.reduce((least, point) => Math.min(least, point[c]), Infinity));
  const size = [0, 1].map((c) => places.reduce((most, point) => Math.max(most, point[c]), -Infinity) - low[c]);
  const fit = (across, down) => Math.min((width / across - 2 * ROUND) / size[0], (height / down - 2 * ROUND - CAPTION) / size[1]);
  const beside = fit(2, 1) >= fit(1, 2);
  const scale = Math.max(beside ? fit(2, 1) : fit(1, 2), 1e-9);
  const room = [width / (beside ? 2 : 1), height / (beside ? 1 : 2)];
  const ink = getComputedStyle(document.body).color;
  const parts = ["from above", "from below"].map((name, k) => {
    const left = (beside ? k * room[0] : 0) + (room[0] - scale * size[0]) / 2;
    const top = (beside ? 0 : k * room[1]) + (room[1] - CAPTION - scale * size[1]) / 2;
    const place = ([x, y]) => [left + scale * (k ? low[0] + size[0] - x : x - low[0]), top + scale * (low[1] + size[1] - y)];
    const layers = (k ? [...stack.layers].reverse() : stack.layers).map((n) => shapes[n]);
    const ground = svg("path", { d: layers.map((shape) => outline(shape, place)).join(""), fill: "#ffffff" });
    const text = svg("text", { x: left + (scale * size[0]) / 2, y: top + scale * size[1] + ROUND + 2, "text-anchor": "middle", "font-size": 12, "font-family": "system-ui, sans-serif", fill: ink, "fill-opacity": 0.75 });
    text.textContent = name;
    return svg("g", { class: "view" }, ground, ...layers.map((shape) => layerNode(shape, place, k > 0, stack.letters, widthOf(shapes, scale))), text);
  });
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": `The flat-folded state from above and from below, in ${stack.layers.length} layers` }, ...parts);
  return picture;
}

// One layer with the lines on it; what lies below is seen through it.
function layerNode(shape, place, below, letters, wide) {
  const node = svg("g", { class: "layer" }, svg("path", { d: outline(shape, place), fill: shape.front === below ? LOOK.back : LOOK.front, "fill-opacity": LOOK.opaque, "shape-rendering": "crispEdges" }));
  const paths = {};
  shape.folds.forEach((fold, k) => {
    const [a, b, c, d] = shape.lines.slice(4 * k, 4 * k + 4);
    const letter = fold < 0 ? "B" : letters[fold];
    paths[letter] = `${paths[letter] ?? ""}${lineOf([place([a, b]), place([c, d])])}`;
  });
  for (const letter of ["F", "V", "M", "B"]) {
    if (!paths[letter]) continue;
    const { width, dash, cap, colour } = LOOK.letters[letter];
    node.append(svg("path", { d: paths[letter], fill: "none", stroke: colour, "stroke-width": (wide * width).toFixed(2), "stroke-linecap": cap, "stroke-dasharray": dash.map((x) => (Math.max(wide, 0.5) * x).toFixed(2)).join(" ") || "none" }));
  }
  return node;
}

// The scale of widths of lines, by the lengths of the lines.
function widthOf(shapes, scale) {
  const lengths = shapes.flatMap(({ lines }) => Array.from({ length: lines.length / 4 }, (_, k) => Math.hypot(lines[4 * k] - lines[4 * k + 2], lines[4 * k + 1] - lines[4 * k + 3]))).sort((a, b) => a - b);
  return Math.min(Math.max((scale * (lengths[Math.floor(0.3 * lengths.length)] ?? 100)) / LOOK.full, LOOK.smallest), 1);
}

function pairsOf(numbers) {
  return Array.from({ length: numbers.length / 2 }, (_, k) => [numbers[2 * k], numbers[2 * k + 1]]);
}

function lineOf(points) {
  return points.map(([x, y], k) => `${k ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`).join("");
}

function outline(shape, place) {
  return `${lineOf(pairsOf(shape.corners).map(place))}Z`;
}
