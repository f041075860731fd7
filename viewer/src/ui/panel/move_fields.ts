import { modes, type Mode } from '../../core/pictures';
import { text } from '../../core/text';
import { element } from '../element';

/** How one moves: in the air or on foot, and there with a captured mouse. */
export class MoveFields {
  readonly root: HTMLElement;
  private readonly buttons = new Map<Mode, HTMLButtonElement>();
  private readonly mouseLook: HTMLButtonElement;

  constructor(actions: { mode(mode: Mode): void; mouseLook(): void }) {
    const group = element('div', { class: 'group' }, modes.map((mode) => {
      const button = element('button', { type: 'button', title: `${text.modeHints[mode]} (${mode === 'orbit' ? 'O' : 'P'})` }, [text.modes[mode]]);
      button.addEventListener('click', () => actions.mode(mode));
      this.buttons.set(mode, button);
      return button;
    }));
    this.mouseLook = element('button', { type: 'button', class: 'mouse-look', title: `${text.mouseLook.hint} (L)` }, [text.mouseLook.name]);
    this.mouseLook.addEventListener('click', () => actions.mouseLook());
    this.root = element('fieldset', { class: 'field' }, [element('legend', {}, [text.navigation]), group, element('div', { class: 'row below fine' }, [this.mouseLook])]);
  }

  update(mode: Mode): void {
    for (const [name, button] of this.buttons) button.setAttribute('aria-pressed', String(name === mode));
    this.mouseLook.hidden = mode !== 'walk';
  }
}
