// The file's unit of length, and where its north is.

import { idOf, idsOf, numberOf } from './ifc_file.mjs';

const kPrefix = {
  EXA: 1e18, PETA: 1e15, TERA: 1e12, GIGA: 1e9, MEGA: 1e6, KILO: 1e3, HECTO: 1e2, DECA: 1e1,
  DECI: 1e-1, CENTI: 1e-2, MILLI: 1e-3, MICRO: 1e-6, NANO: 1e-9, PICO: 1e-12, FEMTO: 1e-15, ATTO: 1e-18,
};

function inSI(file, id, depth = 0) {
  const unit = file.get(id);
  if (file.classOf(unit) === 'IfcSIUnit') return kPrefix[unit.Prefix?.value] ?? 1;
  const measure = file.get(idOf(unit?.ConversionFactor));
  const value = numberOf(measure?.ValueComponent);
  return value > 0 && depth < 5 ? value * inSI(file, idOf(measure.UnitComponent), depth + 1) : 1;
}

/** The project's unit of this type in the SI's; 1 where it has none. */
function projectUnit(file, type) {
  const project = file.get(file.all('IfcProject')[0]);
  const assignment = idOf(project?.UnitsInContext) ?? file.all('IfcUnitAssignment')[0];
  const id = idsOf(file.get(assignment)?.Units).find((unit) => file.get(unit)?.UnitType?.value === type);
  return id === undefined ? 1 : inSI(file, id);
}

/** Metres of the project's unit of length. */
export const metresPerUnit = (file) => projectUnit(file, 'LENGTHUNIT');
/** Degrees of its unit of angles; a degree of few digits, 0.01745 rad, is one all the same. */
export function degreesPerAngle(file) {
  const degrees = (projectUnit(file, 'PLANEANGLEUNIT') * 180) / Math.PI;
  return Math.abs(degrees - 1) < 1e-3 ? 1 : degrees;
}

/** Degrees from +y to true north, clockwise seen from above; undefined when the file does not say. */
export function northDegrees(file) {
  for (const id of file.all('IfcGeometricRepresentationContext', true)) {
    const ratios = file.get(idOf(file.get(id)?.TrueNorth))?.DirectionRatios?.map(numberOf);
    if (ratios?.length >= 2 && Math.hypot(ratios[0], ratios[1]) > 1e-9)
      return Math.round(((Math.atan2(ratios[0], ratios[1]) * 180) / Math.PI) * 1e6) / 1e6;
  }
  return undefined;
}
