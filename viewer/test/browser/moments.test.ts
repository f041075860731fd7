// Moments between baked instants, and the page in German; on the synthetic bake.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { srgbDecode } from '../../src/core/units';
import { findChromium, launch, openPage } from '../support/chromium';
import { writeFixture } from '../support/fixture';
import { serve, type Host } from '../support/static_host';
import { dist, whenReady } from '../support/walkthrough_page';

const chromium = findChromium();
const size = { width: 480, height: 360 };

describe.skipIf(!chromium)('moments of the synthetic bake', () => {
  let browser: Browser;
  let folder: string;
  let host: Host;
  let page: Page;
  let problems: string[];

  beforeAll(async () => {
    folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-moments-'));
    writeFixture(folder);
    host = await serve([dist, folder]);
    browser = await launch(chromium!);
    ({ page, problems } = await openPage(browser, size));
    await whenReady(page, `${host.url}?antialias=off&lang=de`);
  });
  afterAll(async () => {
    await browser?.close();
    await host?.close();
    fs.rmSync(folder, { recursive: true, force: true });
  });

  test('half way, light and sky are the means of both instants', async () => {
    const lightAt = (moment: number) => page.evaluate(async (m) => {
      const hook = window.skybake!;
      hook.setToneMapping('none');
      hook.setPicture('lit');
      hook.setCamera([70, -85, 55], [0, 0, 4]);
      await hook.setMoment(m);
      hook.setExposure(-4); // nothing clips
      const exposure = hook.exposure();
      return { exposure, pixels: [[240, 20], [60, 300], [150, 180]].map(([x, y]) => hook.readPixels(x!, y!, 1, 1).slice(0, 3)) };
    }, moment);
    const [a, b, half] = [await lightAt(0), await lightAt(1), await lightAt(0.5)];
    expect(half.exposure / Math.sqrt(a.exposure * b.exposure)).toBeCloseTo(1, 6); // even in stops
    const radiance = (shot: typeof a, pixel: number, c: number): { value: number; step: number } => {
      const code = shot.pixels[pixel]![c]!;
      const at = (v: number): number => srgbDecode(Math.min(1, v / 255)) / shot.exposure;
      return { value: at(code), step: at(code + 1.5) - at(code) }; // rounding and dither
    };
    for (const pixel of [0, 1, 2]) {
      for (const c of [0, 1, 2]) {
        const [first, second, mean] = [radiance(a, pixel, c), radiance(b, pixel, c), radiance(half, pixel, c)];
        expect(Math.abs(mean.value - (first.value + second.value) / 2)).toBeLessThanOrEqual(mean.step + (first.step + second.step) / 2);
      }
    }
    await page.evaluate(() => window.skybake!.setToneMapping('agx'));
  });

  test('the slider fades, says that it does, and the link restores it', async () => {
    const slider = page.getByRole('slider', { name: 'Zeit, als Schieberegler' });
    await slider.focus();
    await page.evaluate(() => window.skybake!.setMoment(0));
    for (let i = 0; i < 6; ++i) await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => Math.abs(window.skybake!.view().moment - 0.3) < 1e-6);
    expect(await slider.getAttribute('aria-valuetext')).toBe('≈ 21.06.2026, 12:42'); // 0.3 of 10:00 to 19:00
    expect(await page.locator('.panel').first().textContent()).toContain('Überblendung');
    await page.waitForTimeout(500);
    expect(page.url()).toContain('&i=0&f=0.30');
    const opened = await openPage(browser, size);
    await whenReady(opened.page, page.url());
    expect(await opened.page.evaluate(() => window.skybake!.view().moment)).toBeCloseTo(0.3, 6);
    await opened.page.close();
  });

  test('the times play, until the button or the slider stops them', async () => {
    await page.evaluate(() => window.skybake!.setMoment(0));
    await page.getByRole('button', { name: 'Abspielen' }).click();
    await page.waitForFunction(() => window.skybake!.view().moment > 0.1);
    await page.getByRole('button', { name: 'Anhalten' }).click();
    const stopped = await page.evaluate(() => window.skybake!.view().moment);
    await page.waitForTimeout(500);
    expect(await page.evaluate(() => window.skybake!.view().moment)).toBeLessThanOrEqual(stopped + 0.05); // the step that was under way
  });

  test('the page speaks German', async () => {
    expect(await page.evaluate(() => document.documentElement.lang)).toBe('de');
    await page.getByRole('button', { name: 'Zu Fuß' }).click();
    expect(await page.locator('.help').textContent()).toContain('Pfeile: gehen');
    await page.getByRole('button', { name: 'Überflug' }).click();
  });

  test('the language is switched without losing the view', async () => {
    await page.evaluate(() => window.skybake!.setCamera([30, -40, 25], [0, 0, 4]));
    await page.waitForTimeout(500);
    await page.getByLabel('Sprache').selectOption('en');
    await page.getByRole('button', { name: 'Walk', exact: true }).waitFor();
    await page.evaluate(() => window.skybake!.ready);
    expect(page.url()).toContain('lang=en');
    expect(await page.evaluate(() => window.skybake!.view().position)).toEqual([30, -40, 25].map((v) => expect.closeTo(v, 1)));
  });

  test('the console stayed clean', () => expect(problems).toEqual([]));
});
