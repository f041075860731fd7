// The same link in the walkthrough and in `skybake render`: geometry, exposure and colour of both pictures.
// Runs on the bake that was given, with the program that SKYBAKE_PROGRAM names; both pictures land side by side in test/out/.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import type { Manifest } from '../../src/core/generated/manifest';
import { wholeLight } from '../../src/core/light_parts';
import type { Vec3 } from '../../src/core/units';
import { formatViewState } from '../../src/core/view_state';
import { findChromium, launch, openPage } from '../support/chromium';
import { decodePng, encodePng } from '../support/png';
import { serve, type Host } from '../support/static_host';
import { canvas, dist, outFolder, whenReady } from '../support/walkthrough_page';

const bake = process.env['SKYBAKE_BAKE'];
const program = process.env['SKYBAKE_PROGRAM'];
const chromium = findChromium();
const size = { width: 640, height: 360 };
const gap = 8;

/**
 * Of 255, over all channels. Measured on the old town, the FZK house, The Hague and Rotterdam (docs/validation.md): means to 1.6, p95 to 9, where a
 * fine texture is filtered in two ways; besides, a card takes 4 samples at edges and its lightmaps have 8 bit. A tenth of a stop would be 3 everywhere.
 */
const bounds = { mean: 2, p95: 12 };

if (!bake || !program) console.warn('walkthrough against `skybake render`: skipped, needs a bake folder and SKYBAKE_PROGRAM');

describe.skipIf(!chromium || !bake || !program)('the walkthrough and the still', () => {
  let browser: Browser;
  let host: Host;
  let manifest: Manifest;

  beforeAll(async () => {
    manifest = JSON.parse(fs.readFileSync(path.join(bake!, 'manifest.json'), 'utf8')) as Manifest;
    host = await serve([dist, bake!]);
    browser = await launch(chromium!);
  });
  afterAll(async () => {
    await browser?.close();
    await host?.close();
  });

  test.each([
    ['from the air', 'orbit', 'lit', 0],
    ['from the air, textures', 'orbit', 'textures', 0],
    ['from the air, light, darker', 'orbit', 'light', -1],
    ['on foot', 'walk', 'lit', 0.5],
    ['on foot, last instant', 'walk', 'lit', 0],
  ] as const)('show the same: %s', async (name, mode, picture, ev) => {
    const view = manifest.views.at(mode === 'walk' ? -1 : 0);
    expect(view, 'the bake needs saved views').toBeDefined();
    const instant = name.endsWith('last instant') ? manifest.instants.length - 1 : 0;
    const [position, target] = [view!.position, view!.target] as [Vec3, Vec3];
    const { page, problems } = await openPage(browser, size);
    await whenReady(page, host.url + formatViewState({ mode, position, target, picture, moment: instant, ev, air: true, mix: wholeLight, layer: null, scale: null, comparison: null }));
    const shown = await canvas(page, size.width, size.height);
    // The walkthrough has its own will (feet on the ground, no view from below): its link says what it came to.
    const link = formatViewState({ ...(await page.evaluate(() => window.skybake!.view())), ev, air: true, mix: wholeLight, layer: null, scale: null, comparison: null });
    await page.close();
    expect(problems).toEqual([]);

    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-still-'));
    const file = path.join(folder, 'still.png');
    execFileSync(program!, ['render', bake!, '-o', file, '--camera', link, '--size', `${size.width}x${size.height}`, '--quiet']);
    const still = decodePng(fs.readFileSync(file)).pixels;
    fs.rmSync(folder, { recursive: true, force: true });

    fs.mkdirSync(outFolder, { recursive: true });
    fs.writeFileSync(path.join(outFolder, `still ${name}.png`.replaceAll(/[ ,]+/g, '-')), sideBySide(shown, still));
    const found = difference(shown, still, 0, 0);
    console.log(`${name}: mean ${found.mean.toFixed(2)}, p95 ${found.p95}, p99 ${found.p99}, max ${found.max} of 255`);
    expect(found.mean).toBeLessThanOrEqual(bounds.mean);
    expect(found.p95).toBeLessThanOrEqual(bounds.p95);
    // Geometry: shifted by one pixel any way, the pictures fit worse.
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) expect(difference(shown, still, dx, dy).mean).toBeGreaterThan(found.mean);
  });
});

/** Absolute differences of a against b moved by (dx, dy), over the part that both have. */
function difference(a: Uint8Array, b: Uint8Array, dx: number, dy: number): { mean: number; p95: number; p99: number; max: number } {
  const counts = new Array<number>(256).fill(0);
  for (let y = 1; y < size.height - 1; ++y) {
    for (let i = 3; i < 3 * (size.width - 1); ++i) {
      const at = Math.abs(a[3 * y * size.width + i]! - b[3 * ((y + dy) * size.width + dx) + i]!);
      counts[at] = counts[at]! + 1;
    }
  }
  const total = counts.reduce((sum, count) => sum + count, 0);
  const quantile = (share: number): number => {
    let left = share * total;
    return counts.findIndex((count) => (left -= count) <= 0);
  };
  return { mean: counts.reduce((sum, count, at) => sum + count * at, 0) / total, p95: quantile(0.95), p99: quantile(0.99), max: quantile(1) };
}

/** The walkthrough on the left, the still on the right. */
function sideBySide(left: Uint8Array, right: Uint8Array): Buffer {
  const width = 2 * size.width + gap;
  const pixels = new Uint8Array(3 * width * size.height).fill(255);
  for (let y = 0; y < size.height; ++y) {
    pixels.set(left.subarray(3 * y * size.width, 3 * (y + 1) * size.width), 3 * y * width);
    pixels.set(right.subarray(3 * y * size.width, 3 * (y + 1) * size.width), 3 * (y * width + size.width + gap));
  }
  return encodePng({ width, height: size.height, channels: 3, pixels });
}
