// A sheet and its ways to fold, shown in the parts of the page.

import { popped, poppedSigns, seen } from "./choose.js";
import { decodeFrames, positionsAt } from "./frames.js";
import { download, fileName, foldFile } from "./foldfile.js";
import { createFamily } from "./family.js";
import { createFolded } from "./folded.js";
import { own, sentence, showFacts } from "./facts.js";
import { createList } from "./list.js";
import { createPattern, legendItems } from "./pattern.js";
import { createScene } from "./scene.js";
import { foldAngles, readSheet } from "./sheet.js";
import { createStore } from "./store.js";
import { createTransport } from "./transport.js";

const OPENING = 0.55;
const APART = 0.003;  // layers that meet at the end are drawn in the order in which they arrive

export function byId(id) {
  return document.getElementById(id);
}

let messageTimer = 0;
export function say(text, wrong = false) {
  const box = byId("message");
  box.textContent = text;
  box.className = `message shown${wrong ? " wrong" : ""}`;
  clearTimeout(messageTimer);
  messageTimer = setTimeout(() => (box.className = "message"), wrong ? 9000 : 2600);
}

// The answer in the head of the page, with its verdict in colour.
export function showAnswer(name, answer) {
  byId("name").textContent = name;
  byId("answer").replaceChildren(...answer.split(/\b(PROVED|UNDECIDED)\b/).map((part) => {
    if (part !== "PROVED" && part !== "UNDECIDED") return part.replace(/ - $/, " – ");
    return Object.assign(document.createElement("b"), { textContent: part, className: part === "PROVED" ? "" : "open" });
  }));
}

// The flat sheet with its middle at the origin.
function flatPositions({ points }) {
  const middle = [0, 1].map((c) => points.reduce((sum, point) => sum + point[c], 0) / points.length);
  return Float64Array.from(points.flatMap(([x, y]) => [x - middle[0], y - middle[1], 0]));
}

// A state in the address, if the page has it.
function stateIn(found, folded) {
  return folded && found?.sheets[folded.sheet]?.stacks[folded.state] ? folded : null;
}

