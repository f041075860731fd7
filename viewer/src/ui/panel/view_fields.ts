import type { SavedView } from '../../core/saved_views';
import { text } from '../../core/text';
import { element } from '../element';

export interface ViewActions {
  view(index: number): void;
  saveView(name: string): void;
  ownView(name: string): void;
  deleteView(name: string): void;
  copyView(name: string): void;
  copyLink(): void;
  copyAllViews(): void;
  savePicture(): void;
}

/** From where: the bake's views, the user's own, and what leads others there. */
export class ViewFields {
  readonly root: HTMLElement;
  private readonly select: HTMLSelectElement;
  private readonly summary = element('summary', {});
  private readonly list = element('ul', { class: 'own-views' });
  private readonly all: HTMLButtonElement;
  private readonly name: HTMLInputElement;

  constructor(views: readonly string[], private readonly actions: ViewActions) {
    this.select = element('select', { id: 'view' }, [
      element('option', { value: '', disabled: '' }, [text.freeView]),
      ...views.map((name, i) => element('option', { value: String(i) }, [name])),
    ]);
    this.select.addEventListener('change', () => actions.view(Number(this.select.value)));
    const button = (label: string, hint: string, action: () => void): HTMLButtonElement => {
      const made = element('button', { type: 'button', title: hint }, [label]);
      made.addEventListener('click', action);
      return made;
    };
    this.name = element('input', { type: 'text', id: 'view-name', maxlength: '80', placeholder: text.ownViews.placeholder, 'aria-label': text.ownViews.name, autocomplete: 'off' });
    const form = element('form', { class: 'row below slim' }, [this.name, element('button', { type: 'submit', title: text.ownViews.saveHint }, [text.ownViews.save])]);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      if (this.name.value.trim() === '') return this.name.focus();
      actions.saveView(this.name.value);
      this.name.value = '';
    });
    this.all = button(text.ownViews.copyAll, text.ownViews.copyAllHint, () => actions.copyAllViews());
    this.root = element('div', { class: 'field' }, [
      element('label', { for: 'view' }, [text.views]),
      element('div', { class: 'row' }, [this.select]),
      element('div', { class: 'row below' }, [button(text.copyLink, text.copyLinkHint, () => actions.copyLink()), button(text.savePicture, text.savePictureHint, () => actions.savePicture())]),
      element('details', { class: 'below' }, [this.summary, form, this.list, this.all]),
    ]);
    this.showOwn([]);
  }

  /** Marks the view that is shown, or none when the user moved on by themselves. */
  showView(index: number | null): void {
    this.select.value = index === null ? '' : String(index);
  }

  showOwn(views: readonly SavedView[]): void {
    const hadFocus = this.list.contains(document.activeElement);
    this.summary.textContent = text.ownViews.heading(views.length);
    this.all.hidden = views.length === 0;
    this.list.replaceChildren(...views.map(({ name }) => {
      const go = element('button', { type: 'button', class: 'go', title: text.ownViews.go(name) }, [name]);
      go.addEventListener('click', () => this.actions.ownView(name));
      const copy = element('button', { type: 'button', 'aria-label': text.ownViews.copy(name), title: text.ownViews.copy(name) }, [element('span', { class: 'copy-icon' })]);
      copy.addEventListener('click', () => this.actions.copyView(name));
      const forget = element('button', { type: 'button', 'aria-label': text.ownViews.delete(name), title: text.ownViews.delete(name) }, ['✕']);
      forget.addEventListener('click', () => this.actions.deleteView(name));
      return element('li', { class: 'row' }, [go, copy, forget]);
    }));
    if (hadFocus) (this.list.querySelector('button') ?? this.name).focus();
  }
}
