// node tools/measure.mjs PROGRAM BAKE…: what bakes cost a browser, one table row each. Debian's Chromium with WebGL 2 in software, 640 × 360, served by
// `PROGRAM view`, so compressed as users get it. Times are medians of the runs, which take turns between the bakes; on a graphics card frames are faster by orders.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { chromium } from 'playwright-core';

const [program, ...bakes] = process.argv.slice(2);
if (!program || bakes.length === 0) {
  console.error('usage: node tools/measure.mjs PROGRAM BAKE…');
  process.exit(2);
}
const runs = 1;
const framesARun = 3;
const size = { width: 640, height: 360 };
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

/** Serves a bake; resolves with its address. */
function serve(bake) {
  const server = spawn(program, ['view', bake, '--no-open', '--json'], { stdio: ['ignore', 'pipe', 'ignore'] });
  const url = new Promise((resolve, reject) => {
    server.stdout.once('data', (line) => resolve(JSON.parse(String(line)).url));
    server.once('exit', () => reject(new Error(`${program} view ${bake} ended by itself`)));
  });
  return { url, stop: () => server.kill('SIGINT') };
}

async function run(browser, bake) {
  const server = serve(bake);
  const page = await browser.newPage({ viewport: size, deviceScaleFactor: 1, reducedMotion: 'reduce' });
  const network = await page.context().newCDPSession(page);
  await network.send('Network.enable');
  let bytes = 0;
  network.on('Network.dataReceived', ({ encodedDataLength }) => (bytes += encodedDataLength));
  const begin = performance.now();
  const soFar = () => ({ seconds: (performance.now() - begin) / 1000, bytes });
  await page.goto(`${await server.url}?antialias=off`);
  await page.waitForFunction(() => (window.skybake?.stats().frames ?? 0) > 0, null, { timeout: 300_000, polling: 50 });
  const first = soFar();
  await page.evaluate(() => window.skybake.ready);
  await page.evaluate(() => window.skybake.renderFrame());
  const whole = soFar();
  const frame = async () => median(await page.evaluate((n) => Array.from({ length: n }, () => window.skybake.renderFrame()), framesARun));
  const birdsEyeMs = await frame();
  const stats = await page.evaluate(() => window.skybake.stats());
  await page.evaluate(() => window.skybake.setMode('walk'));
  const streetMs = await frame();
  await page.close();
  server.stop();
  return { first, whole, stats, birdsEyeMs, streetMs };
}

const browser = await chromium.launch({
  executablePath: process.env['SKYBAKE_CHROMIUM'] ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage'],
});
const found = bakes.map(() => []);
for (let i = 0; i < runs; ++i) {
  for (const [k, bake] of bakes.entries()) found[k].push(await run(browser, bake));
}
await browser.close();

console.log('| bake | first picture, MB | s | whole light, MB | s | all instants, MB | draw calls | triangles | lightmaps on the card, MB | albedo on the card, MB | frame from the air, ms | on foot, ms |');
console.log('|---|---|---|---|---|---|---|---|---|---|---|---|');
for (const [k, bake] of bakes.entries()) {
  const manifest = JSON.parse(fs.readFileSync(path.join(bake, 'manifest.json'), 'utf8'));
  const web = manifest.files.reduce((sum, { name, bytes }) => sum + (name.endsWith('.exr') || name === 'objects.json' ? 0 : bytes), 0);
  const of = (value) => median(found[k].map(value));
  const { stats } = found[k][0];
  const row = [
    path.basename(bake), megabytes(of(({ first }) => first.bytes)), of(({ first }) => first.seconds).toFixed(1), megabytes(of(({ whole }) => whole.bytes)), of(({ whole }) => whole.seconds).toFixed(1),
    megabytes(web), stats.drawCalls, stats.triangles, megabytes(stats.lightBytes), megabytes(stats.textureBytes), of(({ birdsEyeMs }) => birdsEyeMs).toFixed(0), of(({ streetMs }) => streetMs).toFixed(0),
  ];
  console.log(`| ${row.join(' | ')} |`);
}
