// What surfaces look like: presentation styles of shapes and of materials, as plain descriptions.

import { idOf, idsOf, numberOf, textOf } from './ifc_file.mjs';

/** The attribute of a representation item that names what it is shown by. */
const kShownBy = {
  IfcBooleanResult: 'FirstOperand', IfcBooleanClippingResult: 'FirstOperand', IfcCsgSolid: 'TreeRootExpression',
  IfcShellBasedSurfaceModel: 'SbsmBoundary', IfcFaceBasedSurfaceModel: 'FbsmFaces', IfcGeometricSet: 'Elements',
  IfcFacetedBrep: 'Outer', IfcFacetedBrepWithVoids: 'Outer', IfcAdvancedBrep: 'Outer', IfcAdvancedBrepWithVoids: 'Outer',
};

const kDeepest = 50;  // operands of operands, maps of maps; more is a ring

export class Styles {
  constructor(file) {
    this.file = file;
    this.ofItem = new Map();   // id of a representation item -> ids of its styles
    this.look = new Map();     // id of a style -> its description
    this.itemLooks = new Map();
    for (const id of file.all('IfcStyledItem', true)) {
      const line = file.get(id);
      const item = idOf(line?.Item);
      if (item !== undefined && !this.ofItem.has(item)) this.ofItem.set(item, idsOf(line.Styles));
    }
    this.ofMaterial = this.materialStyles();
    this.colourMaps = new Map();  // id of a face set -> id of its IfcIndexedColourMap
    for (const id of file.all('IfcIndexedColourMap', true)) {
      const of = idOf(file.get(id)?.MappedTo);
      if (of !== undefined) this.colourMaps.set(of, id);
    }
    this.textured = new Set();
    for (const id of file.all('IfcTextureMap', true)) this.textured.add(idOf(file.get(id)?.MappedTo));
  }

  /** id of a material -> ids of the styles that it is shown with. */
  materialStyles() {
    const of = new Map();
    for (const id of this.file.all('IfcMaterialDefinitionRepresentation', true)) {
      const line = this.file.get(id);
      const material = idOf(line?.RepresentedMaterial);
      if (material === undefined) continue;
      for (const representation of idsOf(line.Representations))
        for (const item of idsOf(this.file.get(representation)?.Items))
          of.set(material, [...(of.get(material) ?? []), ...idsOf(this.file.get(item)?.Styles)]);
    }
    return of;
  }

  colour(id) {
    const line = this.file.get(id);
    const rgb = [line?.Red, line?.Green, line?.Blue].map(numberOf);
    return rgb.every((v) => v !== undefined) ? rgb.map((v) => Math.min(Math.max(v, 0), 1)) : undefined;
  }

  /** The first of these styles that says how a surface looks. */
  first(ids, depth = 0) {
    for (const id of ids ?? []) {
      const look = this.describe(id, depth);
      if (look) return look;
    }
    return undefined;
  }

  /** { name, colour, gloss, transparency, reflectance, transmittance, textured } of a style; undefined when it has no colour. */
  describe(id, depth = 0) {
    if (this.look.has(id)) return this.look.get(id);
    this.look.set(id, undefined);
    const line = this.file.get(id);
    let look;
    if (this.file.classOf(line) === 'IfcPresentationStyleAssignment') {
      if (depth < kDeepest) look = this.first(idsOf(line.Styles), depth + 1);
    } else if (this.file.classOf(line) === 'IfcSurfaceStyle') {
      look = { name: textOf(line.Name) };
      for (const part of idsOf(line.Styles)) this.addPart(look, this.file.get(part));
      if (!look.colour && !look.reflectance) look = undefined;
    }
    this.look.set(id, look);
    return look;
  }

  addPart(look, part) {
    switch (this.file.classOf(part)) {
      case 'IfcSurfaceStyleShading':
      case 'IfcSurfaceStyleRendering': {
        const surface = this.colour(idOf(part.SurfaceColour));
        const factor = idOf(part.DiffuseColour) === undefined ? numberOf(part.DiffuseColour) : undefined;
        look.colour = this.colour(idOf(part.DiffuseColour)) ?? surface?.map((v) => v * Math.min(Math.max(factor ?? 1, 0), 1));
        const transparency = numberOf(part.Transparency);
        look.gloss = this.gloss(part, look.colour ?? surface);
        if (transparency !== undefined) look.transparency = Math.min(Math.max(transparency, 0), 1);
        break;
      }
      case 'IfcSurfaceStyleLighting':  // photometric, so it wins over a colour
        look.reflectance = this.colour(idOf(part.DiffuseReflectionColour));
        look.transmittance = this.colour(idOf(part.TransmissionColour));
        break;
      case 'IfcSurfaceStyleWithTextures':
        look.textured = true;
        break;
    }
  }

  /** { specular, exponent | roughness } of a rendering; undefined when it does not say both how much and how sharp. */
  gloss(part, colour) {
    const factor = idOf(part.SpecularColour) === undefined ? numberOf(part.SpecularColour) : undefined;
    const specular = this.colour(idOf(part.SpecularColour)) ?? (factor !== undefined ? colour?.map((v) => v * factor) : undefined);
    const highlight = numberOf(part.SpecularHighlight);
    if (!specular || highlight === undefined || !(highlight >= 0)) return undefined;
    const isRoughness = part.SpecularHighlight?.name === 'IFCSPECULARROUGHNESS';
    return isRoughness ? { specular, roughness: Math.min(highlight, 1) } : { specular, exponent: Math.min(highlight, 1e6) };
  }

  /**
   * Map of geometry id -> look for all that an item may be shown as: itself, operands of its booleans, its shells, what
   * it maps. undefined as a look: nothing says.
   */
  looksOf(item, depth = 0) {
    if (this.itemLooks.has(item)) return this.itemLooks.get(item);
    const looks = new Map();
    this.itemLooks.set(item, looks);
    const line = this.file.get(item);
    if (!line || depth > kDeepest) return looks;
    const own = this.first(this.ofItem.get(item));
    const inner = [];
    const look = (id) => {
      for (const [geometry, of] of this.looksOf(id, depth + 1)) {
        looks.set(geometry, of ?? own);
        inner.push(of);
      }
    };
    const className = this.file.classOf(line);
    const map = className === 'IfcMappedItem' ? this.file.get(idOf(line.MappingSource)) : undefined;
    for (const id of idsOf(map ? this.file.get(idOf(map.MappedRepresentation))?.Items : line[kShownBy[className]])) look(id);
    looks.set(item, own ?? inner.find((of) => of));
    return looks;
  }

  /** Colours of an IfcTriangulatedFaceSet, one a triangle of `count`: { looks, of }; undefined when it has none. */
  coloursOfFaces(item, count) {
    const line = this.file.get(this.colourMaps.get(item));
    if (!line) return undefined;
    const index = (line.ColourIndex ?? []).map(numberOf);
    const list = this.file.get(idOf(line.Colours))?.ColourList ?? [];
    if (index.length !== count || list.length === 0) return undefined;
    const opacity = numberOf(line.Opacity);
    const looks = list.map((rgb) => ({
      name: '',
      colour: rgb.map((v) => Math.min(Math.max(numberOf(v) ?? 0, 0), 1)),
      transparency: opacity === undefined ? 0 : Math.min(Math.max(1 - opacity, 0), 1),
    }));
    return { looks, of: index.map((i) => Math.min(Math.max((i ?? 1) - 1, 0), looks.length - 1)) };
  }
}
