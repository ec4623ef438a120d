// The page: it reads its data and connects its parts.

import { popped, poppedSigns, seen } from "./choose.js";
import { decodeFrames, positionsAt } from "./frames.js";
import { download, fileName, foldFile } from "./foldfile.js";
import { createFamily } from "./family.js";
import { sentence, showFacts } from "./facts.js";
import { createList } from "./list.js";
import { createPattern, legendItems } from "./pattern.js";
import { ask } from "./remote.js";
import { createScene } from "./scene.js";
import { foldAngles, readSheet } from "./sheet.js";
import { createStore } from "./store.js";
import { createTransport } from "./transport.js";

const OPENING = 0.55;
const APART = 0.003;  // layers that meet at the end are drawn in the order in which they arrive

const page = JSON.parse(document.getElementById("data").textContent);
const sheet = readSheet(page.sheet);
const flat = flatPositions(sheet);
const store = createStore({
  ways: page.ways, way: page.drawn?.way ?? 0, mirrored: page.drawn?.mirrored ?? false, time: 0, playing: false, asks: new Map(), search: "",
});
const positions = new Float64Array(flat.length);
const decoded = new Map();
let scene = null;

function byId(id) {
  return document.getElementById(id);
}

// The flat sheet with its middle at the origin.
function flatPositions({ points }) {
  const middle = [0, 1].map((c) => points.reduce((sum, point) => sum + point[c], 0) / points.length);
  return Float64Array.from(points.flatMap(([x, y]) => [x - middle[0], y - middle[1], 0]));
}

function framesOf(way) {
  if (!way?.motion) return null;
  if (!decoded.has(way)) {
    if (decoded.size > 40) decoded.delete(decoded.keys().next().value);
    decoded.set(way, decodeFrames(way.motion));
  }
  return decoded.get(way);
}

function paintSheet() {
  const { ways, way, mirrored, time } = store.get();
  const frames = framesOf(ways[way]);
  if (frames) positionsAt(frames, Math.min(time, 1 - APART), mirrored, positions);
  else positions.set(flat);
  scene?.show(positions);
  family?.leave();
  transport.angle(frames ? foldAngles(sheet, positions).reduce((most, angle) => Math.max(most, Math.abs(angle)), 0) : null);
}

// The first view contains the flat sheet and the motion that is shown first.
function fitScene() {
  const frames = framesOf(store.get().ways[store.get().way]);
  const shapes = frames ? [0.35, 0.7, 1].flatMap((part) => [false, true].map(
    (turn) => positionsAt(frames, part, turn, new Float64Array(flat.length)))) : [];
  scene?.fit([flat, ...shapes]);
}

function describe() {
  const { ways, way, mirrored } = store.get();
  const shown = ways[way];
  showFacts(page, shown);
  transport.describe(shown?.motion);
  family?.describe(shown, mirrored);
  byId("mirror").disabled = !shown;
  byId("mirror").setAttribute("aria-pressed", String(mirrored));
  byId("download").disabled = !shown;
  const waiting = page.served && shown && !shown.motion && !shown.why;
  byId("empty").hidden = Boolean(shown?.motion);
  byId("empty").textContent = !shown ? nothingMoves() : waiting ? "Following the motion …" : sentence(`no motion is drawn: ${shown.why}`);
  if (waiting) follow(way);
}

// Why the sheet lies flat, if no way to fold is listed.
function nothingMoves() {
  if (/\brigid\b/.test(page.answer) && page.status === "proved") return "The sheet is rigid: it lies flat, and nothing can move.";
  return `The sheet lies flat: no way to fold is known. ${sentence(page.notes[0] ?? page.reason)}`;
}

// Positions that were chosen by hand, instead of those of the motion.
function pose(chosen) {
  positions.set(chosen);
  scene?.show(positions);
  transport.angle(foldAngles(sheet, positions).reduce((most, angle) => Math.max(most, Math.abs(angle)), 0));
}

let messageTimer = 0;
function say(text, wrong = false) {
  const box = byId("message");
  box.textContent = text;
  box.className = `message shown${wrong ? " wrong" : ""}`;
  clearTimeout(messageTimer);
  messageTimer = setTimeout(() => (box.className = "message"), wrong ? 9000 : 2600);
}

// --- on demand -----------------------------------------------------------------------------------

const asked = new Set();

async function follow(k) {
  if (asked.has(k)) return;
  asked.add(k);
  const way = store.get().ways[k];
  try {
    const found = await ask(way.found ? `branch?signs=${encodeURIComponent(way.signs)}` : `motion?way=${k}`);
    replace(k, { ...way, motion: found.motion, why: found.why, angles: found.angles });
  } catch (error) {
    say(error.message, true);
    replace(k, { ...way, why: error.message });
  }
}

function replace(k, way) {
  const ways = [...store.get().ways];
  ways[k] = way;
  store.set({ ways });
}

