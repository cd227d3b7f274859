import { createHash } from 'node:crypto';
import { defineConfig, type Plugin } from 'vite';

/** The hash of an inline text, as a Content-Security-Policy names it. */
const hash = (text: string): string => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/**
 * Makes one page of everything: no file beside it, no server, no network. The policy of the page allows this
 * script and this style, by their hashes, and nothing else.
 */
const onePage = (): Plugin => ({
  name: 'one-page',
  enforce: 'post',
  generateBundle(_, bundle) {
    const entries = Object.entries(bundle);
    const text = (end: string): string => {
      const texts = entries
        .filter(([name]) => name.endsWith(end))
        .map(([, file]) => {
          const content = file.type === 'chunk' ? file.code : file.source;
          return typeof content === 'string' ? content : new TextDecoder().decode(content);
        });
      return texts.join('').trim();
    };
    const script = text('.js').replaceAll('</script', '<\\/script');
    const style = text('.css');
    const policy = [
      "default-src 'none'",
      `script-src ${hash(script)}`,
      `style-src ${hash(style)}`,
      "base-uri 'none'",
      "form-action 'none'",
    ];
    const head = `<meta http-equiv="Content-Security-Policy" content="${policy.join('; ')}">`;
    const page = text('.html')
      .replace(/\s*<script type="module"[^>]*><\/script>/, '')
      .replace(/\s*<link rel="stylesheet"[^>]*>/, '')
      .replace('<!--policy-->', () => head)
      .replace('<!--style-->', () => `<style>${style}</style>`)
      .replace('<!--script-->', () => `<script type="module">${script}</script>`);
    for (const [name] of entries) Reflect.deleteProperty(bundle, name);
    this.emitFile({ type: 'asset', fileName: 'viewer.html', source: page });
  },
});

export default defineConfig({
  plugins: [onePage()],
  build: {
    outDir: '../crates/usar/assets',
    emptyOutDir: false,
    modulePreload: { polyfill: false },
    target: 'es2022',
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
