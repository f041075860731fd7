import { defineConfig } from 'vite';

// base './': the built folder works from any place of any static host, and from inside a bake folder.
export default defineConfig({
  base: './',
  // assetsDir: apps/skybake/viewer_assets.cpp copies index.html and this folder into a bake.
  build: { target: 'es2022', assetsDir: 'viewer', chunkSizeWarningLimit: 1500, assetsInlineLimit: 0 },
});
