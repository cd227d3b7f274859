import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { type Plugin, type Rollup, build, defineConfig } from 'vite';
import { onePage } from './onePage';

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** The simulator as WebAssembly. */
const module = process.env.LAB_WASM ?? here('../target/lab/usar_lab.wasm');

/** The module as a block of the page; the same module makes the same block. */
function wasmBlock(): string {
  const packed = gzipSync(readFileSync(module), { level: 9 });
  packed[9] = 255; // the system on which it was packed: not said
  return `<script type="application/wasm" id="wasm">${packed.toString('base64')}</script>`;
}

const NAME = 'virtual:lab-worker';

/** The script of the workers as a text: a worker of the page begins with a Blob, for there is no file. */
const workerText = (): Plugin => ({
  name: 'lab-worker',
  resolveId: (name) => (name === NAME ? `\0${NAME}` : null),
  async load(name) {
    if (name !== `\0${NAME}`) return null;
    for (const file of ['worker', 'module', 'policyErrors']) this.addWatchFile(here(`src/lab/${file}.ts`));
    const made = await build({
      configFile: false,
      logLevel: 'warn',
      build: {
        write: false,
        target: 'es2022',
        lib: { entry: here('src/lab/worker.ts'), formats: ['iife'], name: 'labWorker' },
      },
    });
    const [output] = made as Rollup.RollupOutput[];
    return `export default ${JSON.stringify(output.output[0].code)};`;
  },
});

export default defineConfig({
  plugins: [
    workerText(),
    onePage({
      fileName: 'usar-lab.html',
      blocks: () => ({ wasm: wasmBlock() }),
      scripts: ["'wasm-unsafe-eval'"],
      hasNonce: true,
      directives: ['worker-src blob:', 'img-src data:'],
    }),
  ],
  build: {
    outDir: '../target/lab',
    emptyOutDir: false,
    modulePreload: { polyfill: false },
    target: 'es2022',
    rollupOptions: { input: here('lab.html'), output: { inlineDynamicImports: true } },
  },
});