// Shows the document `page`. `server` follows ways and finds branches on demand; null without one.
// `signal` ends what listens beyond the parts of the page, `begin` is the state to begin with, and
// `changed` is called when the state changes. `moves` undoes moves of vertices; null without them.
export function createView(page, { server, signal, begin = {}, moves = null, changed }) {
  const sheet = readSheet(page.sheet);
  const flat = flatPositions(sheet);
  const store = createStore({
    ways: page.ways, way: page.drawn?.way ?? 0, mirrored: page.drawn?.mirrored ?? false, time: 0, playing: false,
    speed: 1, asks: new Map(), search: "", beside: null, ...begin, folded: stateIn(page.folded, begin.folded),
  });
  const positions = new Float64Array(flat.length), others = new Float64Array(flat.length);
  const radius = flat.reduce((most, _, i) => (i % 3 ? most : Math.max(most, Math.hypot(flat[i], flat[i + 1]))), 1e-12);
  const decoded = new Map();
  let scene = null, second = null;

  function framesOf(way) {
    if (!way?.motion) return null;
    if (!decoded.has(way)) {
      if (decoded.size > 40) decoded.delete(decoded.keys().next().value);
      decoded.set(way, decodeFrames(way.motion));
    }
    return decoded.get(way);
  }

  // The order of the layers at the end of a way, if it is proved: they lie apart in the last frame.
  function layersOf(way) {
    const { layered } = folded.endOf(store.get().ways.indexOf(way)) ?? {};
    return layered?.length ? layered : null;
  }

  function placeAt(way, mirrored, time, out) {
    const frames = framesOf(way), layered = frames && layersOf(way);
    if (layered) frames.values.set(layered, frames.values.length - frames.size);
    if (frames) positionsAt(frames, layered ? time : Math.min(time, 1 - APART), mirrored, out);
    else out.set(flat);
    return frames;
  }

  function paintSheet() {
    const { ways, way, mirrored, time, beside } = store.get();
    const frames = placeAt(ways[way], mirrored, time, positions);
    scene?.show(positions);
    if (beside && second) {
      placeAt(ways[beside.way], beside.mirrored, time, others);
      second.show(others);
    }
    family?.leave();
    transport.angle(frames ? largest() : null);
  }

  function largest() {
    const { ways, way, time } = store.get();
    if (time === 1 && layersOf(ways[way])) return 180;
    return foldAngles(sheet, positions).reduce((most, angle) => Math.max(most, Math.abs(angle)), 0);
  }

  // The first view contains the flat sheet and the motion that is shown first.
  function shapesOf(way) {
    const frames = framesOf(way);
    return [flat, ...(frames ? [0.35, 0.7, 1].flatMap((part) => [false, true].map(
      (turn) => positionsAt(frames, part, turn, new Float64Array(flat.length)))) : [])];
  }

  function describe() {
    const { ways, way, mirrored } = store.get();
    const shown = ways[way], moving = !store.get().folded;
    showFacts(page, shown, folded.endOf(way));
    transport.describe(moving ? shown?.motion : null, Boolean(shown && layersOf(shown)));
    family?.describe(moving ? shown : null, mirrored);
    byId("flat").hidden = !page.folded?.sheets.length;
    byId("flat").setAttribute("aria-pressed", String(!moving));  // the sheet folded flat is shown instead
    byId("stage").parentElement.hidden = !moving;
    for (const id of ["beside", "home", "gif", "mp4"]) byId(id).classList.toggle("away", !moving);
    byId("mirror").classList.toggle("away", !moving && !folded.ending());
    pattern.letters(folded.letters());
    for (const id of ["mirror", "download", "beside"]) byId(id).disabled = !shown;
    byId("mirror").setAttribute("aria-pressed", String(mirrored));
    const waiting = server && shown && !shown.motion && !shown.why;
    byId("empty").hidden = Boolean(shown?.motion) || !moving;
    byId("empty").textContent = !shown ? nothingMoves() : waiting ? "Following the motion …" : sentence(`no motion is drawn: ${shown.why}`);
    if (waiting && !page.busy) follow(way);
  }

  // Why the sheet lies flat, if no way to fold is listed.
  function nothingMoves() {
    if (page.busy) return "Looking for ways to fold …";
    if (/\brigid\b/.test(page.answer) && page.status === "proved") return "The sheet is rigid: it lies flat, and nothing can move.";
    return `The sheet lies flat: no way to fold is known. ${sentence(page.notes[0] ?? own(page))}`.trim();
  }

  // Positions that were chosen by hand, instead of those of the motion.
  function pose(chosen) {
    positions.set(chosen);
    scene?.show(positions);
    transport.angle(largest());
  }

  // Flat-folded states, and the ways that end in them, which the server has found.
  function foldedFlat(found) {
    page.folded = found.sheets ? found : { ...page.folded, ends: [...page.folded.ends, found] };
    describe();
    folded.refresh();
    paintSheet();
  }

  // A motion that the server has found.
  function arrived(k, keys) {
    const first = k === store.get().way && begin.time === undefined && !framesOf(store.get().ways[k]);
    replace(k, keys);
    if (!first || !framesOf(store.get().ways[k])) return;
    scene?.fit(shapesOf(store.get().ways[k]));
    if (store.get().time === 0) store.set({ time: OPENING });
  }

  // --- on demand ---------------------------------------------------------------------------------

  const asked = new Set();

  async function follow(k) {
    if (asked.has(k)) return;
    asked.add(k);
    try {
      const { signs, found } = store.get().ways[k];
      replace(k, found ? await server.branch(signs) : (await server.follow(k)).found);
    } catch (error) {
      if (signal.aborted) return;
      say(error.message, true);
      replace(k, { why: error.message });
    }
  }

  function replace(k, keys) {
    const ways = [...store.get().ways];
    ways[k] = { ...ways[k], ...keys };
    store.set({ ways });
  }

  async function fetchBranch(signs) {
    say(`Asking for branch ${signs} …`);
    try {
      const found = { ...(await server.branch(signs)), found: true };
      const ways = [...store.get().ways, found];
      store.set({ ways, way: ways.length - 1, mirrored: false });
      say(`Branch ${found.signs.replaceAll("-", "−")}`);
    } catch (error) {
      say(error.message, true);
    }
  }

  // --- asking for letters, and asking no longer ---------------------------------------------------

  const past = [];

  function ask(patch) {
    const { asks, search, way, mirrored } = store.get();
    past.push({ asks, search, way, mirrored });
    store.set(patch);
    undoable();
  }

  // What was asked last is undone first, then the moves of vertices before it.
  function undo() {
    const last = past.pop();
    if (last) {
      byId("search").value = last.search;
      store.set(last);
    } else moves?.undo();
    undoable();
  }

  function undoable() {
    byId("undo").hidden = !past.length && !moves?.undoable();
  }

  function pop(at) {
    const { ways, way, mirrored } = store.get();
    if (!ways[way]) return;
    const vertex = sheet.interior[at];
    const next = popped(ways, way, mirrored, at);
    if (next) {
      if (!byId(`way-${next.way}`)) ask({ search: (byId("search").value = ""), asks: new Map() });
      store.set({ way: next.way, mirrored: next.mirrored });
      say(`Vertex ${vertex} popped through`);
    } else if (server) fetchBranch(poppedSigns(seen(ways[way], mirrored).signs, at));
    else say(`No branch is listed that differs at vertex ${vertex} only`);
  }

  // --- the parts ---------------------------------------------------------------------------------

  showAnswer(page.name, page.answer);
  const HINT = !page.ways.length ? "Letters of the file" : page.kind === "branches" ? "Click a vertex or a fold" : "Click a fold";
  const hint = (text) => (byId("pattern-hint").textContent = text || HINT);
  hint("");
  byId("pattern").parentElement.classList.toggle("idle", !page.ways.length);
  const all = (key) => page.ways.map((way) => way[key]).join("");
  byId("legend").replaceChildren(...legendItems(page.ways.length ? all("letters") : sheet.letters, all("signs"), !page.ways.length, [...sheet.marks.values()].map(({ kind }) => kind)).map((parts) => {
    const node = document.createElement("li");
    node.append(...parts);
    return node;
  }));

  const transport = createTransport(store);
  const pattern = createPattern(byId("pattern"), sheet, store, {
    onVertex: pop, onAsk: ask, onHint: hint,
    poppable: (at) => server !== null || popped(store.get().ways, store.get().way, store.get().mirrored, at) !== null,
  });
  const list = createList(page, store, { onAsk: ask });
  const folded = createFolded(byId("folded"), page, sheet, store);
  const family = createFamily(byId("family"), sheet, store, { positions: () => positions, pose, say });
  try {
    scene = createScene(byId("canvas"), sheet, flat, radius, signal);
  } catch (error) {
    byId("stage").append(Object.assign(document.createElement("p"), { className: "empty", textContent: `The sheet cannot be drawn in space, which takes WebGL 2: ${error.message}` }));
  }

  // Another way beside the one that is chosen; both fold at the same time.
  function besides() {
    const { beside, ways } = store.get();
    byId("stage2").hidden = !beside;
    byId("beside").setAttribute("aria-pressed", String(Boolean(beside)));
    if (!beside) return;
    const name = seen(ways[beside.way], beside.mirrored).signs.replaceAll("-", "−") || ways[beside.way].name;
    byId("beside-name").textContent = `${ways[beside.way].number ? `${ways[beside.way].number}: ` : ""}${name}${beside.mirrored ? ", mirror image" : ""}`;
    if (!second && scene) second = createScene(byId("canvas2"), sheet, flat, radius, signal);
    second?.fit(shapesOf(ways[beside.way]));
    paintSheet();
  }

  store.on(["way", "mirrored", "time", "ways"], paintSheet);
  store.on(["way", "mirrored", "ways", "folded"], describe);
  store.on(["beside"], besides);
  if (changed) store.on(["way", "mirrored", "folded", "time", "asks", "search", "playing"], changed);
  describe();
  folded.refresh();
  scene?.fit(shapesOf(store.get().ways[store.get().way]));
  if (begin.time === undefined && framesOf(store.get().ways[store.get().way])) store.set({ time: OPENING });
  paintSheet();

  byId("mirror").addEventListener("click", () => store.set({ mirrored: !store.get().mirrored }));
  byId("flat").addEventListener("click", () => (store.get().folded ? folded.close() : folded.open()));
  byId("home").addEventListener("click", () => (scene?.home(), second?.home()));
  byId("beside").addEventListener("click", () => {
    const { beside, way, mirrored } = store.get();
    store.set({ beside: beside ? null : { way, mirrored } });
    if (!beside) say("Now choose another way: both fold side by side");
  });
  byId("as-drawn").hidden = !page.ways.length || !/[MV]/.test(sheet.letters);
  byId("as-drawn").addEventListener("click", () => {
    ask({ asks: new Map([...sheet.letters].flatMap((letter, k) => ("MV".includes(letter) ? [[k, letter]] : []))) });
    const { drawn } = page;
    if (drawn) store.set({ way: drawn.way, mirrored: drawn.mirrored });
    else say(page.complete ? "No way of this sheet has the letters of the file" : "No listed way has the letters of the file");
  });
  byId("undo").addEventListener("click", () => {
    undo();
    if (byId("undo").hidden) byId("pattern").querySelector("[tabindex='0']")?.focus({ preventScroll: true });
  });
  undoable();
  byId("download").addEventListener("click", () => {
    const { ways, way, mirrored } = store.get();
    const name = fileName(page, ways[way], mirrored);
    download(new Blob([JSON.stringify(foldFile(page, sheet, ways[way], mirrored))], { type: "application/json" }), name);
    say(`Saved ${name}`);
  });
  byId("search").addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") list.step(event.key === "ArrowDown" ? 1 : -1);
    else if (event.key === "Enter" && server && !byId("ways").querySelector(".way")) fetchBranch(event.target.value.replaceAll("−", "-").replaceAll(/\s/g, ""));
    else return;
    event.preventDefault();
  });
  byId("canvas").addEventListener("keydown", (event) => {
    const moves = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12], "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1.1] };
    if (!moves[event.key]) return;
    scene?.move(...moves[event.key]);
    event.preventDefault();
    event.stopPropagation();
  });
  document.addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !event.target.matches?.("input[type=search]")) {
      event.preventDefault();
      undo();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target.matches?.("input[type=search], select");
    const pressing = event.target.matches?.("button, summary");
    const sliding = event.target.matches?.("input[type=range]");
    const { time, mirrored, ways } = store.get();
    if (typing || (pressing && (event.key === " " || event.key === "Enter"))) return;
    if (event.key === " ") transport.toggle();
    else if (event.key === "f" && page.folded?.sheets.length) byId("flat").click();
    else if (event.key === "m" && ways.length) store.set({ mirrored: !mirrored });
    else if (event.key === "0") scene?.home();
    else if (sliding) return;
    else if (event.key === "ArrowDown" || event.key === "ArrowUp") list.step(event.key === "ArrowDown" ? 1 : -1);
    else if (store.get().folded && (event.key === "ArrowRight" || event.key === "ArrowLeft")) folded.step(event.key === "ArrowRight" ? 1 : -1);
    else if (event.key === "ArrowRight" || event.key === "ArrowLeft") store.set({ playing: false, time: Math.min(Math.max(time + (event.key === "ArrowRight" ? 0.02 : -0.02), 0), 1) });
    else return;
    event.preventDefault();
  }, { signal });

  // A picture of the sheet at a time, or as it is shown, on the ground of the page.
  function picture(time = null) {
    const { ways, way, mirrored, beside } = store.get();
    const parts = [[scene, ways[way], mirrored, positions], ...(beside ? [[second, ways[beside.way], beside.mirrored, others]] : [])];
    const canvases = parts.map(([where, one, side, own]) => {
      const shape = time === null ? own : new Float64Array(flat.length);
      if (time !== null) placeAt(one, side, time, shape);
      return where.picture(shape);
    });
    const out = document.createElement("canvas");
    out.width = canvases.reduce((sum, { width }) => sum + width, 0);
    out.height = canvases[0].height;
    const pen = out.getContext("2d", { willReadFrequently: true });
    pen.fillStyle = getComputedStyle(byId("stage").closest(".pane")).backgroundColor;
    pen.fillRect(0, 0, out.width, out.height);
    let left = 0;
    for (const canvas of canvases) {
      pen.drawImage(canvas, left, 0);
      left += canvas.width;
    }
    return out;
  }

  return {
    page, sheet, store, pattern, arrived, foldedFlat, picture, folded, repaint: paintSheet, describe,
    drawable: () => scene !== null,
    positions: () => Array.from(positions), angles: () => foldAngles(sheet, positions), drawn: () => scene?.drawn() ?? 0,
    foldFile: () => foldFile(page, sheet, store.get().ways[store.get().way], store.get().mirrored),
    name: () => fileName(page, store.get().ways[store.get().way] ?? { name: "flat", signs: "" }, store.get().mirrored),
  };
}
