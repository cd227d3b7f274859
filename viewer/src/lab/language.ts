/** Colours for RON and for the own policy's JavaScript: simple ones, by the kind of each word. */

import { HighlightStyle, StreamLanguage, type StringStream, syntaxHighlighting } from '@codemirror/language';
import type { Extension } from '@codemirror/state';
import { tags } from '@lezer/highlight';

/** How deep the comment is in which a line begins. */
interface State {
  comments: number;
}

function comment(stream: StringStream, state: State, isNested: boolean): string {
  while (!stream.eol()) {
    if (stream.match('*/')) state.comments -= 1;
    else if (isNested && stream.match('/*')) state.comments += 1;
    else stream.next();
    if (state.comments === 0) break;
  }
  return 'comment';
}

/** What a word is: a field, a keyword, a kind. */
type Word = (word: string, stream: StringStream) => string | null;

function language(word: Word, isNested: boolean, strings: RegExp): Extension {
  return StreamLanguage.define<State>({
    startState: () => ({ comments: 0 }),
    token(stream, state) {
      if (state.comments > 0) return comment(stream, state, isNested);
      if (stream.eatSpace()) return null;
      if (stream.match(/^\/\/.*/)) return 'comment';
      if (stream.match('/*')) {
        state.comments = 1;
        return comment(stream, state, isNested);
      }
      if (stream.match(strings)) return 'string';
      if (stream.match(/^[-+]?\.?\d[\d_.]*(?:[eE][-+]?\d+)?/)) return 'number';
      const name = stream.match(/^[A-Za-z_$][\w$]*/) as RegExpMatchArray | null;
      if (name) return word(name[0], stream);
      stream.next();
      return null;
    },
    languageData: { commentTokens: { line: '//', block: { open: '/*', close: '*/' } } },
  });
}

const ronWord: Word = (word, stream) => {
  if (stream.match(/^\s*:(?!:)/, false)) return 'propertyName';
  return word === 'true' || word === 'false' ? 'bool' : 'typeName';
};

const KEYWORDS = new Set([
  ...['break', 'case', 'catch', 'class', 'const', 'continue', 'default', 'delete', 'do', 'else', 'extends'],
  ...['false', 'finally', 'for', 'function', 'if', 'in', 'instanceof', 'let', 'new', 'null', 'of', 'return'],
  ...['static', 'super', 'switch', 'this', 'throw', 'true', 'try', 'typeof', 'undefined', 'var', 'void'],
  ...['while', 'yield'],
]);

const scriptWord: Word = (word) => (KEYWORDS.has(word) ? 'keyword' : null);

const RON_STRING = /^(?:r(#*)"[^]*?"\1|"(?:\\.|[^"\\])*"?|'(?:\\.|[^'\\])')/;
const SCRIPT_STRING = /^(?:"(?:\\.|[^"\\])*"?|'(?:\\.|[^'\\])*'?|`(?:\\.|[^`\\])*`?)/;

export const ron = language(ronWord, true, RON_STRING);
export const script = language(scriptWord, false, SCRIPT_STRING);

/** The colours stand in the style sheet, where they know of light and dark. */
export const highlighting = syntaxHighlighting(
  HighlightStyle.define([
    { tag: tags.comment, class: 'code-comment' },
    { tag: tags.string, class: 'code-string' },
    { tag: [tags.number, tags.bool], class: 'code-number' },
    { tag: tags.propertyName, class: 'code-field' },
    { tag: [tags.typeName, tags.keyword], class: 'code-word' },
  ]),
);
