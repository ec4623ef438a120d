// Sliders for the free fold angles of a family: one of its infinitely many ways is shown at first.

import { createKinematics, placed } from "./kinematics.js";
import { foldAngles } from "./sheet.js";

const DEGREES = 180 / Math.PI;
const FLAT = 1;  // degrees: so close to the flat sheet its fold angles cannot be chosen freely

// `positions` gives what the motion shows; `pose` shows other positions, or the motion again (null).
export function createFamily(box, sheet, store, { positions, pose, say }) {
  const kinematics = createKinematics(sheet);
  let drivers = [], sliders = [], angles = null;

  // The sliders of the way that is shown; none if it is a single way.
  function describe(way, mirrored) {
    const family = way?.motion ? way.family : null;
    box.hidden = !family;
    angles = null;
    if (!family) return;
    drivers = family.drivers;
    const text = document.createElement("p");
    const size = family.dimension, more = size - drivers.length;
    text.textContent = `One of infinitely many ways: turn ${more > 0 ? `${drivers.length} of ${size}` : size} free folds, and the others follow.`;
    sliders = drivers.map((fold, k) => sliderOf(fold, k, mirrored));
    box.replaceChildren(text, ...sliders.map(({ row }) => row));
    follow();
  }

  function sliderOf(fold, k) {
    const [i, j] = sheet.folds[fold];
    const input = Object.assign(document.createElement("input"), { type: "range", min: -179, max: 179, step: 1 });
    input.setAttribute("aria-label", `Angle of fold ${i}–${j}`);
    const value = document.createElement("output");
    const row = document.createElement("label");
    row.append(Object.assign(document.createElement("span"), { textContent: `Fold ${i}–${j}` }), input, value);
    input.addEventListener("input", () => move(k, Number(input.value)));
    return { row, input, value };
  }

  // The sliders show the angles of what is drawn.
  function follow() {
    if (box.hidden || angles) return;
    show(foldAngles(sheet, positions()));
  }

  function show(degrees) {
    const most = degrees.reduce((found, angle) => Math.max(found, Math.abs(angle)), 0);
    sliders.forEach(({ input, value }, k) => {
      const angle = degrees[drivers[k]];
      input.value = Math.round(angle);
      input.disabled = most < FLAT;
      value.textContent = `${Math.round(angle)}°`;
    });
  }

  // Turn one fold, while the other driven folds keep their angles and all other folds follow.
  function move(k, degrees) {
    store.set({ playing: false });
    const here = positions();
    const start = angles ?? Float64Array.from(foldAngles(sheet, here), (angle) => angle / DEGREES);
    const goals = drivers.map((fold, m) => [fold, m === k ? degrees / DEGREES : start[fold]]);
    const { angles: reached, reached: whole } = kinematics.drive(start, goals);
    angles = reached;
    if (!whole) say(`Fold ${sheet.folds[drivers[k]].join("–")} turns no further here while the others keep their angles`);
    pose(placed(sheet, angles, here));
    show(Array.from(angles, (angle) => angle * DEGREES));
  }

  function leave() {
    angles = null;
    follow();
  }

  return { describe, follow, leave, posed: () => angles !== null };
}
