// Moments between baked instants, and the page in German; on the synthetic bake.
import { describe, expect, test } from 'vitest';
import { srgbDecode } from '../../src/core/units';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';

const size = { width: 480, height: 360 };

describe.skipIf(!chromium)('moments of the synthetic bake', () => {
  const at = useWalkthrough({ size, query: 'lang=de' });

  test('half way, light and sky are the means of both instants', async () => {
    const lightAt = (moment: number) => at.page.evaluate(async (m) => {
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
    await at.page.evaluate(() => window.skybake!.setToneMapping('agx'));
  });

  test('the slider fades, says that it does, and the link restores it', async () => {
    const slider = at.page.getByRole('slider', { name: 'Zeit, als Schieberegler' });
    await slider.focus();
    await at.page.evaluate(() => window.skybake!.setMoment(0));
    for (let i = 0; i < 6; ++i) await at.page.keyboard.press('ArrowRight');
    await at.page.waitForFunction(() => Math.abs(window.skybake!.view().moment - 0.3) < 1e-6);
    expect(await slider.getAttribute('aria-valuetext')).toBe('≈ 21.06.2026, 12:42'); // 0.3 of 10:00 to 19:00
    expect(await at.page.locator('.panel').first().textContent()).toContain('Überblendung');
    await at.linkHas('&i=0&f=0.30');
    const opened = await at.another(at.page.url());
    expect(await opened.page.evaluate(() => window.skybake!.view().moment)).toBeCloseTo(0.3, 6);
    await opened.page.close();
  });

  test('the times play, until the button or the slider stops them', async () => {
    await at.page.evaluate(() => window.skybake!.setMoment(0));
    await at.page.getByRole('button', { name: 'Abspielen' }).click();
    await at.page.waitForFunction(() => window.skybake!.view().moment > 0.1);
    await at.page.getByRole('button', { name: 'Anhalten' }).click();
    const stopped = await at.page.evaluate(() => window.skybake!.view().moment);
    await at.page.waitForTimeout(500);
    expect(await at.page.evaluate(() => window.skybake!.view().moment)).toBeLessThanOrEqual(stopped + 0.05); // the step that was under way
  });

  test('the page speaks German', async () => {
    expect(await at.page.evaluate(() => document.documentElement.lang)).toBe('de');
    await at.page.getByRole('button', { name: 'Zu Fuß' }).click();
    expect(await at.page.locator('.help').textContent()).toContain('Pfeile: gehen');
    await at.page.getByRole('button', { name: 'Überflug' }).click();
  });

  test('the language is switched without losing the view', async () => {
    await at.page.evaluate(() => window.skybake!.setCamera([30, -40, 25], [0, 0, 4]));
    await at.linkHas('&p=30.00,-40.00,25.00&');
    await at.page.getByLabel('Sprache').selectOption('en');
    await at.page.getByRole('button', { name: 'Walk', exact: true }).waitFor();
    await at.page.evaluate(() => window.skybake!.ready);
    expect(at.page.url()).toContain('lang=en');
    expect(await at.page.evaluate(() => window.skybake!.view().position)).toEqual([30, -40, 25].map((v) => expect.closeTo(v, 1)));
  });

  testConsole(at);
});
