// What a study found out, as layers; and light by parts: pictures of numbers that say what they show. On the synthetic bake.
import fs from 'node:fs';
import path from 'node:path';
import { describe, expect, test } from 'vitest';
import { parseManifest } from '../../src/core/bake';
import { layerColour, rampOf, rampSize, scaleOf } from '../../src/core/layer_colours';
import { whiteCard } from '../support/fixture';
import { cardLayers } from '../support/fixture_layers';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';

const size = { width: 640, height: 480 };

describe.skipIf(!chromium)('layers of a study', () => {
  const at = useWalkthrough({ size });
  const manifest = () => parseManifest('manifest.json', fs.readFileSync(path.join(at.folder, 'manifest.json'), 'utf8'));
  const lookAtCard = () => at.page.evaluate(([x, y, z]) => window.skybake!.setCamera([x, y - 3, z], [x, y, z]), whiteCard.center);
  const middle = () => at.page.evaluate(() => window.skybake!.readPixels(320, 240, 1, 1).slice(0, 3));

  test.each(Object.entries(cardLayers))('%s: the card has its colour, and a click its very number', async (id, value) => {
    await lookAtCard();
    await at.page.getByRole('combobox', { name: 'Layer of the study' }).selectOption(id);
    const layer = manifest().layers!.find((known) => known.id === id)!;
    // Of the grey level that the picture holds.
    const stored = layer.minimum + ((layer.maximum - layer.minimum) * Math.round((255 * (value - layer.minimum)) / (layer.maximum - layer.minimum))) / 255;
    const expected = layerColour(layer, scaleOf(layer), stored).map((code) => expect.closeTo(code, -0.3)); // within 1
    await expect.poll(middle).toEqual(expected);
    const measured = (await at.page.evaluate(() => window.skybake!.measureAt(320, 240)))!;
    expect(measured.layer).toEqual({ id, value });
  });

  test('steps have a legend of steps with the unit; a difference has 0 in its middle', async () => {
    await at.page.evaluate(() => window.skybake!.setLayer('sun_hours_2026-03-21'));
    const hours = at.page.getByRole('region', { name: 'Sun hours, 21 March 2026, h' });
    expect(await hours.locator('.ticks span').allTextContents()).toEqual(['0', '1', '2', '4', '6', '8', '12']);
    await at.page.evaluate(() => window.skybake!.setLayer('sun_hours_change'));
    const change = at.page.getByRole('region', { name: 'Change of sun hours, h' });
    expect(await change.locator('.ticks span').allTextContents()).toEqual(['−3', '−2', '−1', '−0.5', '0.5', '1', '2']);
    expect(await change.locator('.bar').evaluate((bar) => getComputedStyle(bar).backgroundImage)).toContain('rgb(245, 245, 245) 50%, rgb(245, 245, 245) 66.67%'); // −0.5 to 0.5
  });

  test('the range of a flowing layer can be changed, and the link remembers layer and range', async () => {
    await lookAtCard();
    await at.page.evaluate(() => window.skybake!.setLayer('irradiation'));
    const legend = at.page.getByRole('region', { name: 'Solar energy in a year, kWh/m²' });
    await legend.getByLabel('From').fill('600');
    await legend.getByLabel('to', { exact: true }).fill('625');
    await legend.getByLabel('to', { exact: true }).blur();
    await expect.poll(async () => (await middle())[1]!).toBeGreaterThan(120); // 612.5: the middle of the range
    await at.linkHas('&s=layer&l=irradiation&');
    await at.linkHas('&fc=600,625,lin');
    const opened = await at.another(at.page.url());
    await opened.page.getByRole('region', { name: 'Solar energy in a year, kWh/m²' }).waitFor();
    expect(await opened.page.getByLabel('From').inputValue()).toBe('600');
    await opened.page.close();
    const stranger = await at.another(at.page.url().replace('l=irradiation', 'l=noise'));
    await stranger.page.getByText('no study layer “noise”').waitFor();
    expect((await stranger.page.evaluate(() => window.skybake!.view())).picture).toBe('lit');
    await stranger.page.close();
  });

  test('another layer or time measures the place anew', async () => {
    await lookAtCard();
    await at.page.mouse.click(480, 240);
    const panel = at.page.getByRole('region', { name: 'Measured here' });
    await panel.getByText('612.5 kWh/m²').waitFor();
    await at.page.evaluate(() => window.skybake!.setLayer('sun_hours_change'));
    await panel.getByText('−1.5 h').waitFor();
    const before = await panel.locator('.second').textContent();
    await at.page.evaluate(() => window.skybake!.setInstant(1));
    await expect.poll(() => panel.locator('.second').textContent()).not.toBe(before);
    await at.page.evaluate(() => window.skybake!.setInstant(0));
    await at.page.keyboard.press('Escape');
  });

  testConsole(at);
});

