/** Reads the recordings that are in the page and shows them. */

import './style.css';
import { Recording } from './recording/recording';
import { App } from './ui/app';
import { element } from './ui/dom';
import { TrialList, chosenOf } from './ui/trialList';

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

/** A recording that can be read. */
interface File {
  name: string;
  bytes: () => Uint8Array;
}

/** The recordings in the page, and whether they are a list to choose from. */
function embedded(): { files: File[]; isList: boolean } {
  const blocks = [...document.querySelectorAll<HTMLScriptElement>('script[type="application/x-usrec"]')];
  const files = blocks.map((block) => ({
    name: block.dataset.name ?? '',
    bytes: () => bytesOf(block.textContent),
  }));
  return { files, isList: blocks.some(({ dataset }) => dataset.listed !== undefined) };
}

/** Shows recordings, with a list to choose from. */
async function show(root: HTMLElement, files: File[], list?: TrialList): Promise<void> {
  const status = element('p', { role: 'status' }, 'Reading the recording ...');
  root.replaceChildren(element('div', { class: 'message' }, status));
  try {
    const recordings: Recording[] = [];
    for (const { name, bytes } of files) recordings.push(await Recording.read(name, bytes()));
    const app = new App(root, recordings, { list: list?.root });
    window.usarView = app;
    for (const recording of recordings) await recording.survey();
    app.refresh();
    document.documentElement.dataset.ready = 'yes';
  } catch (error) {
    root.replaceChildren(element('div', { class: 'message' }, element('h1', {}, 'Nothing to show')));
    root.firstElementChild?.append(element('p', {}, error instanceof Error ? error.message : String(error)));
  }
}

/** Shows some of many recordings, and says what each rescued. An address with other trials shows those. */
async function choose(root: HTMLElement, files: File[]): Promise<void> {
  const names = files.map(({ name }) => name);
  const chosen = chosenOf(names, location.hash);
  window.addEventListener('hashchange', () => {
    if (chosenOf(names, location.hash).join() !== chosen.join()) location.reload();
  });
  const list = new TrialList(names, chosen);
  await show(
    root,
    files.filter(({ name }) => chosen.includes(name)),
    list,
  );
  for (const { name, bytes } of files) list.tell(await Recording.read(name, bytes()));
}

/** Without a recording in the page, asks for files. */
function ask(root: HTMLElement): void {
  const input = element('input', { type: 'file', multiple: '', accept: '.usrec' });
  input.addEventListener('change', () => {
    const files = [...(input.files ?? [])];
    const read = files.map(async (file): Promise<File> => {
      const bytes = new Uint8Array(await file.arrayBuffer());
      return { name: file.name, bytes: () => bytes };
    });
    void Promise.all(read).then((all) => show(root, all));
  });
  const label = element('label', {}, 'Open recordings (.usrec): ', input);
  root.replaceChildren(element('div', { class: 'message' }, element('h1', {}, 'usar view'), label));
}

const root = document.getElementById('app');
if (root) {
  const { files, isList } = embedded();
  if (files.length === 0) ask(root);
  else void (isList ? choose(root, files) : show(root, files));
}
