// Which branches agree with the letters and signs asked for, and which branch is next to another.

const TURNED = { M: "V", V: "M", "+": "-", "-": "+" };

export const NAMES = { M: "mountain", V: "valley", F: "flat", U: "undecided" };

// Signs or letters of the mirror image.
export function turned(text) {
  return [...text].map((letter) => TURNED[letter] ?? letter).join("");
}

// A way as it is seen from one side of the sheet.
export function seen(way, mirrored) {
  if (!mirrored) return { signs: way.signs, letters: way.letters, saddle: way.saddle };
  return { signs: turned(way.signs), letters: turned(way.letters), saddle: -way.saddle };
}

// The ways that agree with the letters asked of folds (a Map) and with a text, each with the side
// on which it agrees; if both sides agree, the side that is listed.
export function agreeing(ways, asks, text) {
  const found = [];
  ways.forEach((way, k) => {
    for (const mirrored of [false, true]) {
      const side = seen(way, mirrored);
      if (keepsTo(side.letters, asks) && reads(way, side, text, k)) {
        found.push({ way: k, mirrored });
        return;
      }
    }
  });
  return found;
}

function keepsTo(letters, asks) {
  for (const [fold, letter] of asks) if (letters[fold] !== letter) return false;
  return true;
}

// Signs are compared from the first vertex on, letters at any place; `?` stands for any of them.
function reads(way, side, text, k) {
  const wanted = text.trim().toUpperCase().replaceAll("−", "-").replaceAll(/[\s,]/g, "");
  if (!wanted) return true;
  if (/^#?\d+$/.test(wanted) && Number(wanted.replace("#", "")) === (way.number ?? k + 1)) return true;
  if (/^[+\-0?]+$/.test(wanted) && side.signs) return fits(side.signs.slice(0, wanted.length), wanted);
  if (/^[MVFU?]+$/.test(wanted)) {
    for (let at = 0; at + wanted.length <= side.letters.length; at++) {
      if (fits(side.letters.slice(at, at + wanted.length), wanted)) return true;
    }
    return false;
  }
  return way.name.toUpperCase().includes(text.trim().toUpperCase());
}

function fits(text, wanted) {
  return text.length === wanted.length && [...wanted].every((c, k) => c === "?" || c === text[k]);
}

// The way that differs from the shown way at one vertex. Of several, the one on the same side of the
// boundary saddle is preferred, then the one whose letters differ least. Null if none is listed.
export function popped(ways, shown, mirrored, at) {
  const here = seen(ways[shown], mirrored);
  if (!here.signs) return null;
  const same = (signs) => signs.length === here.signs.length
    && [...signs].every((sign, k) => (k === at ? sign !== here.signs[k] : sign === here.signs[k]));
  let best = null;
  ways.forEach((way, k) => {
    for (const turn of [mirrored, !mirrored]) {
      const side = seen(way, turn);
      if (!same(side.signs)) continue;
      const opposite = side.signs[at] === turned(here.signs[at]) ? 0 : 1;
      const cost = [opposite, side.saddle === here.saddle ? 0 : 1, difference(side.letters, here.letters)];
      if (!best || less(cost, best.cost)) best = { way: k, mirrored: turn, cost };
    }
  });
  return best;
}

// The signs with the one at a given place reversed; a flat vertex pops up.
export function poppedSigns(signs, at) {
  return signs.slice(0, at) + (signs[at] === "+" ? "-" : "+") + signs.slice(at + 1);
}

export function difference(one, other) {
  let count = 0;
  for (let k = 0; k < one.length; k++) if (one[k] !== other[k]) count++;
  return count;
}

function less(a, b) {
  for (let k = 0; k < a.length; k++) if (a[k] !== b[k]) return a[k] < b[k];
  return false;
}
