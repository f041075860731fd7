// Getting about and coming back: the user's own views, the map, the captured mouse, the help; on the synthetic bake.
import type { Page } from 'playwright-core';
import { describe, expect, test } from 'vitest';
import { openPage } from '../support/chromium';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';
import { whenReady } from '../support/walkthrough_page';

const size = { width: 1280, height: 720 };
const viewOf = (page: Page) => page.evaluate(() => window.skybake!.view());

describe.skipIf(!chromium)('own views', () => {
  const at = useWalkthrough({ size });
  const keep = async (name: string): Promise<void> => {
    await at.page.getByLabel('Name of this view').fill(name);
    await at.page.getByRole('button', { name: 'Keep' }).click();
  };

  test('are kept with place, time and light, listed, gone to, and there again after a reload', async () => {
    await at.page.getByText('Own views').click();
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(1);
      window.skybake!.setPart('sun', false);
      window.skybake!.setCamera([30, -40, 25], [0, 0, 4]);
    });
    await keep('Evening <from> “above”');
    await at.page.evaluate(async () => {
      await window.skybake!.setInstant(0);
      window.skybake!.setPart('sun', true);
      window.skybake!.walkFrom([-8, -34, 1.7], [4, 10, 5]);
    });
    await keep('Street');
    expect(await at.page.locator('.own-views .go').allTextContents()).toEqual(['Evening <from> “above”', 'Street']);
    await at.page.getByRole('button', { name: 'Evening <from> “above”', exact: true }).click();
    await at.page.waitForFunction(() => window.skybake!.view().moment === 1);
    expect(await viewOf(at.page)).toMatchObject({ mode: 'orbit', position: [30, -40, 25].map((v) => expect.closeTo(v, 1)) });
    expect(await at.page.getByRole('checkbox', { name: 'Sun' }).isChecked()).toBe(false);
    await at.page.reload();
    await at.page.evaluate(() => window.skybake!.ready);
    await at.page.getByText('Own views (2)').click();
    await at.page.getByRole('button', { name: 'Street', exact: true }).click();
    expect(await viewOf(at.page)).toMatchObject({ mode: 'walk', position: [-8, -34, 1.7].map((v) => expect.closeTo(v, 1)) });
  });

  test('one of them, and all of them, travel by link to another browser', async () => {
    await at.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await at.page.getByRole('button', { name: 'Copy the link to “Street”' }).click();
    await at.page.getByText('The link to “Street” is copied.').waitFor();
    expect(await at.page.evaluate(() => navigator.clipboard.readText())).toContain('#v=1&m=walk&p=-8.00,-34.00,1.70&');
    await at.page.getByRole('button', { name: 'Link with these views' }).click();
    await at.page.getByText('brings all own views along').first().waitFor();
    const link = await at.page.evaluate(() => navigator.clipboard.readText());
    const elsewhere = await at.another(link); // a page of its own context has a storage of its own
    expect(await elsewhere.page.locator('.own-views .go').allTextContents()).toEqual(['Evening <from> “above”', 'Street']);
    await expect.poll(() => elsewhere.page.url()).not.toContain('&w='); // taken over, so the address is short again
    await elsewhere.page.close();
  });

  test('go when they are deleted, and the focus stays in the list', async () => {
    await at.page.getByRole('button', { name: 'Delete “Evening' }).click();
    expect(await at.page.locator('.own-views .go').allTextContents()).toEqual(['Street']);
    expect(await at.page.evaluate(() => document.activeElement?.textContent)).toBe('Street');
  });

  test('a browser that stores nothing says so and works on', async () => {
    const context = await at.browser.newContext({ viewport: size, reducedMotion: 'reduce' });
    const page = await context.newPage();
    const problems: string[] = [];
    page.on('pageerror', (error) => problems.push(String(error)));
    await page.addInitScript(() => Object.defineProperty(window, 'localStorage', { get: () => { throw new DOMException('denied', 'SecurityError'); } }));
    await whenReady(page, `${at.host.url}?antialias=off&lang=en`);
    await page.getByText('Own views').click();
    await page.getByLabel('Name of this view').fill('Here');
    await page.keyboard.press('Enter');
    await page.getByText('until the page is closed').waitFor();
    expect(await page.locator('.own-views .go').allTextContents()).toEqual(['Here']);
    expect(problems).toEqual([]);
    await context.close();
  });

  testConsole(at);
});

