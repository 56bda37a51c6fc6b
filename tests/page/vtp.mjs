// A result as `clerestory solve` writes it, read without VTK: XML in base 64, of zlib streams where it has no layers.

import fs from 'node:fs';
import zlib from 'node:zlib';

const kTypes = { Float32: Float32Array, Float64: Float64Array, Int32: Int32Array, Int64: BigInt64Array, UInt32: Uint32Array, UInt8: Uint8Array, Int8: Int8Array };

function decode(text, isPacked) {
  if (!isPacked) return Buffer.from(text, 'base64').subarray(4);  // a count of bytes, then these
  // Head: count of blocks, their size, size of the last, then how long each is as it is stored.
  const words = (base64) => new Uint32Array(new Uint8Array(Buffer.from(base64, 'base64')).buffer);
  const blocks = words(text.slice(0, 16))[0];
  const headLength = Math.ceil(((3 + blocks) * 4) / 3) * 4;
  const sizes = words(text.slice(0, headLength)).slice(3, 3 + blocks);
  const stored = Buffer.from(text.slice(headLength), 'base64');
  const parts = [];
  let at = 0;
  for (const size of sizes) {
    parts.push(zlib.inflateSync(stored.subarray(at, at + size)));
    at += size;
  }
  return Buffer.concat(parts);
}

export class Vtp {
  constructor(file) {
    this.xml = fs.readFileSync(file, 'latin1');
  }

  /** An array within a section of the file: ('PointData', 'illuminance'). */
  bytes(section, name) {
    const begin = section === 'FieldData' ? this.xml.indexOf('<FieldData') : this.xml.indexOf(`<${section}`);
    const part = this.xml.slice(begin, this.xml.indexOf(`</${section}>`, begin));
    const found = [...part.matchAll(/<(?:Data)?Array ([^>]*)>\s*([A-Za-z0-9+/=]*)/g)].find((m) => m[1].includes(`Name="${name}"`));
    if (!found) throw new Error(`the result has no ${name} in ${section}`);
    return { type: /type="(\w+)"/.exec(found[1])[1], bytes: decode(found[2], this.xml.includes('compressor=')) };
  }

  numbers(section, name) {
    const { type, bytes } = this.bytes(section, name);
    return Array.from(new kTypes[type](new Uint8Array(bytes).buffer), Number);
  }

  /** Strings follow one another, each ended by a 0. */
  strings(name) {
    return this.bytes('FieldData', name).bytes.toString('utf8').split('\0').slice(0, -1);
  }
}

/** Its triangles, and what they show where. */
export class LitSurfaces {
  constructor(file) {
    const vtp = new Vtp(file);
    const points = vtp.numbers('Points', 'Points'), corners = vtp.numbers('Polys', 'connectivity');
    const lux = vtp.numbers('PointData', 'illuminance');
    const names = (array, table) => {
      const of = vtp.numbers('CellData', array), strings = vtp.strings(table);
      return (t) => strings[of[t]];
    };
    const [surface, room, material] = [['surface', 'surface_names'], ['room', 'room_names'], ['material', 'material_names']].map((n) => names(...n));
    this.vtp = vtp;
    this.size = points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    this.triangles = Array.from({ length: corners.length / 3 }, (_, t) => {
      const of = corners.slice(3 * t, 3 * t + 3);
      const p = of.map((c) => points.slice(3 * c, 3 * c + 3));
      const [low, high] = [Math.min, Math.max].map((end) => [0, 1, 2].map((k) => end(...p.map((x) => x[k]))));
      return { p, low, high, lux: of.map((c) => lux[c]), surface: surface(t), room: room(t), material: material(t) };
    });
    this.groups = new Map();
    for (const t of this.triangles) {
      const key = LitSurfaces.key(t);
      if (!this.groups.has(key)) this.groups.set(key, []);
      this.groups.get(key).push(t);
    }
  }

  static key({ surface, room }) { return `${surface}\n${room}`; }

  /** Each triangle of the surface in the room that has this place in it, with its illuminance there. */
  at({ place, ...names }) {
    const minus = (a, b) => a.map((x, k) => x - b[k]);
    const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
    const near = 1e-5 * this.size;
    const found = [];
    for (const triangle of this.groups.get(LitSurfaces.key(names)) ?? []) {
      if (place.some((x, k) => x < triangle.low[k] - near || x > triangle.high[k] + near)) continue;
      const { p, lux: [a, b, c] } = triangle;
      const [u, v, w] = [minus(p[1], p[0]), minus(p[2], p[0]), minus(place, p[0])];
      const [uu, uv, vv, wu, wv] = [dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)];
      const area = uu * vv - uv * uv, s = (vv * wu - uv * wv) / area, q = (uu * wv - uv * wu) / area;
      const off = minus(w, u.map((x, k) => s * x + q * v[k]));
      if (Math.min(s, q, 1 - s - q) < -1e-4 || Math.sqrt(dot(off, off)) > near) continue;
      found.push({ ...triangle, lux: (1 - s - q) * a + s * b + q * c });
    }
    return found;
  }
}
