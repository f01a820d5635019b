// What the page tells in a line: how far the picture is, what is wrong with the text, what just happened.
import { element } from './dom';
import type { Finding, Findings, Pass, Progress } from './protocol';
import type { Studio } from './studio';

const said_ms = 6000;

export class Status {
  private timer = 0;
  private why: string | null = null;

  constructor(
    private readonly line: HTMLElement, private readonly bar: HTMLElement, private readonly finding: HTMLElement,
    private readonly said: HTMLElement, private readonly stale: HTMLElement, private readonly studio: Studio,
  ) {}

  pass({ samples, seconds_left, done }: Pass): void {
    const count = samples < 1 ? 'coarse' : `${Number(samples.toPrecision(3))} ${samples === 1 ? 'sample' : 'samples'} a pixel`;
    this.line.textContent = done || seconds_left === null ? count : `${count}, ${duration(seconds_left)} left`;
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

  say(text: string): void {
    this.said.textContent = text;
    this.said.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.said.hidden = this.why === null;
      this.said.textContent = this.why;
    }, said_ms) as unknown as number;
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
      element('strong', {}, `Line ${line}: `), finding.text,
      finding.hint ? element('span', { class: 'hint' }, finding.hint) : null,
      count > 1 ? element('span', { class: 'more' }, `${count - 1} more`) : null);
  }
}

function duration(seconds: number): string {
  if (seconds < 1) return 'less than 1 s';
  return seconds < 100 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} min`;
}
