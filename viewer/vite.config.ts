import { defineConfig } from 'vite';
import { onePage } from './onePage';

export default defineConfig({
  plugins: [onePage({ fileName: 'viewer.html' })],
  build: {
    outDir: '../crates/usar/assets',
    emptyOutDir: false,
    modulePreload: { polyfill: false },
    target: 'es2022',
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
