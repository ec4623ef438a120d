// The flat sheet, and the angles of its folds in space.

export function readSheet(json) {
  const { fold } = json;
  const boundary = [];
  const folded = new Set(json.folds.map(([i, j]) => `${i}-${j}`));
  for (const [i, j] of fold.edges_vertices) {
    if (!folded.has(`${Math.min(i, j)}-${Math.max(i, j)}`)) boundary.push([i, j]);
  }
  return {
    fold,
    points: fold.vertices_coords.map(([x, y]) => [x, y]),
    faces: fold.faces_vertices,
    triangles: json.triangles,
    folds: json.folds,
    letters: json.letters,
    boundary,
    interior: json.interior,
    foldable: new Set(json.foldable),
    marks: new Map(json.marks.map((mark) => [mark.vertex, mark])),
    hinges: hingesOf(json.folds, json.triangles),
  };
}

// For each fold i-j, its ends and the opposite corners of the faces to its left and right.
function hingesOf(folds, triangles) {
  const across = new Map();
  for (const [a, b, c] of triangles) {
    across.set(`${a}-${b}`, c).set(`${b}-${c}`, a).set(`${c}-${a}`, b);
  }
  return folds.map(([i, j]) => [i, j, across.get(`${i}-${j}`), across.get(`${j}-${i}`)]);
}

// The angle of each fold in degrees, positive for a valley, between -180 and 180.
export function foldAngles(sheet, positions) {
  const point = (v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
  return sheet.hinges.map(([i, j, left, right]) => {
    const a = point(i);
    const along = minus(point(j), a), l = minus(point(left), a), r = minus(point(right), a);
    const n = cross(along, l), m = cross(r, along);
    const length = Math.hypot(...along);
    return (Math.atan2(-dot(cross(n, m), along) / length, dot(n, m)) * 180) / Math.PI;
  });
}

export function minus(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
