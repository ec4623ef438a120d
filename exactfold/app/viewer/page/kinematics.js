// Rigid panels moved by hand: fold angles with which all vertices stay closed, in floats.

import { cross, dot, minus } from "./sheet.js";

const CLOSE = 1e-9, MOST = 12, STEP = 0.05, CLOSED = Math.PI - 1e-3;

// `angles` are in radians by fold. `drive` moves the angles of some folds towards values, and all
// other folds follow with as little change as possible; it returns the angles reached, and whether
// these are the values asked for.
export function createKinematics(sheet) {
  const stars = sheet.interior.map((v) => starOf(sheet, v));
  const size = sheet.folds.length;

  // The residuals of all vertices, three for each, and their derivatives by the angles.
  function closing(angles) {
    const values = [], rows = [];
    for (const star of stars) {
      const factors = star.map(({ fold, x, y }) => {
        const c = Math.cos(angles[fold] / 2), s = Math.sin(angles[fold] / 2);
        return { q: [c, s * x, s * y, 0], rate: [-s / 2, (c * x) / 2, (c * y) / 2, 0] };
      });
      const before = [[1, 0, 0, 0]];
      for (const { q } of factors) before.push(times(before.at(-1), q));
      const own = [0, 1, 2].map(() => new Float64Array(size));
      let after = [1, 0, 0, 0];
      for (let k = star.length - 1; k >= 0; k--) {
        const part = times(times(before[k], factors[k].rate), after);
        for (let c = 0; c < 3; c++) own[c][star[k].fold] += part[c + 1];
        after = times(factors[k].q, after);
      }
      values.push(...before.at(-1).slice(1));
      rows.push(...own);
    }
    return { values, rows };
  }

  // Angles nearby with which all vertices close and the driven folds have their values, or null.
  function corrected(start, driven) {
    const angles = Float64Array.from(start);
    let before = Infinity;
    for (let round = 0; round < MOST; round++) {
      const { values, rows } = closing(angles);
      for (const [fold, value] of driven) {
        const row = new Float64Array(size);
        row[fold] = 1;
        rows.push(row);
        values.push(angles[fold] - value);
      }
      const error = values.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
      if (error < CLOSE) return angles;
      if (!(error < before)) return null;
      before = error;
      leastChange(rows, values).forEach((x, k) => (angles[k] -= x));
    }
    return null;
  }

  // From here to the values of some folds, step by step, so that nothing jumps.
  function drive(start, goals) {
    let angles = Float64Array.from(start);
    let step = STEP;
    for (let round = 0; round < 400; round++) {
      const left = goals.map(([fold, value]) => value - angles[fold]);
      const far = left.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
      if (far < 1e-9) return { angles, reached: true };
      const share = Math.min(step / far, 1);
      const next = goals.map(([fold], k) => [fold, angles[fold] + share * left[k]]);
      const guess = Float64Array.from(angles);
      next.forEach(([fold, value]) => (guess[fold] = value));
      const there = corrected(guess, next);
      if (there && !jumped(angles, there) && there.every((angle) => Math.abs(angle) <= CLOSED)) {
        angles = there;
        step = Math.min(1.5 * step, STEP);
      } else if ((step /= 2) < 1e-3) break;
    }
    return { angles, reached: false };
  }

  return { drive, corrected, closing };
}

function jumped(before, after) {
  return after.some((angle, k) => Math.abs(angle - before[k]) > 6 * STEP);
}

// The folds at an interior vertex, counter-clockwise, with unit vectors away from it.
function starOf(sheet, v) {
  const [vx, vy] = sheet.points[v];
  return sheet.folds.flatMap((edge, fold) => {
    if (!edge.includes(v)) return [];
    const [ux, uy] = sheet.points[edge[0] === v ? edge[1] : edge[0]];
    const length = Math.hypot(ux - vx, uy - vy);
    return [{ fold, x: (ux - vx) / length, y: (uy - vy) / length }];
  }).sort((a, b) => Math.atan2(a.y, a.x) - Math.atan2(b.y, b.x));
}

function times([s, a, b, c], [t, p, q, r]) {
  return [s * t - a * p - b * q - c * r, s * p + a * t + b * r - c * q, s * q - a * r + b * t + c * p, s * r + a * q - b * p + c * t];
}

