// IFC file -> surfaces, materials, spaces and lights, by web-ifc: node read_ifc.mjs < FILE > answer

import fs from 'node:fs';
import { createRequire } from 'node:module';

import { kTag, utf8, writeMesh, writeRecord, writeStart } from './answer.mjs';
import { IfcFile, idOf, idsOf, textOf } from './ifc_file.mjs';
import { fixtureClass, Lights, photometricCentre } from './lights.mjs';
import { Materials, opticalProperties } from './materials.mjs';
import { Notes } from './notes.mjs';
import { findPanes, isGlazed } from './panes.mjs';
import { cross, dot, placement } from './placement.mjs';
import { Styles } from './styles.mjs';
import { metresPerUnit, northDegrees } from './units.mjs';

const kSegments = 32;      // of a circle
const kMostRestarts = 20;  // after shapes that end the WebAssembly machine

/** Products that are no matter for light, or not there to be seen. */
const kNoMatter = /^Ifc(?:OpeningElement|OpeningStandardCase|VoidingFeature|EarthworksCut|VirtualElement|Annotation|Grid|.*Port|Structural.*|SpatialZone|ExternalSpatialElement|Reinforcing.*|Tendon.*|Referent|Positioning.*|Linear.*|Alignment.*)$/;
/** Shapes of these are seen when there is no body. */
const kNotTheBody = /^(?:axis|box|footprint|foot print|profile|annotation|clearance|cog|reference|surveypoints|lighting|lightsource|body-fallback|plan|facetation)$/i;
/** Representation items that are no surfaces. */
const kNoSurface = /^Ifc(?:LightSource.*|.*Curve.*|Polyline|Line|Circle|Ellipse|.*Point.*|GeometricCurveSet|GeometricSet|Annotation.*|TextLiteral.*|BoundingBox|Vertex.*|Edge.*)$/;

function refuse(message) {
  writeRecord(kTag.end, utf8(JSON.stringify({ refused: message })));
  process.exit(0);
}

/** What web-ifc says goes into `notes` under the name of the product in work. */
function listenTo(notes, current) {
  const hear = (...words) => {
    const line = words.map(String).join(' ').replace(/^\s*(?:ERROR|WARN|INFO|DEBUG):?\s*/i, '').replace(/^(?:\[[^\]]*\]\s*)+/, '').trim();
    if (!line) return;
    const about = current.classOf(Number(/(\d+)\s*$/.exec(line)?.[1] ?? NaN));
    if (kNoSurface.test(about)) return;  // read elsewhere, or nothing to light
    const what = line.replace(/\s*\d+(?:\.\d+)?\s*$/, '').replace(/\d+/g, 'N').slice(0, 160);
    notes.add(about ? `${what} (${about})` : what, current.name);
  };
  for (const level of ['log', 'info', 'warn', 'error', 'debug', 'trace']) console[level] = hear;
}

class Reader {
  constructor(WebIfc, bytes) {
    this.WebIfc = WebIfc;
    this.bytes = bytes;
    this.heard = new Notes();    // by web-ifc
    this.leftOut = new Notes();
    this.warnings = new Notes();
    this.current = { name: '', classOf: (id) => (Number.isFinite(id) && this.file ? this.file.classOf(this.file.get(id)) : '') };
    this.surfaces = [];
    this.spaces = [];
    this.fixtures = [];
    this.materials = [];
    this.materialIndex = new Map();
    this.restarts = 0;
    listenTo(this.heard, this.current);
  }

  async open() {
    const api = new this.WebIfc.IfcAPI();
    await api.Init();
    const settings = { CIRCLE_SEGMENTS: kSegments, COORDINATE_TO_ORIGIN: false, ALLOW_INCOMPATIBLE_SCHEMA_ALIASES: true };
    const model = api.OpenModel(this.bytes, settings);
    if (model < 0) {
      const schema = /FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'/i.exec(Buffer.from(this.bytes.subarray(0, 65536)).toString('latin1'))?.[1];
      refuse(schema === undefined ? 'is no IFC file: its header names no schema; export it again' : `has the schema '${schema}', which is not read; known are IFC2X3, IFC4 and IFC4X3; export it as one of them`);
    }
    this.file = new IfcFile(this.WebIfc, api, model);
  }

