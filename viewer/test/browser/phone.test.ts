// The page on a phone: 390 × 844, touch.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { findChromium, launch } from '../support/chromium';
import { whiteCard, writeFixture } from '../support/fixture';
import { serve, type Host } from '../support/static_host';
import { dist, whenReady } from '../support/walkthrough_page';

const chromium = findChromium();

describe.skipIf(!chromium)('on a phone', () => {
  let browser: Browser;
  let folder: string;
  let host: Host;
  let page: Page;
  const problems: string[] = [];

  beforeAll(async () => {
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-phone-'));
    writeFixture(folder);
    host = await serve([dist, folder]);
    browser = await launch(chromium!);
    page = await browser.newPage({ viewport: { width: 390, height: 844 }, deviceScaleFactor: 1, hasTouch: true, isMobile: true, reducedMotion: 'reduce' });
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && problems.push(message.text()));
    page.on('pageerror', (error) => problems.push(String(error)));
    await whenReady(page, `${host.url}?antialias=off&lang=en`);
  });
  afterAll(async () => {
    await browser?.close();
    await host?.close();
    fs.rmSync(folder, { recursive: true, force: true });
  });

  test('the city comes first, the settings open over it and fit the page', async () => {
    const settings = page.getByRole('region', { name: 'Settings of the walkthrough' });
    expect(await settings.count()).toBe(0);
    await page.getByRole('button', { name: 'Settings' }).tap();
    const box = (await settings.boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(390);
    const small = await settings.getByRole('button').evaluateAll((buttons) => buttons.filter((b) => b.getBoundingClientRect().height > 0 && b.getBoundingClientRect().height < 40).map((b) => b.textContent));
    expect(small).toEqual([]);
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
  });

  test('fingers walk by the pad, and look by dragging', async () => {
    await page.getByRole('button', { name: 'Walk', exact: true }).tap();
    await page.getByRole('button', { name: 'Hide' }).tap();
    await page.evaluate(() => window.skybake!.walkFrom([-8, -40, 1.7], [-8, 0, 1.7]));
    const forward = page.getByRole('button', { name: 'Forward' });
    await forward.dispatchEvent('pointerdown', { pointerId: 5, pointerType: 'touch', isPrimary: true });
    await page.waitForFunction(() => window.skybake!.view().position[1] > -39.5);
    await forward.dispatchEvent('pointerup', { pointerId: 5, pointerType: 'touch', isPrimary: true });
  });

  test('a tap measures, and the place stays in view above the numbers', async () => {
    await page.evaluate(([x, y, z]) => window.skybake!.setCamera([x!, y! - 6, z!], [x!, y!, z!]), whiteCard.center);
    await page.touchscreen.tap(195, 422);
    const sheet = page.getByRole('region', { name: 'Measured here' });
    await sheet.getByText('card').waitFor();
    expect((await sheet.boundingBox())!.y).toBeGreaterThan(422);
  });

  test('the console stayed clean', () => expect(problems).toEqual([]));
});
