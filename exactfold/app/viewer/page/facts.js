// The facts beside the picture: what is proved, and what is only drawn.

import { svg } from "./pattern.js";

const ICONS = {
  good: "M3.5 9.5l3.6 3.6 7.4-8",
  open: "M9 4v6.2M9 13.4v.2",
  note: "M9 8.2V14M9 4.4v.2",
};

export function showFacts(page, way, end) {
  const facts = [countFact(page), ...(page.freedom ? [["note", sentence(page.freedom), ""]] : []), ...(way ? wayFacts(page, way, end) : []), ...flatFacts(page), ...page.notes.map((text) => ["open", "To know", text])];
  const items = facts.map(item);
  if (page.read.length) items.push(reading(page.read, page.served));
  document.getElementById("facts").replaceChildren(...items);
}

function countFact(page) {
  if (page.busy && !page.ways.length) return ["note", "Looking for ways", ""];
  if (!page.ways.length) {
    const known = page.status === "proved";
    return [known ? "good" : "open", known ? "The answer: proved" : "The answer: undecided", own(page)];
  }
  if (page.complete) return ["good", "All are listed: proved", own(page)];
  if (page.status !== "proved") return ["open", "The count is undecided", own(page)];
  if (page.kind === "branches") return ["note", "Not all are listed", own(page)];
  return ["note", "All known ways are listed", own(page)];
}

// The reason, unless the heading of the page says it.
export function own(page) {
  return page.answer.includes(page.reason) ? "" : page.reason;
}

function wayFacts(page, way, end) {
  const noun = page.kind === "branches" ? "branch" : "way to fold";
  const facts = [];
  if (way.status === "proved") facts.push(["good", `This ${noun}: proved`, way.reason]);
  else if (way.status === "refuted") facts.push(["good", "Proved: it starts to fold but does not truly fold", way.reason]);
  else facts.push(["open", `This ${noun}: ${way.status}`, way.reason]);
  if (way.family) facts.push(["note", "One of infinitely many", `a family of dimension ${way.family.dimension}; the sliders choose others in floats, without contacts`]);
  if (way.multiplicity > 1) facts.push(["note", `Counted ${way.multiplicity} times`, "because flat vertices count double"]);
  if (way.motion) {
    const closed = end?.status === "proved";  // then contacts are proved, too
    const drawn = closed ? way.motion.said.replace("; contacts were found in floats", "") : way.motion.said;
    if (way.motion.proved) facts.push(["good", "The motion: proved", drawn]);
    else if (way.motion.exists) facts.push(["good", "The motion exists: proved", drawn]);
    else facts.push(["open", "The motion: not proved", drawn]);
    if (!closed) facts.push(["note", "It ends", way.motion.ending]);
    if (end) facts.push(endFact(end));
  } else if (way.why && way.status === "proved") {
    facts.push(["open", "No motion is drawn", way.why]);
  }
  return facts;
}

// Where the way ends of which all folds close together.
function endFact({ status, said }) {
  if (status === "proved") return ["good", "It folds flat: proved", said];
  if (status === "refuted") return ["good", "Proved: it does not get to a flat-folded state", said];
  return ["open", "Whether it folds flat is undecided", said];
}

// The flat-folded states of the sheet, with the letters of the file and with any.
function flatFacts(page) {
  const sheets = page.folded?.sheets ?? [];
  if (!sheets.length) return page.folded?.left ? [["open", "Folded flat: not looked for", page.folded.left]] : [];
  const words = sheets.map(({ answer }) => answer.split(/ is UNDECIDED| - /)[0]);
  const all = sheets.every(({ status }) => status !== "undecided");
  return [[all ? "good" : "open", all ? "Folded flat: proved" : "Folded flat", words.join("; ")]];
}

// How the drawing was read; it is the same for every way, and the user opens it.
function reading(lines, open) {
  const node = item(["note", "", ""]);
  node.className = "wide";
  const details = Object.assign(document.createElement("details"), { open });
  details.append(Object.assign(document.createElement("summary"), { textContent: "How the drawing was read" }));
  for (const line of lines) details.append(Object.assign(document.createElement("small"), { textContent: line }));
  node.lastChild.replaceChildren(details);
  return node;
}

function item([kind, title, text]) {
  const node = document.createElement("li");
  const icon = svg("svg", { viewBox: "0 0 18 18", class: kind, "aria-hidden": "true", fill: "none", stroke: "currentColor", "stroke-width": 2, "stroke-linecap": "round", "stroke-linejoin": "round" });
  if (kind !== "good") icon.append(svg("circle", { cx: 9, cy: 9, r: 8, "stroke-width": 1.4 }));
  icon.append(svg("path", { d: ICONS[kind] }));
  const words = document.createElement("div");
  words.append(Object.assign(document.createElement("strong"), { textContent: title }));
  if (text) words.append(Object.assign(document.createElement("small"), { textContent: sentence(text) }));
  node.append(icon, words);
  return node;
}

export function sentence(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
