import { pictures, type Picture } from '../../core/pictures';
import { text } from '../../core/text';
import { element } from '../element';

/** What is drawn: light, textures, measures; and which layer of the study. */
export class PictureFields {
  readonly root: HTMLElement;
  private readonly buttons = new Map<Picture, HTMLButtonElement>();
  private readonly layer: HTMLSelectElement;

  constructor(layers: readonly { id: string; title: string }[], actions: { picture(picture: Picture): void; layer(id: string): void }) {
    const shown = pictures.filter((picture) => picture !== 'layer' || layers.length > 0);
    const group = element('div', { class: 'group wraps' }, shown.map((picture) => {
      const button = element('button', { type: 'button', title: `${text.pictureHints[picture]} (${pictures.indexOf(picture) + 1})` }, [text.pictures[picture]]);
      button.addEventListener('click', () => actions.picture(picture));
      this.buttons.set(picture, button);
      return button;
    }));
    this.layer = element('select', { id: 'layer' }, layers.map(({ id, title }) => element('option', { value: id }, [title])));
    this.layer.addEventListener('change', () => actions.layer(this.layer.value));
    const choice = element('div', { class: 'below' }, [element('label', { for: 'layer', class: 'label' }, [text.layer]), this.layer]);
    this.root = element('fieldset', { class: 'field' }, [element('legend', {}, [text.picture]), group, ...(layers.length > 0 ? [choice] : [])]);
  }

  update(picture: Picture, layer: string | null): void {
    for (const [name, button] of this.buttons) button.setAttribute('aria-pressed', String(name === picture));
    if (layer !== null) this.layer.value = layer;
  }
}
