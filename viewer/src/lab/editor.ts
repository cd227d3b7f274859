/** The editor: one text at a time, each with its own history of changes and its own marks. */

import { defaultKeymap, history, historyKeymap, isolateHistory } from '@codemirror/commands';
import { bracketMatching, indentUnit } from '@codemirror/language';
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from '@codemirror/lint';
import { EditorState, type Extension, type Text, Transaction } from '@codemirror/state';
import {
  EditorView,
  drawSelection,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from '@codemirror/view';
import type { Problem } from './contract';
import { highlighting, ron, script } from './language';
import { nonce } from './page';

/** A change of a text, as CodeMirror has it. */
interface Change {
  from: number;
  to: number;
  insert: string;
}

/** The field of a problem with its value, as it stands in a line; null if it does not. */
function fieldIn(line: string, field: string | null): { from: number; to: number } | null {
  const name = /(\w+)(?:\[\d+\])*$/.exec(field ?? '')?.[1];
  const found = name === undefined ? null : new RegExp(`\\b${name}\\s*:\\s*[^,()\\[\\]]*`).exec(line);
  return found && { from: found.index, to: found.index + found[0].trimEnd().length };
}

/** Where a problem stands in a text: the word at its column, its field, or its line. */
function placeOf(text: Text, { line, column, field }: Problem): { from: number; to: number } {
  if (line === null) return { from: 0, to: text.line(1).to };
  const found = text.line(Math.min(Math.max(line, 1), text.lines));
  if (column !== null) {
    const from = Math.min(found.from + column - 1, found.to);
    const word = /^[\w.]+|^[^]/.exec(text.sliceString(from, found.to))?.[0].length ?? 0;
    if (word > 0) return { from, to: from + word };
  }
  const inLine = fieldIn(found.text, field);
  if (inLine) return { from: found.from + inLine.from, to: found.from + inLine.to };
  const indent = /^\s*/.exec(found.text)?.[0].length ?? 0;
  const content = found.text.replace(/\s*(\/\/.*)?$/, '').length;
  return { from: found.from + Math.min(indent, content), to: found.from + Math.max(content, indent) };
}

/**
 * Text typed in place of a selection. Browsers would keep the look of what was selected with a style in the
 * text, which the page does not allow.
 */
function replaceSelection(event: InputEvent, view: EditorView): boolean {
  const { data, inputType, isComposing } = event;
  if (inputType !== 'insertText' || data === null || isComposing || view.composing) return false;
  if (view.state.selection.ranges.every(({ empty }) => empty)) return false;
  event.preventDefault();
  view.dispatch(view.state.replaceSelection(data), { userEvent: 'input.type', scrollIntoView: true });
  return true;
}

export class Editor {
  readonly root: HTMLElement;
  private readonly view: EditorView;
  private readonly styles = EditorView.cspNonce.of(nonce());
  private readonly states = new Map<string, EditorState>();
  /** The name of the text that is shown. */
  shown = '';

  constructor(
    parent: HTMLElement,
    private readonly changed: (name: string) => void,
  ) {
    this.view = new EditorView({ parent, state: EditorState.create({ extensions: this.styles }) });
    this.root = this.view.dom;
  }

  private extensions(name: string): Extension {
    const isScript = name.endsWith('.js');
    const label = isScript ? 'Your own policy, in JavaScript' : `Text of the scenario ${name}`;
    return [
      this.styles,
      EditorView.contentAttributes.of({ 'aria-label': label, spellcheck: 'false' }),
      [lineNumbers(), lintGutter(), highlightActiveLine(), highlightActiveLineGutter(), drawSelection()],
      [history(), bracketMatching(), indentUnit.of(isScript ? '  ' : '    '), EditorView.lineWrapping],
      keymap.of([...defaultKeymap, ...historyKeymap, ...lintKeymap]),
      EditorView.domEventHandlers({ beforeinput: replaceSelection }),
      [isScript ? script : ron, highlighting],
      EditorView.updateListener.of(({ docChanged }) => {
        if (docChanged) this.changed(name);
      }),
    ];
  }

  private stateOf(name: string): EditorState | undefined {
    return name === this.shown ? this.view.state : this.states.get(name);
  }

  /** A text; undefined if there is none of this name. */
  text(name: string): string | undefined {
    return this.stateOf(name)?.doc.toString();
  }

  /** Adds a text that is not there yet. */
  add(name: string, text: string): void {
    if (this.stateOf(name)) return;
    this.states.set(name, EditorState.create({ doc: text, extensions: this.extensions(name) }));
  }

  /** Shows a text; the one before stays as it is. */
  show(name: string): void {
    const state = this.states.get(name);
    if (name === this.shown || !state) return;
    if (this.shown !== '') this.states.set(this.shown, this.view.state);
    this.shown = name;
    this.view.setState(state);
  }

  /** Gives a text that is there another content, as one step that can be undone. */
  replaceAll(name: string, text: string): void {
    const state = this.stateOf(name);
    if (!state || state.doc.toString() === text) return;
    const changes = { from: 0, to: state.doc.length, insert: text };
    if (name === this.shown) this.view.dispatch({ changes });
    else this.states.set(name, state.update({ changes }).state);
    if (name !== this.shown) this.changed(name);
  }

  /** Changes the text that is shown. A change that goes on with the one before is undone together with it. */
  change(changes: Change, goesOn: boolean): void {
    // Of the ways in which CodeMirror joins steps, this one knows no limit of time.
    const userEvent = Transaction.userEvent.of(goesOn ? 'input.type.compose' : 'input.slider');
    const annotations = goesOn ? [userEvent] : [userEvent, isolateHistory.of('before')];
    this.view.dispatch({ changes, annotations });
  }

  /** Marks the problems of a text. */
  mark(name: string, problems: readonly Problem[]): void {
    const state = this.stateOf(name);
    if (!state) return;
    const marks = problems.map((problem): Diagnostic => {
      return { ...placeOf(state.doc, problem), severity: 'error', message: problem.sentence };
    });
    marks.sort((a, b) => a.from - b.from);
    const marked = setDiagnostics(state, marks);
    if (name === this.shown) this.view.dispatch(marked);
    else this.states.set(name, state.update(marked).state);
  }

  /** Goes to where a problem of the text that is shown stands. */
  goTo(problem: Problem): void {
    const { from } = placeOf(this.view.state.doc, problem);
    this.view.dispatch({
      selection: { anchor: from },
      effects: EditorView.scrollIntoView(from, { y: 'center' }),
    });
    this.view.focus();
  }
}
