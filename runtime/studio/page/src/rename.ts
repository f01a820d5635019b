// A line below the text that asks for a new name.
import { StateEffect, StateField, type Extension } from '@codemirror/state';
import { EditorView, showPanel, type Panel } from '@codemirror/view';
import { element } from './dom';
import type { Edit } from './protocol';
import type { Studio } from './studio';

const set_open = StateEffect.define<boolean>();

export function open_rename(view: EditorView): boolean {
  view.dispatch({ effects: set_open.of(true) });
  return true;
}

export function rename_panel(studio: Studio): Extension {
  const make = (view: EditorView): Panel => {
    const { state } = view, { head } = state.selection.main;
    const word = state.wordAt(head);
    const input = element('input', {
      type: 'text', 'aria-label': 'New name', value: word ? state.sliceDoc(word.from, word.to) : '', spellcheck: 'false',
    });
    const close = () => {
      view.dispatch({ effects: set_open.of(false) });
      view.focus();
    };
    const dom = element('form', { class: 'rename' }, element('label', {}, 'New name ', input), element('button', {}, 'Rename'));
    dom.onkeydown = (event) => {
      if (event.key === 'Escape') close();
      event.stopPropagation();
    };
    dom.onsubmit = async (event) => {
      event.preventDefault();
      try {
        const { edits } = await studio.session.ask('rename', { offset: head, name: input.value });
        studio.edit(edits as Edit[]);
      } catch (error) {
        studio.say((error as Error).message);
      }
      close();
    };
    return { dom, mount: () => input.select() };
  };
  return StateField.define<boolean>({
    create: () => false,
    update: (open, transaction) => transaction.effects.reduce((now, effect) => (effect.is(set_open) ? effect.value : now), open),
    provide: (field) => showPanel.from(field, (open) => (open ? make : null)),
  });
}
