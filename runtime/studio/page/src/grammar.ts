// Reads a TextMate grammar as editors do, as far as share/graftal.tmLanguage.json goes: match, begin and end, captures,
// includes. tests/studio holds it to vscode-textmate over all scenes.

interface Captures {
  [group: string]: { name: string };
}

export interface Rule {
  name?: string;
  match?: string;
  begin?: string;
  end?: string;
  captures?: Captures;
  beginCaptures?: Captures;
  include?: string;
  patterns?: Rule[];
}

export interface Grammar {
  patterns: Rule[];
  repository: Record<string, Rule>;
}

export interface Token {
  from: number;
  to: number;
  /** Innermost scope, such as `constant.numeric.graftal`; empty: plain text. */
  scope: string;
}

/** An open begin, and those that it is in; null at the top. */
export interface Frame {
  readonly rule: Compiled;
  readonly outer: Frame | null;
}

interface Compiled {
  name: string;
  /** What the rule looks for: its match, or its begin. */
  opens: RegExp;
  closes: RegExp | null;
  open_captures: Captures;
  close_captures: Captures;
  inner: () => Compiled[];
}

export class LineTokenizer {
  private readonly made = new Map<Rule, Compiled>();
  private readonly top: Compiled[];

  constructor(private readonly grammar: Grammar) {
    this.top = this.flat(grammar.patterns);
  }

  /** The pieces of a line, in order, and what is open behind it. */
  line(text: string, open: Frame | null): { tokens: Token[]; open: Frame | null } {
    const tokens: Token[] = [];
    const found = new Map<RegExp, RegExpExecArray | null>();
    let at = 0;
    const put = (to: number, scope: string) => {
      if (to > at) tokens.push({ from: at, to, scope });
      at = Math.max(at, to);
    };
    const search = (pattern: RegExp) => {
      const known = found.get(pattern);
      if (known === null || (known && known.index >= at)) return known;
      pattern.lastIndex = at;
      const match = pattern.exec(text);
      found.set(pattern, match);
      return match;
    };
    // Each turn moves on, or opens or closes one frame where it stands; a grammar that turns in place ends with its line.
    for (let turns = 0; turns <= 4 * text.length + 8; ++turns) {
      let first: { match: RegExpExecArray; rule: Compiled | null } | null = null;
      const closing = open?.rule.closes ? search(open.rule.closes) : null;
      if (closing) first = { match: closing, rule: null };
      for (const rule of open ? open.rule.inner() : this.top) {
        const match = search(rule.opens);
        if (match && (!first || match.index < first.match.index)) first = { match, rule };
      }
      const outside = open?.rule.name ?? '';
      if (!first) break;
      const { match, rule } = first;
      put(match.index, outside);
      if (rule === null) {
        this.put_captures(match, open!.rule.close_captures, outside, put);
        open = open!.outer;
      } else {
        this.put_captures(match, rule.open_captures, rule.name || outside, put);
        if (rule.closes) open = { rule, outer: open };
        else if (match[0] === '') break;
      }
    }
    put(text.length, open?.rule.name ?? '');
    return { tokens, open };
  }

  private put_captures(match: RegExpExecArray, captures: Captures, scope: string, put: (to: number, scope: string) => void): void {
    const whole = captures['0']?.name ?? scope;
    for (let group = 1; group < match.length; ++group) {
      const span = match.indices![group], name = captures[group]?.name;
      if (!span || !name) continue;
      put(span[0], whole);
      put(span[1], name);
    }
    put(match.index + match[0].length, whole);
  }

  private flat(patterns: Rule[]): Compiled[] {
    return patterns.flatMap((rule) => {
      if (rule.include) {
        const named = this.grammar.repository[rule.include.slice(1)];
        return named ? this.flat([named]) : [];
      }
      if (rule.match === undefined && rule.begin === undefined) return this.flat(rule.patterns ?? []);
      return [this.compile(rule)];
    });
  }

  private compile(rule: Rule): Compiled {
    const known = this.made.get(rule);
    if (known) return known;
    let inner: Compiled[] | null = null;
    const captures = rule.captures ?? {};
    const compiled: Compiled = {
      name: rule.name ?? '',
      opens: new RegExp((rule.match ?? rule.begin)!, 'dg'),
      closes: rule.end === undefined ? null : new RegExp(rule.end, 'dg'),
      open_captures: rule.beginCaptures ?? captures,
      close_captures: captures,
      inner: () => (inner ??= this.flat(rule.patterns ?? [])),
    };
    this.made.set(rule, compiled);
    return compiled;
  }
}
