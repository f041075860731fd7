// Debian's Chromium, headless, with WebGL 2 in software: the same pixels with and without a graphics card.
import fs from 'node:fs';
import { chromium, type Browser, type Page } from 'playwright-core';

const candidates = [process.env['SKYBAKE_CHROMIUM'], '/usr/lib/chromium/chromium', '/usr/bin/chromium'];

export function findChromium(): string | null {
  return candidates.find((path): path is string => path !== undefined && fs.existsSync(path)) ?? null;
}

export async function launch(executablePath: string): Promise<Browser> {
  return chromium.launch({
    executablePath,
    headless: true,
    timeout: 60_000,
    args: [
      '--no-sandbox', // tests run as root in containers
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
      '--force-color-profile=srgb',
      '--force-device-scale-factor=1',
      '--disable-dev-shm-usage',
      '--hide-scrollbars',
    ],
  });
}

export interface Size { width: number; height: number }

/** A page that remembers what its console complained of. */
export async function openPage(browser: Browser, size: Size = { width: 640, height: 360 }, isPhone = false): Promise<{ page: Page; problems: string[] }> {
  const page = await browser.newPage({ viewport: size, deviceScaleFactor: 1, reducedMotion: 'reduce', hasTouch: isPhone, isMobile: isPhone });
  const problems: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') problems.push(message.text());
  });
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('crash', () => problems.push('the page crashed'));
  return { page, problems };
}
