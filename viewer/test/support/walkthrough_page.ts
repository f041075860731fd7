// The walkthrough in a page, as browser tests hold it.
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import type { TestHook } from '../../src/app/test_hook';

const here = path.dirname(fileURLToPath(import.meta.url));
export const dist = path.join(here, '../../dist');
export const outFolder = path.join(here, '../out');
if (!fs.existsSync(path.join(dist, 'index.html'))) throw new Error('viewer/dist is absent: run npm run build first');

declare global {
  interface Window {
    skybake?: TestHook;
  }
}

export async function whenReady(page: Page, url: string): Promise<void> {
  await page.goto(url);
  await page.waitForFunction(() => window.skybake !== undefined);
  await page.evaluate(() => window.skybake!.ready);
}

/** The canvas as RGB bytes, row 0 on top. */
export async function canvas(page: Page, width: number, height: number): Promise<Uint8Array> {
  // As text: an array of numbers would take seconds through the protocol.
  const encoded = await page.evaluate(([w, h]) => {
    let bytes = '';
    for (const value of window.skybake!.readPixels(0, 0, w!, h!)) bytes += String.fromCharCode(value);
    return btoa(bytes);
  }, [width, height]);
  const rgba = Buffer.from(encoded, 'base64');
  const rgb = new Uint8Array(width * height * 3);
  for (let i = 0; i < width * height; ++i) rgb.set([rgba[4 * i]!, rgba[4 * i + 1]!, rgba[4 * i + 2]!], 3 * i);
  return rgb;
}
