// How a large bake comes in: the first picture with the first page, the rest one by one, and what happens when one is missing.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { findChromium, launch, openPage } from '../support/chromium';
import { writeFixture } from '../support/fixture';
import { serve, type Host } from '../support/static_host';
import { canvas, dist, whenReady } from '../support/walkthrough_page';

const size = { width: 320, height: 180 };
const chromium = findChromium();
/** From above: the ground lies on page 0, the houses on page 1. */
const camera = '#v=1&m=orbit&p=70,-85,55&t=0,0,4&s=lit&i=0&ev=0';

const meanOf = (pixels: Uint8Array): number => pixels.reduce((sum, value) => sum + value, 0) / pixels.length;

describe.skipIf(!chromium)('a bake that is loading', () => {
  let browser: Browser;
  let folder: string;

  beforeAll(async () => {
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-loading-'));
    writeFixture(folder);
    browser = await launch(chromium!);
  });
  afterAll(async () => {
    await browser?.close();
    fs.rmSync(folder, { recursive: true, force: true });
  });

  /** Opens the walkthrough and keeps back the files that are named, until they are let through or refused. */
  async function openWithout(held: RegExp, query = ''): Promise<{ page: Page; host: Host; letThrough: () => Promise<void>; refuse: () => Promise<void>; problems: string[] }> {
    const host = await serve([dist, folder]);
    const { page, problems } = await openPage(browser, size);
    const kept: (() => Promise<void>)[] = [];
    let outcome: 'wait' | 'continue' | 'refuse' = 'wait';
    await page.route((url) => held.test(url.pathname), async (route) => {
      const end = (): Promise<void> => (outcome === 'refuse' ? route.fulfill({ status: 404, body: '' }) : route.continue());
      if (outcome === 'wait') kept.push(end);
      else await end();
    });
    const release = (what: 'continue' | 'refuse') => async (): Promise<void> => {
      outcome = what;
      await Promise.all(kept.map((end) => end()));
    };
    await page.goto(`${host.url}?antialias=off${query}${camera}`);
    await page.waitForFunction(() => (window.skybake?.stats().frames ?? 0) > 0);
    return { page, host, letThrough: release('continue'), refuse: release('refuse'), problems };
  }

  test('shows a first picture before all pages are there, then the whole', async () => {
    const { page, host, letThrough, problems } = await openWithout(/_p1_(sky|sun)\.png$/);
    const early = await canvas(page, size.width, size.height);
    const progress = page.locator('.progress progress');
    expect(await progress.isVisible()).toBe(true);
    expect(await page.locator('.progress').first().textContent()).toMatch(/Loading the light of .*: \d+(\.\d+)? .*of \d+(\.\d+)? [kM]B/);
    await letThrough();
    await page.evaluate(() => window.skybake!.ready);
    expect(await progress.isVisible()).toBe(false);
    const whole = await canvas(page, size.width, size.height);
    await page.close();

    const { page: calm } = await openPage(browser, size);
    await whenReady(calm, `${host.url}?antialias=off${camera}`);
    expect(Buffer.compare(Buffer.from(whole), Buffer.from(await canvas(calm, size.width, size.height)))).toBe(0);
    await calm.close();
    await host.close();
    expect(problems).toEqual([]);
    // The houses wait for their light: neither black nor blinding, the picture as bright as the whole one to a fifth.
    expect(Buffer.compare(Buffer.from(early), Buffer.from(whole))).not.toBe(0);
    expect(Math.abs(meanOf(early) / meanOf(whole) - 1)).toBeLessThan(0.2);
    const darkest = (pixels: Uint8Array): number => pixels.filter((value) => value < 12).length / pixels.length;
    expect(darkest(early)).toBeLessThanOrEqual(darkest(whole) + 0.001);
  });

  test('is told in German, too', async () => {
    const { page, host, letThrough } = await openWithout(/_p1_(sky|sun)\.png$/, '&lang=de');
    expect(await page.locator('.progress').first().textContent()).toMatch(/\d+(,\d+)? .*von \d+(,\d+)? [kM]B/);
    await letThrough();
    await page.evaluate(() => window.skybake!.ready);
    await page.close();
    await host.close();
  });

  test('a page that is missing later is told with its address', async () => {
    const { page, host, refuse } = await openWithout(/i0_p1_sky\.png$/);
    await refuse();
    const alert = page.getByRole('alert').filter({ hasText: 'no such file' });
    await alert.waitFor();
    expect(await alert.textContent()).toContain(`${host.url}light/i0_p1_sky.png`);
    await page.close();
    await host.close();
  });

  test('what is dropped is freed, and a city is few draw calls', async () => {
    const host = await serve([dist, folder]);
    const { page } = await openPage(browser, size);
    await whenReady(page, `${host.url}?antialias=off${camera}`);
    const stats = await page.evaluate(() => {
      window.skybake!.renderFrame();
      return window.skybake!.stats();
    });
    // Surfaces with and without textures, and the sky.
    expect(stats.drawCalls).toBe(3);
    expect(stats.primitives).toBe(4);
    // 2 pages of 256² texels and a level of a quarter: light and lamps, 4 bytes each; the rest is panorama and scales.
    const pages = 2 * (256 * 256 + 128 * 128) * 4;
    expect(stats.lightBytes).toBeGreaterThanOrEqual(2 * pages);
    expect(stats.lightBytes).toBeLessThan(2 * pages + 512 * 128 * 8 + 2048 * 16 + 1);
    // An instant that was overtaken leaves nothing behind.
    const { textures, geometries } = stats;
    const after = await page.evaluate(async () => {
      const hook = window.skybake!;
      const overtaken = hook.setInstant(1);
      await hook.setInstant(0);
      await overtaken;
      hook.renderFrame();
      return hook.stats();
    });
    expect(after).toMatchObject({ textures, geometries });
    await page.close();
    await host.close();
  });
});
