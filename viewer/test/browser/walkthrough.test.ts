// The built walkthrough in Chromium. Pixels are compared in the canvas, so fonts and panel do not matter.
import fs from 'node:fs';
import path from 'node:path';
import { describe, expect, test } from 'vitest';
import { parseAirlight } from '../../src/core/air';
import type { LightPart } from '../../src/core/light_parts';
import { srgbEncode } from '../../src/core/units';
import { launch, openPage } from '../support/chromium';
import { viewThrough } from '../support/air';
import { fixtureAir, fixtureBeam, fixtureInstants, fixtureSun, whiteCard } from '../support/fixture';
import { compareWithGolden, differingShare } from '../support/golden';
import { serve } from '../support/static_host';
import { canvas, dist, outFolder, whenReady } from '../support/walkthrough_page';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';

const size = { width: 480, height: 270 };

const meanOf = (pixels: Uint8Array) => pixels.reduce((sum, value) => sum + value, 0) / pixels.length;

describe.skipIf(!chromium)('the walkthrough of the synthetic bake', () => {
  const at = useWalkthrough({ size });

  test.each([
    ['all of its light', []],
    ['no lamps', ['lamps']],
    ['the lamp alone', ['sun', 'sky']],
  ] as const)('a white wall of known light gives the pixel that paper and pencil give, with %s', async (_, off) => {
    const [x, y, z] = whiteCard.center;
    await at.page.evaluate(([cx, cy, cz]) => {
      window.skybake!.setToneMapping('none');
      window.skybake!.setPicture('lit');
      window.skybake!.setAir(false);
      window.skybake!.setCamera([cx!, cy! - 3, cz!], [cx!, cy!, cz!]);
    }, [x, y, z]);
    const exposure = await at.page.evaluate((parts) => {
      for (const part of parts) window.skybake!.setPart(part, false);
      window.skybake!.setExposure(parts.length > 1 ? 1.5 : -2.5); // bright light, but below the clip
      return window.skybake!.exposure();
    }, off);
    const block = 16;
    const pixels = await at.page.evaluate(([px, py, n]) => window.skybake!.readPixels(px!, py!, n!, n!), [size.width / 2 - 8, size.height / 2 - 8, block]);
    await at.page.evaluate((parts) => {
      for (const part of parts) window.skybake!.setPart(part, true);
      window.skybake!.setToneMapping('agx');
      window.skybake!.setExposure(0);
      window.skybake!.setAir(true);
    }, off);
    const isOn = (part: LightPart) => (off as readonly LightPart[]).includes(part) ? 0 : 1;
    for (let c = 0; c < 3; ++c) {
      // L = (E_sky + cos·E_sun + E_lamps) / π for albedo 1, then exposure, sRGB, 8 bit.
      const illuminance =
        isOn('sky') * whiteCard.skyKlx[c]! + isOn('sun') * whiteCard.sunCosine * fixtureBeam[c]! + isOn('lamps') * whiteCard.lampKlx[c]!;
      const expected = 255 * srgbEncode((illuminance / Math.PI) * exposure);
      expect(expected).toBeLessThan(250);
      expect(expected).toBeGreaterThan(60);
      let mean = 0;
      for (let i = 0; i < block * block; ++i) {
        const value = pixels[4 * i + c]!;
        expect(Math.abs(value - expected)).toBeLessThanOrEqual(1.5); // half a step of rounding and half a step of dither on top of the one
        mean += value / (block * block);
      }
      expect(Math.abs(mean - expected)).toBeLessThanOrEqual(1);
    }
  });

  test('the same wall through the air is what the C++ formula gives', async () => {
    const tables = parseAirlight('air.bin', new Uint8Array(fs.readFileSync(path.join(at.folder, fixtureAir(0).airlight.uri))), 4, 6);
    for (const eye of [[-20, -110, 2], [-45, -90, 30]] as const) {
      const pixel = await at.page.evaluate(([from, to, px, py]) => {
        const hook = window.skybake!;
        hook.setToneMapping('none');
        hook.setPicture('lit');
        hook.setCamera(from, to);
        hook.setExposure(-2.5);
        const block = hook.readPixels(px, py, 4, 4);
        const value = { exposure: hook.exposure(), mean: [0, 1, 2].map((c) => block.reduce((sum, v, i) => (i % 4 === c ? sum + v / 16 : sum), 0)) };
        hook.setToneMapping('agx');
        hook.setExposure(0);
        return value;
      }, [eye, whiteCard.center, size.width / 2 - 2, size.height / 2 - 2] as const);
      const ray = whiteCard.center.map((v, i) => v - eye[i]!) as [number, number, number];
      const metres = Math.hypot(...ray);
      const seen = viewThrough(fixtureAir(0), tables, fixtureSun, eye[2], ray.map((v) => v / metres) as [number, number, number], metres);
      for (const c of [0, 1, 2] as const) {
        const radiance = (whiteCard.skyKlx[c] + whiteCard.sunCosine * fixtureBeam[c] + whiteCard.lampKlx[c]) / Math.PI;
        const expected = 255 * srgbEncode((radiance * seen[c]!.transmittance + seen[c]!.inscatter) * pixel.exposure);
        const withoutAir = 255 * srgbEncode(radiance * pixel.exposure);
        expect(Math.abs(expected - withoutAir)).toBeGreaterThan(3); // else the test would see nothing
        expect(Math.abs(pixel.mean[c]! - expected)).toBeLessThanOrEqual(1);
      }
    }
  });

  test('the switch takes the air away and brings it back, and the link remembers', async () => {
    await at.page.evaluate(() => {
      window.skybake!.setPicture('lit');
      window.skybake!.setCamera([70, -85, 55], [0, 0, 4]);
    });
    const withAir = await canvas(at.page, size.width, size.height);
    await at.page.getByLabel('Haze over distance').uncheck();
    expect(differingShare(withAir, await canvas(at.page, size.width, size.height))).toBeGreaterThan(0.3);
    await at.linkHas('&a=0');
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('f');
    expect(differingShare(withAir, await canvas(at.page, size.width, size.height))).toBe(0);
    await at.page.keyboard.press('3');
    expect(await at.page.getByLabel('Haze over distance').isDisabled()).toBe(true);
    await at.page.keyboard.press('1');
  });

  test.each([
    ['birds-eye', 0, 'lit'],
    ['birds-eye-evening', 1, 'lit'],
    ['birds-eye-textures', 0, 'textures'],
    ['birds-eye-light', 0, 'light'],
  ] as const)('the picture “%s” is the golden one', async (name, instant, picture) => {
    await at.page.evaluate(async ([i, p]) => {
      await window.skybake!.setInstant(i);
      window.skybake!.setPicture(p);
      window.skybake!.setCamera([70, -85, 55], [0, 0, 4]);
    }, [instant, picture] as const);
    compareWithGolden(name, size, await canvas(at.page, size.width, size.height));
  });

  test('the street picture is the golden one', async () => {
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(0);
      window.skybake!.setPicture('lit');
      window.skybake!.walkFrom([-8, -34, 1.7], [4, 10, 5]);
    });
    compareWithGolden('street', size, await canvas(at.page, size.width, size.height));
  });

  test('a walk keeps the eye at 1.7 m, is stopped by a wall and by the end of the world', async () => {
    const walked = await at.page.evaluate(() => {
      const hook = window.skybake!;
      hook.walkFrom([15, 0, 1.7], [15, 20, 1.7]); // the second house's south wall stands at y = 10
      hook.walk(1, 0, 50);
      const atWall = hook.view().position;
      hook.walkFrom([-50, 0, 1.7], [-60, 0, 1.7]); // the ground ends at x = −60
      hook.walk(1, 0, 50);
      return { atWall, atEnd: hook.view().position, mode: hook.view().mode };
    });
    expect(walked.mode).toBe('walk');
    expect(walked.atWall[2]).toBeCloseTo(1.7, 3);
    expect(walked.atWall[1]).toBeGreaterThan(9);
    expect(walked.atWall[1]).toBeLessThanOrEqual(9.65);
    expect(walked.atEnd[2]).toBeCloseTo(1.7, 3);
    expect(walked.atEnd[0]).toBeGreaterThanOrEqual(-60);
    expect(walked.atEnd[0]).toBeLessThan(-59);
  });

  test('a default walk begins outdoors on the ground', async () => {
    const { mode, position } = await at.page.evaluate(() => {
      const hook = window.skybake!;
      hook.setCamera([70, -85, 55], [-23, 18, 0]); // looking at the first house: its roof and its inside are no place to stand
      hook.setMode('walk');
      return hook.view();
    });
    expect(mode).toBe('walk');
    expect(position[2]).toBeCloseTo(1.7, 3);
    const isInside = position[0] > -32 && position[0] < -14 && position[1] > 6 && position[1] < 30;
    expect(isInside).toBe(false);
    // Nearest to the house, not anywhere: within twenty metres of its walls.
    expect(Math.hypot(position[0] + 23, position[1] - 18)).toBeLessThan(35);
  });

  test('keys walk with the passing of time', async () => {
    await at.page.evaluate(() => window.skybake!.walkFrom([-8, -40, 1.7], [-8, 0, 1.7]));
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.down('KeyW');
    await at.page.waitForFunction(() => window.skybake!.view().position[1] > -39.5);
    await at.page.keyboard.up('KeyW');
    const stopped = await at.page.evaluate(() => window.skybake!.view().position[1]);
    await at.page.waitForTimeout(200);
    expect(await at.page.evaluate(() => window.skybake!.view().position[1])).toBe(stopped);
  });

  test('instants switch through the list, and the light of the old one is freed', async () => {
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(0);
      window.skybake!.setCamera([70, -85, 55], [0, 0, 4]);
      window.skybake!.renderFrame();
    });
    const before = await at.page.evaluate(() => window.skybake!.stats().textures);
    const morning = await canvas(at.page, size.width, size.height);
    await at.page.locator('#instant').selectOption('1');
    await at.page.waitForFunction(() => window.skybake!.view().moment === 1);
    const evening = await canvas(at.page, size.width, size.height);
    expect(differingShare(morning, evening)).toBeGreaterThan(0.3);
    for (let round = 0; round < 4; ++round) {
      for (let i = 0; i < fixtureInstants; ++i) {
        await at.page.evaluate(async (index) => {
          await window.skybake!.setInstant(index);
          window.skybake!.renderFrame();
        }, i);
      }
    }
    expect(await at.page.evaluate(() => window.skybake!.stats().textures)).toBe(before);
    await at.page.evaluate(() => window.skybake!.setInstant(0));
    expect(differingShare(morning, await canvas(at.page, size.width, size.height))).toBe(0);
  });

  test('buttons and keys switch the three pictures and the exposure', async () => {
    await at.page.locator('body > canvas').focus();
    for (const [key, picture] of [['2', 'textures'], ['3', 'light'], ['1', 'lit']] as const) {
      await at.page.keyboard.press(key);
      expect(await at.page.evaluate(() => window.skybake!.view().picture)).toBe(picture);
    }
    await at.page.getByRole('button', { name: 'Textures' }).click();
    expect(await at.page.evaluate(() => window.skybake!.view().picture)).toBe('textures');
    await at.page.getByRole('button', { name: 'Lit' }).click();
    const normal = meanOf(await canvas(at.page, size.width, size.height));
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('-');
    await at.page.keyboard.press('-');
    expect(meanOf(await canvas(at.page, size.width, size.height))).toBeLessThan(0.9 * normal);
    await at.page.getByRole('button', { name: 'Auto' }).click();
    expect(meanOf(await canvas(at.page, size.width, size.height))).toBeCloseTo(normal, 6);
  });

  test('nothing is drawn while nothing changes', async () => {
    await at.page.waitForTimeout(300);
    const before = await at.page.evaluate(() => window.skybake!.stats().frames);
    await at.page.waitForTimeout(500);
    expect(await at.page.evaluate(() => window.skybake!.stats().frames)).toBe(before);
  });

  test('the link restores place, picture and instant', async () => {
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(1);
      window.skybake!.setPicture('light');
      window.skybake!.walkFrom([-8, -34, 1.7], [4, 10, 5]);
    });
    const sent = await at.page.evaluate(() => window.skybake!.view());
    await at.linkHas('m=walk&p=-8.00,-34.00');
    const link = at.page.url();
    const opened = await at.another(link);
    const got = await opened.page.evaluate(() => window.skybake!.view());
    expect(opened.problems).toEqual([]);
    await opened.page.close();
    expect(got).toMatchObject({ mode: 'walk', picture: 'light', moment: 1 });
    for (let c = 0; c < 3; ++c) expect(got.position[c]).toBeCloseTo(sent.position[c]!, 1);
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(0);
      window.skybake!.setPicture('lit');
    });
  });

  test('a click copies the link to this very view', async () => {
    await at.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await at.page.evaluate(() => window.skybake!.setCamera([30, -40, 25], [0, 0, 4]));
    await at.page.getByRole('button', { name: 'Copy link' }).click();
    await at.page.getByText('The link to this view is copied.').waitFor();
    const copied = await at.page.evaluate(() => navigator.clipboard.readText());
    expect(copied).toBe(at.page.url());
    expect(copied).toContain('#v=1&m=orbit&p=30.00,-40.00,25.00&t=0.00,0.00,4.00&s=');
  });

  testConsole(at);

  test.each([
    ['light/i0_p1_sky.png', null, 'no such file'],
    ['city.glb', null, 'no such file'],
    ['manifest.json', null, 'no such file'],
    ['manifest.json', '{"format": "skybake-bake", "version": 1}', 'schema'],
    ['manifest.json', '{"format": "skybake-bake", "version": 7}', 'version 7'],
    ['manifest.json', 'PK\u0003', 'not JSON'],
    ['light/i0_scales.bin', 'short', 'bytes'],
  ] as const)('%s missing or broken (%s) is told with its address', async (name, content, words) => {
    const broken = await serve([dist, at.folder], (asked, bytes) => (asked === name ? (content === null ? null : Buffer.from(content)) : bytes));
    const opened = await openPage(at.browser, size);
    try {
      await opened.page.goto(broken.url);
      const alert = opened.page.getByRole('alert');
      await alert.waitFor();
      expect(await alert.textContent()).toContain(words);
      expect(await alert.textContent()).toContain(broken.url + name);
    } finally {
      await opened.page.close();
      await broken.close();
    }
  });
});

