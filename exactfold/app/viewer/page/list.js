// The list of the ways that agree with what is asked for; one of them is shown.

import { agreeing, difference, seen } from "./choose.js";

const NOUNS = { branches: ["branch", "branches"], panels: ["way", "ways"] };

export function createList(page, store, { onAsk }) {
  const box = document.getElementById("ways");
  const search = document.getElementById("search");
  const count = document.getElementById("count");
  const clear = document.getElementById("clear");
  const [one, many] = NOUNS[page.kind];
  let found = [];

  document.getElementById("list-title").textContent = page.kind === "branches" ? "Branches" : "Ways to fold";
  search.placeholder = page.kind === "branches" ? "Search: + − +, or MVV" : "Search: way 2, or MVV";
  search.setAttribute("aria-label", `Search the ${many}`);

  function refresh() {
    const { ways, asks, search: text } = store.get();
    found = agreeing(ways, asks, text);
    const narrowed = asks.size > 0 || text.trim() !== "";
    const total = `${ways.length} ${ways.length === 1 ? one : many}`;
    const numbered = ways.filter((way) => way.number).length;  // as `count` lists them
    const drawn = numbered && numbered < ways.length ? `${numbered} ${numbered === 1 ? one : many}, 1 as drawn` : total;
    count.textContent = narrowed ? `${found.length} of ${total} ${found.length === 1 ? "agrees" : "agree"}` : ways.length ? drawn : "";
    clear.hidden = !narrowed;
    box.replaceChildren(...found.map(({ way, mirrored }) => row(ways[way], way, mirrored, page.drawn)));
    box.setAttribute("role", found.length ? "listbox" : "group");  // a listbox has options
    search.hidden = !ways.length;
    if (!found.length) box.append(paragraph(page.busy && !ways.length ? "Looking for ways to fold …" : ways.length ? nothing() : page.status === "proved" ? `No way to list: ${page.answer.split(" - ")[0]}.` : "No way to list: none is known."));
    settle();
    mark();
  }

  function nothing() {
    const { asks } = store.get();
    const of = page.complete ? `No ${one} of this sheet agrees` : `No ${one} that is listed agrees`;
    const wish = asks.size ? `with the letters asked of ${asks.size} ${asks.size === 1 ? "fold" : "folds"}` : "with the search";
    return `${of} ${wish}. "Clear" shows all again.`;
  }

  // If the shown way is no longer in the list, show the most similar way that is.
  function settle() {
    const { ways, way, mirrored, asks, search: text } = store.get();
    if (!found.length || (!asks.size && !text.trim())) return;
    if (found.some((item) => item.way === way && item.mirrored === mirrored)) return;
    const here = seen(ways[way], mirrored).letters;
    const cost = (item) => difference(seen(ways[item.way], item.mirrored).letters, here);
    const best = found.reduce((a, b) => (cost(b) < cost(a) ? b : a));
    store.set({ way: best.way, mirrored: best.mirrored });
  }

  function mark() {
    const { way } = store.get();
    for (const node of box.querySelectorAll('[aria-selected="true"]')) node.setAttribute("aria-selected", "false");
    const node = document.getElementById(`way-${way}`);
    if (!node) {
      box.removeAttribute("aria-activedescendant");
      return;
    }
    node.setAttribute("aria-selected", "true");
    box.setAttribute("aria-activedescendant", node.id);
    const top = node.offsetTop - box.offsetTop, bottom = top + node.offsetHeight;
    if (top < box.scrollTop) box.scrollTop = top - 4;
    else if (bottom > box.scrollTop + box.clientHeight) box.scrollTop = bottom - box.clientHeight + 4;
  }

  function step(by) {
    if (!found.length) return;
    const at = found.findIndex((item) => item.way === store.get().way);
    const next = found[Math.min(Math.max(at < 0 ? 0 : at + by, 0), found.length - 1)];
    store.set({ way: next.way, mirrored: next.mirrored });
  }

  box.addEventListener("click", (event) => {
    const node = event.target.closest(".way");
    if (!node) return;
    const item = found[Array.from(box.children).indexOf(node)];
    store.set({ way: item.way, mirrored: item.mirrored });
  });
  box.addEventListener("keydown", (event) => {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8, Home: -Infinity, End: Infinity }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    step(by);
  });
  search.addEventListener("input", () => store.set({ search: search.value }));
  clear.addEventListener("click", () => {
    search.value = "";
    onAsk({ search: "", asks: new Map() });
    search.focus();
  });
  store.on(["ways", "asks", "search"], refresh);
  store.on(["way"], mark);
  refresh();
  return { step };
}

function row(way, k, mirrored, drawn) {
  const side = seen(way, mirrored);
  const node = document.createElement("div");
  node.className = "way";
  node.id = `way-${k}`;
  node.setAttribute("role", "option");
  node.setAttribute("aria-selected", "false");
  const number = span("number", way.number ? String(way.number) : "–");
  const title = way.number ? `way ${way.number}` : way.name;
  const signs = span(side.signs ? "signs" : "signs plain", side.signs ? side.signs.replaceAll("-", "−") : title);
  const notes = [];
  if (mirrored) notes.push("mirror image");
  if (drawn?.way === k && way.name !== "letters of the file") notes.push("letters of the file");
  if (way.family && !title.includes("family")) notes.push(`family of dimension ${way.family.dimension}`);
  if (way.status === "refuted") notes.push("does not fold on");
  else if (way.status !== "proved") notes.push(way.status);
  else if (way.why) notes.push("no motion drawn");
  if (notes.length) signs.append(Object.assign(document.createElement("small"), { textContent: notes.join(", ") }));
  node.append(number, signs, lettersNode(side.letters));
  return node;
}

export function lettersNode(letters) {
  const node = span("letters", "");
  for (const run of letters.match(/M+|V+|[^MV]+/g) ?? []) {
    node.append(span({ M: "m", V: "v" }[run[0]] ?? "", run));
  }
  return node;
}

function span(name, text) {
  const node = document.createElement("span");
  node.className = name;
  node.textContent = text;
  return node;
}

function paragraph(text) {
  const node = document.createElement("p");
  node.className = "none";
  node.textContent = text;
  return node;
}
