// Placements of products, in double precision: columns x, y, z and the origin.

import { idOf, numberOf } from './ifc_file.mjs';

const kDeepest = 200;  // placements upon placements; more is a ring

export const kIdentity = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], o: [0, 0, 0] };

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => {
  const l = Math.hypot(...a);
  return l > 1e-12 ? a.map((v) => v / l) : undefined;
};
export const direction = (m, d) => [0, 1, 2].map((k) => m.x[k] * d[0] + m.y[k] * d[1] + m.z[k] * d[2]);
export const point = (m, p) => direction(m, p).map((v, k) => v + m.o[k]);
export const compose = (a, b) => ({ x: direction(a, b.x), y: direction(a, b.y), z: direction(a, b.z), o: point(a, b.o) });

const triple = (list) => {
  const values = (list ?? []).map((v) => numberOf(v) ?? 0);
  return [values[0] ?? 0, values[1] ?? 0, values[2] ?? 0];
};
export const pointOf = (file, id) => triple(file.get(id)?.Coordinates);
const directionOf = (file, id) => (id === undefined ? undefined : unit(triple(file.get(id)?.DirectionRatios)));

/** IfcAxis2Placement3D or 2D. */
export function axisPlacement(file, id) {
  const line = file.get(id);
  if (!line) return kIdentity;
  const z = directionOf(file, idOf(line.Axis)) ?? [0, 0, 1];
  const across = (a) => unit(a.map((v, k) => v - dot(a, z) * z[k]));
  const x = across(directionOf(file, idOf(line.RefDirection)) ?? [1, 0, 0]) ?? across([0, 1, 0]) ?? across([1, 0, 0]);
  return { x, y: cross(z, x), z, o: pointOf(file, idOf(line.Location)) };
}

/** IfcCartesianTransformationOperator, with its scale. */
export function mappingTarget(file, id) {
  const line = file.get(id);
  if (!line) return kIdentity;
  const scale = numberOf(line.Scale) ?? 1;
  const x = directionOf(file, idOf(line.Axis1)) ?? [1, 0, 0];
  const y = directionOf(file, idOf(line.Axis2)) ?? [0, 1, 0];
  const z = directionOf(file, idOf(line.Axis3)) ?? cross(x, y);
  const times = (a, s) => a.map((v) => v * s);
  return {
    x: times(x, scale),
    y: times(y, numberOf(line.Scale2) ?? scale),
    z: times(z, numberOf(line.Scale3) ?? scale),
    o: pointOf(file, idOf(line.LocalOrigin)),
  };
}

/** IfcLocalPlacement, with all that it stands on; undefined for kinds that are not understood. */
export function placement(file, id, depth = 0) {
  if (id === undefined) return kIdentity;
  const line = file.get(id);
  if (!line || depth > kDeepest || !('RelativePlacement' in line) || file.classOf(line) !== 'IfcLocalPlacement') return undefined;
  const own = axisPlacement(file, idOf(line.RelativePlacement));
  const outer = placement(file, idOf(line.PlacementRelTo), depth + 1);
  return outer && compose(outer, own);
}