const bake = process.env['SKYBAKE_BAKE'];
describe.skipIf(!chromium || !bake)('the walkthrough of the bake that was given', () => {
  test('loads, walks, switches pictures and instants without a complaint', async () => {
    const host = await serve([bake!, dist]);
    const browser = await launch(chromium!);
    try {
      const { page, problems } = await openPage(browser, size);
      await whenReady(page, `${host.url}?antialias=off`);
      fs.mkdirSync(outFolder, { recursive: true });
      const shoot = (name: string) => page.screenshot({ path: path.join(outFolder, `${name}.png`) });
      const lit = await canvas(page, size.width, size.height);
      await shoot('bake-birds-eye');
      for (const picture of ['textures', 'light'] as const) {
        await page.evaluate((p) => window.skybake!.setPicture(p), picture);
        const other = await canvas(page, size.width, size.height);
        await shoot(`bake-${picture}`);
        expect(differingShare(lit, other)).toBeGreaterThan(0.05);
      }
      await page.evaluate(() => window.skybake!.setPicture('lit'));
      await page.getByRole('button', { name: 'Walk' }).click();
      const before = await page.evaluate(() => window.skybake!.view());
      expect(before.mode).toBe('walk');
      await shoot('bake-street');
      const after = await page.evaluate(() => {
        for (const [along, aside] of [[1, 0], [0, 1], [-1, 0]] as const) window.skybake!.walk(along, aside, 3);
        return window.skybake!.view();
      });
      expect(Math.hypot(after.position[0] - before.position[0], after.position[1] - before.position[1])).toBeGreaterThan(1);
      const count = await page.locator('#instant option:enabled').count();
      for (let i = 0; i < count; ++i) await page.evaluate((index) => window.skybake!.setInstant(index), i);
      expect((await page.evaluate(() => window.skybake!.view())).moment).toBe(count - 1);
      expect(problems).toEqual([]);
    } finally {
      await browser.close();
      await host.close();
    }
  });
});
