// A plan drawn from heights alone: ground dark, what stands on it pale, both shaded by a light from the north-west as maps have it.

/** How far about a cell its ground is looked for, and how high something must stand over it to be a building, metres. */
const groundReach = 30;
const lowestBuilding = 2.5;

type Code = readonly [number, number, number];
const ground: Code = [74, 84, 96];
const building: Code = [214, 207, 192];

/** The lowest value within `reach` entries of a line, by van Herk's passes in short: a plain scan is fast enough at a map's size. */
function lowestAlong(values: Float32Array, start: number, stride: number, count: number, reach: number): number[] {
  return Array.from({ length: count }, (_, i) => {
    let lowest = Infinity;
    for (let k = Math.max(0, i - reach); k <= Math.min(count - 1, i + reach); ++k) {
      const value = values[start + k * stride] ?? NaN;
      if (value < lowest) lowest = value;
    }
    return lowest;
  });
}

/** The lowest height in the square about each cell; Infinity where there is none. */
export function groundBelow(metres: Float32Array, columns: number, rows: number, reach: number): Float32Array {
  const low = Float32Array.from(metres, (value) => (Number.isNaN(value) ? Infinity : value));
  for (let row = 0; row < rows; ++row) low.set(lowestAlong(low, row * columns, 1, columns, reach), row * columns);
  for (let column = 0; column < columns; ++column) lowestAlong(low, column, columns, rows, reach).forEach((value, row) => (low[row * columns + column] = value));
  return low;
}

/** RGBA, rows from north to south; transparent where nothing is. `cellM`: metres a cell. */
export function shadePlan({ metres, columns, rows }: { metres: Float32Array; columns: number; rows: number }, cellM: number): Uint8ClampedArray<ArrayBuffer> {
  const low = groundBelow(metres, columns, rows, Math.ceil(groundReach / cellM));
  const pixels = new Uint8ClampedArray(4 * columns * rows);
  const at = (column: number, row: number): number => metres[Math.min(rows - 1, Math.max(0, row)) * columns + Math.min(columns - 1, Math.max(0, column))] ?? NaN;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const here = at(column, row);
      if (Number.isNaN(here)) continue;
      const rise = at(column - 1, row - 1) - at(column + 1, row + 1); // towards the light
      const slope = Number.isFinite(rise) ? rise / (2 * Math.SQRT2 * cellM) : 0;
      const light = Math.min(1.35, Math.max(0.55, 1 - 0.35 * slope));
      const colour = here - (low[row * columns + column] ?? here) > lowestBuilding ? building : ground;
      pixels.set([...colour.map((code) => code * light), 255], 4 * (row * columns + column));
    }
  }
  return pixels;
}
