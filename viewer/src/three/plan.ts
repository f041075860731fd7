import * as THREE from 'three';
import type { BakedScene } from './baked_scene';

/** Heights of what is seen from straight above, in rows from north to south. */
export interface Heights {
  columns: number;
  rows: number;
  /** Metres; NaN where nothing is. */
  metres: Float32Array<ArrayBuffer>;
  /** What the grid covers, world metres: grid east from west to east, grid north from south to north. */
  west: number;
  east: number;
  south: number;
  north: number;
}

/** So long one piece of the work may keep the page waiting, milliseconds. */
const pieceMs = 12;
const down = new THREE.Vector3(0, -1, 0);

/** Looks down on the whole city with one ray a cell, `longer` cells along its longer side, in pieces that leave the page usable. */
export async function heightsFromAbove({ city, rays }: BakedScene, longer: number): Promise<Heights> {
  const { min, max } = city.bounds;
  const [width, depth] = [Math.max(1, max.x - min.x), Math.max(1, max.z - min.z)];
  const cell = Math.max(width, depth) / longer;
  const [columns, rows] = [Math.max(1, Math.round(width / cell)), Math.max(1, Math.round(depth / cell))];
  const metres = new Float32Array(columns * rows);
  const from = new THREE.Vector3(0, max.y + 1, 0);
  let begun = performance.now();
  for (let row = 0; row < rows; ++row) {
    from.z = min.z + ((row + 0.5) / rows) * depth;
    for (let column = 0; column < columns; ++column) {
      from.x = min.x + ((column + 0.5) / columns) * width;
      metres[row * columns + column] = rays.first(from, down)?.point.y ?? NaN;
    }
    if (performance.now() - begun < pieceMs) continue;
    await new Promise((resolve) => setTimeout(resolve));
    begun = performance.now();
  }
  return { columns, rows, metres, west: min.x, east: max.x, south: -max.z, north: -min.z };
}
