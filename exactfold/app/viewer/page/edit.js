// Vertices that are moved with the mouse or by keys; the server answers while they move.

import { svg } from "./pattern.js";
import { byId, say, showAnswer } from "./view.js";

const FREE = 4096, MOST_UNDONE = 60;

export function createEditing({ server, open, view }) {
  let on = false, grid = 16, undone = [], dragged = null, busy = false, next = null;

  // The sheet that is shown, with the letters of the file, as the server reads it.
  function fold() {
    const { sheet } = view();
    const letters = new Map(sheet.folds.map(([i, j], k) => [`${i}-${j}`, sheet.letters[k]]));
    const edges_assignment = sheet.fold.edges_vertices.map(([i, j]) => letters.get(`${Math.min(i, j)}-${Math.max(i, j)}`) ?? "B");
    return { ...sheet.fold, edges_assignment };
  }

  // The buttons and handles of a sheet that has just been opened.
  function attach() {
    const { sheet, pattern, page } = view();
    byId("edit").hidden = false;
    byId("edit").setAttribute("aria-pressed", String(on));
    byId("grid").value = String(grid);
    byId("edit-tools").hidden = !on;
    byId("edit").addEventListener("click", () => {
      on = !on;
      byId("edit").setAttribute("aria-pressed", String(on));
      byId("edit-tools").hidden = !on;
      handles();
      if (on) say("Drag a vertex; the answer changes as it moves");
    });
    byId("grid").addEventListener("change", ({ target }) => (grid = Number(target.value)));
    const live = byId("live");
    live.textContent = page.freedom;
    pattern.onLayout(handles);
    const picture = byId("pattern");
    picture.addEventListener("pointerdown", (event) => {
      const handle = on && event.target.closest?.("[data-handle]");
      if (!handle) return;
      event.preventDefault();
      picture.setPointerCapture(event.pointerId);
      server.stop("open");
      dragged = { vertex: Number(handle.dataset.handle), before: fold(), from: [...sheet.points[Number(handle.dataset.handle)]], moved: false };
      pattern.hold(true);
    });
    picture.addEventListener("pointermove", (event) => {
      if (!dragged) return;
      const box = picture.getBoundingClientRect();
      moveTo(snapped(pattern.back([event.clientX - box.left, event.clientY - box.top])));
    });
    for (const kind of ["pointerup", "pointercancel"]) picture.addEventListener(kind, () => dragged && settle());
    handles();
  }

  function handles() {
    const { sheet, pattern } = view();
    byId("pattern").classList.toggle("editing", on);
    pattern.overlay(!on ? [] : sheet.points.map((point, v) => {
      const [cx, cy] = pattern.place(point);
      const node = svg("circle", { class: "handle", cx, cy, r: 8, tabindex: 0, role: "button", "data-handle": v, "aria-label": `Vertex ${v}: drag it, or move it with the arrow keys` });
      node.addEventListener("keydown", (event) => step(event, v));
      return node;
    }));
  }

  function extent() {
    const { points } = view().sheet;
    const low = [0, 1].map((c) => Math.min(...points.map((point) => point[c])));
    return { low, size: Math.max(...[0, 1].map((c) => Math.max(...points.map((point) => point[c])) - low[c])) };
  }

  // The nearest point of the grid of the sheet as it was when the vertex was taken.
  function snapped(point) {
    const { low, size } = dragged.extent ??= extent();
    const unit = size / (grid || FREE);
    return point.map((x, c) => low[c] + unit * Math.round((x - low[c]) / unit));
  }

  function moveTo(point) {
    const { sheet, pattern } = view();
    const here = sheet.points[dragged.vertex];
    if (Math.hypot(here[0] - point[0], here[1] - point[1]) < 1e-12) return;
    dragged.moved = true;
    sheet.points[dragged.vertex] = point;
    pattern.redraw();
    ask({ name: view().page.name, fold: dragged.before, live: true, move: { vertex: dragged.vertex, x: point[0], y: point[1], grid: grid || FREE } });
  }

  // One question at a time; of those that wait, only the last is asked.
  async function ask(request) {
    next = request;
    if (busy) return;
    busy = true;
    while (next) {
      const now = next;
      next = null;
      const began = performance.now();
      try {
        await server.lines("open?live", now, (line) => {
          if (line.kind === "error") throw new Error(line.error);
          if (line.kind !== "listed") return;
          byId("live").textContent = `${line.document.freedom}${line.document.freedom ? " · " : ""}answered in ${Math.round(performance.now() - began)} ms`;
          byId("live").dataset.milliseconds = Math.round(performance.now() - began);
          showAnswer(now.name, line.document.answer);
          view().pattern.mark(line.document.sheet.marks);
        });
      } catch (error) {
        if (error.name === "AbortError") continue;
        byId("live").textContent = error.message;
      }
    }
    busy = false;
  }

  // The vertex is let go: the sheet is opened where it lies, and the one before can be had back.
  async function settle() {
    const { vertex, before, moved, from } = dragged;
    const point = view().sheet.points[vertex];
    const last = { vertex, x: point[0], y: point[1], grid: grid || FREE };
    dragged = null;
    view().pattern.hold(false);
    if (!moved) return;
    next = null;
    while (busy) await new Promise((done) => setTimeout(done, 10));
    const name = view().page.name;
    let found = null;
    try {
      await server.lines("open?live", { name, fold: before, live: true, move: last }, (line) => {
        if (line.kind === "error") throw new Error(line.error);
        if (line.kind === "read") found = line.sheet;
      });
    } catch (error) {
      if (error.name === "AbortError") return;
      say(error.message, true);
      view().sheet.points[vertex] = from;
      view().pattern.redraw();
      showAnswer(name, view().page.answer);
      return;
    }
    const { asks } = view().store.get();
    undone = [...undone.slice(1 - MOST_UNDONE), { fold: before, name, asks }];
    await open({ name, fold: lettered(found) }, { asks });
  }

  function lettered(sheet) {
    const letters = new Map(sheet.folds.map(([i, j], k) => [`${i}-${j}`, sheet.letters[k]]));
    return { ...sheet.fold, edges_assignment: sheet.fold.edges_vertices.map(([i, j]) => letters.get(`${Math.min(i, j)}-${Math.max(i, j)}`) ?? "B") };
  }

  function step(event, vertex) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation();
    const { sheet } = view();
    dragged = { vertex, before: fold(), from: [...sheet.points[vertex]], moved: false };
    const unit = extent().size / (grid || 64);
    moveTo(snapped(sheet.points[vertex].map((x, c) => x + unit * way[c])));
    settle();
  }

  function undo() {
    const last = undone.pop();
    if (last) open({ name: last.name, fold: last.fold }, { asks: last.asks });
  }

  return { attach, fold, undo, undoable: () => undone.length > 0, changed: () => view() !== null, forget: () => (undone = []) };
}