describe.skipIf(!chromium)('the map', () => {
  const at = useWalkthrough({ size });
  const map = () => at.page.getByRole('application', { name: 'Map of the city' });

  test('shows the houses where they stand, and the eye with its heading', async () => {
    await at.page.evaluate(() => window.skybake!.walkFrom([0, -40, 1.7], [10, -40, 1.7]));
    const pixel = (x: number, y: number) => at.page.evaluate(([px, py]) => {
      const plan = document.querySelector<HTMLCanvasElement>('.minimap canvas')!;
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [plan.width, plan.height];
      const context = copy.getContext('2d', { willReadFrequently: true })!;
      context.drawImage(plan, 0, 0);
      return Array.from(context.getImageData(Math.floor(((px! + 60) / 120) * plan.width), Math.floor(((60 - py!) / 120) * plan.height), 1, 1).data).slice(0, 3);
    }, [x, y]);
    await expect.poll(() => pixel(-23, 18)).toEqual([214, 207, 192]); // a flat roof
    expect(await pixel(15, 17)).toEqual([214, 207, 192]);
    expect(await pixel(40, 40)).toEqual([74, 84, 96]); // the square
    await expect.poll(async () => map().getAttribute('aria-description')).toBe('You are at 0 m east, −40 m north, looking towards 90°.'.replace('−', '-'));
    const eye = await at.page.locator('.minimap .eye').evaluate((e) => [e.style.left, e.style.top, e.style.transform]);
    expect(eye).toEqual(['50%', '83.33%', 'rotate(90deg)']);
  });

  test('is not drawn again while the eye stands still', async () => {
    const changes = await at.page.evaluate(async () => {
      let count = 0;
      const observer = new MutationObserver((records) => (count += records.length));
      observer.observe(document.querySelector('.minimap')!, { attributes: true, childList: true, subtree: true });
      for (let i = 0; i < 5; ++i) {
        window.skybake!.setExposure(0.1 * i); // frames, but no movement
        window.skybake!.renderFrame();
        await new Promise((resolve) => setTimeout(resolve, 60));
      }
      observer.disconnect();
      return count;
    });
    expect(changes).toBe(0);
  });

  test('a click goes there, on foot and in the air', async () => {
    const box = (await map().boundingBox())!;
    const click = (x: number, y: number) => at.page.mouse.click(box.x + ((x + 60) / 120) * box.width, box.y + ((60 - y) / 120) * box.height);
    await click(40, -40);
    const there = await viewOf(at.page);
    expect(there.mode).toBe('walk');
    expect(Math.hypot(there.position[0] - 40, there.position[1] + 40)).toBeLessThan(5);
    expect(there.target[0] - there.position[0]).toBeGreaterThan(9); // still looking east
    await click(15, 17); // a house: to the open ground beside it, not onto its roof
    expect((await viewOf(at.page)).position[2]).toBeCloseTo(1.7, 2);
    await at.page.evaluate(() => window.skybake!.setCamera([0, -80, 60], [0, 0, 0]));
    await click(-40, 40);
    const above = await viewOf(at.page);
    expect(above.mode).toBe('orbit');
    expect(above.target.map(Math.round)).toEqual([expect.closeTo(-40, -0.5), expect.closeTo(40, -0.5), 0]);
    expect(above.position[1] - above.target[1]).toBeCloseTo(-80, 1); // from the same side and distance
  });

  test('by keyboard: arrows and Enter go there, N hides it', async () => {
    await map().focus();
    for (let i = 0; i < 5; ++i) await at.page.keyboard.press('ArrowRight');
    const { target } = await viewOf(at.page);
    await at.page.keyboard.press('Enter');
    expect((await viewOf(at.page)).target[0]! - target[0]!).toBeCloseTo(5 * 0.04 * 120, 0);
    await at.page.keyboard.press('n');
    expect(await map().count()).toBe(0);
    expect(await at.page.getByRole('checkbox', { name: 'Map of the city' }).isChecked()).toBe(false);
    await at.page.getByRole('checkbox', { name: 'Map of the city' }).check();
    expect(await map().count()).toBe(1);
  });

  testConsole(at);
});

describe.skipIf(!chromium)('the captured mouse and the help', () => {
  const at = useWalkthrough({ size: { width: 800, height: 600 } });

  test('L lets the mouse look, on foot; a click measures the middle; O gives it back', async () => {
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('l');
    await at.page.waitForFunction(() => document.pointerLockElement !== null);
    expect((await viewOf(at.page)).mode).toBe('walk');
    await at.page.getByText('Esc frees the mouse').waitFor();
    await at.page.evaluate(() => window.skybake!.walkFrom([-20, -26, 1.7], [-20, -20, 1.7]));
    const heading = () => at.page.evaluate(() => {
      const { position, target } = window.skybake!.view();
      return Math.atan2(target[0] - position[0], target[1] - position[1]);
    });
    await at.page.mouse.move(400, 300);
    const before = await heading();
    await at.page.mouse.move(440, 300);
    expect(await heading()).toBeCloseTo(before + 40 * 0.003, 3); // no button held; the eye follows the mouse
    await at.page.mouse.move(400, 300);
    await at.page.mouse.down();
    await at.page.mouse.up();
    await at.page.getByRole('region', { name: 'Measured here' }).getByText('card').waitFor();
    await at.page.keyboard.press('o');
    await at.page.waitForFunction(() => document.pointerLockElement === null);
  });

  test('a browser that refuses is told of', async () => {
    const { page, problems } = await openPage(at.browser, { width: 800, height: 600 });
    await page.addInitScript(() => (HTMLCanvasElement.prototype.requestPointerLock = () => Promise.reject(new DOMException('no', 'NotAllowedError'))));
    await whenReady(page, `${at.host.url}?antialias=off&lang=en`);
    await page.getByRole('button', { name: 'Walk', exact: true }).click();
    await page.getByRole('button', { name: 'Mouse looks' }).click();
    await page.getByText('does not let the page take the mouse').waitFor();
    expect(problems).toEqual([]);
    await page.close();
  });

  test('? lists all keys; meanwhile they do nothing; Escape closes it and gives the focus back', async () => {
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('?');
    const help = at.page.getByRole('dialog', { name: 'Keys and gestures' });
    await help.waitFor();
    for (const words of ['faster', 'look about', 'map: click, or arrows and Enter', 'Stick on the left', 'the mouse looks without being held']) expect(await help.textContent()).toContain(words);
    await at.page.keyboard.press('2');
    expect((await viewOf(at.page)).picture).toBe('lit');
    await at.page.keyboard.press('Escape');
    expect(await help.count()).toBe(0);
    expect(await at.page.evaluate(() => document.activeElement?.tagName)).toBe('CANVAS');
  });

  testConsole(at);
});
