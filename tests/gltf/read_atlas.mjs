// Looks up the light of a .glb of clerestory bake --texels-per-metre as a viewer does: the .exr beside it, read by
// three.js, at TEXCOORD_1, against _ILLUMINANCE that is linear between vertices. gltf-validator finds no error and no
// warning with the picture, which has the size of the .exr.
//   node read_atlas.mjs FILE.glb...
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import validator from 'gltf-validator';

globalThis.self = globalThis;  // three.js asks a browser for it
const three = '../../io/page/node_modules/three';
const { EXRLoader } = await import(`${three}/examples/jsm/loaders/EXRLoader.js`);
const { FloatType } = await import(`${three}/build/three.module.js`);

const kShare = 0.97, kWithin = 0.01;  // of the area; elements finer than texels are the rest
const kLeast = 1e-3;                  // of the largest illuminance: darker than that counts as that
let failed = false;

/// JSON of a .glb, and its accessors as numbers.
function readGlb(bytes) {
  const size = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + size).toString());
  const numbers = (accessor) => {
    const { bufferView, componentType, count, type } = json.accessors[accessor];
    const at = 28 + size + json.bufferViews[bufferView].byteOffset;
    const n = count * { SCALAR: 1, VEC2: 2, VEC3: 3 }[type];
    const read = { 5123: (i) => bytes.readUInt16LE(at + 2 * i), 5125: (i) => bytes.readUInt32LE(at + 4 * i),
      5126: (i) => bytes.readFloatLE(at + 4 * i) }[componentType];
    return Array.from({ length: n }, (_, i) => read(i));
  };
  return { json, numbers };
}

/// Rows from the top.
function readExr(file) {
  const bytes = readFileSync(file);
  const { data, width, height } = new EXRLoader().setDataType(FloatType).parse(
    bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
  const channels = data.length / (width * height);
  return { width, height, at: (x, y) => data[((height - 1 - y) * width + x) * channels] };  // three.js turns it over
}

function lookUp({ width, height, at }, u, v) {
  const clamp = (x, n) => Math.min(Math.max(x, 0), n);
  const x = clamp(u * width - 0.5, width - 1), y = clamp(v * height - 0.5, height - 1);
  const i = Math.min(Math.floor(x), width - 2), j = Math.min(Math.floor(y), height - 2), s = x - i, t = y - j;
  return (1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) + t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
}

for (const file of process.argv.slice(2)) {
  const bytes = readFileSync(file);
  const { json, numbers } = readGlb(bytes);
  const exr = readExr(file.replace(/\.glb$/, '.exr'));
  const { issues, info } = await validator.validateBytes(new Uint8Array(bytes), {
    maxIssues: 0,
    externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
  });
  for (const m of issues.messages.filter((m) => m.severity < 2).slice(0, 5))
    console.error(`${file}: ${m.code}: ${m.message} ${m.pointer ?? ''}`);
  const picture = info.resources.find((r) => r.image).image;

  const primitives = json.meshes.flatMap((m) => m.primitives);
  const all = primitives.map(({ attributes: a, indices }) => ({ position: numbers(a.POSITION), uv: numbers(a.TEXCOORD_1),
    lux: numbers(a._ILLUMINANCE), corners: numbers(indices) }));
  const least = kLeast * Math.max(...all.map((p) => p.lux.reduce((a, b) => Math.max(a, b), 0)));
  let area = 0, good = 0;
  for (const { position, uv, lux, corners } of all)
    for (let c = 0; c < corners.length; c += 3) {
      const [p, q, r] = corners.slice(c, c + 3);
      const side = (a, b) => [0, 1, 2].map((k) => position[3 * b + k] - position[3 * a + k]);
      const [e, f] = [side(p, q), side(p, r)];
      const part = Math.hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]) / 2 / 36;
      for (let i = 0; i < 6; ++i)
        for (let j = 0; j < 6; ++j) {
          let s = (i + 0.5) / 6, t = (j + 0.4) / 6;
          if (s + t > 1) [s, t] = [1 - s, 1 - t];
          const mix = (values, n, k) => (1 - s - t) * values[n * p + k] + s * values[n * q + k] + t * values[n * r + k];
          const value = mix(lux, 1, 0), seen = lookUp(exr, mix(uv, 2, 0), mix(uv, 2, 1));
          area += part;
          if (Math.abs(seen - value) <= kWithin * Math.max(value, least)) good += part;
        }
    }
  const holds = issues.numErrors + issues.numWarnings === 0 && good / area >= kShare && picture.width === exr.width &&
    picture.height === exr.height;
  if (!holds) failed = true;
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings; ${exr.width} x ${exr.height} texels, ` +
    `lookups within 1 % on ${(100 * good / area).toFixed(2)} % of the area${holds ? '' : ': FAILED'}`);
}
process.exit(failed ? 1 : 0);
