import { evRange } from '../../core/exposure';
import type { Picture } from '../../core/pictures';
import { text } from '../../core/text';
import { element } from '../element';

/** How bright, and through which air. */
export class ExposureFields {
  readonly roots: HTMLElement[];
  private readonly slider: HTMLInputElement;
  private readonly label = element('span', { class: 'label' });
  private readonly air: HTMLInputElement;
  private readonly airLabel = element('span', { class: 'label' });
  private airNote: string | null = null;

  constructor(actions: { ev(ev: number): void; air(isSeen: boolean): void }) {
    this.slider = element('input', { type: 'range', id: 'ev', min: String(evRange.min), max: String(evRange.max), step: String(evRange.step) });
    this.slider.addEventListener('input', () => actions.ev(Number(this.slider.value)));
    const reset = element('button', { type: 'button' }, [text.exposureReset]);
    reset.addEventListener('click', () => actions.ev(0));
    this.air = element('input', { type: 'checkbox', id: 'air', title: `${text.airHint} (F)` });
    this.air.addEventListener('change', () => actions.air(this.air.checked));
    this.roots = [
      element('div', { class: 'field' }, [element('label', { for: 'ev' }, [text.exposure]), element('div', { class: 'row slim' }, [this.slider, reset]), this.label]),
      element('fieldset', { class: 'field' }, [
        element('legend', {}, [text.air]),
        element('div', { class: 'row' }, [this.air, element('label', { for: 'air' }, [text.airSwitch])]),
        this.airLabel,
      ]),
    ];
  }

  update({ picture, ev, exposure, air }: { picture: Picture; ev: number; exposure: number; air: boolean }): void {
    const isExposed = picture === 'lit' || picture === 'light';
    this.slider.value = String(ev);
    this.slider.disabled = !isExposed;
    this.label.textContent = isExposed ? text.exposureValue(ev, exposure) : text.exposureUnused;
    this.slider.setAttribute('aria-valuetext', this.label.textContent);
    this.air.checked = air && this.airNote !== null;
    this.air.disabled = picture !== 'lit' || this.airNote === null;
    this.airLabel.textContent = this.air.disabled ? text.airUnused : this.airNote;
  }

  /** What is known of the air; null where there is none to draw. Shown with the next update. */
  setAirNote(note: string | null): void {
    this.airNote = note;
  }
}
