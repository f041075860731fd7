import { text } from '../core/text';
import { element } from './element';

const signs = [['forward', '↑', 1, 0], ['left', '←', 0, -1], ['right', '→', 0, 1], ['back', '↓', -1, 0]] as const;

/**
 * Walking by the left thumb: pushed a little it walks slowly, to the edge it runs. Shown on touch screens, on foot. Its four arrows are buttons for keyboards and
 * screen readers, half a step at a time.
 */
export function touchStick(actions: { steer(along: number, aside: number): void; step(along: number, aside: number): void }): HTMLElement {
  const knob = element('span', { class: 'knob', 'aria-hidden': 'true' });
  const stick = element('div', { class: 'stick', role: 'group', 'aria-label': text.movePad }, [knob]);
  let pointer: number | null = null;

  const push = (event: PointerEvent): void => {
    const box = stick.getBoundingClientRect();
    const reach = box.width / 2;
    const [dx, dy] = [(event.clientX - box.left - reach) / reach, (event.clientY - box.top - reach) / reach];
    const length = Math.max(1, Math.hypot(dx, dy));
    const [aside, along] = [dx / length, -dy / length];
    knob.style.transform = `translate(${(aside * reach * 0.6).toFixed(1)}px, ${(-along * reach * 0.6).toFixed(1)}px)`;
    const isResting = Math.hypot(aside, along) < 0.12;
    actions.steer(isResting ? 0 : along, isResting ? 0 : aside);
  };
  const release = (event: PointerEvent): void => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    knob.style.transform = '';
    actions.steer(0, 0);
  };
  stick.addEventListener('pointerdown', (event) => {
    if (pointer !== null) return;
    pointer = event.pointerId;
    stick.setPointerCapture(event.pointerId);
    push(event);
  });
  stick.addEventListener('pointermove', (event) => {
    if (event.pointerId === pointer) push(event);
  });
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) stick.addEventListener(name, release);
  stick.addEventListener('contextmenu', (event) => event.preventDefault()); // a long press is no menu

  for (const [way, sign, along, aside] of signs) {
    const button = element('button', { type: 'button', class: way, 'aria-label': text.movePadButtons[way] }, [sign]);
    button.addEventListener('click', (event) => {
      if (event.detail === 0) actions.step(along, aside);
    });
    stick.append(button);
  }
  return stick;
}