describe.skipIf(!chromium)('light by parts', () => {
  const at = useWalkthrough({ size });

  test('half the sun is half the sun’s light, in lux of the picture', async () => {
    const green = await at.page.evaluate(([x, y, z]) => {
      const hook = window.skybake!;
      hook.setToneMapping('none');
      hook.setAir(false);
      hook.setExposure(-3);
      hook.setCamera([x, y - 3, z], [x, y, z]);
      const linear = (code: number): number => (code <= 10.3 ? code / 255 / 12.92 : ((code / 255 + 0.055) / 1.055) ** 2.4);
      const mean = (): number => hook.readPixels(316, 236, 8, 8).reduce((sum, v, i) => (i % 4 === 1 ? sum + linear(v) / 64 : sum), 0);
      const values: Record<string, number> = { whole: mean() };
      hook.setFactor('sun', 0.5);
      values['half'] = mean();
      hook.setPart('sun', false);
      values['none'] = mean();
      hook.setFactor('sun', 2);
      values['twice'] = mean();
      hook.setFactor('sun', 1);
      hook.setToneMapping('agx');
      hook.setExposure(0);
      return values as { whole: number; half: number; none: number; twice: number };
    }, whiteCard.center);
    const sun = green.whole - green.none;
    expect(sun).toBeGreaterThan(0.05);
    expect((green.half - green.none) / sun).toBeCloseTo(0.5, 1.5);
    expect((green.twice - green.none) / sun).toBeCloseTo(2, 1.2);
  });

  test('check boxes and sliders, the link, and the way back', async () => {
    await at.page.getByRole('slider', { name: 'Sky: how much of it' }).focus();
    for (let i = 0; i < 4; ++i) await at.page.keyboard.press('ArrowRight');
    await at.page.getByRole('checkbox', { name: 'Lamps' }).uncheck();
    await at.linkHas('&off=lamps&k=sky:1.20');
    const opened = await at.another(at.page.url());
    expect(await opened.page.getByRole('slider', { name: 'Sky: how much of it' }).getAttribute('aria-valuetext')).toBe('120 %');
    expect(await opened.page.getByRole('checkbox', { name: 'Lamps' }).isChecked()).toBe(false);
    await opened.page.close();
  });

  test('no number is scaled in silence: the legend and the measurement say it', async () => {
    await at.page.evaluate(([x, y, z]) => {
      window.skybake!.setPicture('illuminance');
      window.skybake!.setCamera([x, y - 3, z], [x, y, z]);
    }, whiteCard.center);
    await at.page.getByRole('region', { name: 'Illuminance, lx' }).getByText('Not the whole baked light: Sky 120 %, Lamps 0 %.').waitFor();
    const scaled = (await at.page.evaluate(() => window.skybake!.measureAt(480, 240)))!;
    const panel = at.page.getByRole('region', { name: 'Measured here' });
    await panel.getByText('These numbers are of the light as it was baked.').waitFor();
    await at.page.getByRole('button', { name: 'All light as baked' }).click();
    expect(await panel.getByText('These numbers are of the light as it was baked.').isVisible()).toBe(false);
    expect(await at.page.getByText('Not the whole baked light').isVisible()).toBe(false);
    expect((await at.page.evaluate(() => window.skybake!.measureAt(480, 240)))!.lx).toBe(scaled.lx);
  });

  testConsole(at);
});

test('every grey level of a layer has an entry of its own in the ramp', () => expect((rampSize - 1) % 255).toBe(0));
test('a ramp of steps changes colour at its edges', () => {
  const layer = { id: 'x', title: { en: 'x', de: 'x' }, unit: '1', minimum: 0, maximum: 255, edges: [10, 20] as [number, number], kind: 'sequential' as const, pages: [] };
  const ramp = rampOf(layer, scaleOf(layer));
  const colourAt = (grey: number) => [...ramp.slice(16 * grey, 16 * grey + 3)];
  expect(colourAt(9)).toEqual([68, 1, 84]);
  expect(colourAt(10)).toEqual([33, 145, 140]); // the middle of three steps
  expect(colourAt(19)).toEqual(colourAt(10));
  expect(colourAt(20)).toEqual([253, 231, 37]);
});
