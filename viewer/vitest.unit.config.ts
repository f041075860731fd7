import { defineConfig } from 'vitest/config';

// src/core runs in Node: no browser, no three.js.
export default defineConfig({ test: { include: ['test/unit/**/*.test.ts'], environment: 'node', hookTimeout: 60_000 } });
