import { expect, test } from 'vitest';
import { LoadError } from '../../src/core/load_error';
import { groundRadiance, Panorama } from '../../src/core/panorama';

function uniform(width: number, height: number, half: number): Panorama {
  const bytes = new Uint8Array(width * height * 8);
  const view = new DataView(bytes.buffer);
  for (let i = 0; i < width * height * 4; ++i) view.setUint16(2 * i, half, true);
  return Panorama.fromBytes('sky.bin', bytes, width, height);
}

test('a uniform sky of L gives E = π L on level ground', () => {
  const [r] = uniform(64, 128, 0x4000).horizontalIlluminance(); // L = 2
  const step = Math.PI / 2 / 127;
  expect(Math.abs(r / (2 * Math.PI) - 1)).toBeLessThan(step ** 2 / 2); // the trapezoidal rule misses sin(2e) by a third of it
});

test('the horizon is the last row', () => {
  const bytes = new Uint8Array(2 * 2 * 8);
  const view = new DataView(bytes.buffer);
  for (let i = 8; i < 16; ++i) view.setUint16(2 * i, 0x3c00, true); // second row = 1
  const panorama = Panorama.fromBytes('sky.bin', bytes, 2, 2);
  expect(panorama.at(0, 0)).toEqual([0, 0, 0]);
  expect(panorama.horizonMean()).toEqual([1, 1, 1]);
});

test('a panorama of another size is refused with its address', () => {
  expect(() => Panorama.fromBytes('http://h/sky.bin', new Uint8Array(10), 2, 2)).toThrow(LoadError);
});

test('the sun below the horizon lights no ground', () => {
  expect(groundRadiance([0, 0, 0], [100, 100, 100], -0.2)).toEqual([0, 0, 0]);
  expect(groundRadiance([0, 0, 0], [100, 100, 100], 0.5)[0]).toBeGreaterThan(0);
});
