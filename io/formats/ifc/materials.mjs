// Building materials of products: their names, and what their properties say of light.

import { idOf, idsOf, numberOf, textOf } from './ifc_file.mjs';

const kDeepest = 10;

/** The attribute of a set of materials, or a use of one, that says what it is made of. */
const kMadeOf = {
  IfcMaterialLayerSetUsage: 'ForLayerSet', IfcMaterialLayerSet: 'MaterialLayers',
  IfcMaterialLayer: 'Material', IfcMaterialLayerWithOffsets: 'Material',
  IfcMaterialProfileSetUsage: 'ForProfileSet', IfcMaterialProfileSetUsageTapering: 'ForProfileSet',
  IfcMaterialProfileSet: 'MaterialProfiles', IfcMaterialProfile: 'Material', IfcMaterialProfileWithOffsets: 'Material',
  IfcMaterialConstituentSet: 'MaterialConstituents', IfcMaterialConstituent: 'Material',
  IfcMaterialList: 'Materials',
};

export class Materials {
  constructor(file) {
    this.file = file;
    this.ofObject = file.relation('IfcRelAssociatesMaterial', 'RelatingMaterial', 'RelatedObjects');
    this.parts = new Map();
    this.aspectOf = new Map();  // id of a representation item -> what part of its product it is: "Glazing"
    for (const id of file.all('IfcShapeAspect', true)) {
      const aspect = file.get(id);
      for (const representation of idsOf(aspect?.ShapeRepresentations))
        for (const item of idsOf(file.get(representation)?.Items)) this.aspectOf.set(item, textOf(aspect.Name));
    }
  }

  /** [{ id, name, part }] of a material or a set of them; `part` is what a constituent is for ("Glazing"). */
  partsOf(id, depth = 0) {
    if (this.parts.has(id)) return this.parts.get(id);
    const line = this.file.get(id);
    const of = (target, part = '') =>
      depth < kDeepest
        ? this.partsOf(target, depth + 1).map((m) => ({ ...m, part: m.part || part }))
        : [];
    const className = this.file.classOf(line);
    const part = className === 'IfcMaterialConstituent' ? textOf(line.Name) : '';
    const parts = className === 'IfcMaterial'
      ? [{ id, name: textOf(line.Name), part: '' }]
      : idsOf(line?.[kMadeOf[className]]).flatMap((m) => of(m, part));
    this.parts.set(id, parts);
    return parts;
  }

  /** Of a product, else of its type; where an item is a named part of it, that part's material comes first. */
  of(product, type, item) {
    const aspect = this.aspectOf.get(item);
    const rank = (part) => (aspect && part.part === aspect ? 0 : 1);
    return [...this.ofAll(product, type)].sort((a, b) => rank(a) - rank(b));
  }

  ofAll(product, type) {
    for (const object of [product, type])
      for (const id of this.ofObject.get(object) ?? []) {
        const parts = this.partsOf(id);
        if (parts.length > 0) return parts;
      }
    return [];
  }
}

const kNames = {
  reflectance: ['reflectance', 'lightreflectance', 'visiblereflectance', 'visiblereflectancefront', 'visiblelightreflectance'],
  transmittance: ['transmittance', 'lighttransmittance', 'visibletransmittance', 'visiblelighttransmittance'],
};
const wordOf = (name) => Object.keys(kNames).find((word) => kNames[word].includes(name.toLowerCase().replace(/[^a-z]/g, '')));

/** 0..1, percents taken as such; undefined for what is neither. */
const share = (value) => (value >= 0 && value <= 1 ? value : value > 1 && value <= 100 ? value / 100 : undefined);

/**
 * Properties "Reflectance" and "Transmittance" by the id of what they belong to (product, type or material):
 * { reflectance, transmittance }. Properties are many and these are rare, so the bytes are searched for them first.
 */
export function opticalProperties(file, bytes) {
  const found = new Map();
  const set = (object, word, value) => {
    if (object === undefined || value === undefined) return;
    if (!found.has(object)) found.set(object, {});
    found.get(object)[word] ??= value;
  };
  for (const id of file.all('IfcOpticalMaterialProperties', true)) {
    const line = file.get(id);
    set(idOf(line?.Material), 'reflectance', share(numberOf(line?.VisibleReflectanceFront)));
    set(idOf(line?.Material), 'transmittance', share(numberOf(line?.VisibleTransmittance)));
  }
  const values = new Map();
  for (const id of linesWith(bytes, ['eflectance', 'ransmittance', 'EFLECTANCE', 'RANSMITTANCE'])) {
    const line = file.get(id);
    const word = file.classOf(line) === 'IfcPropertySingleValue' ? wordOf(textOf(line.Name)) : undefined;
    const value = word && share(numberOf(line.NominalValue));
    if (value !== undefined) values.set(id, { [word]: value });
  }
  if (values.size === 0) return found;
  const take = (object, properties) => {
    for (const id of idsOf(properties)) for (const [word, value] of Object.entries(values.get(id) ?? {})) set(object, word, value);
  };
  for (const name of ['IfcMaterialProperties', 'IfcExtendedMaterialProperties'])
    for (const id of file.all(name, true)) {
      const line = file.get(id);
      take(idOf(line?.Material), line?.Properties ?? line?.ExtendedProperties);
    }
  const sets = new Map();
  for (const id of file.all('IfcPropertySet', true)) {
    const properties = file.get(id)?.HasProperties;
    if (idsOf(properties).some((p) => values.has(p))) sets.set(id, properties);
  }
  for (const [object, ids] of file.relation('IfcRelDefinesByProperties', 'RelatingPropertyDefinition', 'RelatedObjects'))
    for (const id of ids) if (sets.has(id)) take(object, sets.get(id));
  if (sets.size > 0)
    for (const id of file.all('IfcTypeObject'))
      for (const of of idsOf(file.get(id)?.HasPropertySets)) if (sets.has(of)) take(id, sets.get(of));
  return found;
}

/** Ids of the lines ("#12= ...;") that one of these words is in. */
function linesWith(bytes, words) {
  const buffer = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const ids = new Set();
  for (const word of words)
    for (let at = buffer.indexOf(word); at >= 0; at = buffer.indexOf(word, at + 1)) {
      const begin = Math.max(0, at - 1000);
      const before = buffer.toString('latin1', begin, at);
      const id = /#(\d+)\s*=[^;]*$/.exec(before);
      if (id) ids.add(Number(id[1]));
    }
  return ids;
}