  async read() {
    await this.open();
    const file = this.file;
    this.metres = metresPerUnit(file);
    this.typeOf = file.relation('IfcRelDefinesByType', 'RelatingType', 'RelatedObjects');
    this.partOf = file.relation('IfcRelAggregates', 'RelatingObject', 'RelatedObjects');
    this.cuts = new Set(file.all('IfcRelVoidsElement').map((id) => idOf(file.get(id)?.RelatedOpeningElement)));
    this.styles = new Styles(file);
    this.buildingMaterials = new Materials(file);
    this.optics = opticalProperties(file, this.bytes);
    this.lights = new Lights(file, this.metres);
    const products = file.all('IfcProduct').sort((a, b) => a - b);
    for (const id of products) await this.readProduct(id);
    for (const id of this.lights.unused()) this.leftOut.add('light source of no product', textOf(this.file.get(id)?.Name));
    return {
      surfaces: this.surfaces,
      materials: this.materials,
      spaces: this.spaces,
      fixtures: this.fixtures,
      north: northDegrees(this.file),
      warnings: this.warnings.list(),
      complaints: this.heard.list(),
      left_out: this.leftOut.list(),
    };
  }

  async readProduct(id) {
    const line = this.file.get(id);
    if (!line) return;
    const className = this.file.classOf(line);
    const type = (this.typeOf.get(id) ?? [])[0];
    const name = textOf(line.Name) || textOf(line.LongName) || textOf(line.ObjectType) || `${className} ${textOf(line.Tag) || id}`;
    this.current.name = name;
    if (kNoMatter.test(className)) {
      const isCut = /^Ifc(?:Opening|Voiding|EarthworksCut)/.test(className) && this.cuts.has(id);
      if (idOf(line.Representation) && !isCut) this.leftOut.add(className, name);
      return;
    }
    const isSpace = className === 'IfcSpace';
    const typeLine = this.file.get(type);
    const { isFixture, mayBe } = fixtureClass(className, this.file.classOf(typeLine));
    const place = placement(this.file, idOf(line.ObjectPlacement));
    const sources = place ? this.lights.of(line, place) : [];
    const shape = this.onlyBody(idOf(line.Representation));  // after the lights, which are no body
    if (!shape && !isFixture && !isSpace) return;

    writeRecord(kTag.progress, utf8(name));
    const meshes = shape ? await this.meshesOf(id, name) : [];
    if (!meshes) return;
    if (isSpace) {
      this.addSpace(line, name, meshes);
      return;
    }
    this.needsMeasure = isGlazed(className) || isFixture || mayBe || sources.length > 0;
    const looks = this.looksOfProduct(shape);
    const parts = meshes.map((mesh) => this.describe(mesh, id, type, looks, place));
    const surface = this.surfaces.length;
    if (parts.length > 0) {
      this.surfaces.push(name);
      this.findGlass(className, name, id, parts);
      const isGuess = (part) => !part.look && part.glass === undefined && !this.buildingMaterials.aspectOf.has(part.geometry);
      if (parts.some((part) => isGuess(part) && new Set(part.materials.map((m) => m.name)).size > 1))
        this.warnings.add('has several materials and no style; the first of them is taken for it', name);
      for (const part of parts) this.writePart(part, surface, id, type);
    } else if (shape && sources.length === 0 && this.hasSurfaces(shape)) {
      this.warnings.add('has a shape that could not be read', name);
      this.leftOut.add('shape that could not be read', name);
    }
    if (isFixture || sources.length > 0 || mayBe) {
      const names = [...new Set([name, textOf(line.ObjectType), textOf(typeLine?.Name)].filter((n) => n))];
      if (!place) {
        if (isFixture) this.leftOut.add('light fixture that is placed on a grid or a line', name);
        return;
      }
      this.fixtures.push({
        names, is_fixture: isFixture || sources.length > 0, sources,
        ...(parts.length > 0 ? { surface } : {}),
        position: photometricCentre(place, this.metres, parts.length > 0 ? this.boxOf(parts) : undefined),
        x: place.x, z: place.z,
      });
    }
  }

  /** The id of a product's shape, rid of what is no body when there is one; undefined when there is no shape. */
  onlyBody(id) {
    const shape = this.file.get(id);
    const all = idsOf(shape?.Representations);
    if (all.length < 2) return all.length > 0 ? id : undefined;
    const kept = all.filter((representation) => !kNotTheBody.test(textOf(this.file.get(representation)?.RepresentationIdentifier)));
    if (kept.length > 0 && kept.length < all.length) {
      shape.Representations = shape.Representations.filter((reference) => kept.includes(idOf(reference)));
      this.file.api.WriteLine(this.file.model, shape);
    }
    return id;
  }

  /** Do the items of a shape ask for surfaces? */
  hasSurfaces(shape) {
    return idsOf(this.file.get(shape)?.Representations).some((representation) =>
      idsOf(this.file.get(representation)?.Items).some((item) => !kNoSurface.test(this.file.classOf(this.file.get(item)))));
  }

