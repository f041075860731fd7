import { text } from '../core/text';
import { element } from './element';

const signs = [['forward', '↑', 1, 0], ['left', '←', 0, -1], ['back', '↓', -1, 0], ['right', '→', 0, 1]] as const;
export type Way = (typeof signs)[number][0];

/** Arrows for fingers: shown on touch screens, in walk mode. */
export function movePad(actions: { press(way: Way, isDown: boolean): void; step(along: number, aside: number): void }): HTMLElement {
  const pad = element('div', { class: 'pad', role: 'group', 'aria-label': text.movePad });
  for (const [way, sign, along, aside] of signs) {
    const button = element('button', { type: 'button', 'aria-label': text.movePadButtons[way] }, [sign]);
    button.addEventListener('pointerdown', () => actions.press(way, true));
    for (const name of ['pointerup', 'pointercancel', 'pointerleave'] as const) button.addEventListener(name, () => actions.press(way, false));
    // Keyboards and screen readers click: half a step at a time.
    button.addEventListener('click', (event) => {
      if (event.detail === 0) actions.step(along, aside);
    });
    pad.append(button);
  }
  return pad;
}
