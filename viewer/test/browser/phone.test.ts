// The page on a phone: 390 × 844, touch.
import { describe, expect, test } from 'vitest';
import { whiteCard } from '../support/fixture';
import { chromium, testConsole, useWalkthrough } from '../support/walkthrough';


describe.skipIf(!chromium)('on a phone', () => {
  const at = useWalkthrough({ size: { width: 390, height: 844 }, isPhone: true });

  test('the city comes first, the settings open over it and fit the page', async () => {
    const settings = at.page.getByRole('region', { name: 'Settings of the walkthrough' });
    expect(await settings.count()).toBe(0);
    await at.page.getByRole('button', { name: 'Settings' }).tap();
    const box = (await settings.boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(390);
    const small = await settings.getByRole('button').evaluateAll((buttons) => buttons.filter((b) => b.getBoundingClientRect().height > 0 && b.getBoundingClientRect().height < 40).map((b) => b.textContent));
    expect(small).toEqual([]);
    expect(await at.page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
  });

  test('the left thumb walks by the stick while the right one looks about', async () => {
    await at.page.getByRole('button', { name: 'Walk', exact: true }).tap();
    await at.page.getByRole('button', { name: 'Hide', exact: true }).tap();
    await at.page.evaluate(() => window.skybake!.walkFrom([-8, -40, 1.7], [-8, 0, 1.7]));
    const stick = (await at.page.getByRole('group', { name: 'Walk' }).boundingBox())!;
    expect(stick.x + stick.width).toBeLessThan(195); // on the left
    const touches = await at.page.context().newCDPSession(at.page);
    const thumb = { x: stick.x + stick.width / 2, y: stick.y + stick.height / 2, id: 1 };
    const pushed = { ...thumb, y: thumb.y - 40 };
    const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', touchPoints: { x: number; y: number; id: number }[]): Promise<unknown> => touches.send('Input.dispatchTouchEvent', { type, touchPoints });
    await send('touchStart', [thumb]);
    await send('touchMove', [pushed]);
    await at.page.waitForFunction(() => window.skybake!.view().position[1] > -39.5);
    const heading = (): Promise<number> => at.page.evaluate(() => {
      const { position, target } = window.skybake!.view();
      return Math.atan2(target[0] - position[0], target[1] - position[1]);
    });
    const before = await heading();
    await send('touchStart', [pushed, { x: 300, y: 500, id: 2 }]);
    await send('touchMove', [pushed, { x: 240, y: 500, id: 2 }]);
    await expect.poll(heading).toBeCloseTo(before + 60 * 0.003, 2); // the city follows the finger
    await send('touchEnd', []);
    await at.page.waitForTimeout(300);
    const place = (): Promise<readonly number[]> => at.page.evaluate(() => window.skybake!.view().position);
    const stopped = await place();
    await at.page.waitForTimeout(300);
    expect(await place()).toEqual(stopped);
    expect(await at.page.getByRole('region', { name: 'Measured here' }).count()).toBe(0); // neither thumb measured
  });

  test('the stick’s arrows are buttons: half a step at a time', async () => {
    await at.page.evaluate(() => window.skybake!.walkFrom([-8, -40, 1.7], [-8, 0, 1.7]));
    await at.page.getByRole('button', { name: 'Forward' }).focus();
    await at.page.keyboard.press('Enter');
    expect((await at.page.evaluate(() => window.skybake!.view().position))[1]).toBeCloseTo(-39.5, 2);
  });

  test('the map waits until it is asked for', async () => {
    expect(await at.page.getByRole('region', { name: 'Map' }).count()).toBe(0);
    await at.page.keyboard.press('n');
    const map = (await at.page.getByRole('region', { name: 'Map' }).boundingBox())!;
    expect(map.x + map.width).toBeLessThanOrEqual(390);
    await at.page.getByRole('button', { name: 'Hide the map' }).tap();
  });

  test('a tap measures, and the place stays in view above the numbers', async () => {
    await at.page.evaluate(([x, y, z]) => window.skybake!.setCamera([x!, y! - 6, z!], [x!, y!, z!]), whiteCard.center);
    await at.page.touchscreen.tap(195, 422);
    const sheet = at.page.getByRole('region', { name: 'Measured here' });
    await sheet.getByText('card').waitFor();
    expect((await sheet.boundingBox())!.y).toBeGreaterThan(422);
  });

  testConsole(at);
});
