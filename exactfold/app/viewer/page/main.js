// The page: it shows the sheet that it contains, or those that its server reads.

import { createChecking } from "./check.js";
import { createEditing } from "./edit.js";
import { createFilm } from "./film.js";
import { loadState, saveState } from "./hash.js";
import { createServer } from "./remote.js";
import { byId, createView, say, showAnswer } from "./view.js";

const data = JSON.parse(document.getElementById("data").textContent);
const blank = document.querySelector("main").cloneNode(true);
let view = null, ended = new AbortController();
const server = data.served ? createServer() : null;
const editing = server ? createEditing({ server, open: openSheet, view: () => view }) : null;

// Show a document in new parts of the page, so that nothing of the sheet before is left.
function show(page, begin) {
  ended.abort();
  ended = new AbortController();
  document.querySelector("main").replaceWith(blank.cloneNode(true));
  document.body.classList.toggle("served", Boolean(server));
  document.body.classList.remove("waiting");
  document.title = `${page.name} - exactfold`;
  view = createView(page, {
    server: server && { follow: (k) => server.one("follow", { way: k }), branch: async (signs) => (await server.one("follow", { signs })).branch },
    signal: ended.signal, begin, moves: editing, changed: () => saveState(view, editing),
  });
  createFilm(view, server);
  editing?.attach(view);
  if (page.checker) createChecking(page.checker);
  saveState(view, editing);
  Object.assign(window.exactfold, { page, store: view.store, foldFile: view.foldFile, positions: view.positions, angles: view.angles, drawn: view.drawn, view });
}

// Ask the server for a sheet: it is shown as soon as it is read, then its ways as they are found.
async function openSheet(request, begin = {}) {
  const state = { name: request.name ?? data.name };
  showAnswer(state.name || "exactfold", "reading …");
  let read = false, whole = false;
  try {
    await server.lines("open", request, (line) => {
      if (line.kind === "read") {
        read = true;
        show({ ...unknown(line), busy: true }, { time: 0 });
        if (line.brief) say(`Read: ${line.brief}`);
      }
      else if (line.kind === "listed") {
        whole = true;
        show({ ...line.document, busy: true }, begin);
      } else if (line.kind === "way") view.arrived(line.way, line.found);
      else if (line.kind === "folded") view.foldedFlat(line.folded);
      else if (line.kind === "end") view.foldedFlat(line.end);
      else if (line.kind === "late") say(line.text);
      else if (line.kind === "error") throw new Error(line.error);
    });
  } catch (error) {
    if (error.name === "AbortError") return;
    say(error.message, true);
    if (!view) showAnswer("exactfold", `not read: ${error.message}`);
    else if (!whole) {
      const looking = view.page.busy && !view.page.ways.length;
      const why = read ? error.message : "not counted, because another drawing was opened meanwhile";
      if (looking) Object.assign(view.page, { answer: why, reason: why });
      showAnswer(view.page.name, view.page.answer);
    }
  }
  if (!view) return;
  view.page.busy = false;
  view.describe();
  saveState(view, editing);
}

// What is shown of a sheet before its ways are known.
function unknown({ name, read, sheet }) {
  return { name, read, sheet, kind: "panels", answer: "looking for ways to fold …", status: "undecided", complete: false, reason: "", freedom: "", notes: [], ways: [], drawn: null, served: true };
}

// --- drawings from outside -----------------------------------------------------------------------

async function openFile(file) {
  if (!file) return;
  if (file.size > 5e6) {
    say(`${file.name} is too large: at most 5 MB are read`, true);
    return;
  }
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = "";
  for (let k = 0; k < bytes.length; k += 32768) text += String.fromCharCode(...bytes.subarray(k, k + 32768));
  editing.forget();
  openSheet({ name: file.name, data: btoa(text) });
}

function acceptFiles() {
  const body = document.body;
  body.classList.add("served", "waiting");
  byId("file").addEventListener("change", ({ target }) => (openFile(target.files[0]), (target.value = "")));
  byId("open").addEventListener("click", () => byId("file").click());
  body.addEventListener("dragover", (event) => {
    event.preventDefault();
    body.classList.add("dropping");
  });
  body.addEventListener("dragleave", (event) => !event.relatedTarget && body.classList.remove("dropping"));
  body.addEventListener("drop", (event) => {
    event.preventDefault();
    body.classList.remove("dropping");
    openFile(event.dataTransfer.files[0]);
  });
}

// --- start ---------------------------------------------------------------------------------------

// Used by tests and in the console of the browser.
window.exactfold = { drawn: () => 0 };
if (server) acceptFiles();
loadState().then(({ fold, name, begin }) => {
  if (data.sheet) show(data, begin);
  else if (fold) openSheet({ name, fold }, begin);
  else if (data.begins) openSheet({ name: data.name }, begin);
  else showAnswer("exactfold", "FOLD, SVG, CP, OPX, ORI, DXF, TMD5 or OBJ: it is read, counted, and folded here");
});
