import { element } from './element';

const noticeMs = 5000;

/** What the page says: to all for a while, or to screen readers alone. */
export class Remarks {
  readonly notice = element('p', { class: 'progress', role: 'alert', hidden: '' });
  readonly said = element('p', { class: 'said', role: 'status' });
  private timer: number | null = null;

  /** A remark that goes by itself. */
  tell = (words: string): void => {
    this.notice.textContent = words;
    this.notice.hidden = false;
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.notice.hidden = true), noticeMs);
  };

  say = (words: string): void => {
    this.said.textContent = words;
  };
}
