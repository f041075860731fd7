import { parseHalves } from './halves';
import type { Vec3 } from './units';

/** What endless views through molecules alone, and through haze alone, show (schema: air.airlight): RGBA half floats, kcd/m². */
export interface Airlight {
  columns: number;
  rows: number;
  molecules: Uint16Array<ArrayBuffer>;
  haze: Uint16Array<ArrayBuffer>;
}

export function parseAirlight(url: string, bytes: Uint8Array<ArrayBuffer>, columns: number, rows: number): Airlight {
  const count = columns * rows * 4;
  const halves = parseHalves(url, bytes, 2 * count);
  return { columns, rows, molecules: halves.slice(0, count), haze: halves.slice(count) };
}

/** Two unit vectors across the direction to the sun, from which the tables count the turn about it; world frame. */
export function airAxes(pole: Vec3): { a: Vec3; b: Vec3 } {
  const aside: Vec3 = Math.abs(pole[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const along = aside[0] * pole[0] + aside[1] * pole[1] + aside[2] * pole[2];
  const across = aside.map((v, i) => v - along * (pole[i] ?? 0)) as [number, number, number];
  const a = across.map((v) => v / Math.hypot(...across)) as [number, number, number];
  return { a, b: [pole[1] * a[2] - pole[2] * a[1], pole[2] * a[0] - pole[0] * a[2], pole[0] * a[1] - pole[1] * a[0]] };
}
