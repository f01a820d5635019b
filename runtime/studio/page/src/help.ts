// The page of help: what hands and keys do.
import { element } from './dom';

const parts: [string, [string, string][]][] = [
  ['Picture', [
    ['drag, or arrow keys', 'orbit; near by, about the surface in the middle; pan a flat model'],
    ['Shift and drag, or Shift and arrow keys', 'pan; orbit a flat model'],
    ['drag by the right or middle button', 'pan'],
    ['Ctrl and drag, or Page Up and Page Down', 'move the camera nearer and farther'],
    ['wheel, or + and −', 'zoom, without an end'],
    ['0', 'show the whole model'],
    ['click', 'select the rule in the text'],
  ]],
  ['Text', [
    ['drag a number', 'change it; with Shift finer; with Alt select text'],
    ['click on a swatch', 'choose a colour'],
    ['Ctrl+Space', 'complete a word'],
    ['F12, or Ctrl and click', 'go to the definition'],
    ['F2', 'rename'],
    ['Shift+Alt+F', 'format'],
    ['Ctrl+] and Ctrl+[', 'indent lines more, and less'],
    ['Tab', 'leave the text'],
  ]],
  ['Touch', [
    ['one finger on the picture', 'orbit; pan a flat model'],
    ['two fingers', 'pan and zoom: what is under them goes with them'],
    ['a tap', 'select the rule in the text'],
    ['one finger on the dot, a box or its handles', 'drag it, as a mouse does'],
  ]],
  ['Knobs', [
    ['drag, or arrow keys', 'change; with Shift finer'],
    ['double click on a number, or Enter', 'type it'],
  ]],
  ['Maps', [
    ['click on a box', 'select the map in the text; a second click, the part that is there'],
    ['drag a box', 'move the map'],
    ['square at a corner', 'scale'],
    ['diamond at a side', 'stretch and shear'],
    ['round knob with an arrow', 'turn about the foot, where the cross is; with Shift by steps of 15°; with Alt about the middle'],
    ['arrow keys on a box, or on a name after Enter', 'move the map; with Shift turn and scale it'],
    ['a picture dropped on the page', 'a target behind the boxes, to which Fit moves the maps'],
  ]],
  ['Everywhere', [
    ['Ctrl+Z, Ctrl+Shift+Z', 'undo and redo: text, knobs and camera'],
    ['Ctrl+S', 'save the text'],
    ['F6', 'go from the text to the picture to the tools'],
  ]],
];

export function fill_help(dialog: HTMLDialogElement): void {
  // A hand without a mouse finds its own first.
  const is_first = ([title]: [string, unknown]) => title === 'Touch' && matchMedia('(pointer: coarse)').matches;
  const sorted = [...parts].sort((a, b) => Number(is_first(b)) - Number(is_first(a)));
  dialog.append(
    element('button', { type: 'button', class: 'quiet', onclick: () => dialog.close() }, 'Close'),
    element('h2', { id: 'help-title' }, 'Hands and keys'),
    element('div', {}, ...sorted.map(([title, rows]) => element('section', {}, element('h3', {}, title),
      element('dl', {}, ...rows.flatMap(([keys, does]) => [element('dt', {}, keys), element('dd', {}, does)]))))),
    element('p', { class: 'note' }, 'The editor is CodeMirror: ', element('a', { href: 'licences.html', target: '_blank' }, 'licences'), '.'),
  );
  dialog.addEventListener('click', (event) => event.target === dialog && dialog.close());
}
