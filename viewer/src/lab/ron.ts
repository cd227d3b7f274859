/** Finds the plain values of a RON text by their paths. Broken texts have values, too. */

/** A plain value in a text: where it stands, and the fields that lead to it. */
export interface Leaf {
  /** Fields and places in lists: `mission.rest_s`, `team.0.count`. */
  path: string;
  kind: 'number' | 'string';
  /** The value as it is written; strings without their quotes. */
  text: string;
  from: number;
  to: number;
}

const TOKENS = [
  /\/\/[^\n]*/, // a comment to the end of the line
  /\/\*/, // the beginning of a comment that may hold others
  /r(#*)"[^]*?"\1/, // a raw string
  /"(?:\\[^]|[^"\\])*"/,
  /'(?:\\[^]|[^'\\])'/,
  /[A-Za-z_]\w*/,
  /[-+]?(?:\d[\d_]*\.?[\d_]*|\.\d+)(?:[eE][-+]?\d+)?/,
  /[([{}\]):,]/,
];

const TOKEN = TOKENS.map(({ source }) => source).join('|');

/** Something in brackets: the field or place that its next value has. */
interface Bracket {
  key: string | null;
  place: number;
}

/** Where a comment that begins at a place ends; comments may hold comments. */
function commentEnd(text: string, begin: number): number {
  const marks = /\/\*|\*\//g;
  marks.lastIndex = begin;
  let depth = 0;
  for (let mark = marks.exec(text); mark; mark = marks.exec(text)) {
    depth += mark[0] === '/*' ? 1 : -1;
    if (depth === 0) return marks.lastIndex;
  }
  return text.length;
}

/** Whether a `:` follows, so that what stands before it is the name of a field. */
const isField = (text: string, from: number): boolean => /^\s*:(?!:)/.test(text.slice(from, from + 40));

export class Scanner {
  private readonly brackets: Bracket[] = [];
  private readonly leaves: Leaf[] = [];

  private constructor(private readonly text: string) {}

  /** The plain values of a text, in their order. */
  static scan(text: string): Leaf[] {
    const scanner = new Scanner(text);
    scanner.run();
    return scanner.leaves;
  }

  private run(): void {
    const tokens = new RegExp(TOKEN, 'g');
    for (let found = tokens.exec(this.text); found; found = tokens.exec(this.text)) {
      const [token] = found;
      if (token === '/*') tokens.lastIndex = commentEnd(this.text, found.index);
      else if (!token.startsWith('//')) this.take(token, found.index, tokens.lastIndex);
    }
  }

  private take(token: string, from: number, to: number): void {
    const inner = this.brackets.at(-1);
    if ('([{'.includes(token)) this.brackets.push({ key: null, place: 0 });
    else if (')]}'.includes(token)) this.brackets.pop();
    else if (token === ',') {
      if (inner) [inner.key, inner.place] = [null, inner.place + 1];
    } else if (/^[-+.\d]/.test(token)) this.add('number', token, from, to);
    else if (isField(this.text, to) && inner?.key === null) inner.key = token.replace(/^"|"$/g, '');
    else if (/^r?#*"/.test(token)) this.add('string', token.replace(/^r?#*"|"#*$/g, ''), from, to);
  }

  private add(kind: Leaf['kind'], text: string, from: number, to: number): void {
    // The outermost brackets hold the fields of the scenario.
    const path = this.brackets.map(({ key, place }) => key ?? String(place)).join('.');
    this.leaves.push({ path, kind, text, from, to });
  }
}

/** The path of the scenario of which a text says what differs; null if it says everything itself. */
export function baseOf(text: string): string | null {
  return Scanner.scan(text).find(({ path, kind }) => path === 'base' && kind === 'string')?.text ?? null;
}
