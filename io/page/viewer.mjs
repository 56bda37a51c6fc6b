// The 3D view of a page: a solution that one can turn, cut, colour and ask for its illuminance.

import {
  BufferAttribute, BufferGeometry, ClampToEdgeWrapping, DataTexture, DoubleSide, LinearFilter, Mesh, MeshBasicMaterial,
  NearestFilter, PerspectiveCamera, Plane, Points, PointsMaterial, Raycaster, RGBAFormat, Scene, ShaderMaterial, SphereGeometry, Vector2,
  Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { startLayers } from './layers.mjs';
import { readSolution } from './solution.mjs';

const kMostLevels = 16;
const byId = (id) => document.getElementById(id);

const kVertex = `
  attribute float lux;
  attribute vec3 seen;
  varying float vLux;
  varying vec3 vSeen;
  varying float vHeight;
  void main() {
    vLux = lux;
    vSeen = seen;
    vHeight = position.z;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const kFragment = `
  precision highp float;
  uniform sampler2D colours;
  uniform vec2 range;
  uniform bool byLogarithm, asSeen, lines;
  uniform float cut;
  uniform float levels[${kMostLevels}];
  varying float vLux;
  varying vec3 vSeen;
  varying float vHeight;
  void main() {
    float change = max(fwidth(vLux), 1e-12);
    if (vHeight > cut) discard;
    vec3 colour = vSeen;
    if (!asSeen) {
      float t = byLogarithm ? log(max(vLux, range.x) / range.x) / log(range.y / range.x) : (vLux - range.x) / (range.y - range.x);
      colour = texture2D(colours, vec2(clamp(t, 0.0, 1.0), 0.5)).rgb;
    }
    if (lines)
      for (int i = 0; i < ${kMostLevels}; ++i)
        if (levels[i] > 0.0 && abs(vLux - levels[i]) < 0.6 * change) colour = mix(colour, vec3(0.0), 0.75);
    gl_FragColor = vec4(colour, 1.0);
  }`;

const rounded = (x, digits = 3) => {
  if (x === 0) return '0';
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(x))));
  return decimals > 6 ? x.toPrecision(digits) : x.toLocaleString('en', { maximumFractionDigits: decimals });
};

/** Meshes of the solution: its lit sides, and what they are looked at by. */
function buildSurfaces(solution, uniforms) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(solution.position, 3));
  geometry.setAttribute('lux', new BufferAttribute(solution.lux, 1));
  geometry.setAttribute('seen', new BufferAttribute(solution.seen, 3, true));
  geometry.setIndex(new BufferAttribute(solution.corners, 1));
  return new Mesh(geometry, new ShaderMaterial({ uniforms, vertexShader: kVertex, fragmentShader: kFragment }));
}

function buildPanes(solution, clippingPlanes) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(solution.panes, 3));
  const material = new MeshBasicMaterial({ color: 0x4d8fcc, transparent: true, opacity: 0.25, side: DoubleSide, depthWrite: false, clippingPlanes });
  return new Mesh(geometry, material);
}

function buildLuminaires(solution, clippingPlanes) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(solution.head.luminaires.flat()), 3));
  return new Points(geometry, new PointsMaterial({ color: 0xe69f00, size: 7, sizeAttenuation: false, clippingPlanes }));
}

function colourTexture(colours) {
  const texels = new Uint8Array(colours.flatMap((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)).concat(255)));
  const texture = new DataTexture(texels, colours.length, 1, RGBAFormat);
  texture.magFilter = LinearFilter;
  texture.minFilter = NearestFilter;
  texture.wrapS = ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}

class View {
  constructor(solution) {
    this.solution = solution;
    const { head } = solution;
    this.canvas = byId('view-canvas');
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setClearColor(0xf1f2f3);
    byId('view-colours').style.background = `linear-gradient(to right, ${head.colours.join(', ')})`;
    this.uniforms = {
      colours: { value: colourTexture(head.colours) },
      range: { value: new Vector2(head.range[0], head.range[1]) },
      byLogarithm: { value: true },
      asSeen: { value: false },
      lines: { value: false },
      levels: { value: Array.from({ length: kMostLevels }, (_, i) => head.levels[i] ?? 0) },
      cut: { value: Infinity },
    };
    this.surfaces = buildSurfaces(solution, this.uniforms);
    this.renderer.localClippingEnabled = true;
    this.below = new Plane(new Vector3(0, 0, -1), 1e30);
    this.panes = buildPanes(solution, [this.below]);
    this.mark = new Mesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial({ color: 0xd40000 }));
    this.mark.visible = false;
    this.scene = new Scene();
    this.scene.add(this.surfaces, this.panes, this.mark, buildLuminaires(solution, [this.below]));
    this.camera = new PerspectiveCamera(45, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.listenToKeyEvents(this.canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.listen();
    this.choosePart(head.parts[0]);
    this.fit(new Vector3(-0.6, -1, 0.9));
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
  }

  listen() {
    const on = (id, what) => byId(id).addEventListener('input', () => (what(byId(id)), this.draw()));
    on('view-show', (e) => (this.uniforms.asSeen.value = e.value === 'seen', byId('view-legend').hidden = e.value === 'seen'));
    on('view-log', () => this.setRange());
    on('view-low', () => this.setRange());
    on('view-high', () => this.setRange());
    on('view-lines', (e) => (this.uniforms.lines.value = e.checked));
    on('view-glass', (e) => (this.panes.visible = e.checked));
    on('view-cut', (e) => this.setCut(Number(e.value) / Number(e.max)));
    on('view-part', (e) => (this.choosePart(this.solution.head.parts[e.selectedIndex]), this.fit(this.direction())));
    byId('view-above').addEventListener('click', () => this.fit(new Vector3(0, -0.001, 1)));
    byId('view-aslant').addEventListener('click', () => this.fit(new Vector3(-0.6, -1, 0.9)));
    let down;
    this.canvas.addEventListener('pointerdown', (e) => (down = [e.clientX, e.clientY]));
    this.canvas.addEventListener('pointerup', (e) => {
      if (down && Math.hypot(e.clientX - down[0], e.clientY - down[1]) < 4) this.probe(e.clientX, e.clientY);
    });
    // What is printed is the view as it was left.
    addEventListener('beforeprint', () => {
      this.draw();
      byId('view-print').src = this.canvas.toDataURL('image/png');
    });
    this.setRange();
  }

  setRange() {
    const log = byId('view-log').checked;
    let low = Number(byId('view-low').value), high = Number(byId('view-high').value);
    if (!(high > 0)) high = this.solution.head.range[1];
    if (log && !(low > 0)) low = high / 1000;
    if (!(low >= 0 && low < high)) low = log ? high / 10 : 0;
    this.uniforms.range.value.set(low, high);
    this.uniforms.byLogarithm.value = log;
    const at = (t) => rounded(log ? low * (high / low) ** t : low + (high - low) * t, 2);
    byId('view-ticks').replaceChildren(...[0, 0.25, 0.5, 0.75, 1].map((t) => {
      const tick = document.createElement('span');
      tick.textContent = at(t) + (t === 1 ? ' lx' : '');
      return tick;
    }));
  }

  /** The light of the layers at these weights. */
  relight(weights, asSolved) {
    this.solution.relight(weights, asSolved);
    for (const name of ['lux', 'seen']) this.surfaces.geometry.attributes[name].needsUpdate = true;
    this.probed?.();
    this.draw();
  }

  /** Triangles of some rooms only: they lie together. */
  choosePart(part) {
    this.surfaces.geometry.setDrawRange(3 * part.begin, 3 * part.count);
    const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
    const { corners, position } = this.solution;
    const p = new Vector3();
    for (let i = 3 * part.begin; i < 3 * (part.begin + part.count); ++i) {
      p.fromArray(position, 3 * corners[i]);
      low.min(p);
      high.max(p);
    }
    this.low = low;
    this.high = high;
    this.mark.visible = false;
    this.setCut(Number(byId('view-cut').value) / Number(byId('view-cut').max));
  }

  setCut(share) {
    this.uniforms.cut.value = share >= 1 ? 1e30 : this.low.z + share * (this.high.z - this.low.z);
    this.below.constant = this.uniforms.cut.value;
    const height = this.uniforms.cut.value + this.solution.head.centre[2];
    byId('view-cut-height').textContent = share >= 1 ? 'nothing cut' : `cut at ${height.toFixed(2)} m`;
  }

  direction() {
    return this.camera.position.clone().sub(this.controls.target);
  }

  /** All of the part into the picture, seen from there. */
  fit(direction) {
    const centre = this.low.clone().add(this.high).multiplyScalar(0.5);
    const radius = Math.max(this.high.distanceTo(this.low) / 2, 1e-3);
    const half = Math.atan(Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect));
    const distance = radius / Math.sin(half);
    this.camera.near = radius / 500;
    this.camera.far = 20 * radius + distance;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(centre).addScaledVector(direction.normalize(), distance);
    this.controls.target.copy(centre);
    this.controls.update();
    this.mark.scale.setScalar(radius / 150);
    this.draw();
  }

  resize() {
    const box = this.canvas.parentElement;
    const [width, height] = [box.clientWidth, box.clientHeight];
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
  }

  /** Says what is at a place of the window. */
  probe(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const hit = ray.intersectObject(this.surfaces).find((h) => h.point.z <= this.uniforms.cut.value);
    this.mark.visible = Boolean(hit);
    if (hit) this.mark.position.copy(hit.point);
    this.probed = () => this.tell(hit && this.solution.at(hit.faceIndex, hit.point));
    this.probed();
    this.draw();
  }

  tell(found) {
    const out = byId('view-probe');
    out.replaceChildren();
    out.dataset.probe = JSON.stringify(found ?? null);
    const say = (what, value) => {
      const [term, words] = [document.createElement('dt'), document.createElement('dd')];
      term.textContent = what;
      words.textContent = value;
      out.append(term, words);
    };
    if (found) {
      say('illuminance', `${rounded(found.lux)} lx`);
      if (found.daylightFactor !== undefined) say('daylight factor', `${rounded(found.daylightFactor)} %`);
      say('surface', found.surface);
      say('material', found.material);
      if (found.room) say('room', found.room);
      say('at', `${found.place.map((v) => v.toFixed(2)).join(', ')} m`);
    } else {
      say('probe', 'no lit surface there');
    }
  }
}

async function start() {
  const status = byId('view-status');
  let view;
  startLayers((weights, asSolved) => view?.relight(weights, asSolved));
  try {
    const solution = await readSolution(document);
    view = new View(solution);
    status.hidden = true;
    byId('view').dataset.ready = 'yes';
    byId('view').dataset.milliseconds = Math.round(performance.now());
    window.clerestoryView = view;
  } catch (error) {
    status.hidden = false;
    status.textContent = `The 3D view cannot be shown here (${error.message}). It needs WebGL 2 and a browser of 2023 or later; the rest of the page does not.`;
    byId('view').dataset.ready = 'no';
  }
}

start();