  /** [{ geometry, colour, place, vertices, corners }] */
  async meshesOf(id, name) {
    const meshes = [];
    const { api, model } = this.file;
    try {
      api.StreamMeshes(model, [id], (flat) => {
        for (let k = 0; k < flat.geometries.size(); ++k) {
          const placed = flat.geometries.get(k);
          const geometry = api.GetGeometry(model, placed.geometryExpressID);
          const corners = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
          if (corners.length >= 3) {
            const data = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
            const vertices = new Float32Array(data.length / 2);
            for (let v = 0, at = 0; v < data.length; v += 6) {
              vertices[at++] = data[v];
              vertices[at++] = data[v + 1];
              vertices[at++] = data[v + 2];
            }
            const T = placed.flatTransformation;  // by columns, to y up
            const row = (r, sign) => [sign * T[r], sign * T[4 + r], sign * T[8 + r], sign * T[12 + r]];
            meshes.push({
              geometry: placed.geometryExpressID, colour: placed.color, vertices,
              corners: Uint32Array.from(corners), place: [...row(0, 1), ...row(2, -1), ...row(1, 1)],
            });
          }
          geometry.delete();
        }
      });
    } catch (error) {
      this.warnings.add('has a shape that ends web-ifc', name);
      this.leftOut.add('shape that ends web-ifc', name);
      if (++this.restarts > kMostRestarts) refuse(`has more than ${kMostRestarts} shapes that web-ifc fails on, the last in '${name}'; try to export it again, as glTF or OBJ`);
      await this.open();  // the old machine may be in any state
      this.lights.file = this.styles.file = this.buildingMaterials.file = this.file;
      return undefined;
    }
    return meshes;
  }

  /** Look, material and size of a mesh, in the product's own frame. */
  describe(mesh, id, type, looks, place) {
    const materials = this.buildingMaterials.of(id, type, mesh.geometry);
    let look = looks.get(mesh.geometry);
    if (!look && !looks.has(mesh.geometry)) {
      // Cut by openings, the parts of a product come as one: what is nearest to the colour they have been given.
      const own = [...new Set([...looks.values()].filter((l) => l))];
      look = own.find((l) => isColour(l, mesh.colour)) ?? own[0];
      if (own.length > 1) this.warnings.add('has openings and parts of several looks; the first is taken for all of it', this.current.name);
    }
    let material = materials[0];
    if (!look)
      for (const candidate of materials) {
        const shown = this.styles.first(this.styles.ofMaterial.get(candidate.id));
        if (shown) {
          look = shown.name ? shown : { ...shown, name: candidate.name };
          material = candidate;
          break;
        }
      }
    if (!look && !isWhite(mesh.colour))
      look = { name: '', colour: [mesh.colour.x, mesh.colour.y, mesh.colour.z], transparency: 1 - mesh.colour.w };
    return { ...mesh, look, material, materials, ...this.measure(mesh, place) };
  }

  /** Looks of all items of a shape, by the id of their geometry. */
  looksOfProduct(shape) {
    const looks = new Map();
    for (const representation of idsOf(this.file.get(shape)?.Representations))
      for (const item of idsOf(this.file.get(representation)?.Items))
        for (const [geometry, look] of this.styles.looksOf(item)) looks.set(geometry, looks.get(geometry) ?? look);
    return looks;
  }

