import { defineConfig } from 'vitest/config';

// The built walkthrough in a real browser. One file after the other: two software rasterisers would only wait for each other.
export default defineConfig({
  test: { include: ['test/browser/**/*.test.ts'], environment: 'node', fileParallelism: false, testTimeout: 120_000, hookTimeout: 120_000, expect: { poll: { timeout: 20_000 } } },
});
