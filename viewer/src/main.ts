/** Reads the recordings that are in the page and shows them. */

import './style.css';
import { Recording } from './recording/recording';
import { App } from './ui/app';
import { element } from './ui/dom';

declare global {
  interface Window {
    /** The page, for tests. */
    usarView?: App;
  }
}

/** Bytes of a text in base 64. */
function bytesOf(text: string): Uint8Array {
  const bytes = atob(text.trim());
  return Uint8Array.from({ length: bytes.length }, (_, i) => bytes.charCodeAt(i));
}

/** The recordings in the page: name and bytes. Their texts are let go. */
function embedded(): [string, Uint8Array][] {
  const blocks = document.querySelectorAll<HTMLScriptElement>('script[type="application/x-usrec"]');
  return [...blocks].map((block) => {
    const bytes = bytesOf(block.textContent);
    block.textContent = '';
    return [block.dataset.name ?? '', bytes];
  });
}

async function show(root: HTMLElement, files: [string, Uint8Array][]): Promise<void> {
  const status = element('p', { role: 'status' }, 'Reading the recording ...');
  root.replaceChildren(element('div', { class: 'message' }, status));
  try {
    const recordings: Recording[] = [];
    for (const [name, bytes] of files) recordings.push(await Recording.read(name, bytes));
    const app = new App(root, recordings);
    window.usarView = app;
    for (const recording of recordings) await recording.survey();
    app.refresh();
    document.documentElement.dataset.ready = 'yes';
  } catch (error) {
    root.replaceChildren(element('div', { class: 'message' }, element('h1', {}, 'Nothing to show')));
    root.firstElementChild?.append(element('p', {}, error instanceof Error ? error.message : String(error)));
  }
}

/** Without a recording in the page, asks for files. */
function ask(root: HTMLElement): void {
  const input = element('input', { type: 'file', multiple: '', accept: '.usrec' });
  input.addEventListener('change', () => {
    const files = [...(input.files ?? [])];
    const read = files.map(
      async (file) => [file.name, new Uint8Array(await file.arrayBuffer())] as [string, Uint8Array],
    );
    void Promise.all(read).then((all) => show(root, all));
  });
  const label = element('label', {}, 'Open recordings (.usrec): ', input);
  root.replaceChildren(element('div', { class: 'message' }, element('h1', {}, 'usar view'), label));
}

const root = document.getElementById('app');
if (root) {
  const files = embedded();
  if (files.length > 0) void show(root, files);
  else ask(root);
}
