import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { Bake, parseManifest, parseScales } from '../../src/core/bake';
import { bytesNeededOfGlb, closeGlb } from '../../src/core/glb';
import type { Manifest } from '../../src/core/generated/manifest';
import { LoadError } from '../../src/core/load_error';
import { writeFixture } from '../support/fixture';
import { serve, type Host } from '../support/static_host';

let folder: string;
let manifest: Manifest;
let host: Host;

beforeAll(async () => {
  folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-bake-'));
  manifest = writeFixture(folder);
  host = await serve([folder]);
});

afterAll(async () => {
  await host.close();
  fs.rmSync(folder, { recursive: true });
});

describe('parseManifest', () => {
  const url = 'http://host/manifest.json';
  test('takes what follows the schema', () => expect(parseManifest(url, JSON.stringify(manifest))).toEqual(manifest));

  test.each([
    ['a missing part', { ...manifest }, 'instants'],
    ['a wrong type', { ...manifest }, 'charts'],
  ])('names the place of %s', (what, _, place) => {
    const broken: Record<string, unknown> = { ...structuredClone(manifest) };
    if (what === 'a missing part') delete broken[place];
    else broken[place] = 'many';
    expect(() => parseManifest(url, JSON.stringify(broken))).toThrow(new RegExp(place));
  });

  test('does not take numbers that no city has', () => {
    const broken = structuredClone(manifest);
    broken.instants[0]!.exposure_hint = 0;
    expect(() => parseManifest(url, JSON.stringify(broken))).toThrow(/exposure_hint/);
  });

  test('tells another version apart from a broken file', () => expect(() => parseManifest(url, '{"version": 2}')).toThrow(/version 2/));
  test('keeps the address', () => {
    expect.assertions(1);
    try {
      parseManifest(url, 'no json');
    } catch (error) {
      expect((error as LoadError).url).toBe(url);
    }
  });
});

describe('parseScales', () => {
  test('reads little-endian pairs', () => {
    const bytes = new Uint8Array([0, 0, 0x80, 0x3f, 0, 0, 0, 0x40]);
    expect([...parseScales('s', bytes, 2)]).toEqual([1, 2]);
  });
  test('refuses another number of charts', () => expect(() => parseScales('s', new Uint8Array(8), 4)).toThrow(/8 bytes where 16/));
});

describe('Bake', () => {
  test('loads an instant and counts its bytes', async () => {
    let bytes = 0;
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    const count = (more: number): number => (bytes += more);
    const light = await bake.loadInstant(1, count);
    expect(light.scales).toHaveLength(2 * manifest.charts);
    const pages = await Promise.all(manifest.pages.map((_, p) => bake.loadInstantPage(1, p, count)));
    expect(pages.every(({ sun }) => sun !== null)).toBe(true);
    expect(bytes).toBe(bake.bytesOfInstant(1));
  });

  test('without a beam the sun’s pages stay where they are', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    const instants = bake.manifest.instants.map((instant) => ({ ...instant, sun: { ...instant.sun, normal_illuminance_klx: [0, 0, 0] as [number, number, number] } }));
    const night = new Bake({ ...bake.manifest, instants }, bake.manifestUrl);
    let bytes = 0;
    const count = (more: number): number => (bytes += more);
    await night.loadInstant(0, count);
    for (const p of manifest.pages.keys()) expect((await night.loadInstantPage(0, p, count)).sun).toBeNull();
    expect(bytes).toBe(night.bytesOfInstant(0));
    expect(bytes).toBeLessThan(bake.bytesOfInstant(0)!);
  });

  test('of the city only comes what is read', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    let bytes = 0;
    const whole = await bake.fetch('city.glb', () => undefined);
    const start = await bake.fetchStart('city.glb', (count) => (bytes += count), (soFar) => bytesNeededOfGlb(soFar, ['POSITION', '_CHART']));
    const needed = bytesNeededOfGlb([whole], ['POSITION', '_CHART'])!;
    expect(bytesNeededOfGlb([whole.subarray(0, 9), whole.subarray(9, 15), whole.subarray(15)], ['POSITION', '_CHART'])).toBe(needed);
    expect(bytesNeededOfGlb([whole], ['POSITION', '_CHART', 'NORMAL'])).toBeGreaterThan(needed);
    expect(bytesNeededOfGlb([whole.subarray(0, 1000)], [])).toBeNull(); // amid its JSON
    expect(start.byteLength).toBe(bytes);
    expect(start.byteLength).toBeGreaterThanOrEqual(needed);
    expect(start.byteLength).toBeLessThan(0.9 * whole.byteLength);
    expect(Buffer.compare(start.subarray(20), whole.subarray(20, start.byteLength))).toBe(0);
    closeGlb(start);
    const words = new DataView(start.buffer);
    expect(words.getUint32(8, true)).toBe(start.byteLength);
    expect(20 + words.getUint32(12, true) + 8 + words.getUint32(20 + words.getUint32(12, true), true)).toBe(start.byteLength);
  });

  test('loads the lamps, and none where there are none', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    expect(await bake.loadLampScales(() => undefined)).toHaveLength(manifest.charts);
    let bytes = 0;
    for (const p of manifest.pages.keys()) await bake.loadLampPage(p, (count) => (bytes += count));
    expect(bytes).toBe(bake.bytesOfLamps());
    expect(bake.partsOf(0)).toEqual(['sun', 'sky', 'lamps']);
    const { lamp_scales, ...dark } = bake.manifest;
    expect(lamp_scales).toBeDefined();
    const day = new Bake(dark, bake.manifestUrl);
    expect(await day.loadLampScales(() => undefined)).toBeNull();
    expect(day.partsOf(0)).toEqual(['sun', 'sky']);
  });

  test('a file of another size than announced is a damaged copy', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    const cut = new Bake({ ...bake.manifest, files: bake.manifest.files.map((f) => (f.name === 'light/i0_scales.bin' ? { ...f, bytes: f.bytes + 1 } : f)) }, bake.manifestUrl);
    await expect(cut.loadInstant(0, () => undefined)).rejects.toThrow(/Copy the bake again/);
  });

  test('a missing file is told with its address', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    await expect(bake.fetch('light/none.png', () => undefined)).rejects.toMatchObject({ url: `${host.url}light/none.png` });
  });

  test('an overtaken load stops', async () => {
    const bake = await Bake.load(`${host.url}manifest.json`, () => undefined);
    const abort = new AbortController();
    const loading = bake.loadInstant(0, () => undefined, abort.signal);
    abort.abort();
    await expect(loading).rejects.toMatchObject({ name: 'AbortError' });
  });
});
