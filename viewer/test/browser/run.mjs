// npm run test:browser [-- BAKE_DIR]: the browser tests on the synthetic bake, and on a real one when its folder is given.
import path from 'node:path';
import { startVitest } from 'vitest/node';

const [bake, ...rest] = process.argv.slice(2).filter((argument) => !argument.startsWith('--'));
if (rest.length > 0) {
  console.error('usage: npm run test:browser [-- BAKE_DIR] [-- --update-golden]');
  process.exit(2);
}
if (bake) process.env['SKYBAKE_BAKE'] = path.resolve(bake);
if (process.argv.includes('--update-golden')) process.env['SKYBAKE_UPDATE_GOLDEN'] = '1';
const vitest = await startVitest('test', [], { config: 'vitest.browser.config.ts', watch: false });
await vitest?.close();
