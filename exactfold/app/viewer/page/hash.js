// The state of the page in its address, so that it can be kept, sent, and opened again.

const LONGEST = 60000;
let timer = 0;

function base64url(bytes) {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function piped(bytes, stream) {
  const out = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(out).arrayBuffer());
}

export async function packed(value) {
  return base64url(await piped(new TextEncoder().encode(JSON.stringify(value)), new CompressionStream("deflate-raw")));
}

export async function unpacked(text) {
  const raw = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(raw, (c) => c.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(await piped(bytes, new DecompressionStream("deflate-raw"))));
}

// Write the state into the address, soon after the last change.
export function saveState(view, editing) {
  clearTimeout(timer);
  timer = setTimeout(async () => {
    const { way, mirrored, folded, time, asks, search, playing } = view.store.get();
    if (playing || view.page.busy) return;
    const state = new URLSearchParams({ way: way + 1, t: time.toFixed(3) });
    if (mirrored) state.set("side", "-");
    if (folded) state.set("flat", `${folded.sheet}.${folded.state}`);
    if (asks.size) state.set("asks", [...asks].map(([fold, letter]) => `${fold}${letter}`).join("."));
    if (search) state.set("find", search);
    if (editing?.changed()) {
      const sheet = await packed(editing.fold());
      if (sheet.length < LONGEST) state.set("sheet", sheet);
      state.set("name", view.page.name);
    }
    history.replaceState(null, "", `#${state}`);
  }, 250);
}

// The state in the address, as far as it can be read.
export async function loadState() {
  const state = new URLSearchParams(location.hash.slice(1));
  const begin = {};
  const way = Number(state.get("way")), time = Number(state.get("t"));
  if (Number.isInteger(way) && way > 0) begin.way = way - 1;
  if (state.has("t") && time >= 0 && time <= 1) begin.time = time;
  if (state.has("way")) begin.mirrored = state.get("side") === "-";
  const flat = /^(\d+)\.(\d+)$/.exec(state.get("flat") ?? "");
  if (flat) begin.folded = { sheet: Number(flat[1]), state: Number(flat[2]) };
  const asks = [...(state.get("asks") ?? "").matchAll(/(\d+)([MV])/g)];
  if (asks.length) begin.asks = new Map(asks.map(([, fold, letter]) => [Number(fold), letter]));
  if (state.has("find")) begin.search = state.get("find");
  let fold = null;
  try {
    if (state.has("sheet")) fold = await unpacked(state.get("sheet"));
  } catch {
    fold = null;  // a damaged address opens the page without its sheet
  }
  return { fold, name: state.get("name") ?? "sheet", begin };
}
