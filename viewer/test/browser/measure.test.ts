// Numbers: what a click says, on the synthetic bake; and against `skybake probe` on the bake that was given (SKYBAKE_PROGRAM, SKYBAKE_CITY).
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { describe, expect, test } from 'vitest';
import { colourOf } from '../../src/core/false_colour';
import type { Manifest } from '../../src/core/generated/manifest';
import { luminance } from '../../src/core/units';
import type { Measured } from '../../src/app/reading';
import { launch, openPage } from '../support/chromium';
import { fixtureBeam, whiteCard } from '../support/fixture';
import { serve } from '../support/static_host';
import { dist, whenReady } from '../support/walkthrough_page';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';

const size = { width: 640, height: 480 };

describe.skipIf(!chromium)('measuring in the synthetic bake', () => {
  const at = useWalkthrough({ size });

  const lookAtCard = (distance = 3): Promise<void> =>
    at.page.evaluate(([x, y, z, d]) => window.skybake!.setCamera([x!, y! - d!, z!], [x!, y!, z!]), [...whiteCard.center, distance]);
  const cardLx = {
    sun: 1000 * whiteCard.sunCosine * luminance(fixtureBeam),
    sky: 1000 * luminance(whiteCard.skyKlx),
    lamps: 1000 * luminance(whiteCard.lampKlx),
  };

  test('a click on the white card tells its light, part by part, from the archive', async () => {
    await lookAtCard();
    await at.page.mouse.click(size.width / 2, size.height / 2);
    const panel = at.page.getByRole('region', { name: 'Measured here' });
    await panel.getByText('sky view factor', { exact: false }).waitFor();
    const measured = (await at.page.evaluate(() => window.skybake!.measureAt(320, 240)))!;
    for (const [part, lx] of Object.entries(cardLx)) expect(measured.parts[part]! / lx).toBeCloseTo(1, 5); // 32-bit files
    expect(measured.lx / (cardLx.sun + cardLx.sky + cardLx.lamps)).toBeCloseTo(1, 5);
    expect(measured).toMatchObject({ id: 'card', reflectance: 1, isFilled: false });
    const words = (await panel.textContent())!;
    for (const lx of Object.values(cardLx)) expect(words).toContain(new Intl.NumberFormat('en', { maximumSignificantDigits: 4 }).format(lx));
    expect(words).toContain('south');
  });

  test('a house tells its id and attributes', async () => {
    await at.page.evaluate(() => window.skybake!.setCamera([16, -45, 12], [16, -30, 12])); // the south wall of the third house
    const measured = await at.page.evaluate(() => window.skybake!.measureAt(320, 240));
    expect(measured).toMatchObject({ id: 'house-3' });
    const panel = at.page.getByRole('region', { name: 'Measured here' });
    await panel.getByText('Attributes (2)').click();
    expect(await panel.textContent()).toContain('House “3”');
  });

  test('the sun path shows the wall itself, its neighbours and the sun', async () => {
    const chart = at.page.getByRole('img', { name: /Sun in view on/ });
    expect(await chart.count()).toBe(1);
    const shapes = await chart.evaluate((svg) => ({ behind: svg.querySelector('.behind')!.getAttribute('d')!.length, paths: svg.querySelectorAll('.path').length, hours: svg.querySelectorAll('.hour').length }));
    expect(shapes.behind).toBeGreaterThan(1000); // half the sky is behind a wall
    expect(shapes.paths).toBe(4);
    expect(shapes.hours).toBeGreaterThanOrEqual(4);
  });

  test('by keyboard: M measures the middle, focus goes into the panel, Escape closes it and gives the focus back', async () => {
    await at.page.keyboard.press('Escape');
    await lookAtCard();
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('m');
    const panel = at.page.getByRole('region', { name: 'Measured here' });
    await panel.getByText('lx').first().waitFor();
    expect(await at.page.evaluate(() => document.activeElement?.textContent)).toBe('Close');
    await at.page.keyboard.press('Escape');
    expect(await panel.count()).toBe(0);
    expect(await at.page.evaluate(() => document.activeElement?.tagName)).toBe('CANVAS');
  });

  test('a drag measures nothing, and neither does the sky', async () => {
    await at.page.mouse.move(300, 200);
    await at.page.mouse.down();
    await at.page.mouse.move(340, 220, { steps: 3 });
    await at.page.mouse.up();
    expect(await at.page.getByRole('region', { name: 'Measured here' }).count()).toBe(0);
    await at.page.evaluate(() => window.skybake!.setCamera([0, -50, 40], [0, -60, 60]));
    expect(await at.page.evaluate(() => window.skybake!.measureAt(320, 20))).toBeNull();
  });

  test('false colours are those of the legend and of the stills', async () => {
    await lookAtCard();
    const scale = { low: 1000, high: 100000, isLogarithmic: true };
    await at.page.evaluate((s) => {
      window.skybake!.setPicture('illuminance');
      window.skybake!.setScale(s);
    }, scale);
    const pixel = await at.page.evaluate(() => window.skybake!.readPixels(320, 240, 1, 1));
    const expected = colourOf(scale, cardLx.sun + cardLx.sky + cardLx.lamps);
    for (const c of [0, 1, 2] as const) expect(Math.abs(pixel[c]! - expected[c])).toBeLessThanOrEqual(1.5); // 8-bit light: half a percent of a decade or two, and rounding
    const legend = at.page.getByRole('region', { name: 'Illuminance, lx' });
    expect(await legend.locator('.ticks').textContent()).toBe('1,0002,0005,00010,00020,00050,000100,000');
    await at.linkHas('&s=illuminance');
    await at.linkHas('&fc=1000,100000,log');
    await legend.getByLabel('to', { exact: true }).fill('500');
    await legend.getByLabel('to', { exact: true }).blur();
    expect(await legend.textContent()).toContain('a lower and a higher number');
  });

  test('the sky view is a picture, too', async () => {
    await at.page.evaluate(() => window.skybake!.setPicture('sky-view'));
    const expected = colourOf({ low: 0, high: 1, isLogarithmic: false }, Math.round(255 * 0.4) / 255);
    const offBy = async (): Promise<number> => {
      const pixel = await at.page.evaluate(() => window.skybake!.readPixels(320, 240, 1, 1));
      return Math.max(...([0, 1, 2] as const).map((c) => Math.abs(pixel[c]! - expected[c])));
    };
    // The picture before stays until the pages of this one have come.
    await expect.poll(offBy).toBeLessThanOrEqual(1);
    await at.page.evaluate(() => window.skybake!.setPicture('lit'));
  });

  test('a host without ranges gives the same numbers; a missing archive is told with its address', async () => {
    const plain = await serve([dist, at.folder], (name, bytes) => (name === 'light/i1_p1.exr' ? null : bytes), false);
    const opened = await openPage(at.browser, size);
    try {
      await whenReady(opened.page, `${plain.url}?antialias=off&lang=en`);
      await opened.page.evaluate(([x, y, z]) => window.skybake!.setCamera([x!, y! - 3, z!], [x!, y!, z!]), whiteCard.center);
      const measured = (await opened.page.evaluate(() => window.skybake!.measureAt(320, 240)))!;
      expect(measured.parts['sun']! / cardLx.sun).toBeCloseTo(1, 5);
      expect(opened.problems).toEqual([]);
      await opened.page.evaluate(async () => {
        await window.skybake!.setInstant(1);
        await window.skybake!.measureAt(320, 240);
      });
      const alert = opened.page.getByRole('alert').filter({ hasText: 'light/i1_p1.exr' });
      expect(await alert.textContent()).toContain('no such file');
    } finally {
      await opened.page.close();
      await plain.close();
    }
  });

  testConsole(at);
});

