import { text } from '../../core/text';
import { element } from '../element';

/** When: a list, a slider that fades between the baked times, and their play. */
export class TimeFields {
  readonly roots: HTMLElement[];
  readonly select: HTMLSelectElement;
  private readonly slider: HTMLInputElement;
  private readonly earlier: HTMLButtonElement;
  private readonly later: HTMLButtonElement;
  private readonly playButton: HTMLButtonElement;
  private readonly between = element('option', { value: '', disabled: '', hidden: '' });
  private readonly sun = element('p', { class: 'note' });
  private moment = 0;

  constructor(instants: readonly string[], actions: { moment(moment: number): void; play(): void }) {
    const last = instants.length - 1;
    this.select = element('select', { id: 'instant' }, [...instants.map((label, i) => element('option', { value: String(i) }, [label])), this.between]);
    this.select.addEventListener('change', () => actions.moment(Number(this.select.value)));
    this.slider = element('input', { type: 'range', min: '0', max: String(last), step: '0.05', 'aria-label': text.instantSlider });
    this.slider.addEventListener('input', () => actions.moment(Number(this.slider.value)));
    this.earlier = element('button', { type: 'button', 'aria-label': text.previousInstant, title: `${text.previousInstant} (,)` }, ['‹']);
    this.later = element('button', { type: 'button', 'aria-label': text.nextInstant, title: `${text.nextInstant} (.)` }, ['›']);
    this.earlier.addEventListener('click', () => actions.moment(Math.ceil(this.moment) - 1));
    this.later.addEventListener('click', () => actions.moment(Math.floor(this.moment) + 1));
    this.playButton = element('button', { type: 'button', title: text.playHint }, [text.play]);
    this.playButton.addEventListener('click', () => actions.play());
    this.roots = [
      element('div', { class: 'field' }, [
        element('label', { for: 'instant' }, [text.instant]),
        element('div', { class: 'row' }, last > 0 ? [this.earlier, this.select, this.later] : [this.select]),
        ...(last > 0 ? [element('div', { class: 'row below slim' }, [this.slider, this.playButton])] : []),
      ]),
      this.sun,
    ];
  }

  update(moment: number, label: string): void {
    this.moment = moment;
    this.between.textContent = label;
    this.between.hidden = Number.isInteger(moment);
    this.select.value = this.between.hidden ? String(moment) : '';
    this.slider.value = String(moment);
    this.slider.setAttribute('aria-valuetext', label);
    this.earlier.disabled = moment <= 0;
    this.later.disabled = moment >= Number(this.slider.max);
  }

  showPlaying(isPlaying: boolean): void {
    this.playButton.textContent = isPlaying ? text.pause : text.play;
  }

  showSun(note: string): void {
    this.sun.textContent = note;
  }
}
