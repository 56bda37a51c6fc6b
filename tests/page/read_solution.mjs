// Reads the solution that a page carries as its 3D view does, without a browser, and holds it against the result:
//   node read_solution.mjs PAGE.html RESULT.vtp

import fs from 'node:fs';
import zlib from 'node:zlib';

import { cellPaths, figuresOf, isoluxLevels, isoluxPieces, luxWords, mixed } from '../../io/page/mixing.mjs';
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

expect(String(mixed(Float32Array.of(1, 2, NaN, 10, 20, NaN), [0, 0.5])) === '5,10,NaN', 'mixed');
const figures = figuresOf([4, NaN, 1, 10, 5], 5);
expect(JSON.stringify(figures) === '{"mean":5,"min":1,"max":10,"median":4.5,"uniformity":0.2,"share":0.5}', 'figuresOf:', JSON.stringify(figures));
// A plane of 3 x 2 places that rises by 10 a column: the line of 15 stands upright halfway between the last two columns.
const rise = { columns: 3, rows: 2 };
expect(isoluxPieces([0, 10, 20, 0, 10, 20], rise, 15).every(([x0, , x1]) => x0 === 1.5 && x1 === 1.5), 'isoluxPieces');
expect(isoluxPieces([0, 10, 20, 0, 10, 20], rise, 15).length === 2, 'isoluxPieces: one of each triangle');
expect(isoluxPieces([0, 10, NaN, 0, 10, 20], rise, 15).length === 1, 'isoluxPieces at a place without a sensor');
expect(String(isoluxLevels(90, 800)) === '100,150,200,300,500,750', 'isoluxLevels', isoluxLevels(90, 800));
const cells = cellPaths([0, 0, NaN, 100, 100, 0], { ...rise, low: 0, high: 100, log: false }, ['dark', 'bright']);
expect(cells.get('dark') === 'M0 0h2v1h-2zM2 1h1v1h-1z' && cells.get('bright') === 'M0 1h2v1h-2z', 'cellPaths', ...cells);
expect(['412', '0', '< 0.01', '1,235', '95.0', '0.250'].join() === [412.3, 0, 0.001, 1234.6, 95, 0.25].map(luxWords).join(), 'luxWords');

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

// Layers: those of the result, and with all of them as they were solved its light again; sensors as its table tells them.
const names = vtp.xml.includes('Name="layer_names"') ? vtp.strings('layer_names') : [];
expect((head.layers?.length ?? 0) === names.length, head.layers?.length, 'layers, and the result has', names.length);
if (head.layers) {
  const lit = Float32Array.from(solution.lux), looked = Uint8Array.from(seen), brightest = Math.max(...vtp.numbers('PointData', 'illuminance'));
  const sameAs = (lux) => lux.every((x, i) => Math.abs(x - solution.lux[i]) <= kLux * x + 1e-7 * brightest);
  solution.relight(names.map(() => 1), false);
  expect(sameAs(lit), 'the layers do not sum to the light');
  expect(seen.every((byte, i) => Math.abs(byte - looked[i]) <= 2), 'the layers do not look as the light does');
  // Points of the page lie in another order than the result's: sorted they are the same numbers.
  names.forEach((name, layer) => {
    solution.relight(names.map((_, k) => (k === layer ? 0.5 : 0)), false);
    const wanted = vtp.numbers('PointData', `illuminance:${name}`).map((x) => x / 2).sort((a, b) => a - b);
    expect([...solution.lux].sort((a, b) => a - b).every((x, i) => Math.abs(x - wanted[i]) <= kLux * x + 1e-7 * brightest), `layer '${name}' at a half`);
  });
  solution.relight(names.map(() => 0), false);
  expect(Math.max(...solution.lux) === 0 && Math.max(...seen) === 0, 'without light it is not dark');
  solution.relight(names.map(() => 1), true);
  expect(solution.lux.every((x, i) => x === lit[i]) && seen.every((x, i) => x === looked[i]), 'as solved it is not what it was');

  const rows = [...html.slice(html.indexOf('id="sensors"')).matchAll(/<tr><td class="words">(.*)<\/tr>/g)].map((m) => m[1].split(/<[^>]*>+/).filter(Boolean));
  for (const [id] of [...elements].filter(([name]) => /^plan-.*-head$/.test(name))) {
    const plan = JSON.parse(elements.get(id));
    const values = await unpack(elements.get(id.replace('head', 'light')).trim(), Float32Array);
    const of = figuresOf(mixed(values, names.map(() => 1)), plan.target);
    const wanted = [of.mean, of.min, of.max, of.median].map(luxWords).concat(of.uniformity.toFixed(2)).join(' ');
    expect(rows[plan.set].slice(2, 7).join(' ') === wanted, `'${plan.name}' is told as ${rows[plan.set].slice(2, 7).join(' ')}, its layers have ${wanted}`);
  }
}

for (const problem of problems.slice(0, 20)) console.error(`${page}: ${problem}`);
console.log(`${page}: ${count} triangles, ${problems.length} problems`);
process.exit(problems.length > 0 ? 1 : 0);