// The least x with rows x = values, as far as the rows are independent: x = A^T (A A^T + tiny)^-1 values.
export function leastChange(rows, values) {
  const n = rows.length;
  const square = rows.map((row, i) => rows.map((other, j) => (j < i ? 0 : product(row, other))));
  for (let i = 0; i < n; i++) for (let j = 0; j < i; j++) square[i][j] = square[j][i];
  const largest = square.reduce((most, row, i) => Math.max(most, row[i]), 1e-300);
  square.forEach((row, i) => (row[i] += 1e-13 * largest));
  const weights = cholesky(square, values);
  const x = new Float64Array(rows[0]?.length ?? 0);
  rows.forEach((row, i) => row.forEach((entry, k) => (x[k] += entry * weights[i])));
  return x;
}

function cholesky(square, values) {
  const n = values.length;
  const low = square.map(() => new Float64Array(n));
  for (let i = 0; i < n; i++) {
    for (let j = 0; j <= i; j++) {
      let sum = square[i][j];
      for (let k = 0; k < j; k++) sum -= low[i][k] * low[j][k];
      low[i][j] = i === j ? Math.sqrt(Math.max(sum, 1e-300)) : sum / low[j][j];
    }
  }
  const y = new Float64Array(n), x = new Float64Array(n);
  for (let i = 0; i < n; i++) {
    let sum = values[i];
    for (let k = 0; k < i; k++) sum -= low[i][k] * y[k];
    y[i] = sum / low[i][i];
  }
  for (let i = n - 1; i >= 0; i--) {
    let sum = y[i];
    for (let k = i + 1; k < n; k++) sum -= low[k][i] * x[k];
    x[i] = sum / low[i][i];
  }
  return x;
}

function product(a, b) {
  let sum = 0;
  for (let k = 0; k < a.length; k++) sum += a[k] * b[k];
  return sum;
}

// The places of all vertices for fold angles: the first triangle stays where it is in `positions`,
// and each other one is turned about the edge over which it is reached.
export function placed(sheet, angles, positions) {
  const out = Float64Array.from(positions);
  const turn = new Map(sheet.folds.map(([i, j], k) => [`${i}-${j}`, angles[k]]));
  const across = new Map();
  sheet.triangles.forEach(([a, b, c], t) => across.set(`${a}-${b}`, [t, c]).set(`${b}-${c}`, [t, a]).set(`${c}-${a}`, [t, b]));
  const seen = new Set([0]), known = new Set(sheet.triangles[0]);
  const waiting = [0];
  for (const t of waiting) {
    const corners = sheet.triangles[t];
    corners.forEach((i, k) => {
      const j = corners[(k + 1) % 3], third = corners[(k + 2) % 3];
      const other = across.get(`${j}-${i}`);
      if (!other || seen.has(other[0])) return;
      seen.add(other[0]);
      waiting.push(other[0]);
      if (known.has(other[1])) return;
      known.add(other[1]);
      const angle = turn.get(`${Math.min(i, j)}-${Math.max(i, j)}`) ?? 0;
      out.set(beyond(sheet, out, [i, j, third, other[1]], angle), 3 * other[1]);
    });
  }
  return out;
}

// The place of the corner `next` beyond the edge i-j of a triangle with third corner `third`.
function beyond(sheet, out, [i, j, third, next], angle) {
  const at = (v) => [out[3 * v], out[3 * v + 1], out[3 * v + 2]];
  const a = at(i), along = unit(minus(at(j), a));
  const inward = minus(at(third), a);
  const left = unit(minus(inward, scaled(along, dot(inward, along))));  // in the triangle
  const normal = cross(along, left);
  const [ax, ay] = sheet.points[i], [bx, by] = sheet.points[j], [px, py] = sheet.points[next];
  const length = Math.hypot(bx - ax, by - ay);
  const u = ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / length;
  const w = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / length;  // negative: beyond the edge
  const c = Math.cos(angle), s = Math.sin(angle);
  return a.map((x, k) => x + u * along[k] + w * (c * left[k]) - w * s * normal[k]);
}

function scaled(a, by) {
  return a.map((x) => x * by);
}

function unit(a) {
  return scaled(a, 1 / (Math.hypot(...a) || 1));
}
