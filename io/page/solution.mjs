// The solution that a page carries (io/page/solution_data.h tells what is in it), unpacked.

import { mixed } from './mixing.mjs';

/** Base 64 of a zlib stream -> numbers, whose bytes of equal weight lie together. */
export async function unpack(text, Numbers) {
  if (!text) return new Numbers(0);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = Numbers.BYTES_PER_ELEMENT;
  const n = planes.length / size;
  const whole = new Uint8Array(planes.length);
  for (let k = 0; k < size; ++k) for (let i = 0; i < n; ++i) whole[i * size + k] = planes[k * n + i];
  return new Numbers(whole.buffer);
}

/** Corners are told from the points that were named before them: 0 is the next new one. */
export function cornersOf(codes) {
  const corners = new Uint32Array(codes.length);
  let next = 0;
  for (let i = 0; i < codes.length; ++i) {
    corners[i] = next - codes[i];
    if (codes[i] === 0) ++next;
  }
  return corners;
}

/** 0 is no light; 1 to 65535 are even steps of the logarithm from `low` to `high`. */
export function luxOf(steps, [low, high]) {
  const ratio = Math.log(high / low) / 65534;
  const lux = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) lux[i] = steps[i] === 0 ? 0 : low * Math.exp((steps[i] - 1) * ratio);
  return lux;
}

/** Light of all layers, one after the other. */
function layersOf(head, steps) {
  const points = steps.length / head.layers.length;
  const lux = new Float32Array(steps.length);
  head.layers.forEach((range, layer) => lux.set(luxOf(steps.subarray(layer * points, (layer + 1) * points), range), layer * points));
  return lux;
}

/** Linear light of sRGB bytes, and back. */
const kLinear = Float32Array.from({ length: 256 }, (_, byte) => (byte <= 10.31475 ? byte / 3294.6 : ((byte / 255 + 0.055) / 1.055) ** 2.4));
const srgbByte = (x) => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(x, 1) ** (1 / 2.4) - 0.055));

export async function readSolution(page) {
  const text = (name) => page.getElementById(`solution-${name}`).textContent.trim();
  const head = JSON.parse(text('head'));
  const [position, steps, shades, codes, runs, panes] = await Promise.all([
    unpack(text('positions'), Float32Array), unpack(text('light'), Uint16Array), unpack(text('shades'), Uint8Array),
    unpack(text('corners'), Uint32Array), unpack(text('runs'), Uint32Array), unpack(text('panes'), Float32Array),
  ]);
  const corners = cornersOf(codes);
  const solved = luxOf(steps, head.light);
  const lux = Float32Array.from(solved);
  const seen = head.channels === 1 ? new Uint8Array(3 * shades.length) : shades;
  if (head.channels === 1) for (let i = 0; i < seen.length; ++i) seen[i] = shades[Math.floor(i / 3)];
  const seenSolved = Uint8Array.from(seen);
  const layers = head.layers && layersOf(head, await unpack(text('layers'), Uint16Array));
  const shares = await unpack(text('shares'), Uint8Array);
  let isSolved = true;

  /** Writes the light of the layers at these weights over `lux` and `seen`. Colours keep their hue. */
  const relight = (weights, asSolved) => {
    isSolved = asSolved;
    if (asSolved) {
      lux.set(solved);
      seen.set(seenSolved);
      return;
    }
    mixed(layers, weights, lux);
    const left = shares.length > 0 && mixed(shares, weights);
    for (let i = 0; i < lux.length; ++i) {
      const share = left ? left[i] / 255 : lux[i] / Math.max(solved[i], 1e-30);
      for (let k = 3 * i; k < 3 * i + 3; ++k) seen[k] = srgbByte(share * kLinear[seenSolved[k]]);
    }
  };

  /** What is known of a place on a triangle. */
  const at = (triangle, p) => {
    const [a, b, c] = [0, 1, 2].map((k) => corners[3 * triangle + k]);
    const point = (i) => [position[3 * i], position[3 * i + 1], position[3 * i + 2]];
    const minus = (u, v) => u.map((x, k) => x - v[k]);
    const dot = (u, v) => u.reduce((sum, x, k) => sum + x * v[k], 0);
    const [u, v, w] = [minus(point(b), point(a)), minus(point(c), point(a)), minus([p.x, p.y, p.z], point(a))];
    const [uu, uv, vv, wu, wv] = [dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)];
    const area = uu * vv - uv * uv;
    const s = (vv * wu - uv * wv) / area, t = (uu * wv - uv * wu) / area;
    const value = (1 - s - t) * lux[a] + s * lux[b] + t * lux[c];
    let run = 0;
    for (let left = triangle; left >= runs[4 * run]; ++run) left -= runs[4 * run];
    const found = {
      lux: value,
      room: head.rooms[runs[4 * run + 1]],
      surface: head.surfaces[runs[4 * run + 2]],
      material: head.materials[runs[4 * run + 3]],
      place: [p.x, p.y, p.z].map((x, k) => x + head.centre[k]),
    };
    if (head.daylightReference && isSolved) found.daylightFactor = (100 * value) / head.daylightReference;
    return found;
  };
  return { head, position, lux, seen, corners, panes, at, relight };
}
