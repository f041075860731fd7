// view_through of src/sky/aerial_perspective.cpp in TypeScript: the judge of the walkthrough's shader, itself judged by values of the C++ one.
import { airAxes, type Airlight } from '../../src/core/air';
import type { Manifest } from '../../src/core/generated/manifest';
import { halfToNumber, type Vec3 } from '../../src/core/units';

export type AirDescription = NonNullable<Manifest['instants'][number]['air']>;

const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function lookUp(table: Uint16Array, { columns, rows }: Airlight, pole: Vec3, direction: Vec3): number[] {
  const { a, b } = airAxes(pole);
  const [x, y] = [dot(direction, a), dot(direction, b)];
  const row = Math.sqrt(Math.atan2(Math.hypot(x, y), dot(direction, pole)) / Math.PI) * (rows - 1);
  const column = (Math.atan2(y, x) / (2 * Math.PI) + 1) * columns - 0.5;
  const top = Math.min(Math.floor(row), rows - 2);
  const left = Math.floor(column);
  const value = (r: number, c: number, channel: number) => halfToNumber(table[4 * (r * columns + (c % columns)) + channel]!);
  return [0, 1, 2].map((channel) => {
    const across = (r: number) => value(r, left, channel) * (left + 1 - column) + value(r, left + 1, channel) * (column - left);
    return across(top) * (top + 1 - row) + across(top + 1) * (row - top);
  });
}

function columnOf(begin: number, end: number, metres: number, scaleHeight: number): number {
  const rise = (end - begin) / scaleHeight;
  const mean = Math.abs(rise) < 1e-6 ? 1 - 0.5 * rise : -Math.expm1(-rise) / rise;
  return Math.exp(-begin / scaleHeight) * mean * metres;
}

/** Per channel: a radiance L is seen as L · transmittance + inscatter (kcd/m²). `height` over air.base_m. */
export function viewThrough(air: AirDescription, airlight: Airlight, pole: Vec3, height: number, direction: Vec3, metres: number): { transmittance: number; inscatter: number }[] {
  const fromMolecules = lookUp(airlight.molecules, airlight, pole, direction);
  const fromHaze = lookUp(airlight.haze, airlight, pole, direction);
  const piece = metres / 4;
  return [0, 1, 2].map((c) => {
    let transmittance = 1;
    let inscatter = 0;
    for (let i = 0; i < 4; ++i) {
      const begin = height + i * piece * direction[2];
      const end = begin + piece * direction[2];
      const molecules = air.molecules_per_m[c]! * columnOf(begin, end, piece, air.molecule_height_m);
      const haze = air.haze_per_m[c]! * columnOf(begin, end, piece, air.haze_height_m);
      const depth = molecules + haze;
      const after = transmittance * Math.exp(-depth);
      if (depth > 0) inscatter += ((fromMolecules[c]! * molecules + fromHaze[c]! * haze) / depth) * (transmittance - after);
      transmittance = after;
    }
    return { transmittance, inscatter };
  });
}
