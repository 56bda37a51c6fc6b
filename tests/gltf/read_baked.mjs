// Reads .glb files of clerestory bake as others do: gltf-validator finds no error and no warning, and three.js the same
// numbers as the .ply of the same name beside it, which has one vertex for each here (but for those that surfaces share).
//   node read_baked.mjs FILE.glb...
import { readFileSync } from 'node:fs';
import validator from 'gltf-validator';

globalThis.self = globalThis;  // three.js asks a browser for it
const three = '../../io/page/node_modules/three';
const { GLTFLoader } = await import(`${three}/examples/jsm/loaders/GLTFLoader.js`);
const { Vector3 } = await import(`${three}/build/three.module.js`);

const kAsGood = 1e-4;
let failed = 0;
const expect = (holds, words) => {
  if (holds) return;
  console.error(words);
  ++failed;
};

/// Rows of numbers by the name of the property.
function readPly(file) {
  const bytes = readFileSync(file);
  const end = bytes.indexOf('end_header\n') + 11;
  const lines = bytes.subarray(0, end).toString().split('\n');
  const origin = lines.find((l) => l.startsWith('comment origin '))?.split(' ').slice(2).map(Number) ?? [0, 0, 0];
  const exposure = Number(lines.find((l) => l.startsWith('comment exposure ')).split(' ')[2]);
  const count = Number(lines.find((l) => l.startsWith('element vertex ')).split(' ')[2]);
  const properties = lines.filter((l) => /^property (float|uchar) /.test(l)).map((l) => l.split(' ').slice(1));
  const rows = [];
  let at = end;
  for (let i = 0; i < count; ++i) {
    const row = {};
    for (const [type, name] of properties) {
      row[name] = type === 'float' ? bytes.readFloatLE(at) : bytes[at];
      at += type === 'float' ? 4 : 1;
    }
    rows.push(row);
  }
  return { origin, exposure, rows };
}

/// Vertices by where they are, to a tenth of a millimetre; those near a border are there twice.
class Places {
  constructor() { this.cells = new Map(); }
  static keys(p) {
    let keys = [''];
    for (const x of p) {
      const cell = Math.floor(x * 1e4), rest = x * 1e4 - cell;
      const near = rest < 0.2 ? [cell, cell - 1] : rest > 0.8 ? [cell, cell + 1] : [cell];
      keys = keys.flatMap((k) => near.map((n) => k + ',' + n));
    }
    return keys;
  }
  add(p, value) {
    for (const key of Places.keys(p)) {
      if (!this.cells.has(key)) this.cells.set(key, []);
      this.cells.get(key).push(value);
    }
  }
  at(p) { return this.cells.get(Places.keys(p)[0]) ?? []; }
}

async function compare(name, glb, ply) {
  const { origin, exposure, rows } = readPly(ply);
  const places = new Places();
  for (const row of rows) places.add([row.x, row.y, row.z], row);
  const gltf = await new GLTFLoader().parseAsync(glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.byteLength), '');
  gltf.scene.updateMatrixWorld(true);
  let vertices = 0, worst = 0;
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const { position, color, _illuminance: lux, _irradiance: E } = mesh.geometry.attributes;
    expect(mesh.material.type === 'MeshBasicMaterial', `${name}: ${mesh.name} is not unlit`);
    expect(mesh.userData.exposure === exposure || mesh.parent.userData.exposure === exposure,
      `${name}: ${mesh.name} has no exposure`);
    for (let i = 0; i < position.count; ++i, ++vertices) {
      const p = new Vector3().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld);
      const found = places.at([p.x - origin[0], -p.z - origin[1], p.y - origin[2]]);
      const off = (row) => {
        const e = [0, 1, 2].map((k) => row[`irradiance_${k}`] ?? row.irradiance_0);
        const relative = (a, b) => Math.abs(a - b) / Math.max(1e-6, Math.abs(b));
        // An 8-bit colour says no more than half a step of it.
        const linear = (byte) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
        const shown = [color.getX(i), color.getY(i), color.getZ(i)];
        const is_shown = ['red', 'green', 'blue'].every((c, k) =>
          shown[k] >= linear(row[c] - 0.51) - 1e-6 && shown[k] <= linear(row[c] + 0.51) + 1e-6);
        return is_shown ? Math.max(relative(lux.getX(i), row.illuminance), relative(E.getX(i), e[0]),
          relative(E.getY(i), e[1]), relative(E.getZ(i), e[2])) : Infinity;
      };
      worst = Math.max(worst, found.length ? Math.min(...found.map(off)) : Infinity);
    }
  });
  expect(vertices >= rows.length, `${name}: ${vertices} vertices, and the .ply has ${rows.length}`);
  expect(worst <= kAsGood, `${name}: three.js reads light that is ${worst} off that of the .ply`);
  return `three.js reads ${vertices} vertices within ${worst.toExponential(1)}`;
}

for (const file of process.argv.slice(2)) {
  const glb = readFileSync(file);
  const { issues } = await validator.validateBytes(new Uint8Array(glb), { maxIssues: 0 });
  for (const m of issues.messages.filter((m) => m.severity < 2).slice(0, 5))
    console.error(`${file}: ${m.code}: ${m.message} ${m.pointer ?? ''}`);
  expect(issues.numErrors + issues.numWarnings === 0, `${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  console.log(`${file}: valid; ${await compare(file, glb, file.replace(/\.glb$/, '.ply'))}`);
}
process.exit(failed ? 1 : 0);
