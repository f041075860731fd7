// A plan drawn from heights alone: ground dark, what stands on it pale, both shaded by a light from the north-west as maps have it.

/** What is narrower than twice this and stands higher than that over what is beside it is a building, not a hill or a bank, metres. By eye, on towns and suburbs. */
const groundReach = 30;
const lowestBuilding = 3;

type Code = readonly [number, number, number];
const ground: Code = [74, 84, 96];
const building: Code = [214, 207, 192];

/**
 * Of each entry of a line, the extreme of those within `reach`; a plain scan is fast enough at a map's size. Towards the ends of the line the reach shrinks to two fifths,
 * as slopes that rise to the edge of the city would be cut otherwise.
 */
function extremesAlong(values: Float32Array, start: number, stride: number, count: number, reach: number, extreme: (a: number, b: number) => number): number[] {
  return Array.from({ length: count }, (_, i) => {
    let found = values[start + i * stride] ?? NaN;
    const near = Math.max(Math.ceil(0.4 * reach), Math.min(reach, i, count - 1 - i));
    for (let k = Math.max(0, i - near); k <= Math.min(count - 1, i + near); ++k) {
      const value = values[start + k * stride] ?? NaN;
      if (!Number.isNaN(value)) found = Number.isNaN(found) ? value : extreme(found, value);
    }
    return found;
  });
}

function extremes(metres: Float32Array, columns: number, rows: number, reach: number, extreme: (a: number, b: number) => number): Float32Array {
  const found = Float32Array.from(metres);
  for (let row = 0; row < rows; ++row) found.set(extremesAlong(found, row * columns, 1, columns, reach, extreme), row * columns);
  for (let column = 0; column < columns; ++column) extremesAlong(found, column, columns, rows, reach, extreme).forEach((value, row) => (found[row * columns + column] = value));
  return found;
}

/** Heights without what is narrower than `2 reach + 1` cells: the morphological opening by a square (Serra, "Image Analysis and Mathematical Morphology", 1982, II.C). Slopes and wide hills stay. */
export function groundOf(metres: Float32Array, columns: number, rows: number, reach: number): Float32Array {
  return extremes(extremes(metres, columns, rows, reach, Math.min), columns, rows, reach, Math.max);
}

/** RGBA, rows from north to south; transparent where nothing is. `cellM`: metres a cell. */
export function shadePlan({ metres, columns, rows }: { metres: Float32Array; columns: number; rows: number }, cellM: number): Uint8ClampedArray<ArrayBuffer> {
  const low = groundOf(metres, columns, rows, Math.ceil(groundReach / cellM));
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
