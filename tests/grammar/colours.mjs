// node colours.mjs MODULES SOURCE: reads models by share/graftal.tmLanguage.json as Visual Studio Code does (vscode-textmate and
// Oniguruma, of the folder MODULES), and compares what some words become. No scene may leave a comment, string or bracket open.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, source] = process.argv.slice(2);
if (!fs.existsSync(modules)) {
  console.error(`there is no ${modules}: tools/test installs it from npm`);
  process.exit(1);
}
const require = createRequire(path.join(modules, 'x'));
const { Registry, INITIAL, parseRawGrammar } = require('vscode-textmate');
const oniguruma = require('vscode-oniguruma');
await oniguruma.loadWASM(fs.readFileSync(path.join(modules, 'vscode-oniguruma/release/onig.wasm')));
const file = path.join(source, 'share/graftal.tmLanguage.json');
const registry = new Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => parseRawGrammar(fs.readFileSync(file, 'utf8'), file),
});
const grammar = await registry.loadGrammar('source.graftal');

// Each line's pieces, [text, innermost scope without its ".graftal"], and how deep the text ends.
function colour(text) {
  let stack = INITIAL;
  const lines = text.split('\n').map((line) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    return tokens.map((token) => [
      line.slice(token.startIndex, token.endIndex),
      token.scopes.at(-1).replace(/\.graftal$/, ''),
    ]);
  });
  return { lines, depth: stack.depth };
}

const control = 'keyword.control', comment = 'comment.line', number = 'constant.numeric', turn = 'keyword.operator.turtle';
const branch = 'punctuation.section.branch', plain = 'source';
const cases = [
  ['object tree { instance: cube  scale: 1/2 }', ['object', control], ['tree', 'entity.name.type'], ['instance', control],
    ['cube', 'support.type'], ['scale', 'keyword.other'], ['1', number], ['/', 'keyword.operator'], ['2', number]],
  ['map n { scale 1/2 } // half', ['map', control], ['n', 'entity.name.type'], ['// half', comment]],
  ['let k = sin(30) # degrees', ['k', 'entity.name.type'], ['sin', 'support.function'], ['30', number], ['# degrees', comment]],
  ['  seg -> F[//&leaf](35) : 0.33 # a leaf', ['->', control], ['[', branch], ['//&', turn], [']', branch], ['35', number],
    ['0.33', number], ['# a leaf', comment]],
  ['axiom A//B', ['axiom', control], ['A', plain], ['//', turn], ['B', plain]],
  ['  A -> F[    # open\n    //A\n  ][-A]\nobject', ['# open', comment], ['//', turn], ['][', branch], ['-', turn],
    ['object', control]],
  ['bark { texture: "bark.png" around: 2e1 }', ['texture', control], ['"bark.png"', 'string.quoted.double'],
    ['around', 'variable.parameter'], ['2e1', number]],
  ['/* two\nlines */ camera', ['/* twolines */', 'comment.block'], ['camera', control]],
];
let faults = 0, models = 0;
function fault(text) {
  console.error(text);
  ++faults;
}

// Neighbours of one scope are one piece.
function joined(pieces) {
  const result = [];
  for (const [text, scope] of pieces) {
    if (result.length && result.at(-1)[1] === scope) result.at(-1)[0] += text;
    else result.push([text, scope]);
  }
  return result;
}

for (const [text, ...expected] of cases) {
  const pieces = joined(colour(text).lines.flat());
  let at = 0;
  for (const [piece, scope] of expected) {
    const found = pieces.findIndex(([other, its], i) => i >= at && its === scope && other.trim() === piece.trim());
    if (found < 0) {
      fault(`'${text}': '${piece}' is no ${scope} among ${JSON.stringify(pieces)}`);
      break;
    }
    at = found + 1;
  }
}

function look(name, text, language) {
  ++models;
  const { lines, depth } = colour(text.replace(/\n$/, '') + '\n');
  if (depth !== 1) fault(`${name} ends in the midst of something`);
  lines.forEach((pieces, i) => {
    let before = '';
    for (const [piece, scope] of joined(pieces)) {
      // Turns of the turtle in the string of an L-system.
      if (language === 'lsys' && scope === comment && piece.startsWith('//') && /\S$/.test(before))
        fault(`${name}:${i + 1}: '${piece}' is no comment`);
      if (scope !== comment && scope !== 'comment.block' && scope !== 'string.quoted.double' && piece.includes('#'))
        fault(`${name}:${i + 1}: '${piece}' holds a comment`);
      before += piece;
    }
  });
}

for (const entry of fs.readdirSync(path.join(source, 'scenes'), { recursive: true })) {
  const language = path.extname(entry).slice(1);
  if (['lsys', 'rifs', 'inst'].includes(language))
    look(`scenes/${entry}`, fs.readFileSync(path.join(source, 'scenes', entry), 'utf8'), language);
}
const page = fs.readFileSync(path.join(source, 'docs/language.md'), 'utf8');
for (const example of page.matchAll(/\n```(lsys|rifs|inst)\n(.*?)\n```\n/gs))
  look(`docs/language.md, '${example[2].split('\n')[0]}'`, example[2], example[1]);
if (models < 100) fault(`only ${models} models were found`);
if (faults) process.exit(1);
console.log(`${cases.length} cases, ${models} models`);
