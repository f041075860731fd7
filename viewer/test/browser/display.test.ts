// The walkthrough's exposure and tone mapping as a table: tests/render/display_values.csv, by which the C++ side is judged as well.
// With --update-golden the table is written anew.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, test } from 'vitest';
import type { Manifest } from '../../src/core/generated/manifest';
import { srgbDecode, srgbEncode, type Vec3 } from '../../src/core/units';
import { findChromium, launch, openPage } from '../support/chromium';
import { whiteCard, writeFixture } from '../support/fixture';
import { serve } from '../support/static_host';
import { dist, whenReady } from '../support/walkthrough_page';

const table = path.join(path.dirname(fileURLToPath(import.meta.url)), '../../../tests/render/display_values.csv');
const header = 'picture,hint_m2_per_kcd,ev,r_kcd_m2,g_kcd_m2,b_kcd_m2,r_code,g_code,b_code';
const size = { width: 480, height: 270 };
const block = 16;
/** Beams of all hues: what the white card then sends out. klx. */
const beams: Vec3[] = [[88, 82, 72], [300, 2, 1], [1, 190, 3], [2, 4, 340], [260, 110, 5], [0, 0, 0]];
const steps = [-4, -2, 0, 2, 4];
const chromium = findChromium();

test.skipIf(!chromium)('exposure, tone mapping and sRGB give the values of the table', { timeout: 300_000 }, async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'skybake-display-'));
  const manifest = writeFixture(folder);
  const browser = await launch(chromium!);
  const rows: string[] = [];
  try {
    for (const beam of beams) {
      const host = await serve([dist, folder], (name, bytes) => (name === 'manifest.json' ? withBeam(manifest, beam) : bytes));
      const { page } = await openPage(browser, size);
      await whenReady(page, `${host.url}?antialias=off`);
      for (const picture of beam === beams[0] ? (['lit', 'light'] as const) : (['lit'] as const)) {
        for (const ev of steps) {
          const pixels = await page.evaluate(([[cx, cy, cz], shown, stops, [px, py], n]) => {
            const hook = window.skybake!;
            hook.setPicture(shown);
            hook.setPart('lamps', false);
            hook.setAir(false);
            hook.setExposure(stops);
            hook.setCamera([cx, cy - 3, cz], [cx, cy, cz]);
            return hook.readPixels(px, py, n, n);
          }, [whiteCard.center, picture, ev, [(size.width - block) / 2, (size.height - block) / 2], block] as const);
          const codes = [0, 1, 2].map((c) => pixels.reduce((sum, value, i) => (i % 4 === c ? sum + value : sum), 0) / block ** 2);
          rows.push([picture, manifest.instants[0]!.exposure_hint, ev, ...radiance(beam).map((l) => l.toFixed(5)), ...codes.map((code) => code.toFixed(2))].join(','));
        }
      }
      await page.close();
      await host.close();
    }
  } finally {
    await browser.close();
    fs.rmSync(folder, { recursive: true, force: true });
  }
  if (process.env['SKYBAKE_UPDATE_GOLDEN']) fs.writeFileSync(table, [header, ...rows, ''].join('\n'));
  const [first, ...known] = fs.readFileSync(table, 'utf8').trimEnd().split('\n');
  expect(first).toBe(header);
  expect(known.length).toBe(rows.length);
  rows.forEach((row, i) => {
    const got = row.split(',');
    const wanted = known[i]!.split(',');
    expect(got.slice(0, 6)).toEqual(wanted.slice(0, 6));
    for (let c = 6; c < 9; ++c) expect(Math.abs(Number(got[c]) - Number(wanted[c])), `${row} is not ${known[i]}`).toBeLessThanOrEqual(0.5);
  });
});

/** kcd/m² of the card: E / π of its eight-bit skylight and the beam. */
function radiance(beam: Vec3): number[] {
  const scale = Math.max(...whiteCard.skyKlx);
  return whiteCard.skyKlx.map((klx, c) => {
    const stored = scale * srgbDecode(Math.round(255 * srgbEncode(klx / scale)) / 255);
    return (stored + whiteCard.sunCosine * beam[c]!) / Math.PI;
  });
}

function withBeam(manifest: Manifest, beam: Vec3): Buffer {
  const changed = structuredClone(manifest);
  changed.instants[0]!.sun.normal_illuminance_klx = [...beam];
  return Buffer.from(JSON.stringify(changed));
}
