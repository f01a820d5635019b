// Ways out: a picture of any size, files for other programs, the command line, a link.
import { by_id, element } from './dom';
import { link_of, opened } from './link';
import { inflate, type Choices, type SentFile } from './protocol';
import type { Knobs, Unwritten } from './knobs';
import type { Offer, Studio } from './studio';

export class Out {
  readonly element = element('div', {});
  private readonly width = element('input', { type: 'number', min: 1, max: 65536, 'aria-label': 'Width in pixels' });
  private readonly height = element('input', { type: 'number', min: 1, max: 65536, 'aria-label': 'Height in pixels' });
  private readonly picture_kind = element('select', { 'aria-label': 'Kind of picture' },
    element('option', { value: '.png' }, 'PNG'), element('option', { value: '.exr' }, 'EXR'));
  private readonly format = element('select', { id: 'format' });
  private readonly export_room = element('div', {});
  private readonly command = element('pre', { tabindex: 0, role: 'region', 'aria-label': 'Command line' });
  private readonly path = element('input', { type: 'text', id: 'path', placeholder: 'name.png', 'aria-label': 'Name of the picture file', spellcheck: 'false' });

  /** Which knobs the text does not have. */
  private readonly unwritten = element('p', { class: 'line note', id: 'unwritten' });

  constructor(
    private readonly studio: Studio, private readonly knobs: Pick<Knobs, 'unwritten' | 'write'>,
    private readonly open: (choices: Partial<Choices>) => void,
    /** A file has this text now. */
    private readonly saved: (choices: Choices) => void,
  ) {
    const pasted = element('input', { type: 'text', id: 'pasted', 'aria-label': 'Link to open', placeholder: 'paste a link here' });
    const link_form = element('form', { class: 'line' }, pasted, element('button', { class: 'quiet' }, 'Open'));
    link_form.onsubmit = async (event) => {
      event.preventDefault();
      try {
        this.open(await opened(pasted.value, studio.session));
        pasted.value = '';
      } catch (error) {
        studio.say((error as Error).message);
      }
    };
    const size = (times: number) => element('button', {
      type: 'button', class: 'small', onclick: () => this.size(times),
    }, `${times}×`);
    const file = element('input', { type: 'file', class: 'unseen', tabindex: -1, 'aria-hidden': 'true', accept: '.lsys,.rifs,.inst' });
    file.onchange = () => void (file.files?.[0] && this.open_file(file.files[0]));
    this.export_room.append(
      element('h2', {}, 'For other programs'),
      element('div', { class: 'line' }, element('label', { for: 'format' }, 'Format '), this.format,
        this.button('save-export', 'Save file', () => this.write({ suffix: this.format.value }))));
    this.element.append(
      element('h2', {}, 'Text'),
      element('div', { class: 'line' },
        this.button('save-text', 'Save text', () => this.save_text(), 'Writes the file of the model, in the folder of the studio'),
        this.button('download-text', 'Download text', () => this.download_text(), 'Has the browser save a copy'),
        this.button('open-file', 'Open a file', () => file.click()), file),
      this.unwritten,
      element('h2', {}, 'Picture'),
      element('div', { class: 'line', id: 'picture-size' }, this.width, ' × ', this.height, size(1), size(2), size(4)),
      element('div', { class: 'line' }, this.picture_kind, this.button('save-picture', 'Save picture', () => this.save_picture())),
      element('div', { class: 'line', id: 'at-home' }, this.path, this.button('save-path', 'Save beside the model', () => this.write(
        { path: this.path.value, width: Number(this.width.value), height: Number(this.height.value) }))),
      this.export_room,
      element('h2', {}, 'Command line'),
      this.command,
      element('div', { class: 'line' }, this.button('copy-command', 'Copy', () => this.copy(this.command.textContent ?? '', 'The command line'))),
      element('h2', {}, 'Link'),
      element('div', { class: 'line' }, this.button('copy-link', 'Copy link', () => this.copy_link())),
      link_form,
    );
  }

  hello(): void {
    const { hello } = this.studio;
    this.format.replaceChildren(...(hello?.formats ?? []).map((format) => element('option', { value: format.startsWith('.') ? format : `.${format}` }, format.replace(/^\./, ''))));
    this.element.querySelector<HTMLElement>('#at-home')!.hidden = hello?.home !== 'program';
    this.element.querySelector<HTMLElement>('#save-text')!.hidden = hello?.home !== 'program';
    this.element.querySelector<HTMLElement>('#picture-size')!.hidden = hello?.home !== 'program';
    this.picture_kind.hidden = hello?.home !== 'program';
    this.export_room.hidden = !hello?.formats.length;
    this.size(1);
  }

  async show(): Promise<void> {
    if (!this.width.value) this.size(1);
    this.show_unwritten();
    try {
      const { command } = await this.studio.session.ask('command');
      this.command.textContent = String(command);
    } catch (error) {
      this.command.textContent = (error as Error).message;
    }
  }

  private show_unwritten(): void {
    const left = this.knobs.unwritten(), names = writable(left);
    this.unwritten.hidden = left.length === 0;
    const write = element('button', { type: 'button', class: 'small', onclick: () => this.knobs.write(names) }, 'Write into the text');
    this.unwritten.replaceChildren(`The text does not have: ${said_of(left)}.`, ...(names.length ? [write] : []));
  }

