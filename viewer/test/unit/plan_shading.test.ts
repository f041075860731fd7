// The plan of the map, from heights alone.
import { expect, test } from 'vitest';
import { builtCells, shadePlan } from '../../src/core/plan_shading';

const [columns, rows] = [80, 60]; // cells of 2 m
const plan = (height: (x: number, y: number) => number): Float32Array => Float32Array.from({ length: columns * rows }, (_, i) => height(2 * (i % columns), 2 * Math.floor(i / columns)));
const isBuilding = (metres: Float32Array, x: number, y: number): boolean => builtCells(metres, columns, rows, 2)[(y / 2) * columns + x / 2] === 1;

const house = (x: number, y: number): number => (x >= 40 && x < 60 && y >= 40 && y < 52 ? 9 : 0);

test('a house on level ground is one, its court is not', () => {
  const metres = plan((x, y) => (x >= 46 && x < 52 && y >= 44 && y < 48 ? 0 : house(x, y)));
  expect(isBuilding(metres, 42, 46)).toBe(true);
  expect(isBuilding(metres, 48, 46)).toBe(false);
  expect(isBuilding(metres, 100, 46)).toBe(false);
});

test('a slope of one in five is ground up to the edge of the city, the house on it is not', () => {
  const metres = plan((x, y) => x / 5 + house(x, y));
  expect(isBuilding(metres, 50, 46)).toBe(true);
  for (const x of [2, 30, 80, 120, 156]) expect(isBuilding(metres, x, 20)).toBe(false);
});

test('a castle hill of one in two is ground, the castle on it is not', () => {
  const cellM = 4;
  const metres = Float32Array.from({ length: columns * rows }, (_, i) => {
    const [x, y] = [cellM * (i % columns) - 160, cellM * Math.floor(i / columns) - 120]; // about the hill's top
    return Math.max(0, Math.min(40, 50 - 0.5 * Math.hypot(x, y))) + (Math.abs(x) < 9 && Math.abs(y) < 9 ? 12 : 0);
  });
  const built = builtCells(metres, columns, rows, cellM);
  expect(built[30 * columns + 40]).toBe(1);
  expect(built.reduce((sum, cell) => sum + cell, 0)).toBe(25); // the castle and nothing else
});

test('the banks of a sunken river are ground', () => {
  const metres = plan((x) => (x >= 70 && x < 90 ? -6 : 0));
  for (const x of [60, 68, 92, 100]) expect(isBuilding(metres, x, 30)).toBe(false);
});

test('where nothing is, the plan is clear', () => {
  const metres = plan((x, y) => (x < 20 ? NaN : house(x, y)));
  expect(shadePlan({ metres, columns, rows }, 2)[3]).toBe(0);
  expect(isBuilding(metres, 50, 46)).toBe(true);
});
