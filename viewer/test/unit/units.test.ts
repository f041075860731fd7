import { describe, expect, test } from 'vitest';
import { halfToNumber, luminance, sceneToWorld, srgbDecode, srgbEncode, worldToScene } from '../../src/core/units';

describe('halfToNumber', () => {
  // IEEE 754-2019, table 3.5 and the definitions of binary16: hand-made bit patterns.
  test.each([
    [0x3c00, 1], [0xc000, -2], [0x3555, 0.333251953125], [0x7bff, 65504], [0x0001, 2 ** -24], [0x0400, 2 ** -14], [0x0000, 0], [0x7c00, Infinity],
  ])('%i', (bits, value) => expect(halfToNumber(bits)).toBe(value));
  test('NaN', () => expect(halfToNumber(0x7e00)).toBeNaN());
});

describe('sRGB', () => {
  // IEC 61966-2-1: the branch point, the ends, and mid grey 128/255 = 0.21586.
  test('mid grey', () => expect(srgbDecode(128 / 255)).toBeCloseTo(0.21586, 5));
  test('the branches meet', () => expect(srgbEncode(0.0031308)).toBeCloseTo(0.04045, 5));
  test('there and back', () => {
    for (let i = 0; i <= 255; ++i) expect(255 * srgbEncode(srgbDecode(i / 255))).toBeCloseTo(i, 9);
  });
});

test('glTF is y up: east stays, up becomes y, north becomes −z, and back', () => {
  expect(worldToScene([1, 2, 3])).toEqual([1, 3, -2]);
  expect(sceneToWorld(worldToScene([1, 2, 3]))).toEqual([1, 2, 3]);
});

test('luminance of white is its channel (Rec. 709 weights sum to one)', () => {
  expect(luminance([5, 5, 5])).toBeCloseTo(5, 12);
});
