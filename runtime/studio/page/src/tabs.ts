// Tabs as the ARIA practices have them: one in the tab order, arrow keys between them.
import { element } from './dom';

export interface Tab {
  id: string;
  label: string;
  content: HTMLElement;
}

export class Tabs {
  selected = '';
  private readonly buttons = new Map<string, HTMLButtonElement>();
  /** How far each panel was scrolled. */
  private readonly scrolled_px = new Map<string, number>();

  constructor(list: HTMLElement, private readonly panels: HTMLElement, private readonly tabs: Tab[], private readonly changed: (id: string) => void) {
    for (const { id, label, content } of tabs) {
      const button = element('button', {
        type: 'button', role: 'tab', id: `tab-${id}`, 'aria-controls': content.id || `panel-${id}`, onclick: () => this.select(id),
      }, label);
      this.buttons.set(id, button);
      list.append(button);
      content.id ||= `panel-${id}`;
      content.setAttribute('role', 'tabpanel');
      content.setAttribute('aria-labelledby', `tab-${id}`);
      if (!content.parentElement) panels.append(content);
    }
    list.addEventListener('keydown', (event) => {
      const shown = tabs.filter(({ id }) => this.buttons.get(id)!.offsetParent !== null);
      const at = shown.findIndex(({ id }) => id === this.selected);
      const to: Record<string, number> = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: shown.length - 1 };
      const next = to[event.key];
      if (next === undefined) return;
      event.preventDefault();
      const { id } = shown[(next + shown.length) % shown.length]!;
      this.select(id);
      this.buttons.get(id)!.focus();
    });
  }

  select(id: string): void {
    this.scrolled_px.set(this.selected, this.panels.scrollTop);
    this.selected = id;
    for (const tab of this.tabs) {
      const button = this.buttons.get(tab.id)!, chosen = tab.id === id;
      button.setAttribute('aria-selected', String(chosen));
      button.tabIndex = chosen ? 0 : -1;
      tab.content.classList.toggle('chosen', chosen);
    }
    this.panels.scrollTop = this.scrolled_px.get(id) ?? 0;
    this.changed(id);
  }
}
