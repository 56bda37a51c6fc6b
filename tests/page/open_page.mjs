// Opens a page as a client does, clicks into its 3D view, and holds what it says against the result:
//   node open_page.mjs PAGE.html RESULT.vtp CHROMIUM FOLDER   screenshots go there

import path from 'node:path';
import { pathToFileURL } from 'node:url';

import { Chromium } from './chromium.mjs';
import { LitSurfaces } from './vtp.mjs';

const [page, result, program, folder] = process.argv.slice(2);
const kTolerance = 2e-3;  // illuminance is told in steps of 0.02 %, places in float of the scene's size

const problems = [];
const expect = (good, ...what) => good || problems.push(what.join(' '));

const browser = new Chromium(program);
try {
  await browser.open(pathToFileURL(page).href);
  const ready = await browser.waitFor(`document.getElementById('view')?.dataset.ready`);
  console.log(`page: the view was there ${await browser.evaluate(`document.getElementById('view').dataset.milliseconds`)} ms after the page was asked for`);
  expect(ready === 'yes', 'the 3D view was not shown:', await browser.evaluate(`document.getElementById('view-status').textContent`));
  await browser.evaluate(`document.getElementById('view-canvas').scrollIntoView({ block: 'center' })`);
  const box = await browser.evaluate(`(({ left, top, width, height }) => ({ left, top, width, height }))(document.getElementById('view-canvas').getBoundingClientRect())`);

  const surfaces = new LitSurfaces(result);
  let hits = 0;
  for (const [x, y] of [[0.5, 0.5], [0.45, 0.6], [0.55, 0.45], [0.5, 0.62], [0.6, 0.55], [0.4, 0.5], [0.01, 0.01]]) {
    await browser.click(box.left + x * box.width, box.top + y * box.height);
    const probe = JSON.parse(await browser.waitFor(`document.getElementById('view-probe').dataset.probe`));
    const words = await browser.evaluate(`document.getElementById('view-probe').textContent`);
    await browser.evaluate(`delete document.getElementById('view-probe').dataset.probe`);
    if (!probe) {
      expect(words.includes('no lit surface'), 'beside all surfaces it says', words);
      continue;
    }
    ++hits;
    const values = surfaces.at(probe).map((found) => found.lux);
    expect(values.some((lux) => Math.abs(lux - probe.lux) <= kTolerance * Math.max(lux, 0.01)),
      `at ${probe.place} on '${probe.surface}' it says ${probe.lux} lx, and the result`, values.join(', ') || 'has no such place');
    expect(words.includes(probe.surface) && words.includes('lx'), 'the words are', words);
  }
  expect(hits >= 3, 'only', hits, 'clicks hit a surface');

  // What the controls do is seen in the picture.
  const picture = () => browser.evaluate(`(clerestoryView.draw(), document.getElementById('view-canvas').toDataURL())`);
  let before = await picture();
  for (const [id, change] of [['view-show', `e.value = 'seen'`], ['view-show', `e.value = 'false'`], ['view-lines', 'e.checked = true'],
    ['view-log', 'e.checked = false'], ['view-high', 'e.value = 100'], ['view-cut', 'e.value = 60']]) {
    await browser.evaluate(`{ const e = document.getElementById('${id}'); ${change}; e.dispatchEvent(new Event('input')); }`);
    const after = await picture();
    expect(after !== before, `${id} (${change}) changes nothing`);
    before = after;
  }

  // A slider moves plans, tables and the view; as solved is as it was.
  if (await browser.evaluate(`document.getElementById('layers') !== null`)) {
    await browser.waitFor(`document.getElementById('layers').dataset.ready`);
    const state = async () => {
      await browser.evaluate(`new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))`);
      const html = await browser.evaluate(`[...document.querySelectorAll('section.reacts table, svg.plan, .verdict')].map((e) => e.outerHTML).join('')`);
      return { html, picture: await picture(), mean: Number(await browser.evaluate(`document.querySelector('#sensors')?.closest('section').querySelector('tbody td:nth-child(3)').textContent.replace(',', '')`)) };
    };
    const solved = await state();
    const move = (value) => browser.evaluate(`for (const e of document.querySelectorAll('#layers input')) { e.value = ${value}; e.dispatchEvent(new Event('input', { bubbles: true })); }`);
    await move(50);
    const half = await state();
    expect(half.picture !== solved.picture, 'layers at a half look as before');
    expect(Math.abs(half.mean - solved.mean / 2) <= 0.01 * solved.mean, `at a half the mean is ${half.mean} lx of ${solved.mean}`);
    expect(half.html !== solved.html && await browser.evaluate(`document.body.classList.contains('relit')`), 'the page does not tell that it is dimmed');
    await browser.screenshot(path.join(folder, `${path.basename(page, '.html')}_dimmed.png`));
    await browser.evaluate(`document.getElementById('layers-off').click()`);
    expect((await state()).mean === 0, 'with all off there is light on sensors');
    await browser.evaluate(`document.getElementById('layers-solved').click()`);
    const again = await state();
    expect(again.html === solved.html && again.picture === solved.picture, 'as solved is not as it was');
  }
  await browser.screenshot(path.join(folder, `${path.basename(page, '.html')}.png`));
  const pdf = await browser.pdf();
  expect(pdf.subarray(0, 5).toString() === '%PDF-' && pdf.length > 10000, 'it cannot be printed');
  expect(await browser.evaluate(`document.getElementById('view-print').src.startsWith('data:image/png')`), 'the view is not printed');

  const outside = browser.requests.filter((url) => !/^(file|data|blob|about):/.test(url));
  expect(outside.length === 0, 'it asks the network for', outside.join(', '));
  expect(browser.errors.length === 0, 'its scripts complain:', browser.errors.join('; '));
} catch (error) {
  problems.push(error.message);
} finally {
  await browser.close();
}
for (const problem of problems) console.error(`page: ${problem}`);
process.exit(problems.length > 0 ? 1 : 0);
