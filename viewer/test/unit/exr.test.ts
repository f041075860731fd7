// Single texels of EXR files, against a writer of the tests' own.
import { describe, expect, test } from 'vitest';
import { ExrFile } from '../../src/core/exr';
import { LoadError } from '../../src/core/load_error';
import { encodeExr } from '../support/exr';

const [width, height] = [37, 43];
const channels = [
  { name: 'R', value: (column: number, row: number) => Math.fround(1000.5 * column + row / 3) },
  { name: 'sun.R', value: (column: number, row: number) => Math.fround(Math.sin(column * row)) },
  { name: 'chart', isInteger: true, value: (column: number, row: number) => 4_000_000_000 + column + 100 * row },
];

function source(bytes: Buffer): { read: (first: number, count: number) => Promise<Uint8Array<ArrayBuffer>>; asked: () => number } {
  let asked = 0;
  return {
    read: async (first, count) => {
      const part = new Uint8Array(bytes.subarray(first, first + count));
      asked += part.length;
      return part;
    },
    asked: () => asked,
  };
}

describe.each(['zip', 'none'] as const)('an EXR, compression %s', (compression) => {
  const bytes = encodeExr(width, height, channels, compression);

  test.each([[0, 0], [36, 0], [5, 15], [5, 16], [36, 42], [17, 33]])('gives texel (%i, %i) to the last bit', async (column, row) => {
    const file = await ExrFile.open('test.exr', source(bytes).read);
    expect([file.width, file.height]).toEqual([width, height]);
    const texel = await file.texel(column, row);
    for (const { name, value } of channels) expect(texel.get(name)).toBe(value(column, row));
  });
});

test('of a large page only a small part is read', async () => {
  const bytes = encodeExr(512, 2048, channels);
  const { read, asked } = source(bytes);
  const file = await ExrFile.open('test.exr', read);
  await file.texel(300, 1000);
  expect(asked()).toBeLessThan(0.05 * bytes.length);
});

test('damaged files are told, wherever they end', async () => {
  const bytes = encodeExr(width, height, channels);
  for (const length of [0, 4, 9, 40, 300, 440, bytes.length - 100]) {
    await expect((async () => (await ExrFile.open('test.exr', source(bytes.subarray(0, length)).read)).texel(0, 42))(), `cut at ${length}`).rejects.toThrow(LoadError);
  }
  const wrong = Buffer.from(bytes);
  wrong.fill(7, bytes.length - 60);
  await expect((await ExrFile.open('test.exr', source(wrong).read)).texel(0, 42)).rejects.toThrow(LoadError);
});
