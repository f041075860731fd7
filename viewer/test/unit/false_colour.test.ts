// The scale of false colours, against the table that holds the stills to the same numbers.
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, test } from 'vitest';
import { autoScale, colourOf, ticksOf } from '../../src/core/false_colour';

const table = path.join(path.dirname(fileURLToPath(import.meta.url)), '../../../tests/render/false_colour_values.csv');
const rows = fs.readFileSync(table, 'utf8').trim().split('\n').slice(1).map((line) => line.split(',').map(Number));

test.each(rows)('from %f to %f (log %i), %f has the colour of the stills', (low, high, log, value, ...codes) => {
  colourOf({ low: low!, high: high!, isLogarithmic: log === 1 }, value!).forEach((code, c) => expect(code).toBeCloseTo(codes[c]!, 2));
});

test('ticks are round, as on the stills', () => {
  expect(ticksOf({ low: 0, high: 1, isLogarithmic: false })).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
  expect(ticksOf({ low: 1000, high: 100000, isLogarithmic: true })).toEqual([1000, 2000, 5000, 10000, 20000, 50000, 100000]);
  expect(ticksOf({ low: 1, high: 10000, isLogarithmic: true })).toEqual([1, 10, 100, 1000, 10000]);
});

test('the range follows the light: day and night', () => {
  // A mean of 20 klx: hint = 0.5 / (20 klx / π).
  expect(autoScale((0.5 * Math.PI) / 20, 80)).toEqual({ low: 1000, high: 100000, isLogarithmic: true });
  expect(autoScale((0.5 * Math.PI) / 0.03, 0)).toEqual({ low: 0.5, high: 50, isLogarithmic: true });
});
