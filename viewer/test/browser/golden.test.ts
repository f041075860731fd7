// Golden pictures of what is laid over the city, and of the pictures of numbers: English and German, desktop and phone.
import { describe, expect, test } from 'vitest';
import { whiteCard } from '../support/fixture';
import { compareScreenshot, compareWithGolden } from '../support/golden';
import { chromium, testConsole, useWalkthrough, type Walkthrough } from '../support/walkthrough';
import { canvas } from '../support/walkthrough_page';

const size = { width: 1000, height: 860 };
const small = { width: 480, height: 270 };

/** A part of the page over an even ground, so that the picture below does not matter. */
async function compareElement(at: Walkthrough, name: string, selector: string): Promise<void> {
  await at.page.addStyleTag({ content: 'body > canvas { opacity: 0 } *, *::before { caret-color: transparent !important }' });
  const clip = (await at.page.locator(selector).boundingBox())!;
  compareScreenshot(name, await at.page.screenshot({ clip, animations: 'disabled' }));
}

describe.skipIf(!chromium)('golden pictures of numbers', () => {
  const at = useWalkthrough({ size: small, isCompared: true });
  const whole = () => canvas(at.page, small.width, small.height);

  test('the difference of two bakes', async () => {
    await at.page.evaluate(() => window.skybake!.setCamera([70, -85, 55], [0, 0, 4]));
    await at.page.locator('body > canvas').focus();
    await at.page.keyboard.press('c');
    compareWithGolden('difference', small, await whole());
    await at.page.keyboard.press('b');
  });

  test.each([['illuminance', null], ['sky-view', null], ['layer', 'sun_hours_2026-03-21'], ['layer', 'irradiation'], ['layer', 'sun_hours_change']] as const)('%s %s', async (picture, layer) => {
    await at.page.evaluate(([p, l]) => (l === null ? window.skybake!.setPicture(p) : window.skybake!.setLayer(l)), [picture, layer] as const);
    await at.page.waitForTimeout(700); // the pages have come
    compareWithGolden(`false-colour-${layer ?? picture}`.replaceAll('_', '-'), small, await whole());
  });

  testConsole(at);
});

describe.skipIf(!chromium).each(['en', 'de'] as const)('golden pictures of the page, %s', (language) => {
  const at = useWalkthrough({ size, query: `lang=${language}` });

  test('settings, with a part of the light scaled and a view kept', async () => {
    await at.page.evaluate(() => {
      window.skybake!.setFactor('sky', 0.5);
      window.skybake!.setPicture('illuminance');
      document.querySelector('details')!.open = true;
    });
    await at.page.locator('#view-name').fill('Rathaus');
    await at.page.keyboard.press('Enter');
    await at.page.locator('.own-views .go').waitFor();
    await compareElement(at, `settings-${language}`, '.panel:not(.measure)');
  });

  test('legends: flowing with a warning, and in steps', async () => {
    await compareElement(at, `legend-illuminance-${language}`, '.legend');
    await at.page.evaluate(() => window.skybake!.setLayer('sun_hours_change'));
    await compareElement(at, `legend-steps-${language}`, '.legend');
  });

  test('what was measured', async () => {
    await at.page.evaluate(([x, y, z]) => window.skybake!.setCamera([x, y - 3, z], [x, y, z]), whiteCard.center);
    await at.page.evaluate(() => window.skybake!.measureAt(500, 430));
    await compareElement(at, `measured-${language}`, '.measure');
  });

  test('the map', async () => {
    await at.page.evaluate(() => window.skybake!.walkFrom([-5, -40, 1.7], [5, -30, 1.7]));
    await expect.poll(() => at.page.locator('.minimap .area').getAttribute('aria-description')).toContain('45°');
    await compareElement(at, `map-${language}`, '.minimap');
  });

  testConsole(at);
});

describe.skipIf(!chromium)('golden pictures of the phone', () => {
  const at = useWalkthrough({ size: { width: 390, height: 844 }, query: 'lang=de', isPhone: true });

  test('the stick', async () => {
    await at.page.evaluate(() => window.skybake!.setMode('walk'));
    await compareElement(at, 'stick', '.stick');
  });

  test('the settings', async () => {
    await at.page.locator('.open-panel').tap();
    await at.page.evaluate(() => (document.activeElement as HTMLElement).blur());
    await compareElement(at, 'settings-phone-de', '.panel:not(.measure)');
  });

  testConsole(at);
});
