// What keyboards, screen readers, fingers and tired eyes need: axe-core's rules (WCAG 2.2 A and AA) and what no rule can see, on a desktop and on a phone.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import type { Page } from 'playwright-core';
import { describe, expect, test } from 'vitest';
import { chromium, testConsole, useWalkthrough, type Walkthrough } from '../support/walkthrough';

const axe = fs.readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface Violation { id: string; nodes: { target: string[]; failureSummary?: string }[] }

/** Faults that axe finds. The picture behind is white: the worst that half-clear panels can stand on. */
async function faultsOf(page: Page): Promise<string[]> {
  await page.addStyleTag({ content: 'body > canvas { opacity: 0 } html, body { background: #fff !important }' });
  await page.evaluate(axe);
  const violations = await page.evaluate(async () => {
    const run = (window as unknown as { axe: { run(context: Document, options: object): Promise<{ violations: Violation[] }> } }).axe.run;
    return (await run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'], rules: { region: { enabled: false } } })).violations;
  });
  return violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(' ')} ${failureSummary ?? ''}`));
}

/** What Tab comes to, until it has come round or out of the page. */
async function tabStops(page: Page): Promise<{ name: string; isSeen: boolean; isOutlined: boolean; top: number; region: string }[]> {
  await page.locator('body > canvas').focus(); // the first of all
  await page.keyboard.press('Shift+Tab');
  const stops = [];
  for (let i = 0; i < 100; ++i) {
    await page.keyboard.press('Tab');
    const stop = await page.evaluate(() => {
      const at = document.activeElement as HTMLElement | null;
      if (!at || at === document.body) return null;
      const again = at.dataset['visited'] === 'yes';
      at.dataset['visited'] = 'yes';
      const box = at.getBoundingClientRect();
      const style = getComputedStyle(at);
      return {
        again,
        name: at.getAttribute('aria-label') ?? (at as HTMLInputElement).labels?.[0]?.textContent ?? at.textContent ?? '',
        isSeen: box.width > 0 && box.height > 0 && box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth,
        isOutlined: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
        top: box.top,
        region: at.closest('section')?.getAttribute('aria-label') ?? '',
      };
    });
    if (!stop || stop.again) break;
    stops.push(stop);
  }
  return stops;
}

/** All that the page can show at once. */
async function openAll(at: Walkthrough): Promise<void> {
  await at.page.evaluate(() => {
    window.skybake!.setFactor('sun', 0.5);
    window.skybake!.setPicture('illuminance');
    document.querySelectorAll('details').forEach((details) => (details.open = true));
  });
}

describe.skipIf(!chromium).each([
  ['a desktop, in English', { size: { width: 1280, height: 720 }, query: 'lang=en' }, 'en'],
  ['a desktop that compares, in German', { size: { width: 1280, height: 720 }, query: 'lang=de', isCompared: true }, 'de'],
  ['a phone, in German', { size: { width: 390, height: 844 }, query: 'lang=de', isPhone: true }, 'de'],
] as const)('on %s', (_, options, language) => {
  const at = useWalkthrough(options);

  test('the page names its language', async () => expect(await at.page.evaluate(() => document.documentElement.lang)).toBe(language));

  test('axe finds no fault: the city first, all settings, on foot, numbers, help', async () => {
    expect(await faultsOf(at.page)).toEqual([]);
    if ('isPhone' in options) await at.page.locator('.open-panel').tap();
    await openAll(at);
    await at.page.locator('#view-name').fill('Rathaus');
    await at.page.keyboard.press('Enter');
    expect(await faultsOf(at.page)).toEqual([]);
    await at.page.evaluate(() => window.skybake!.setLayer('sun_hours_change'));
    await at.page.evaluate(() => window.skybake!.walkFrom([-8, -40, 1.7], [-8, 0, 1.7]));
    if ('isPhone' in options) await at.page.keyboard.press('h');
    await at.page.evaluate(() => window.skybake!.measureAt(190, 600));
    expect(await faultsOf(at.page)).toEqual([]);
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('?');
    await at.page.getByRole('dialog').waitFor();
    expect(await faultsOf(at.page)).toEqual([]);
    await at.page.keyboard.press('Escape');
    await at.page.keyboard.press('Escape');
    expect(await at.page.locator('.measure').isVisible()).toBe(false);
  }, 240_000);

  test('Tab reaches every control once, in the order of the page, visibly, and leaves again', async () => {
    if ('isPhone' in options) await at.page.keyboard.press('h');
    const stops = await tabStops(at.page);
    const wanted = await at.page.evaluate(() => Array.from(document.querySelectorAll<HTMLElement>('button, select, input, summary, [tabindex="0"]'))
      .filter((control) => control.checkVisibility() && !(control as HTMLButtonElement).disabled).length);
    expect(stops.length).toBe(wanted);
    expect(stops.filter(({ name }) => name.trim() === '')).toEqual([]);
    expect(stops.filter(({ isSeen }) => !isSeen)).toEqual([]);
    expect(stops.filter(({ isOutlined }) => !isOutlined)).toEqual([]);
    // A region is gone through as a whole before the next one begins.
    const regions = stops.map(({ region }) => region).filter((region, i, all) => region !== '' && region !== all[i - 1]);
    expect(regions).toEqual([...new Set(regions)]);
  });

  test('every control is large enough to be met: 24 pixels, 40 on a phone where buttons and lists are concerned', async () => {
    const small = await at.page.evaluate((least) => Array.from(document.querySelectorAll<HTMLElement>('button, select, input, summary'))
      .filter((control) => control.checkVisibility())
      .map((control) => ({ control, box: control.getBoundingClientRect() }))
      .filter(({ control, box }) => {
        // A box or a slider is met by its row as well.
        const row = control.matches('input[type=checkbox]') ? control.parentElement!.getBoundingClientRect() : box;
        const wanted = control.matches('button, select') && !control.closest('.minimap, .stick') ? least : 24;
        return row.height < wanted || row.width < 24;
      })
      .map(({ control, box }) => `${control.outerHTML.slice(0, 80)} ${box.width} × ${box.height}`), 'isPhone' in options ? 40 : 24);
    expect(small).toEqual([]);
  });

  test('nothing is cut off or lies beyond the page', async () => {
    const cut = await at.page.evaluate(() => Array.from(document.querySelectorAll<HTMLElement>('button:not(.go), label, legend, h1, h2, h3, p, dt, dd, th, td, summary'))
      .filter((words) => words.checkVisibility() && !words.matches('.said, .progress') && (words.scrollWidth > words.clientWidth + 1 && getComputedStyle(words).display !== 'inline'))
      .map((words) => `${words.tagName} ${words.textContent}`));
    expect(cut).toEqual([]);
    expect(await at.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth)).toBe(true);
  });

  testConsole(at);
});

describe.skipIf(!chromium)('motion', () => {
  const at = useWalkthrough({ size: { width: 640, height: 480 } });
  /** Places that the eye is at on its way to the first view. */
  const stations = (page: Page): Promise<number> => page.evaluate(async () => {
    window.skybake!.setCamera([0, -60, 120], [0, 0, 0]);
    const select = document.querySelector<HTMLSelectElement>('#view')!;
    select.value = '0';
    select.dispatchEvent(new Event('change'));
    const seen = new Set<string>();
    const deadline = performance.now() + 30_000;
    for (let at = 0; Math.abs(at - 70) > 0.01 && performance.now() < deadline; await new Promise((resolve) => setTimeout(resolve, 20))) {
      at = window.skybake!.view().position[0];
      seen.add(at.toFixed(1));
    }
    return seen.size;
  });

  test('who wants less motion is there at once; others fly', async () => {
    expect(await stations(at.page)).toBe(1);
    await at.page.emulateMedia({ reducedMotion: 'no-preference' });
    expect(await stations(at.page)).toBeGreaterThan(3);
  });
});
