// The frames of a motion, decoded from text (exactfold/app/viewer/coding.py), and the sheet between frames.

const STEPS = 1 << 23;
const ORDER = 4;

// All frames in turn, with three numbers for each vertex.
export function decodeFrames(motion) {
  const raw = atob(motion.data);
  const numbers = [];
  let value = 0, weight = 1;
  for (let k = 0; k < raw.length; k++) {
    const byte = raw.charCodeAt(k);
    value += (byte & 127) * weight;
    if (byte & 128) {
      weight *= 128;
    } else {
      numbers.push(value % 2 ? -(value + 1) / 2 : value / 2);
      value = 0;
      weight = 1;
    }
  }
  const size = numbers.length / motion.frames;
  for (let k = 0; k < ORDER; k++) {
    for (let i = size; i < numbers.length; i++) numbers[i] += numbers[i - size];
  }
  const unit = motion.scale / STEPS;
  return { count: motion.frames, size, values: Float64Array.from(numbers, (n) => n * unit) };
}

// Write the sheet at a share of the time, 0 to 1, into `out`, by a cubic through the neighbouring
// frames. The mirror image is the same sheet seen from below.
export function positionsAt(frames, part, mirrored, out) {
  const { count, size, values } = frames;
  const place = Math.min(Math.max(part, 0), 1) * (count - 1);
  const k = Math.min(Math.floor(place), count - 2);
  const t = place - k;
  const before = k > 0 ? k - 1 : -1, after = k + 2 < count ? k + 2 : -1;
  for (let i = 0; i < size; i++) {
    const b = values[k * size + i], c = values[(k + 1) * size + i];
    const a = before < 0 ? edge(values, k, 1, size, i) : values[before * size + i];
    const d = after < 0 ? edge(values, k + 1, -1, size, i, count) : values[after * size + i];
    const slope = (c - a) / 2, next = (d - b) / 2;
    const x = b + t * (slope + t * (3 * (c - b) - 2 * slope - next + t * (2 * (b - c) + slope + next)));
    out[i] = mirrored && i % 3 === 2 ? -x : x;
  }
  return out;
}

// A frame before the first or after the last one, by the parabola through three frames.
function edge(values, k, step, size, i, count = Infinity) {
  const at = (n) => values[n * size + i];
  const third = k + 2 * step;
  if (third < 0 || third >= Math.min(count, values.length / size)) return 2 * at(k) - at(k + step);
  return 3 * at(k) - 3 * at(k + step) + at(third);
}
