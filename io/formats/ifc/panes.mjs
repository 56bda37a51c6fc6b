// Which parts of windows, doors and panels are panes of glass.

const kThickest = 0.06;    // of a pane, double and triple glazing included [m]
const kSmallest = 0.1;     // of a pane's width and height [m]; less is a bar or a handle
const kLeastFilled = 0.7;  // of its box; a disc has 0.79, a frame of one tenth around a hole 0.36
const kSheet = 0.9;        // transmittance where nothing says it: clear glass; a pane drawn as a solid passes it twice

const kGlassWord = /glas|glaz|vitr|verre|cristal|vidrio|vidro|vetro|szk[lł]|стекл|ガラス|玻璃/i;
const kNoGlass = /fib(?:re|er)|faser|wool|wolle|laine|foam|bead|gasket|glasur|plaster|metal|alumini?um|steel|wood|timber|frame|brick|tile/i;
const saysGlass = (name) => kGlassWord.test(name) && !kNoGlass.test(name);
const isGlass = (material) => saysGlass(material.name) || saysGlass(material.part);

export const isGlazed = (className) => /^Ifc(?:Window|Door|Plate|CurtainWall)/.test(className);

/** Is this part, of a window whose box is `whole`, a sheet in the window's plane, without holes? */
function isSheet(part, whole) {
  const size = part.size;
  const depth = whole.indexOf(Math.min(...whole));
  const [a, b] = [0, 1, 2].filter((k) => k !== depth).map((k) => size[k]);
  return size[depth] <= kThickest && Math.min(a, b) >= kSmallest && part.facing[depth] >= kLeastFilled * a * b;
}

/**
 * Sets part.glass, the transmittance of a sheet, of those parts { look, material, size, facing } that are panes.
 * size: of its box [m], facing: its area seen along each axis [m2], in the product's own frame.
 * returns  { panes, assumed }: how many are glass, and of how many the model says no transparency.
 */
export function findPanes(className, parts) {
  let panes = 0, assumed = 0;
  const take = (part, transmittance) => {
    part.glass = transmittance;
    ++panes;
  };
  for (const part of parts)
    if (part.look?.transparency >= 0.05) take(part, part.look.transparency);
  if (panes > 0) return { panes, assumed };
  for (const part of parts)
    if (part.look ? saysGlass(part.look.name) : part.material && isGlass(part.material)) {
      take(part, kSheet);
      ++assumed;
    }
  if (panes > 0 || !className.startsWith('IfcWindow')) return { panes, assumed };
  // A door's leaf may be a sheet as well; a window that lets no light in makes no sense.
  const oneLook = parts.every((part) => part.look === parts[0].look);
  const whole = [0, 1, 2].map((k) => Math.max(...parts.map((part) => part.upper[k])) - Math.min(...parts.map((part) => part.lower[k])));
  for (const part of parts)
    if ((oneLook || !part.look) && isSheet(part, whole)) {
      part.material = part.materials.find(isGlass) ?? part.material;
      take(part, kSheet);
      ++assumed;
    }
  return { panes, assumed };
}
