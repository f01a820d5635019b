// node grammar_test.mjs MODULES WORK SOURCE: the page's reader of share/graftal.tmLanguage.json (runtime/studio/page/src/grammar.ts, by the
// esbuild of the folder WORK, where the page was built) finds in all scenes what vscode-textmate finds.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, work, source] = process.argv.slice(2).map((name) => path.resolve(name));
const require = createRequire(path.join(modules, 'x'));
const { Registry, INITIAL, parseRawGrammar } = require('vscode-textmate');
const oniguruma = require('vscode-oniguruma');
const page = path.join(work, 'runtime/studio/page');
const { code } = createRequire(path.join(page, 'x'))('esbuild').transformSync(
  fs.readFileSync(path.join(page, 'src/grammar.ts'), 'utf8'), { loader: 'ts', format: 'esm' });
const { LineTokenizer } = await import(`data:text/javascript,${encodeURIComponent(code)}`);

await oniguruma.loadWASM(fs.readFileSync(path.join(modules, 'vscode-oniguruma/release/onig.wasm')));
const file = path.join(source, 'share/graftal.tmLanguage.json'), json = fs.readFileSync(file, 'utf8');
const registry = new Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => parseRawGrammar(json, file),
});
const theirs = await registry.loadGrammar('source.graftal'), ours = new LineTokenizer(JSON.parse(json));

/** [end, scope] of the pieces, neighbours of one scope as one. */
function joined(tokens) {
  return tokens.reduce((made, [end, scope]) => {
    if (made.at(-1)?.[1] === scope) made.at(-1)[0] = end;
    else if (end > (made.at(-1)?.[0] ?? 0)) made.push([end, scope]);
    return made;
  }, []);
}

let lines = 0;
function compare(name, text) {
  let stack = INITIAL, open = null;
  text.split('\n').forEach((line, index) => {
    const expected = theirs.tokenizeLine(line, stack), found = ours.line(line, open);
    stack = expected.ruleStack;
    ({ open } = found);
    assert.deepEqual(
      joined(found.tokens.map(({ to, scope }) => [to, scope])),
      joined(expected.tokens.map(({ endIndex, scopes }) => [Math.min(endIndex, line.length), scopes.at(-1) === 'source.graftal' ? '' : scopes.at(-1)])),
      `${name}:${index + 1}: ${line}`);
    ++lines;
  });
}

for (const name of fs.readdirSync(path.join(source, 'scenes'), { recursive: true })) {
  if (/\.(lsys|rifs|inst)$/.test(name)) compare(name, fs.readFileSync(path.join(source, 'scenes', name), 'utf8'));
}
compare('left open', 'A -> F[ # open\n\n  "text\n ) ] [\naxiom\n/* a\n\nb */ "x\ny -> (/*\n*/ 1.5e-3)');
console.log(`${lines} lines are read alike\n1 passed, 0 failed`);
