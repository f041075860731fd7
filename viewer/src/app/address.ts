import { text } from '../core/text';
import { formatViewState, parseViewState, type ViewState } from '../core/view_state';

const intervalMs = 300;

/** The part of the page's address that restores what is seen. */
export class Address {
  private timer: number | null = null;

  /** @param state what is seen now; null before there is a picture */
  constructor(
    private readonly state: () => ViewState | null,
    private readonly tell: (words: string) => void,
  ) {}

  get read(): Partial<ViewState> {
    return parseViewState(location.hash);
  }

  /** Writes the link at most a few times a second: browsers refuse more. */
  changed(): void {
    this.timer ??= window.setTimeout(() => {
      this.timer = null;
      this.write();
    }, intervalMs);
  }

  /** The part of the address from its # on; null before there is a picture. */
  get link(): string | null {
    const state = this.state();
    return state && formatViewState(state);
  }

  async copy(): Promise<void> {
    this.write();
    await this.copyText(location.href, text.linkCopied);
  }

  /** Copies the address of this page with another part behind the #. */
  async copyWith(link: string, done: string): Promise<void> {
    await this.copyText(new URL(link, location.href).href, done);
  }

  private write(): void {
    const { link } = this;
    if (link !== null) history.replaceState(null, '', link);
  }

  private async copyText(address: string, done: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(address);
      this.tell(done);
    } catch {
      this.tell(text.linkNotCopied); // no clipboard over plain http, or the user forbade it
    }
  }
}