  /** Writes the text where the model came from; a page without a folder gives it to the browser. */
  async save_text(): Promise<void> {
    const { now } = this.studio.history;
    if (this.studio.hello?.home !== 'program') return this.download_text();
    const path = await this.write({ path: now.name });
    if (!path) return;
    this.saved(now);
    this.say_saved(path);
  }

  /** Says that the text is saved, and what of the picture is not in it. */
  private say_saved(name: string): void {
    const left = this.knobs.unwritten(), names = writable(left);
    const offer: Offer = { label: 'Write and save again', act: () => this.knobs.write(names, () => void this.save_text()) };
    if (!left.length) this.studio.say(`Saved ${name}.`);
    else this.studio.say(`Saved ${name}, without ${said_of(left)}: the text does not have that.`, names.length ? offer : undefined);
  }

  /** Has the program draw the picture at its size; without a program the one that is shown is saved. */
  private async save_picture(): Promise<void> {
    const size = { width: Number(this.width.value), height: Number(this.height.value) };
    if (this.studio.hello?.home === 'program') return void (await this.write({ suffix: this.picture_kind.value, ...size }));
    const shown = await new Promise<Blob | null>((resolve) => by_id<HTMLCanvasElement>('picture').toBlob(resolve));
    const name = this.studio.history.now.name.replace(/^.*[\\/]/, '').replace(/\.\w+$/, '');
    if (shown) this.give(`${name}.png`, new Uint8Array(await shown.arrayBuffer()));
  }

  /** Opens a file of the person's: its text takes the place of the model. */
  async open_file(file: File): Promise<void> {
    if (file.size > 4_000_000) this.studio.say(`${file.name} is too large for a model: it has more than 4 MB.`);
    else {
      this.open({ name: file.name, text: (await file.text()).replace(/\r\n?/g, '\n') });
      this.saved(this.studio.history.now);
    }
  }

  private download_text(): void {
    const { now } = this.studio.history, file = now.name.replace(/^.*[\\/]/, '');
    this.give(file, new TextEncoder().encode(now.text));
    if (this.studio.hello?.home !== 'program') this.saved(now);
    this.say_saved(file);
  }

  /** The address of this page with the model in it, without the secret that the program gave the page. */
  async copy_link(): Promise<void> {
    const elsewhere = document.querySelector<HTMLMetaElement>('meta[name="graftal-site"]')?.content;
    const base = elsewhere ?? location.origin + location.pathname;
    const { fragment, lacks } = await link_of(this.studio.history.now, this.studio.session);
    const where = !elsewhere && this.studio.hello?.home === 'program' ? ' It opens on this computer while graftal runs; elsewhere, paste it into the studio there.' : '';
    const needs = lacks.length ? ` It cannot hold ${lacks.join(', ')}: elsewhere, that has to lie beside the model.` : '';
    await this.copy(base + fragment, 'The link', where + needs);
  }

  async file(file: SentFile): Promise<void> {
    const bytes = await inflate(file.deflated);
    const name = new TextDecoder().decode(bytes.subarray(0, file.name_bytes));
    this.give(name, bytes.subarray(file.name_bytes));
  }

  private give(name: string, bytes: Uint8Array): void {
    const address = URL.createObjectURL(new Blob([bytes as BlobPart]));
    element('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
    this.studio.say(`Saved ${name}.`);
  }

  private size(times: number): void {
    const { width_px, height_px } = this.studio.size;
    this.width.value = String(width_px * times);
    this.height.value = String(height_px * times);
  }

  private button(id: string, label: string, act: () => unknown, title?: string): HTMLButtonElement {
    const button = element('button', {
      type: 'button', class: 'quiet', id, title,
      onclick: async () => {
        button.disabled = true;
        try {
          await act();
        } catch (error) {
          this.studio.say((error as Error).message);
        } finally {
          button.disabled = false;
        }
      },
    }, label);
    return button;
  }

  /** Gives the path of a file that lies in the folder; null: it went to the browser, or was not made. */
  private async write(fields: object): Promise<string | null> {
    this.studio.say('Working on the file…');
    try {
      const { path } = await this.studio.session.ask('write', fields);
      if (path) this.studio.say(`Saved ${String(path)}.`);
      return path ? String(path) : null;
    } catch (error) {
      this.studio.say((error as Error).message);
      return null;
    }
  }

  private async copy(text: string, what: string, more = ''): Promise<void> {
    try {
      await navigator.clipboard.writeText(text);
      this.studio.say(`${what} is in the clipboard.${more}`);
    } catch {
      const area = element('textarea', { class: 'unseen' });
      area.value = text;
      document.body.append(area);
      area.select();
      const done = document.execCommand('copy');
      area.remove();
      this.studio.say(done ? `${what} is in the clipboard.${more}` : 'The browser does not let the page copy.');
    }
  }
}

const writable = (left: Unwritten[]): string[] => left.filter(({ can_write }) => can_write).map(({ name }) => name);

function said_of(left: Unwritten[]): string {
  const most_named = 5, more = left.length - most_named;
  return left.slice(0, most_named).map(({ says }) => says).join(', ') + (more > 0 ? ` and ${more} more` : '');
}
