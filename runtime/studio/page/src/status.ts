// What the page tells in a line: how far the picture is, what is wrong with the text, what just happened.
import { element } from './dom';
import type { Finding, Findings, Pass, Progress } from './protocol';
import type { Offer, Studio } from './studio';

const said_ms = 4000, offered_ms = 15_000;

export class Status {
  private timer = 0;
  private why: string | null = null;

  constructor(
    private readonly line: HTMLElement, private readonly bar: HTMLElement, private readonly finding: HTMLElement,
    private readonly said: HTMLElement, private readonly stale: HTMLElement, private readonly studio: Studio,
  ) {}

  pass({ samples, seconds_left, done, whole_seconds }: Pass): void {
    const count = samples < 1 ? 'coarse' : `${Number(samples.toPrecision(3))} ${samples === 1 ? 'sample' : 'samples'} a pixel`;
    const left = seconds_left === null ? '' : `, ${duration(seconds_left)} left`;
    const stopped = whole_seconds ? `, stopped here: a better quality takes about ${duration(whole_seconds)}` : '';
    this.line.textContent = count + (done ? stopped : left);
    this.share(done ? null : 0, true);
  }

  progress({ stage, share }: Progress): void {
    this.line.textContent = share === null ? `${stage} …` : `${stage} ${Math.round(100 * share)} %`;
    this.share(share, share === null);
  }

  findings(findings: Findings['findings']): void {
    const errors = findings.filter(({ severity }) => severity === 'error'), first = errors[0] ?? findings[0];
    this.stale.hidden = errors.length === 0;
    if (errors.length) {
      this.line.textContent = '';
      this.share(null, false);
    }
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
    clearTimeout(this.timer);
    this.said.hidden = why === null;
    this.said.textContent = why;
  }

  private share(share: number | null, busy: boolean): void {
    this.bar.style.width = share === null ? '0' : `${100 * share}%`;
    this.bar.classList.toggle('busy', busy && share !== null && share === 0);
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
