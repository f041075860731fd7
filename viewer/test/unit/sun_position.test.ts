// The diagram's sun against `skybake sun` (the NREL algorithm, src/sky/solar_position.cpp), which is held to published tables.
import { expect, test } from 'vitest';
import { hoursInView, sunPath } from '../../src/core/obstruction';
import { sunPosition } from '../../src/core/sun_position';
import sun from '../data/sun_positions.json';

test.each(sun)('$utc at $latitude_deg, $longitude_deg', ({ utc, latitude_deg, longitude_deg, azimuth_deg, elevation_deg }) => {
  const found = sunPosition(Date.parse(utc), { latitude_deg, longitude_deg });
  expect(Math.abs(found.elevationDeg - elevation_deg)).toBeLessThan(0.02); // Michalsky: 0.01°; and parallax, which his formulas leave out
  const turn = ((found.azimuthDeg - azimuth_deg + 540) % 360) - 180;
  expect(Math.abs(turn) * Math.cos((elevation_deg * Math.PI) / 180)).toBeLessThan(0.02);
});

test('an equinox has twelve hours of sun, wherever', () => {
  for (const latitude_deg of [-45, 0, 47]) {
    const path = sunPath(Date.parse('2026-03-20T12:00:00Z'), { latitude_deg, longitude_deg: 15.4 }, 0, 6);
    expect(Math.abs(hoursInView(path, 6, () => true) - 12)).toBeLessThan(0.2);
    expect(hoursInView(path, 6, () => false)).toBe(0);
  }
});
