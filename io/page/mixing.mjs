// Light of layers, summed by how much there is of each, and what a page tells of it.

/** Sum over layers of weight x values; `values` holds one layer after the other. Not a number stays so, also in a layer that is off. */
export function mixed(values, weights, out = new Float32Array(values.length / weights.length)) {
  const n = out.length;
  out.fill(0);
  weights.forEach((weight, layer) => {
    const begin = layer * n;
    for (let i = 0; i < n; ++i) out[i] += weight * values[begin + i];
  });
  return out;
}

/** Of the sensors of a set, as solver/evaluate/sensor_summary.h has them. Places without a sensor are not a number. */
export function figuresOf(lux, target) {
  const values = Float64Array.from(lux).filter((x) => !Number.isNaN(x)).sort();
  const n = values.length;
  const mean = values.reduce((sum, x) => sum + x, 0) / n;
  return {
    mean, min: values[0], max: values[n - 1], median: (values[(n - 1) >> 1] + values[n >> 1]) / 2,
    uniformity: mean > 0 ? values[0] / mean : 0,
    share: target === undefined ? undefined : values.filter((x) => x >= target).length / n,
  };
}

/** Where a value stands in [low, high], as io/picture/colour_map.h has it. */
function placeInRange(value, { low, high, log }) {
  if (!(high > low)) return value < low ? 0 : 1;
  const t = log ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.min(Math.max(t, 0), 1);
}

export function colourOf(lux, plan, colours) {
  return colours[Math.round((colours.length - 1) * placeInRange(lux, plan))];
}

/** Cells of a lattice as SVG in columns and rows: a path a colour. */
export function cellPaths(lux, plan, colours) {
  const paths = new Map();
  const colour = (row, column) => {
    const value = lux[row * plan.columns + column];
    return Number.isNaN(value) ? '' : colourOf(value, plan, colours);
  };
  for (let row = 0; row < plan.rows; ++row)
    for (let begin = 0, end; begin < plan.columns; begin = end) {
      const here = colour(row, begin);
      for (end = begin + 1; end < plan.columns && colour(row, end) === here;) ++end;
      if (here) paths.set(here, `${paths.get(here) ?? ''}M${begin} ${row}h${end - begin}v1h-${end - begin}z`);
    }
  return paths;
}

/** Levels of isolux lines between two illuminances, as io/page/plan.h has them; there may be none. */
export function isoluxLevels(low, high) {
  const series = [];
  for (let power = -4; power < 8; ++power) for (const step of [1, 1.5, 2, 3, 5, 7.5]) series.push({ step, lux: Number(`${step}e${power}`) });
  let levels = series.filter(({ lux }) => lux > Math.max(low, 1e-3 * high) && lux < high);
  if (levels.length > 8) levels = levels.filter(({ step }) => ![1.5, 3, 7.5].includes(step));
  return levels.slice(-8).map(({ lux }) => lux);
}

/** Where the lattice, linear on triangles, has that level: x, y of both ends of each piece, in columns and rows. */
export function isoluxPieces(lux, { columns, rows }, level) {
  const pieces = [];
  const on = (triangle) => {
    if (triangle.some((i) => Number.isNaN(lux[i]))) return;
    const ends = [];
    triangle.forEach((i, k) => {
      const j = triangle[(k + 1) % 3];
      if (lux[i] < level === lux[j] < level) return;
      const t = (level - lux[i]) / (lux[j] - lux[i]);
      const along = (of) => of(i) + t * (of(j) - of(i));
      ends.push(along((p) => p % columns), along((p) => Math.floor(p / columns)));
    });
    if (ends.length === 4) pieces.push(ends);
  };
  for (let row = 0; row + 1 < rows; ++row)
    for (let column = 0; column + 1 < columns; ++column) {
      const a = row * columns + column, d = a + columns;
      on([a, a + 1, d + 1]);
      on([a, d + 1, d]);
    }
  return pieces;
}

/** Three significant digits, as pipeline/wording.h has them. */
export function rounded(value) {
  const size = Math.abs(value);
  if (!(size >= 1e-4 && size < 1e7)) return String(Number(value.toPrecision(3)));
  return value.toFixed(Math.max(0, 2 - Math.floor(Math.log10(size))));
}
export function luxWords(lux) {
  if (lux > 0 && lux < 0.005) return '< 0.01';
  return lux >= 1000 ? Math.round(lux).toLocaleString('en') : rounded(lux);
}
export const percent = (share) => `${rounded(100 * share)} %`;
