// The sliders of a page whose result has layers (io/page/plan_data.h): plans, figures of sensors and the 3D view follow
// them at once. With all of them at 100 % the page is as it was written.

import { cellPaths, colourOf, figuresOf, isoluxLevels, isoluxPieces, luxWords, mixed, percent } from './mixing.mjs';
import { unpack } from './solution.mjs';

const kSvg = 'http://www.w3.org/2000/svg';

function element(name, attributes, text = '') {
  const made = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

/** Words that change with the light, and what they were. */
class Words {
  constructor(node) {
    this.node = node;
    this.solved = [node.textContent, node.className];
  }

  write(text, name = this.solved[1]) {
    this.node.textContent = text;
    if (this.node.className !== name) this.node.className = name;
  }

  restore() {
    this.write(...this.solved);
  }
}

/** A plan, and of a set of sensors what is said of it. */
class LitPlan {
  constructor(svg, head, values, colours) {
    Object.assign(this, { svg, head, values, colours });
    this.cells = svg.querySelector('g.cells');
    this.lines = svg.querySelector('g.lines');
    this.labels = svg.querySelector('g.labels');
    this.dots = [...svg.querySelectorAll('circle.dot')];
    this.solved = [this.cells, this.lines, this.labels].filter(Boolean).map((group) => [group, [...group.childNodes]]);
    this.dotsSolved = this.dots.map((dot) => dot.getAttribute('fill'));
    this.words = {};
    if (head.set === undefined) return;
    const table = document.getElementById('sensors').closest('section').querySelector('table');
    const row = table.tBodies[0].rows[head.set];
    [...table.tHead.rows[0].cells].forEach((cell, column) => row && (this.words[cell.textContent] = new Words(row.cells[column])));
    for (const term of document.querySelectorAll('.key dt')) {
      if (term.textContent === `Mean, ${head.name}`) this.words.keyMean = new Words(term.nextElementSibling);
      if (term.textContent === `Uniformity U0, ${head.name}`) this.words.keyUniformity = new Words(term.nextElementSibling);
    }
    const verdict = svg.closest('figure').previousElementSibling;
    if (!verdict?.classList.contains('verdict')) return;
    this.words.verdict = new Words(verdict.children[0]);
    this.words.reason = new Words(verdict.children[1]);
  }

  restore() {
    for (const [group, nodes] of this.solved) group.replaceChildren(...nodes);
    this.dots.forEach((dot, i) => dot.setAttribute('fill', this.dotsSolved[i]));
    for (const words of Object.values(this.words)) words.restore();
  }

  relight(weights) {
    this.lux = mixed(this.values, weights, this.lux);
    this.dots.forEach((dot, i) => dot.setAttribute('fill', colourOf(this.lux[i], this.head, this.colours)));
    if (this.cells) this.drawLattice();
    if (this.head.set !== undefined) this.say(figuresOf(this.lux, this.head.target));
  }

  drawLattice() {
    const { a, b, c, d, e, f } = this.cells.transform.baseVal.consolidate().matrix;
    const at = (x, y) => [a * (x + 0.5) + c * (y + 0.5) + e, b * (x + 0.5) + d * (y + 0.5) + f].map((px) => px.toFixed(1));
    this.cells.replaceChildren(...[...cellPaths(this.lux, this.head, this.colours)].map(([fill, path]) => element('path', { fill, stroke: fill, d: path })));
    const lit = this.lux.filter((x) => !Number.isNaN(x));
    const levels = isoluxLevels(lit.reduce((x, y) => Math.min(x, y), Infinity), lit.reduce((x, y) => Math.max(x, y), 0));
    const { target } = this.head;
    if (target !== undefined && !levels.includes(target)) levels.push(target);
    const lines = [], labels = [];
    for (const level of levels) {
      const pieces = isoluxPieces(this.lux, this.head, level).map(([x0, y0, x1, y1]) => [at(x0, y0), at(x1, y1)]);
      if (pieces.length === 0) continue;
      const path = pieces.map(([from, to]) => `M${from.join(' ')}L${to.join(' ')}`).join('');
      if (level === target) lines.push(element('path', { class: 'isolux casing', d: path }));
      lines.push(element('path', { class: level === target ? 'isolux target' : 'isolux', d: path }));
      const [x, y] = pieces[pieces.length >> 1][0];
      labels.push(element('text', { class: 'isolux', x, y: Number(y) + 4 }, Number(level.toPrecision(4)).toString()));
    }
    this.lines.replaceChildren(...lines);
    this.labels.replaceChildren(...labels);
  }

  say(figures) {
    const say = (name, text, style) => this.words[name]?.write(text, style);
    for (const name of ['mean', 'min', 'max', 'median']) say(`${name} lx`, luxWords(figures[name]));
    say('U0', figures.uniformity.toFixed(2));
    say('keyMean', `${luxWords(figures.mean)} lx`);
    say('keyUniformity', figures.uniformity.toFixed(2));
    // Of the sky that the result has.
    for (const name of ['DF mean', 'DF median', 'DF 2 % or more']) say(name, '');
    const { target } = this.head;
    if (target === undefined) return;
    const met = figures.mean >= target;
    say('at or above', percent(figures.share));
    say('verdict', `mean ${met ? 'at or above' : 'below'} the target`, met ? 'met' : 'missed');
    say('reason', `The mean is ${luxWords(figures.mean)} lx where ${luxWords(target)} lx are asked for; ${percent(figures.share)} of the points have ${luxWords(target)} lx or more.`);
  }
}

/** Nothing where the result has no layers. `onChange` is called with the weights of the layers, once a frame. */
export async function startLayers(onChange) {
  const bar = document.getElementById('layers');
  if (!bar) return;
  const text = (name) => document.getElementById(name).textContent.trim();
  const { colours } = JSON.parse(text('layers-head'));
  const plans = await Promise.all([...document.querySelectorAll('svg[data-plan]')].map(async (svg) => {
    const name = `plan-${svg.dataset.plan}`;
    return new LitPlan(svg, JSON.parse(text(`${name}-head`)), await unpack(text(`${name}-light`), Float32Array), colours);
  }));
  const sliders = [...bar.querySelectorAll('input')];
  const now = document.getElementById('layers-now');
  let asked = false;
  const relight = () => {
    asked = false;
    const weights = sliders.map((slider) => Number(slider.value) / 100);
    sliders.forEach((slider) => (slider.nextElementSibling.value = `${slider.value} %`));
    const solved = weights.every((weight) => weight === 1);
    document.body.classList.toggle('relit', !solved);
    now.textContent = solved ? '' : `Shown with ${sliders.map((s) => `${s.name} at ${s.value} %`).join(', ')} of what the result has.`;
    for (const plan of plans) solved ? plan.restore() : plan.relight(weights);
    onChange(weights, solved);
  };
  const ask = () => asked || (asked = true, requestAnimationFrame(relight));
  bar.addEventListener('input', ask);
  const set = (id, value) => document.getElementById(id).addEventListener('click', () => {
    for (const slider of sliders) slider.value = value;
    ask();
  });
  set('layers-solved', 100);
  set('layers-off', 0);
  bar.dataset.ready = 'yes';
}