  /** Box and area seen along the axes, in the frame of `place` [m]; only of what may be a pane or a lamp. */
  measure(mesh, place) {
    if (!this.needsMeasure || !place) return { lower: [0, 0, 0], upper: [0, 0, 0], size: [0, 0, 0], facing: [0, 0, 0] };
    const P = mesh.place;
    const axes = [place.x, place.y, place.z];
    const origin = place.o.map((v) => v * this.metres);
    const local = [];
    const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity];
    for (let v = 0; v < mesh.vertices.length; v += 3) {
      const [x, y, z] = mesh.vertices.subarray(v, v + 3);
      const p = [0, 4, 8].map((r, k) => P[r] * x + P[r + 1] * y + P[r + 2] * z + P[r + 3] - origin[k]);
      const q = axes.map((axis) => dot(axis, p));
      local.push(q);
      for (let k = 0; k < 3; ++k) {
        lower[k] = Math.min(lower[k], q[k]);
        upper[k] = Math.max(upper[k], q[k]);
      }
    }
    const facing = [0, 0, 0];  // of a closed shell, half of what all its faces show
    for (let c = 0; c + 2 < mesh.corners.length; c += 3) {
      const [a, b, d] = [0, 1, 2].map((k) => local[mesh.corners[c + k]]);
      if (!a || !b || !d) continue;
      const n = cross(b.map((v, k) => v - a[k]), d.map((v, k) => v - a[k]));
      for (let k = 0; k < 3; ++k) facing[k] += Math.abs(n[k]) / 4;
    }
    return { lower, upper, size: upper.map((v, k) => v - lower[k]), facing };
  }

  boxOf(parts) {
    return {
      lower: [0, 1, 2].map((k) => Math.min(...parts.map((part) => part.lower[k]))),
      upper: [0, 1, 2].map((k) => Math.max(...parts.map((part) => part.upper[k]))),
    };
  }

  findGlass(className, name, id, parts) {
    if (!isGlazed(className)) return;
    const { panes, assumed } = findPanes(className, parts);
    if (assumed > 0) this.warnings.add('is glass that says no transparency; transmittance 0.9 is taken for a sheet of it', name);
    if (panes > 0) return;
    if (className.startsWith('IfcWindow')) this.warnings.add('is a window without a part that looks like a pane; it stays opaque', name);
    if (className.startsWith('IfcPlate') && (this.partOf.get(id) ?? []).some((whole) => this.file.classOf(this.file.get(whole)) === 'IfcCurtainWall'))
      this.warnings.add('is a panel of a curtain wall without a word of glass; it stays opaque', name);
  }

  writePart(part, surface, id, type) {
    const coloured = this.styles.coloursOfFaces(part.geometry, part.corners.length / 3);
    if (!coloured) {
      writeMesh(kTag.mesh, surface, this.material(part, id, type), part.place, part.vertices, part.corners);
      return;
    }
    for (const [k, look] of coloured.looks.entries()) {
      const corners = part.corners.filter((_, c) => coloured.of[Math.floor(c / 3)] === k);
      if (corners.length > 0)
        writeMesh(kTag.mesh, surface, this.material({ ...part, look }, id, type), part.place, part.vertices, corners);
    }
  }

  /** Index of the material of a part. */
  material({ look, material, glass, geometry }, id, type) {
    const own = (word) => [id, material?.id, type].map((of) => this.optics.get(of)?.[word]).find((v) => v !== undefined);
    const itsOwn = this.optics.get(id)?.reflectance === undefined ? '' : this.current.name;
    const of = {
      name: look?.name || material?.name || (glass !== undefined && !look?.transparency ? 'glass' : '') || itsOwn || (look?.colour ? `colour ${look.colour.map((v) => Math.round(255 * v)).join(' ')}` : ''),
      colour: look?.colour,
      gloss: look?.gloss,
      transparency: look?.transparency ?? 0,
      reflectance: own('reflectance') ?? look?.reflectance,
      transmittance: look?.transmittance,
      textured: Boolean(look?.textured) || this.styles.textured.has(geometry),
    };
    if (glass !== undefined) of.glass = own('transmittance') ?? glass;
    const key = JSON.stringify(of);
    if (!this.materialIndex.has(key)) {
      this.materialIndex.set(key, this.materials.length);
      this.materials.push(of);
    }
    return this.materialIndex.get(key);
  }

  addSpace(line, name, meshes) {
    if (meshes.length === 0) this.leftOut.add('space without a volume', name);
    const space = this.spaces.length;
    this.spaces.push({ name, long_name: textOf(line.LongName) });
    for (const mesh of meshes) writeMesh(kTag.space, space, 0, mesh.place, mesh.vertices, mesh.corners);
  }
}

const isWhite = (colour) => colour.x === 1 && colour.y === 1 && colour.z === 1 && colour.w === 1;
const isColour = (look, colour) => look.colour && [colour.x, colour.y, colour.z].every((v, k) => Math.abs(v - look.colour[k]) < 1e-6);

async function main() {
  writeStart();
  const file = fs.readFileSync(0);
  const mark = file[0] === 0xef && file[1] === 0xbb && file[2] === 0xbf ? 3 : 0;
  const WebIfc = createRequire(import.meta.url)('web-ifc');
  const reader = new Reader(WebIfc, new Uint8Array(file.buffer, file.byteOffset + mark, file.byteLength - mark));
  writeRecord(kTag.end, utf8(JSON.stringify(await reader.read())));
}

try {
  await main();
} catch (error) {
  if (/out of memory|cannot allocate/i.test(String(error?.message ?? error))) throw error;  // not the file's fault
  refuse(`cannot be read: ${String(error?.message ?? error).split('\n')[0].slice(0, 160)}; try to export it again, as glTF or OBJ`);
}
