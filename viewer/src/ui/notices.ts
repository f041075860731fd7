import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import { element } from './element';

/** Loading progress in bytes. */
export class ProgressNotice {
  readonly root: HTMLElement;
  private readonly bar = element('progress');
  private readonly words = element('span');
  private what = '';
  private loaded = 0;
  private total: number | null = null;

  constructor() {
    this.root = element('div', { class: 'progress', role: 'status', hidden: '' }, [this.words, this.bar]);
  }

  /** @param total bytes, or null when they are not known */
  begin(what: string, total: number | null): void {
    this.what = what;
    this.loaded = 0;
    this.total = total;
    this.root.hidden = false;
    this.advance(0);
  }

  advance = (count: number): void => {
    this.loaded += count;
    if (this.total !== null && this.total > 0) {
      this.bar.max = this.total;
      this.bar.value = Math.min(this.loaded, this.total);
    } else {
      this.bar.removeAttribute('value');
    }
    this.words.textContent = `${this.what}: ${text.bytes(this.loaded, this.total)}`;
  };

  end(): void {
    this.root.hidden = true;
  }
}

/** The whole page becomes the message, with the address of the file at fault. */
export function showError(error: unknown): void {
  const isAboutFile = error instanceof LoadError;
  const words = isAboutFile ? error.message : text.error.unexpected(error instanceof Error ? error.message : String(error));
  const again = element('button', { type: 'button' }, [text.error.reload]);
  again.addEventListener('click', () => location.reload());
  const parts: Node[] = [element('h1', {}, [text.error.heading]), element('p', {}, [words])];
  if (isAboutFile) parts.push(element('code', { 'aria-label': text.error.file }, [error.url]));
  document.body.replaceChildren(element('main', { class: 'error', role: 'alert' }, [element('div', {}, [...parts, again])]));
  again.focus();
}
