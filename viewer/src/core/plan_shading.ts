// A plan drawn from heights alone: ground dark, what stands on it pale, both shaded by a light from the north-west as maps have it.

/**
 * What is narrower than twice the reach and stands this high over what is beside it may be a building; it is one when so large a share of its outline drops as steeply,
 * which hills do not. The smaller reach finds what stands on a hilltop. Metres. By eye, on towns with hills and a river.
 */
const reaches = [30, 10];
const lowestBuilding = 2.5;
const steepShare = 0.35;

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

/**
 * 1 where something is built, 0 on the ground; `cellM`: metres a cell. The ground is the morphological opening by a square (J. Serra, "Image Analysis and Mathematical
 * Morphology", 1982, II.C).
 */
export function builtCells(metres: Float32Array, columns: number, rows: number, cellM: number): Uint8Array {
  const built = new Uint8Array(metres.length);
  for (const reachM of reaches) {
    const reach = Math.ceil(reachM / cellM);
    const ground = extremes(extremes(metres, columns, rows, reach, Math.min), columns, rows, reach, Math.max);
    const high = Uint8Array.from(metres, (height, i) => (height - (ground[i] ?? 0) > lowestBuilding ? 1 : 0));
    const seen = new Uint8Array(high.length);
    for (let i = 0; i < high.length; ++i) {
      if (!high[i] || seen[i]) continue;
      const piece = pieceAt(i, metres, high, seen, columns);
      if (piece.steep >= steepShare * piece.outline) for (const cell of piece.cells) built[cell] = 1;
    }
  }
  return built;
}

/** The cells that hang together with one; how many sides they have to others, and how many of those are cliffs. */
function pieceAt(first: number, metres: Float32Array, high: Uint8Array, seen: Uint8Array, columns: number): { cells: number[]; outline: number; steep: number } {
  const piece = { cells: [first], outline: 0, steep: 0 };
  seen[first] = 1;
  for (const cell of piece.cells) { // grows as it is walked
    const column = cell % columns;
    const beside = [column > 0 ? cell - 1 : -1, column < columns - 1 ? cell + 1 : -1, cell - columns, cell + columns];
    for (const other of beside.filter((at) => at >= 0 && at < high.length)) {
      if (!high[other]) {
        ++piece.outline;
        const drop = (metres[cell] ?? 0) - (metres[other] ?? 0);
        if (!(drop <= lowestBuilding)) ++piece.steep; // also where nothing is
      } else if (!seen[other]) {
        seen[other] = 1;
        piece.cells.push(other);
      }
    }
  }
  return piece;
}

/** RGBA, rows from north to south; transparent where nothing is. `cellM`: metres a cell. */
export function shadePlan({ metres, columns, rows }: { metres: Float32Array; columns: number; rows: number }, cellM: number): Uint8ClampedArray<ArrayBuffer> {
  const built = builtCells(metres, columns, rows, cellM);
  const pixels = new Uint8ClampedArray(4 * columns * rows);
  const at = (column: number, row: number): number => metres[Math.min(rows - 1, Math.max(0, row)) * columns + Math.min(columns - 1, Math.max(0, column))] ?? NaN;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const here = at(column, row);
      if (Number.isNaN(here)) continue;
      const rise = at(column - 1, row - 1) - at(column + 1, row + 1); // towards the light
      const slope = Number.isFinite(rise) ? rise / (2 * Math.SQRT2 * cellM) : 0;
      const light = Math.min(1.35, Math.max(0.55, 1 - 0.35 * slope));
      const colour = built[row * columns + column] ? building : ground;
      pixels.set([...colour.map((code) => code * light), 255], 4 * (row * columns + column));
    }
  }
  return pixels;
}