const bake = process.env['SKYBAKE_BAKE'];
const program = process.env['SKYBAKE_PROGRAM'];
const city = process.env['SKYBAKE_CITY'];
const canProbe = chromium && bake && program && city;
if (!canProbe) console.warn('measuring against `skybake probe`: skipped, needs a bake folder, SKYBAKE_PROGRAM and SKYBAKE_CITY (the bake’s city file)');

describe.skipIf(!canProbe)('measuring in a real bake', () => {
  test('is what `skybake probe` computes at the same points, within 1 %', async () => {
    const manifest = JSON.parse(fs.readFileSync(path.join(bake!, 'manifest.json'), 'utf8')) as Manifest;
    const host = await serve([dist, bake!]);
    const browser = await launch(chromium!);
    const found: Measured[] = [];
    try {
      const { page, problems } = await openPage(browser, size);
      await whenReady(page, `${host.url}?antialias=off`);
      for (const view of manifest.views) {
        await page.evaluate(([p, t]) => window.skybake!.setCamera(p, t), [view.position, view.target] as unknown as [[number, number, number], [number, number, number]]);
        for (let y = 60; y < size.height; y += 120) {
          for (let x = 60; x < size.width; x += 120) {
            const measured = await page.evaluate(([px, py]) => window.skybake!.measureAt(px!, py!), [x, y]);
            if (measured && !measured.isFilled) found.push(measured);
          }
        }
      }
      expect(problems).toEqual([]);
    } finally {
      await browser.close();
      await host.close();
    }
    expect(found.length).toBeGreaterThan(15);
    const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-probe-'));
    const points = path.join(scratch, 'points.csv');
    fs.writeFileSync(points, ['id,x,y,z,nx,ny,nz', ...found.map(({ pointCsv }, i) => pointCsv.split('\n')[1]!.replace('measured', `m${i}`))].join('\n') + '\n');
    const options = ['site', 'sky', 'sky-samples', 'lamps', 'sun'].flatMap((name) => {
      const value = manifest.settings[name];
      return value ? [`--${name}`, name === 'lamps' ? path.join(path.dirname(city!), value) : value] : []; // lamps lie beside the city
    });
    const csv = execFileSync(program!, ['probe', city!, '--points', points, '--at', manifest.instants[0]!.label, ...options, '--quiet'], { encoding: 'utf8' });
    fs.rmSync(scratch, { recursive: true, force: true });
    const [header, ...rows] = csv.trim().split('\n').map((line) => line.split(','));
    let compared = 0;
    rows.forEach((row, i) => {
      const value = (name: string): number => Number(row[header!.indexOf(name)]);
      const { parts } = found[i]!;
      // Direct light: reflected light comes from photons that a probe of a few points shoots anew.
      const direct = parts['sun']! + parts['sky']! + (parts['lamps'] ?? 0);
      const isAtShadowEdge = value('sun_lx') > 0 !== parts['sun']! > 0 || Math.abs(value('sun_lx') - parts['sun']!) > 0.02 * parts['sun']!; // a texel holds the mean over its area
      if (isAtShadowEdge) return;
      ++compared;
      expect(Math.abs(value('sun_lx') + value('sky_lx') + value('lamps_lx') - direct), `point ${i}`).toBeLessThanOrEqual(0.01 * direct);
      expect(Math.abs(value('sky_view_factor') - found[i]!.skyViewFactor)).toBeLessThanOrEqual(0.01);
    });
    console.log(`${compared} of ${found.length} points compared, the others lie at the edge of a shadow`);
    expect(compared).toBeGreaterThan(0.8 * found.length);
  });
});
