import { expect, test } from 'vitest';
import { LoadError } from '../../src/core/load_error';
import { Panorama } from '../../src/core/panorama';

test('a panorama keeps its halves as they are', () => {
  const bytes = new Uint8Array(2 * 2 * 8);
  new DataView(bytes.buffer).setUint16(30, 0x3c00, true);
  expect(Panorama.fromBytes('sky.bin', bytes, 2, 2).halves[15]).toBe(0x3c00);
});

test('a panorama of another size is refused with its address', () => {
  expect(() => Panorama.fromBytes('http://h/sky.bin', new Uint8Array(10), 2, 2)).toThrow(LoadError);
});