async function fetchBranch(signs) {
  say(`Asking for branch ${signs} …`);
  try {
    const found = { ...(await ask(`branch?signs=${encodeURIComponent(signs)}`)), found: true };
    const ways = [...store.get().ways, found];
    store.set({ ways, way: ways.length - 1, mirrored: false });
    say(`Branch ${found.signs.replaceAll("-", "−")}`);
  } catch (error) {
    say(error.message, true);
  }
}

function pop(at) {
  const { ways, way, mirrored } = store.get();
  if (!ways[way]) return;
  const vertex = sheet.interior[at];
  const next = popped(ways, way, mirrored, at);
  if (next) {
    if (!visible(next.way)) store.set({ search: (byId("search").value = ""), asks: new Map() });
    store.set({ way: next.way, mirrored: next.mirrored });
    say(`Vertex ${vertex} popped through`);
  } else if (page.served) {
    fetchBranch(poppedSigns(seen(ways[way], mirrored).signs, at));
  } else {
    say(`No branch is listed that differs at vertex ${vertex} only`);
  }
}

function visible(k) {
  return document.getElementById(`way-${k}`) !== null;
}

// --- start ---------------------------------------------------------------------------------------

byId("name").textContent = page.name;
byId("answer").append(...page.answer.split(/\b(PROVED|UNDECIDED)\b/).map((part) => {
  if (part !== "PROVED" && part !== "UNDECIDED") return part.replace(/ - $/, " – ");
  return Object.assign(document.createElement("b"), { textContent: part, className: part === "PROVED" ? "" : "open" });
}));
const HINT = !page.ways.length ? "Letters of the file" : page.kind === "branches" ? "Click a vertex or a fold" : "Click a fold";
function hint(text) {
  byId("pattern-hint").textContent = text || HINT;
}
hint("");
byId("pattern").parentElement.classList.toggle("idle", !page.ways.length);
const all = (key) => page.ways.map((way) => way[key]).join("");
byId("legend").append(...legendItems(page.ways.length ? all("letters") : sheet.letters, all("signs"), !page.ways.length, [...sheet.marks.values()].map(({ kind }) => kind)).map((parts) => {
  const node = document.createElement("li");
  node.append(...parts);
  return node;
}));

const transport = createTransport(store);
createPattern(byId("pattern"), sheet, store, {
  onVertex: pop, onHint: hint,
  poppable: (at) => page.served || popped(store.get().ways, store.get().way, store.get().mirrored, at) !== null,
});
const list = createList(page, store);
const family = createFamily(byId("family"), sheet, store, { positions: () => positions, pose, say });
const radius = flat.reduce((most, _, i) => (i % 3 ? most : Math.max(most, Math.hypot(flat[i], flat[i + 1]))), 1e-12);
try {
  scene = createScene(byId("canvas"), sheet, flat, radius);
} catch (error) {
  byId("stage").append(Object.assign(document.createElement("p"), { className: "empty", textContent: `The sheet cannot be drawn in space, which takes WebGL 2: ${error.message}` }));
}
store.on(["way", "mirrored", "time", "ways"], paintSheet);
store.on(["way", "mirrored", "ways"], describe);
describe();
fitScene();
if (framesOf(store.get().ways[store.get().way])) store.set({ time: OPENING });
paintSheet();

byId("mirror").addEventListener("click", () => store.set({ mirrored: !store.get().mirrored }));
byId("home").addEventListener("click", () => scene?.home());
byId("download").addEventListener("click", () => {
  const { ways, way, mirrored } = store.get();
  const name = fileName(page, ways[way], mirrored);
  download(JSON.stringify(foldFile(page, sheet, ways[way], mirrored)), name);
  say(`Saved ${name}`);
});
byId("search").addEventListener("keydown", (event) => {
  if (event.key === "ArrowDown" || event.key === "ArrowUp") list.step(event.key === "ArrowDown" ? 1 : -1);
  else if (event.key === "Enter" && page.served && !byId("ways").querySelector(".way")) fetchBranch(event.target.value.replaceAll("−", "-").replaceAll(/\s/g, ""));
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
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const typing = event.target.matches?.("input[type=search]");
  const pressing = event.target.matches?.("button");
  const sliding = event.target.matches?.("input[type=range]");
  const { time, mirrored, ways } = store.get();
  if (typing || (pressing && (event.key === " " || event.key === "Enter"))) return;
  if (event.key === " ") transport.toggle();
  else if (event.key === "m" && ways.length) store.set({ mirrored: !mirrored });
  else if (event.key === "0") scene?.home();
  else if (sliding) return;
  else if (event.key === "ArrowDown" || event.key === "ArrowUp") list.step(event.key === "ArrowDown" ? 1 : -1);
  else if (event.key === "ArrowRight" || event.key === "ArrowLeft") store.set({ playing: false, time: Math.min(Math.max(time + (event.key === "ArrowRight" ? 0.02 : -0.02), 0), 1) });
  else return;
  event.preventDefault();
});

// Used by tests and in the console of the browser.
window.exactfold = {
  page, store, foldFile: () => foldFile(page, sheet, store.get().ways[store.get().way], store.get().mirrored),
  positions: () => Array.from(positions), angles: () => foldAngles(sheet, positions), drawn: () => scene?.drawn() ?? 0,
};
