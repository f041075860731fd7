// Golden pictures: test/golden, written anew with --update-golden.
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect } from 'vitest';
import { decodePng, encodePng } from './png';
import { outFolder } from './walkthrough_page';

const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), '../golden');

/** Share of the pixels where a channel differs by more than 6 of 255: rounding of other Chromium versions stays below, a wrong light does not. */
export function differingShare(a: Uint8Array, b: Uint8Array): number {
  let count = 0;
  for (let i = 0; i < a.length; i += 3) {
    if ([0, 1, 2].some((c) => Math.abs(a[i + c]! - b[i + c]!) > 6)) ++count;
  }
  return count / (a.length / 3);
}

/** Holds a picture of the canvas to the golden one. */
export function compareWithGolden(name: string, { width, height }: { width: number; height: number }, rgb: Uint8Array): void {
  const file = path.join(folder, `${name}.png`);
  const picture = encodePng({ width, height, channels: 3, pixels: rgb });
  if (process.env['SKYBAKE_UPDATE_GOLDEN']) {
    fs.mkdirSync(folder, { recursive: true });
    fs.writeFileSync(file, picture);
    return;
  }
  const golden = decodePng(fs.readFileSync(file));
  const isAlike = golden.width === width && golden.height === height;
  const share = isAlike ? differingShare(rgb, golden.pixels) : 1;
  if (share > 0.005) {
    fs.mkdirSync(outFolder, { recursive: true });
    fs.writeFileSync(path.join(outFolder, `${name}.png`), picture);
  }
  expect(share, `share of pixels that differ from test/golden/${name}.png; the picture is in test/out/`).toBeLessThanOrEqual(0.005);
}

/** The same for a screenshot of a part of the page, as Chromium encodes it. */
export function compareScreenshot(name: string, png: Buffer): void {
  const { width, height, channels, pixels } = decodePng(png);
  const rgb = new Uint8Array(3 * width * height);
  for (let i = 0; i < width * height; ++i) for (let c = 0; c < 3; ++c) rgb[3 * i + c] = pixels[channels * i + c]!;
  compareWithGolden(name, { width, height }, rgb);
}
