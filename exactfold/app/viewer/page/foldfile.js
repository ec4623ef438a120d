// A way as a FOLD file (version 1.2): the exact flat sheet, followed by the frames in space.

import { decodeFrames } from "./frames.js";
import { foldAngles } from "./sheet.js";
import { seen } from "./choose.js";

const NOISE = 1e-4;  // degrees; coordinates are rounded to about 1e-7 of the sheet

export function foldFile(page, sheet, way, mirrored) {
  const { letters } = seen(way, mirrored);
  const name = mirrored ? `${way.name}, mirror image` : way.name;
  const folds = new Map(sheet.folds.map(([i, j], k) => [`${i}-${j}`, k]));
  const order = sheet.fold.edges_vertices.map(([i, j]) => folds.get(`${Math.min(i, j)}-${Math.max(i, j)}`));
  const byEdge = (values, other) => order.map((k) => (k === undefined ? other : values[k]));
  const leading = way.angles.length ? way.angles : Array.from(letters, () => 0);
  const flat = {
    ...sheet.fold,
    file_title: `${page.name}, ${name}`,
    frame_title: `flat sheet of ${name}`,
    edges_assignment: byEdge(letters, "B"),
    edges_foldAngle: byEdge(leading.map((angle, k) => ("MV".includes(letters[k]) ? (mirrored ? -angle : angle) : 0)), 0),
    "frame_exactfold:motion": {
      vertex_signs: way.signs || null,
      vertices: sheet.interior,
      side: mirrored ? -1 : 1,
      status: way.motion ? (way.motion.proved ? "proved" : "undecided") : null,
      end: way.motion ? way.motion.end : null,
      coordinates: "rounded to 24 bits; every edge keeps its length to that",
    },
  };
  return { ...flat, file_frames: way.motion ? spaceFrames(sheet, way, mirrored, flat.edges_assignment, byEdge, name) : [] };
}

function spaceFrames(sheet, way, mirrored, letters, byEdge, name) {
  const frames = decodeFrames(way.motion);
  let before = Array.from(sheet.folds, () => 0);
  return Array.from({ length: frames.count }, (_, k) => {
    const time = (way.motion.duration * k) / (frames.count - 1);
    const positions = frames.values.slice(k * frames.size, (k + 1) * frames.size);
    if (mirrored) for (let i = 2; i < positions.length; i += 3) positions[i] = 0 - positions[i];
    before = foldAngles(sheet, positions).map((a, f) => a + 360 * Math.round((before[f] - a) / 360));
    const angles = byEdge(before.map(principal), 0);
    const own = letters.map((letter, e) => (letter === "B" ? "B" : angles[e] > 0 ? "V" : angles[e] < 0 ? "M" : "F"));
    return {
      frame_title: `${name}, frame ${k + 1} of ${frames.count}, time ${time.toPrecision(6)}`,
      "frame_exactfold:time": time,
      frame_classes: ["foldedForm"],
      frame_attributes: ["3D"],
      frame_parent: 0,
      frame_inherit: true,
      vertices_coords: sheet.points.map((_, v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]]),
      ...(own.every((letter, e) => letter === letters[e]) ? {} : { edges_assignment: own }),
      edges_foldAngle: angles,
    };
  });
}

// The angle between -180 and 180; a closed fold keeps the side from which it came.
function principal(angle) {
  if (Math.abs(angle) < NOISE) return 0;
  const turns = Math.abs(angle) > 180 + NOISE ? 360 * Math.round(angle / 360) : 0;
  return Math.max(-180, Math.min(180, angle - turns));
}

export function fileName(page, way, mirrored) {
  const plain = (text) => text.replaceAll(/[^\w.+-]+/g, "-").replaceAll(/^-+(?=\w)|(?<=\w)-+$/g, "");
  const base = plain(page.name.replace(/^.*[\\/]/, "").replace(/\.\w+$/, "")) || "sheet";
  const which = way.signs ? `branch_${seen(way, mirrored).signs}` : plain(way.name) + (mirrored ? "_mirror" : "");
  return `${base}_${which.slice(0, 80)}.fold`;
}

export function download(data, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
