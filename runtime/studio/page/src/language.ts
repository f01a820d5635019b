// What the editor shows of the grammar: CodeMirror's tags for TextMate's scopes, and the colours of both.
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { tags, type Tag } from '@lezer/highlight';
import grammar from '../../../../share/graftal.tmLanguage.json';
import { LineTokenizer, type Frame, type Grammar, type Token } from './grammar';

const tag_of_scope: [string, string, Tag][] = [
  ['comment', 'comment', tags.comment],
  ['string', 'string', tags.string],
  ['constant.numeric', 'number', tags.number],
  ['keyword.control', 'keyword', tags.keyword],
  ['keyword.operator.turtle', 'turtle', tags.controlOperator],
  ['keyword.operator', 'operator', tags.operator],
  ['keyword.other', 'verb', tags.operatorKeyword],
  ['entity.name.type', 'name', tags.definition(tags.typeName)],
  ['support.type', 'primitive', tags.standard(tags.typeName)],
  ['support.function', 'function', tags.function(tags.name)],
  ['variable.parameter', 'field', tags.propertyName],
  ['punctuation', 'branch', tags.bracket],
];
const longest_line = 5000;

interface State {
  open: Frame | null;
  tokens: Token[];
  next: number;
}

const tokenizer = new LineTokenizer(grammar as unknown as Grammar);

function style_of(scope: string): string | null {
  return tag_of_scope.find(([prefix]) => scope.startsWith(prefix))?.[1] ?? null;
}

const stream = StreamLanguage.define<State>({
  name: 'graftal',
  startState: () => ({ open: null, tokens: [], next: 0 }),
  copyState: (state) => ({ ...state }),
  blankLine(state) {
    state.open = tokenizer.line('', state.open).open;
  },
  token(input, state) {
    if (input.sol()) {
      const { tokens, open } = input.string.length > longest_line
        ? { tokens: [], open: state.open }
        : tokenizer.line(input.string, state.open);
      Object.assign(state, { tokens, open, next: 0 });
    }
    const token = state.tokens[state.next++];
    if (!token) {
      input.skipToEnd();
      return null;
    }
    input.pos = token.to;
    return style_of(token.scope);
  },
  languageData: { commentTokens: { line: '#' }, closeBrackets: { brackets: ['(', '[', '{', '"'] } },
  tokenTable: Object.fromEntries(tag_of_scope.map(([, style, tag]) => [style, tag])),
});

const colours = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--code-comment)', fontStyle: 'italic' },
  { tag: tags.string, color: 'var(--code-string)' },
  { tag: tags.number, color: 'var(--code-number)' },
  { tag: tags.keyword, color: 'var(--code-keyword)', fontWeight: '600' },
  { tag: tags.controlOperator, color: 'var(--code-verb)' },
  { tag: tags.operatorKeyword, color: 'var(--code-verb)' },
  { tag: tags.definition(tags.typeName), color: 'var(--code-name)' },
  { tag: tags.standard(tags.typeName), color: 'var(--code-name)' },
  { tag: tags.function(tags.name), color: 'var(--code-name)' },
  { tag: tags.propertyName, color: 'var(--code-verb)' },
  { tag: tags.bracket, color: 'var(--code-verb)', fontWeight: '600' },
]);

export const graftal_language = [stream, syntaxHighlighting(colours)];
