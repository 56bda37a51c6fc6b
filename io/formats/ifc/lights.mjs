// Light sources and light fixtures: what a file says of them, in metres and degrees.

import { idOf, idsOf, numberOf, textOf } from './ifc_file.mjs';
import { axisPlacement, compose, mappingTarget, point, pointOf } from './placement.mjs';
import { degreesPerAngle } from './units.mjs';

const kDeepest = 20;

export class Lights {
  constructor(file, metres) {
    this.file = file;
    this.metres = metres;
    this.degrees = degreesPerAngle(file);
    this.used = new Set();
    this.any = file.all('IfcLightSource').length > 0;
  }

  /** Light sources among the shapes of a product that stands at `place`. */
  of(product, place) {
    const sources = [];
    if (this.any)
      for (const representation of idsOf(this.file.get(idOf(product.Representation))?.Representations))
        this.collect(idsOf(this.file.get(representation)?.Items), place, sources, 0);
    return sources;
  }

  collect(items, place, sources, depth) {
    for (const id of items) {
      const line = this.file.get(id);
      const name = this.file.classOf(line);
      if (name.startsWith('IfcLightSource')) {
        this.used.add(id);
        sources.push(this.describe(line, name, place));
      } else if (name === 'IfcMappedItem' && depth < kDeepest) {
        const map = this.file.get(idOf(line.MappingSource));
        const mapped = compose(place, compose(mappingTarget(this.file, idOf(line.MappingTarget)), axisPlacement(this.file, idOf(map?.MappingOrigin))));
        this.collect(idsOf(this.file.get(idOf(map?.MappedRepresentation))?.Items), mapped, sources, depth + 1);
      }
    }
  }

  /** { kind, name, position [m], x, z, colour, flux [lm], distribution, file } */
  describe(line, className, place) {
    const kind = className.slice('IfcLightSource'.length).toLowerCase();
    const colourLine = this.file.get(idOf(line.ColourAppearance)) ?? this.file.get(idOf(line.LightColour));
    const colour = [colourLine?.Red, colourLine?.Green, colourLine?.Blue].map((v) => Math.max(numberOf(v) ?? 1, 0));
    const source = { kind, name: textOf(line.Name), colour };
    if (kind === 'goniometric') {
      const own = compose(place, axisPlacement(this.file, idOf(line.Position)));
      source.position = own.o.map((v) => v * this.metres);
      source.x = own.x;
      source.z = own.z;
      source.flux = numberOf(line.LuminousFlux) ?? 0;
      this.addDistribution(source, this.file.get(idOf(line.LightDistributionDataSource)));
    } else if (idOf(line.Position) !== undefined) {
      source.position = point(place, pointOf(this.file, idOf(line.Position))).map((v) => v * this.metres);
    }
    return source;
  }

  addDistribution(source, line) {
    if (line && 'LightDistributionCurve' in line) {
      const planes = idsOf(line.DistributionData).map((id) => this.file.get(id));
      const angle = (v) => Math.round((numberOf(v) ?? NaN) * this.degrees * 1e3) / 1e3;  // 1.5708 is 90 degrees
      const numbers = (list) => (Array.isArray(list) ? list : []);
      source.distribution = {
        type: String(line.LightDistributionCurve?.value ?? ''),
        planes: planes.map((plane) => ({
          angle: angle(plane?.MainPlaneAngle),
          angles: numbers(plane?.SecondaryPlaneAngle).map(angle),
          intensities: numbers(plane?.LuminousIntensity).map((v) => numberOf(v) ?? NaN),  // [cd/lm]
        })),
      };
    } else if (line) {
      source.file = textOf(line.Location);
    }
  }

  /** Those that belong to no product. */
  unused() {
    return this.file.all('IfcLightSource').filter((id) => !this.used.has(id));
  }
}

/** Could the product be a lamp, that is: named in a table of fixtures? And does its class say that it is one? */
export function fixtureClass(className, typeClassName) {
  const isFixture = /^Ifc(?:LightFixture|Lamp)$/.test(className) || /^Ifc(?:LightFixture|Lamp)Type$/.test(typeClassName);
  const mayBe = isFixture || /^Ifc(?:FlowTerminal|BuildingElementProxy|BuiltElement|ElectricAppliance)$/.test(className);
  return { isFixture, mayBe };
}

/** Where the photometric centre of a fixture is [m]: its placement, or below its body, which would be in the way. */
export function photometricCentre(place, metres, box) {
  const origin = place.o.map((v) => v * metres);
  if (!box || box.lower[2] >= 0) return origin;
  const inside = [0, 1].every((k) => box.lower[k] <= 0 && box.upper[k] >= 0);
  const local = inside ? [0, 0, box.lower[2]] : [(box.lower[0] + box.upper[0]) / 2, (box.lower[1] + box.upper[1]) / 2, box.lower[2]];
  return point({ ...place, o: origin }, local);
}

