// Two bakes beside each other: the square before and after its third house was built.
import { describe, expect, test } from 'vitest';
import { momentOfOther } from '../../src/core/comparison';
import { differenceColours } from '../../src/core/false_colour';
import type { Manifest } from '../../src/core/generated/manifest';
import { serve } from '../support/static_host';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';
import { canvas, dist } from '../support/walkthrough_page';

const size = { width: 800, height: 480 };

describe.skipIf(!chromium)('two bakes', () => {
  const at = useWalkthrough({ size, isCompared: true });
  let before: Uint8Array;
  let after: Uint8Array;

  const shown = (): Promise<Uint8Array> => canvas(at.page, size.width, size.height);
  const button = (name: string): Promise<void> => at.page.getByRole('region', { name: 'Comparison of two bakes' }).getByRole('button', { name, exact: true }).click();
  /** Pixels of columns [from, to) that differ. */
  const differing = (a: Uint8Array, b: Uint8Array, from = 0, to = size.width): number => {
    let count = 0;
    for (let y = 0; y < size.height; ++y) for (let x = from; x < to; ++x) if ([0, 1, 2].some((c) => a[3 * (y * size.width + x) + c] !== b[3 * (y * size.width + x) + c])) ++count;
    return count;
  };

  test('A and B are two cities under one exposure', async () => {
    await button('A');
    before = await shown();
    await button('B');
    after = await shown();
    expect(differing(before, after)).toBeGreaterThan(2000); // the third house
    // The far corner of the square lies in the same sun with and without it.
    const corner = 3 * (330 * size.width + 30);
    expect([...before.slice(corner, corner + 3)]).toEqual([...after.slice(corner, corner + 3)]);
  });

  test('the divider shows A on its left and B on its right, by keyboard and by pointer', async () => {
    await button('Swipe');
    const divider = at.page.getByRole('slider', { name: 'Divider between A and B' });
    await divider.focus();
    await at.page.keyboard.press('Home');
    expect(differing(await shown(), after)).toBe(0);
    await at.page.keyboard.press('End');
    expect(differing(await shown(), before)).toBe(0);
    for (let i = 0; i < 5; ++i) await at.page.keyboard.press('PageDown');
    expect(await divider.getAttribute('aria-valuenow')).toBe('50');
    expect(await divider.getAttribute('aria-valuetext')).toBe('A to 50 % of the width');
    const half = await shown();
    expect(differing(half, before, 0, 400)).toBe(0);
    expect(differing(half, after, 400)).toBe(0);
    const box = (await divider.boundingBox())!;
    await at.page.mouse.move(box.x + box.width / 2, 100);
    await at.page.mouse.down();
    await at.page.mouse.move(600, 100, { steps: 4 });
    await at.page.mouse.up();
    expect(await divider.getAttribute('aria-valuenow')).toBe('75');
    expect(differing(await shown(), before, 0, 600)).toBe(0);
    expect(differing(await shown(), after, 600)).toBe(0);
  });

  test('the link restores the comparison', async () => {
    await at.linkHas('&c=swipe,0.750');
    const opened = await at.another(at.page.url());
    expect(await opened.page.getByRole('slider', { name: 'Divider between A and B' }).getAttribute('aria-valuenow')).toBe('75');
    expect(differing(await canvas(opened.page, size.width, size.height), await shown())).toBe(0);
    await opened.page.close();
  });

  test('keys: B changes sides, C shows the difference: white where nothing changed, blue in the new shadow, stripes at the new house', async () => {
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('b');
    expect(differing(await shown(), after)).toBe(0);
    await at.page.keyboard.press('b');
    expect(differing(await shown(), before)).toBe(0);
    await at.page.keyboard.press('c');
    await at.page.keyboard.press('c');
    const pixels = await shown();
    const count = (isIt: (r: number, g: number, b: number) => boolean): number => {
      let n = 0;
      for (let i = 0; i < pixels.length; i += 3) if (isIt(pixels[i]!, pixels[i + 1]!, pixels[i + 2]!)) ++n;
      return n;
    };
    const [darker, equal] = differenceColours;
    expect(count((...rgb) => rgb.every((code, c) => Math.abs(code - equal![c]!) < 25))).toBeGreaterThan(20_000); // the new house takes a little sky from all about it
    expect(count((r, g, b) => Math.abs(r - darker![0]) < 3 && Math.abs(g - darker![1]) < 3 && Math.abs(b - darker![2]) < 3)).toBeGreaterThan(300);
    expect(count((r, g, b) => Math.abs(r - 92) < 3 && Math.abs(g - 92) < 3 && Math.abs(b - 97) < 3)).toBeGreaterThan(500);
    expect(await at.page.getByRole('region', { name: 'Illuminance, B less A, lx' }).textContent()).toContain('Grey stripes');
  });

  test('a place is measured in both', async () => {
    await button('A');
    await at.page.evaluate(() => window.skybake!.setCamera([5, -10, 30], [5, -10.1, 0])); // straight down, west of the third house, whose morning shadow falls there
    const measured = (await at.page.evaluate(() => window.skybake!.measureAt(400, 240)))!;
    expect(measured.parts['sun']).toBeGreaterThan(0);
    const words = (await at.page.getByRole('region', { name: 'Measured here' }).textContent())!;
    expect(words).toContain('B less A');
    expect(words).toMatch(/−[\d,.]+ lx/);
  });

  test('a bake on another host is refused, and said', async () => {
    const opened = await at.another(`${at.host.url}?lang=en&compare=http://127.0.0.1:9/b/`, false);
    await opened.page.getByRole('alert').filter({ hasText: 'same host' }).waitFor();
    await opened.page.close();
  });

  test('bakes of one title are named by their folders, at the divider and in the bar', async () => {
    const host = await serve([dist, at.folder], (name, bytes) => (bytes && name.endsWith('manifest.json') ? Buffer.from(bytes.toString().replace(/"title": "T.*? houses"/, '"title": "Square"')) : bytes));
    const opened = await at.another(`${host.url}?antialias=off&lang=en&compare=compare/&a=before&b=after%20planning`);
    expect(await opened.page.getByRole('heading', { level: 1 }).textContent()).toBe('Square');
    expect(await opened.page.locator('.compare .side').allTextContents()).toEqual(['A: before', 'B: after planning']);
    expect(await opened.page.locator('.divider .flag').allTextContents()).toEqual(['A: before', 'B: after planning']);
    await opened.page.close();
    await host.close();
  });

  testConsole(at);
});

test('moments belong together by their labels', () => {
  const list = (...labels: string[]) => labels.map((label) => ({ label })) as unknown as Manifest['instants'];
  expect(momentOfOther(list('a', 'b', 'c'), list('b', 'c'), 1)).toBe(0);
  expect(momentOfOther(list('a', 'b', 'c'), list('b', 'c'), 1.25)).toBe(0.25);
  expect(momentOfOther(list('a', 'b', 'c'), list('c', 'b'), 1.25)).toBe(1); // not neighbours there: the nearest
  expect(momentOfOther(list('x', 'y', 'z'), list('b', 'c'), 2)).toBe(1);
});
