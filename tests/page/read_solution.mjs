// Reads the solution that a page carries as its 3D view does, without a browser, and holds it against the result:
//   node read_solution.mjs PAGE.html RESULT.vtp

import fs from 'node:fs';
import zlib from 'node:zlib';

import { cornersOf, luxOf, readSolution, unpack } from '../../io/page/solution.mjs';
import { LitSurfaces } from './vtp.mjs';

const kLux = 3e-4;  // light is told in steps of 0.02 %

const problems = [];
const expect = (good, ...what) => good || problems.push(what.join(' '));
const near = (a, b, share) => Math.abs(a - b) <= share * Math.max(Math.abs(a), Math.abs(b), 1e-3);

// What the pieces do is known without a page.
const numbers = [1.5, -2, 3e7];
const bytes = Buffer.from(Float32Array.from(numbers).buffer);
const planes = Buffer.from([0, 1, 2, 3].flatMap((k) => [0, 1, 2].map((i) => bytes[4 * i + k])));
expect(String(await unpack(zlib.deflateSync(planes).toString('base64'), Float32Array)) === String(numbers), 'unpack');
expect((await unpack('', Float32Array)).length === 0, 'unpack of nothing');
expect(String(cornersOf([0, 0, 0, 3, 1, 0])) === '0,1,2,0,2,3', 'cornersOf: a square of two triangles');
const lux = luxOf([0, 1, 32768, 65535], [2, 200]);
expect([0, 2, 20, 200].every((x, i) => near(lux[i], x, 1e-6)), 'luxOf: the middle of a logarithm, not', lux);

const [page, result] = process.argv.slice(2);
const html = fs.readFileSync(page, 'utf8');
const elements = new Map([...html.matchAll(/<script [^>]*id="([^"]*)">([^<]*)<\/script>/g)].map((m) => [m[1], m[2]]));
const solution = await readSolution({ getElementById: (id) => ({ textContent: elements.get(id) }) });
const { head, position, corners, panes, seen } = solution;
const surfaces = new LitSurfaces(result);
const { vtp, triangles } = surfaces;
const count = triangles.length;
const field = (name) => (vtp.xml.includes(`Name="${name}"`) ? vtp.numbers('FieldData', name) : []);

expect(corners.length === 3 * count, corners.length / 3, 'triangles, and the result has', count);
expect(position.length === vtp.numbers('Points', 'Points').length, position.length / 3, 'points');
expect(seen.length === position.length && Math.max(...seen) > 100 && Math.min(...seen) < Math.max(...seen), 'shades');
expect(head.channels * position.length / 3 === vtp.numbers('PointData', 'irradiance').length, head.channels, 'channels');
const wantedPanes = field('pane_corners');
expect(panes.length === wantedPanes.length && wantedPanes.every((x, i) => Math.abs(panes[i] + head.centre[i % 3] - x) < 1e-5 * surfaces.size), 'panes');
const [reference] = field('daylight_reference');

// Triangles of the page, every fifth, are of the result, and no two are the same one.
const taken = new Set();
let asked = 0;
for (let t = 0; t < count; t += 5, ++asked) {
  const weights = [0.5, 0.3, 0.2];
  const [x, y, z] = [0, 1, 2].map((k) => weights.reduce((sum, w, i) => sum + w * position[3 * corners[3 * t + i] + k], 0));
  const probe = solution.at(t, { x, y, z });
  const found = surfaces.at(probe).find((f) => f.material === probe.material && near(f.lux, probe.lux, kLux));
  expect(found, `${probe.lux} lx at ${probe.place} on '${probe.surface}' in '${probe.room}': the result has no such place`);
  if (found) taken.add(found.p);
  if (reference !== undefined) expect(near(probe.daylightFactor, 100 * probe.lux / reference, 1e-9), 'daylight factor', probe.daylightFactor);
  else expect(probe.daylightFactor === undefined, 'a daylight factor, without a reference for it');
}
expect(taken.size === asked, 'only', taken.size, 'of', asked, 'triangles are there');

// A part that is called as a room is all of that room.
const inRoom = (name) => triangles.filter((t) => t.room === name).length;
for (const { name, begin, count: n } of head.parts.filter((part) => head.rooms.includes(part.name))) {
  expect(n === inRoom(name), `'${name}':`, n, 'triangles, and the result has', inRoom(name));
  for (const t of [begin, begin + n - 1]) {
    const a = 3 * corners[3 * t];
    expect(solution.at(t, { x: position[a], y: position[a + 1], z: position[a + 2] }).room === name, `triangle ${t} is not in '${name}'`);
  }
}
expect(head.parts.some((part) => part.begin === 0 && part.count === count), 'no part is all of it');

for (const problem of problems.slice(0, 20)) console.error(`${page}: ${problem}`);
console.log(`${page}: ${count} triangles, ${problems.length} problems`);
process.exit(problems.length > 0 ? 1 : 0);
