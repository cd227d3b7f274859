/** What the page is made of: its own source, and the blocks that it carries. */

/** The nonce that styles of scripts need. */
export const nonce = (): string =>
  document.querySelector<HTMLMetaElement>('meta[name="nonce"]')?.content ?? '';

/** The content of the block of texts that were saved with the page. */
export function savedBlock(): unknown {
  try {
    return JSON.parse(document.getElementById('saved')?.textContent ?? 'null') as unknown;
  } catch {
    return null;
  }
}

/** The page as it was delivered; to be taken before anything is changed. */
export function pageSource(): string {
  // It is read, and written to a file: nothing becomes markup of this page.
  // eslint-disable-next-line no-restricted-syntax
  return `<!doctype html>\n${document.documentElement.outerHTML}\n`;
}

/** The page with other texts saved in it. */
export function withSaved(source: string, saved: unknown): string {
  const text = JSON.stringify(saved).replaceAll('<', '\\u003c');
  return source.replace(/(<script [^>]*id="saved"[^>]*>)[^<]*/, (_, tag: string) => tag + text);
}

/** Copies a text; returns whether the browser allowed it. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

/** Gives the reader a file. */
export function download(name: string, content: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
  // The browser has begun to read it by then.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
