import fs from 'node:fs';
import { expect, test } from 'vitest';
import { airAxes, parseAirlight } from '../../src/core/air';
import { LoadError } from '../../src/core/load_error';
import type { Vec3 } from '../../src/core/units';
import { viewThrough, type AirDescription } from '../support/air';

interface Truth {
  skies: {
    sky: string;
    pole: Vec3;
    air: AirDescription;
    airlight: string;
    views: { height_m: number; direction: Vec3; distance_m: number; transmittance: Vec3; inscatter_kcd_m2: Vec3 }[];
  }[];
}

// Written by the C++ side (walkthrough_air_test): tables as in light/i0_air.bin, and what view_through says.
const truth = JSON.parse(fs.readFileSync(new URL('../data/air.json', import.meta.url), 'utf8')) as Truth;

test.each(truth.skies)('views under $sky are those of the C++ side', ({ pole, air, airlight, views }) => {
  const tables = parseAirlight('air.bin', new Uint8Array(Buffer.from(airlight, 'hex')), air.airlight.columns, air.airlight.rows);
  expect(views.length).toBeGreaterThan(20);
  for (const view of views) {
    const got = viewThrough(air, tables, pole, view.height_m, view.direction, view.distance_m);
    for (const c of [0, 1, 2] as const) {
      // The C++ side gives floats: 24 bits.
      expect(Math.abs(got[c]!.transmittance - view.transmittance[c])).toBeLessThan(1e-6);
      expect(Math.abs(got[c]!.inscatter - view.inscatter_kcd_m2[c])).toBeLessThan(1e-6 * (1 + view.inscatter_kcd_m2[c]));
    }
  }
});

test('the axes stand at right angles to the sun and to each other, wherever it is', () => {
  for (const pole of [[0, 0, 1], [0, 0.6, 0.8], [0.6, 0, 0.8], [-1, 0, 0], [0.28, 0, 0.96]] as Vec3[]) {
    const { a, b } = airAxes(pole);
    for (const [u, v, product] of [[a, a, 1], [b, b, 1], [a, b, 0], [a, pole, 0], [b, pole, 0]] as [Vec3, Vec3, number][]) {
      expect(u[0] * v[0] + u[1] * v[1] + u[2] * v[2]).toBeCloseTo(product, 12);
    }
  }
});

test('tables of another size are refused with their address', () => {
  expect(() => parseAirlight('http://h/air.bin', new Uint8Array(8), 4, 6)).toThrow(LoadError);
});
