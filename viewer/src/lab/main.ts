/** The page of the laboratory. */

import '../style.css';
import './lab.css';
import { element } from '../ui/dom';
import { running } from './helper';
import { Lab } from './lab';
import { pageSource, savedBlock } from './page';
import { fromHash, sessionOf } from './session';

declare global {
  interface Window {
    /** The page, for tests. */
    usarLab?: { lab: Lab; running: typeof running };
  }
}

/** Shows what the address holds, if it holds something. */
async function restoreAddress(lab: Lab): Promise<void> {
  const session = await fromHash(location.hash);
  if (session) lab.restore(session);
}

async function begin(root: HTMLElement): Promise<void> {
  const page = pageSource();
  const lab = new Lab(root, page);
  window.usarLab = { lab, running };
  const saved = sessionOf(savedBlock());
  if (saved) lab.restore(saved);
  const told = (error: unknown): void =>
    lab.say(`The link cannot be read: ${error instanceof Error ? error.message : String(error)}`);
  await restoreAddress(lab).catch(told);
  window.addEventListener('hashchange', () => {
    const isWanted = !lab.isEdited || window.confirm('Replace your texts by those of the link?');
    if (isWanted) void restoreAddress(lab).catch(told);
  });
  window.addEventListener('beforeunload', (event) => {
    if (lab.isEdited) event.preventDefault();
  });
  await lab.load();
  document.documentElement.dataset.ready = 'yes';
}

const root = document.getElementById('lab');
if (root) {
  begin(root).catch((error: unknown) => {
    const sentence = error instanceof Error ? error.message : String(error);
    root.prepend(
      element('p', { class: 'message', role: 'alert' }, `The laboratory cannot start: ${sentence}`),
    );
  });
}
