import { defineConfig } from 'vite';

// base './': the built folder works from any place of any static host, and from inside a bake folder.
export default defineConfig({
  base: './',
  build: { target: 'es2022', chunkSizeWarningLimit: 1500, assetsInlineLimit: 0 },
});
