// The text of the model, by CodeMirror.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from '@codemirror/autocomplete';
import { defaultKeymap } from '@codemirror/commands';
import { bracketMatching, indentOnInput, indentUnit } from '@codemirror/language';
import { lintKeymap, setDiagnostics, type Diagnostic } from '@codemirror/lint';
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search';
import { Annotation, EditorState } from '@codemirror/state';
import {
  crosshairCursor, drawSelection, dropCursor, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap,
  lineNumbers, rectangularSelection,
} from '@codemirror/view';
import { colour_swatches } from './colours';
import { element } from './dom';
import { graftal_language } from './language';
import { markdown } from './markdown';
import { rename_panel, open_rename } from './rename';
import { number_drags } from './scrub';
import type { Edit, Finding } from './protocol';
import type { Studio } from './studio';

/** Marks a change that the history knows already. */
const from_history = Annotation.define<boolean>();

export class Editor {
  readonly view: EditorView;
  private shown = '';

  constructor(parent: HTMLElement, private readonly studio: Studio) {
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        doc: '',
        extensions: [
          lineNumbers(), highlightActiveLine(), highlightActiveLineGutter(), drawSelection(), dropCursor(),
          rectangularSelection(), crosshairCursor(), indentOnInput(), bracketMatching(), closeBrackets(),
          highlightSelectionMatches(), search({ top: true }), indentUnit.of('  '), EditorState.tabSize.of(4),
          EditorState.lineSeparator.of('\n'), EditorView.lineWrapping,
          graftal_language, number_drags(), colour_swatches(), rename_panel(studio),
          autocompletion({ override: [(context) => this.complete(context)] }),
          hoverTooltip((_, offset) => this.hover(offset)),
          EditorView.contentAttributes.of({ 'aria-label': 'Text of the model', spellcheck: 'false' }),
          EditorView.updateListener.of((update) => {
            if (!update.docChanged || update.transactions.every((one) => one.annotation(from_history))) return;
            const typed = update.transactions.some((one) => one.isUserEvent('input.type') || one.isUserEvent('delete'));
            const key = update.transactions.find((one) => one.isUserEvent('drag')) ? 'drag number' : typed ? 'type' : null;
            this.shown = update.state.doc.toString();
            studio.change({ text: this.shown }, key);
          }),
          EditorView.domEventHandlers({
            mousedown: (event, view) => {
              const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
              if (!(event.ctrlKey || event.metaKey) || event.button !== 0 || at === null) return false;
              void this.to_definition(at);
              return true;
            },
          }),
          keymap.of([
            { key: 'F12', run: (view) => (void this.to_definition(view.state.selection.main.head), true) },
            { key: 'F2', run: open_rename },
            { key: 'Shift-Alt-f', run: () => (void this.format(), true) },
            // Tab leaves the text, as it leaves other fields: Mod-] and Mod-[ of the default keys indent.
            ...closeBracketsKeymap, ...completionKeymap, ...searchKeymap, ...lintKeymap, ...defaultKeymap,
          ]),
        ],
      }),
    });
  }

  /** Brings the text of the history into view, changing only what differs, so that the cursor stays. */
  show(text: string): void {
    const old = this.shown;
    if (old === text) return;
    this.shown = text;
    let from = 0, to = old.length, end = text.length;
    while (from < to && from < end && old.charCodeAt(from) === text.charCodeAt(from)) ++from;
    while (to > from && end > from && old.charCodeAt(to - 1) === text.charCodeAt(end - 1)) --to, --end;
    this.view.dispatch({ changes: { from, to, insert: text.slice(from, end) }, annotations: from_history.of(true) });
  }

  select(from: number, to: number): void {
    const { length } = this.view.state.doc;
    const anchor = Math.min(from, length), head = Math.min(to, length);
    this.view.dispatch({
      selection: { anchor, head },
      effects: EditorView.scrollIntoView(anchor, { y: 'center' }),
    });
  }

  show_findings(findings: Finding[]): void {
    const { length } = this.view.state.doc;
    const diagnostics: Diagnostic[] = findings.map(({ severity, from, to, text, hint }) => {
      const start = Math.max(0, Math.min(from, length));
      return {
        from: start,
        to: Math.max(start, Math.min(to, length)),
        severity: severity === 'note' ? 'info' : severity,
        message: text,
        renderMessage: () => element('span', {}, text, hint ? element('span', { class: 'hint' }, hint) : null),
      };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  async format(): Promise<void> {
    await this.edits_of('format', {});
  }

  private async edits_of(what: string, fields: object): Promise<void> {
    try {
      const { edits } = await this.studio.session.ask(what, fields);
      this.studio.edit(edits as Edit[]);
    } catch (error) {
      this.studio.say((error as Error).message);
    }
  }

  private async to_definition(offset: number): Promise<void> {
    try {
      const answer = await this.studio.session.ask('definition', { offset });
      if (typeof answer['from'] !== 'number') return;
      if (answer['file'] && answer['file'] !== this.studio.history.now.name) {
        this.studio.say(`It is defined in ${answer['file']}.`);
      } else {
        this.select(answer['from'], answer['to'] as number);
      }
    } catch (error) {
      this.studio.say((error as Error).message);
    }
  }

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    if (!context.explicit && !context.matchBefore(/[A-Za-z_][\w.]*$/)) return null;
    try {
      const answer = await this.studio.session.ask('complete', { offset: context.pos });
      const items = answer['items'] as { label: string; kind?: string; detail?: string; text?: string }[];
      if (!items?.length) return null;
      return {
        from: answer['from'] as number,
        options: items.map(({ label, kind, detail, text }) => ({ label, type: kind, info: detail, apply: text ?? label })),
        validFor: /^[\w.]*$/,
      };
    } catch {
      return null;
    }
  }

  private async hover(offset: number) {
    try {
      const answer = await this.studio.session.ask('hover', { offset });
      if (typeof answer['text'] !== 'string' || typeof answer['from'] !== 'number') return null;
      const text = answer['text'];
      return {
        pos: answer['from'],
        end: answer['to'] as number,
        above: true,
        create: () => ({ dom: element('div', { class: 'hover' }, markdown(text)) }),
      };
    } catch {
      return null;
    }
  }
}
