/** One HTML page of everything: script, style and whatever else it carries. */

import { createHash } from 'node:crypto';
import type { Plugin } from 'vite';

/** What a page is called, what it carries, and what its Content-Security-Policy allows besides. */
interface PageOptions {
  fileName: string;
  /** Texts that take the place of comments: `wasm` for `<!--wasm-->`. */
  blocks?: () => Record<string, string>;
  /** Further sources of scripts. */
  scripts?: string[];
  /** Whether styles that the script makes are allowed, by the nonce in `<meta name="nonce">`. */
  hasNonce?: boolean;
  /** Further directives. */
  directives?: string[];
}

const digest = (text: string): string => createHash('sha256').update(text).digest('base64');

/** The hash of an inline text, as a Content-Security-Policy names it. */
const hash = (text: string): string => `'sha256-${digest(text)}'`;

/**
 * Makes one page of everything: no file beside it, no server, no network. The policy of the page allows this
 * script and this style, by their hashes, and what the options say.
 */
export const onePage = (options: PageOptions): Plugin => ({
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
    if (script.includes('<!--')) this.error('The script has "<!--", which HTML reads as a comment.');
    const style = text('.css');
    const nonce = digest(script + style);
    const policy = [
      "default-src 'none'",
      ['script-src', hash(script), ...(options.scripts ?? [])].join(' '),
      ['style-src', hash(style), ...(options.hasNonce ? [`'nonce-${nonce}'`] : [])].join(' '),
      ...(options.directives ?? []),
      "base-uri 'none'",
      "form-action 'none'",
    ];
    const head = [`<meta http-equiv="Content-Security-Policy" content="${policy.join('; ')}">`];
    if (options.hasNonce) head.push(`<meta name="nonce" content="${nonce}">`);
    let page = text('.html')
      .replace(/\s*<script type="module"[^>]*><\/script>/, '')
      .replace(/\s*<link rel="stylesheet"[^>]*>/, '')
      .replace('<!--policy-->', () => head.join('\n    '))
      .replace('<!--style-->', () => `<style>${style}</style>`);
    for (const [name, block] of Object.entries(options.blocks?.() ?? {})) {
      page = page.replace(`<!--${name}-->`, () => block);
    }
    page = page.replace('<!--script-->', () => `<script type="module">${script}</script>`);
    for (const [name] of entries) Reflect.deleteProperty(bundle, name);
    this.emitFile({ type: 'asset', fileName: options.fileName, source: page });
  },
});
