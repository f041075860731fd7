import { comparisons, type Comparison } from '../core/comparison';
import { text } from '../core/text';
import { element } from './element';

const step = 0.01;
const largeStep = 0.1;

/** Which of two bakes is shown, and the divider between them. */
export class CompareBar {
  readonly root: HTMLElement;
  readonly divider: HTMLElement;
  private readonly buttons = new Map<Comparison, HTMLButtonElement>();
  private readonly nameA: HTMLElement;
  private readonly nameB: HTMLElement;
  private at = 0.5;

  constructor(names: { a: string; b: string }, private readonly actions: { show(comparison: Comparison): void; divide(at: number): void }) {
    const group = element('div', { class: 'group' }, comparisons.map((comparison) => {
      const button = element('button', { type: 'button', title: text.compare.hints[comparison] }, [text.compare.names[comparison]]);
      button.addEventListener('click', () => actions.show(comparison));
      this.buttons.set(comparison, button);
      return button;
    }));
    const [labelA, labelB] = [`A: ${names.a}`, `B: ${names.b}`];
    this.nameA = element('span', { class: 'side a', title: labelA }, [labelA]);
    this.nameB = element('span', { class: 'side b', title: labelB }, [labelB]);
    this.root = element('section', { class: 'compare', 'aria-label': text.compare.label }, [this.nameA, group, this.nameB]);
    this.divider = element('div', {
      class: 'divider', role: 'slider', tabindex: '0', 'aria-label': text.compare.divider, 'aria-orientation': 'horizontal', 'aria-valuemin': '0', 'aria-valuemax': '100', title: text.compare.divider,
    }, [
      element('span', { class: 'flag a', 'aria-hidden': 'true' }, [labelA]),
      element('span', { class: 'flag b', 'aria-hidden': 'true' }, [labelB]),
      element('span', { class: 'grip', 'aria-hidden': 'true' }, ['◂▸']),
    ]);
    this.divider.addEventListener('keydown', (event) => this.key(event));
    this.divider.addEventListener('pointerdown', (event) => {
      this.divider.setPointerCapture(event.pointerId);
      event.preventDefault();
      this.divider.focus();
    });
    this.divider.addEventListener('pointermove', (event) => {
      if (this.divider.hasPointerCapture(event.pointerId)) this.move(event.clientX / innerWidth);
    });
  }

  update(comparison: Comparison, at: number): void {
    this.at = at;
    for (const [name, button] of this.buttons) button.setAttribute('aria-pressed', String(name === comparison));
    this.divider.hidden = comparison !== 'swipe';
    this.divider.style.left = `${(100 * at).toFixed(3)}%`;
    this.divider.setAttribute('aria-valuenow', String(Math.round(100 * at)));
    this.divider.setAttribute('aria-valuetext', text.compare.dividerValue(at));
    this.nameA.classList.toggle('off', comparison === 'b');
    this.nameB.classList.toggle('off', comparison === 'a');
  }

  private move(at: number): void {
    this.actions.divide(Math.min(1, Math.max(0, at)));
  }

  private key(event: KeyboardEvent): void {
    const by = event.shiftKey ? largeStep : step;
    const goal: Record<string, number> = {
      ArrowLeft: this.at - by, ArrowDown: this.at - by, ArrowRight: this.at + by, ArrowUp: this.at + by,
      PageDown: this.at - largeStep, PageUp: this.at + largeStep, Home: 0, End: 1,
    };
    const at = goal[event.key];
    if (at === undefined) return;
    event.preventDefault();
    event.stopPropagation(); // arrows walk elsewhere
    this.move(at);
  }
}
