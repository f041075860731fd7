// One open walkthrough of the synthetic bake for all tests of a block.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { findChromium, launch, openPage, type Size } from './chromium';
import { writeFixture } from './fixture';
import { serve, type Host } from './static_host';
import { dist, whenReady } from './walkthrough_page';

export const chromium = findChromium();
if (!chromium) console.warn('browser tests are skipped: no Chromium found (apt-get install chromium, or set SKYBAKE_CHROMIUM)');

/** What the tests of a block share; it is there once the first of them runs. */
export interface Walkthrough {
  browser: Browser;
  /** Of the bake. */
  folder: string;
  host: Host;
  page: Page;
  /** What the console complained of. */
  problems: string[];
  /** Another page of the same size; the block closes it with its browser. */
  another(url: string, isReady?: boolean): Promise<{ page: Page; problems: string[] }>;
  /** Waits until the address, which follows the view a little later, has these words. */
  linkHas(words: string): Promise<void>;
}

export interface WalkthroughOptions {
  size: Size;
  /** Of the address, such as "lang=de". */
  query?: string;
  isPhone?: boolean;
  /** A second bake at `compare/`: the square before its third house was built, and after. */
  isCompared?: boolean;
}

export function useWalkthrough({ size, query = 'lang=en', isPhone = false, isCompared = false }: WalkthroughOptions): Walkthrough {
  const at = {} as Walkthrough;
  beforeAll(async () => {
    at.folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-walkthrough-'));
    writeFixture(at.folder, isCompared ? 'before' : 'after');
    if (isCompared) writeFixture(path.join(at.folder, 'compare'), 'after');
    at.host = await serve([dist, at.folder]);
    at.browser = await launch(chromium!);
    at.another = async (url, isReady = true) => {
      const opened = await openPage(at.browser, size, isPhone);
      if (isReady) await whenReady(opened.page, url);
      else await opened.page.goto(url);
      return opened;
    };
    at.linkHas = (words) => expect.poll(() => at.page.url()).toContain(words);
    Object.assign(at, await at.another(`${at.host.url}?antialias=off&${query}${isCompared ? '&compare=compare/' : ''}`));
  });
  afterAll(async () => {
    await at.browser?.close();
    await at.host?.close();
    fs.rmSync(at.folder, { recursive: true, force: true });
  });
  return at;
}

/** The last test of a block. */
export function testConsole(at: Walkthrough): void {
  test('the console stayed clean', () => expect(at.problems).toEqual([]));
}
