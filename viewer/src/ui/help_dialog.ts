import { text } from '../core/text';
import { element } from './element';

/** All keys and gestures, over the page until Escape. */
export class HelpDialog {
  readonly root: HTMLDialogElement;

  constructor(isComparing: boolean) {
    const close = element('button', { type: 'button' }, [text.help.close]);
    close.addEventListener('click', () => this.root.close());
    const groups = Object.values(text.help.groups).filter((group) => isComparing || group !== text.help.groups.compare);
    this.root = element('dialog', { class: 'help-dialog', 'aria-label': text.help.heading }, [
      element('header', {}, [element('h2', {}, [text.help.heading]), close]),
      element('div', { class: 'columns' }, groups.map(({ name, keys }) =>
        element('section', {}, [
          element('h3', {}, [name]),
          element('dl', {}, Object.entries(keys).flatMap(([what, does]) => [element('dt', {}, [what]), element('dd', {}, [does])])),
        ]))),
    ]);
    this.root.addEventListener('click', (event) => {
      if (event.target === this.root) this.root.close(); // beside the page of it
    });
  }

  show(): void {
    if (!this.root.open) this.root.showModal();
  }
}
