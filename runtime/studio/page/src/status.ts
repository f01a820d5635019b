// What the page tells in a line: how far the picture is, what is wrong with the text, what just happened.
import { by_id, element } from './dom';
import type { Finding, Findings, Pass } from './protocol';
import type { Offer, Studio } from './studio';

const said_ms = 4000, offered_ms = 15_000;
/** A first picture that comes sooner has nothing to tell before it. */
const slow_ms = 600, tick_ms = 500;

export class Status {
  private timer = 0;
  private why: string | null = null;
  /** The next thing that time alone changes in the line. */
  private line_timer = 0;
  /** The work before the first picture, as the line tells it if it takes long. */
  private stage = '';
  private is_slow = false;

  constructor(
    private readonly line: HTMLElement, private readonly bar: HTMLElement, private readonly finding: HTMLElement,
    private readonly said: HTMLElement, private readonly stale: HTMLElement, private readonly studio: Studio,
  ) {}

  /** A state left; nothing of its picture is there. */
  sent(): void {
    this.stage = 'reading the model …';
    this.is_slow = false;
    clearTimeout(this.line_timer);
    this.line_timer = setTimeout(() => {
      this.is_slow = true;
      this.tell(this.stage);
      this.busy(true);
    }, slow_ms) as unknown as number;
  }

  pass({ samples, seconds_left, done, whole_seconds }: Pass): void {
    clearTimeout(this.line_timer);
    this.busy(!done);
    const { history: { now }, hello } = this.studio, engine = now.engine ?? hello?.engines[0];
    if (samples === null) return this.tell(done ? `drawn by ${engine}` : `${engine} is drawing …`);
    const count = samples < 1 ? 'coarse' : `${Number(samples.toPrecision(3))} ${samples === 1 ? 'sample' : 'samples'} a pixel`;
    if (done && whole_seconds) this.stopped(count, `all of it takes ${duration(whole_seconds)} or more`, now.quality !== 'best');
    else if (done) this.tell(count);
    else if (seconds_left !== null) this.count_down(count, performance.now() + 1000 * seconds_left);
    else this.tell(samples < 1 ? 'coarse, a finer picture follows …' : `${count}, taking noise out …`);
  }

  /** A guess that was too short is dropped, and none takes its place. */
  private count_down(count: string, end_ms: number): void {
    const left_ms = end_ms - performance.now();
    this.tell(left_ms > 0 ? `${count}, ${duration(left_ms / 1000)} left` : `${count}, still drawing …`);
    if (left_ms > 0) this.line_timer = setTimeout(() => this.count_down(count, end_ms), tick_ms) as unknown as number;
  }

  private stopped(count: string, whole: string, can_go_on: boolean): void {
    const go_on = () => {
      by_id('view').focus();
      this.studio.change({ quality: 'best' });
    };
    this.line.replaceChildren(count, element('span', { class: 'why' }, `, stopped here: ${whole}`),
      ...(can_go_on ? [' ', element('button', { type: 'button', class: 'small', title: whole, 'aria-label': 'Go on at best quality', onclick: go_on },
        'Go on', element('span', { class: 'why' }, ' at best quality'))] : []));
  }

  private tell(text: string): void {
    this.line.replaceChildren(text);
  }

  findings(findings: Findings['findings']): void {
    const errors = findings.filter(({ severity }) => severity === 'error'), first = errors[0] ?? findings[0];
    this.stale.hidden = errors.length === 0;
    if (errors.length) this.rest();
    else this.stage = 'drawing a first picture …';
    if (!errors.length && this.is_slow) this.tell(this.stage);
    this.finding.replaceChildren(...(first ? [this.finding_line(first, findings.length)] : []));
    this.finding.className = first?.severity ?? '';
  }

  say(text: string, offer?: Offer): void {
    const close = () => {
      this.said.hidden = this.why === null;
      this.said.textContent = this.why;
    };
    const button = offer && element('button', {
      type: 'button', class: 'quiet',
      onclick: () => {
        close();
        offer.act();
      },
    }, offer.label);
    this.said.replaceChildren(text, ...(button ? [button] : []));
    this.said.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(close, offer ? offered_ms : said_ms) as unknown as number;
  }

  reach(why: string | null): void {
    if (why === null && this.why === null) return;
    this.why = why;
    if (why !== null) this.rest();
    clearTimeout(this.timer);
    this.said.hidden = why === null;
    this.said.textContent = why;
  }

  /** No picture is under way. */
  private rest(): void {
    clearTimeout(this.line_timer);
    this.is_slow = false;
    this.line.replaceChildren();
    this.busy(false);
  }

  private busy(busy: boolean): void {
    this.bar.classList.toggle('busy', busy);
  }

  private finding_line(finding: Finding, count: number): HTMLElement {
    const { text } = this.studio.history.now, line = text.slice(0, finding.from).split('\n').length;
    return element('button', { type: 'button', onclick: () => this.studio.select(finding.from, finding.to) },
      finding.file ? element('strong', {}, `Line ${line}: `) : null, finding.text,
      finding.hint ? element('span', { class: 'hint' }, finding.hint) : null,
      count > 1 ? element('span', { class: 'more' }, `${count - 1} more`) : null);
  }
}

function duration(seconds: number): string {
  if (seconds < 1) return 'less than 1 s';
  return seconds < 100 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} min`;
}
