import { changedParts, factorOf, largestFactor, lightParts, type LightMix, type LightPart } from '../../core/light_parts';
import { text } from '../../core/text';
import { element } from '../element';

interface PartRow {
  root: HTMLElement;
  check: HTMLInputElement;
  slider: HTMLInputElement;
  value: HTMLElement;
}

/** How much of each part of the light is shown. */
export class LightFields {
  readonly root: HTMLElement;
  private readonly rows = new Map<LightPart, PartRow>();
  private readonly reset: HTMLButtonElement;

  constructor(actions: { part(part: LightPart, isOn: boolean): void; factor(part: LightPart, factor: number): void; wholeLight(): void }) {
    for (const part of lightParts) {
      const id = `part-${part}`;
      const check = element('input', { type: 'checkbox', id, title: text.partHints[part] });
      check.addEventListener('change', () => actions.part(part, check.checked));
      const slider = element('input', { type: 'range', min: '0', max: String(100 * largestFactor), step: '5', 'aria-label': text.partShare(text.partNames[part]) });
      slider.addEventListener('input', () => actions.factor(part, Number(slider.value) / 100));
      const value = element('span', { class: 'value' });
      const root = element('div', { class: 'row part' }, [check, element('label', { for: id, title: text.partHints[part] }, [text.partNames[part]]), slider, value]);
      this.rows.set(part, { root, check, slider, value });
    }
    this.reset = element('button', { type: 'button', title: text.wholeLightHint }, [text.wholeLight]);
    this.reset.addEventListener('click', () => {
      actions.wholeLight();
      [...this.rows.values()].find(({ root }) => !root.hidden)?.check.focus(); // the button goes
    });
    this.root = element('fieldset', { class: 'field' }, [element('legend', {}, [text.parts]), ...[...this.rows.values()].map(({ root }) => root), this.reset]);
  }

  /** @param parts that the bake has at this time */
  update(parts: readonly LightPart[], mix: LightMix): void {
    for (const [part, { root, check, slider, value }] of this.rows) {
      root.hidden = !parts.includes(part);
      check.checked = !mix.off.includes(part);
      slider.value = String(Math.round(100 * mix.factors[part]));
      slider.setAttribute('aria-valuetext', text.percent(mix.factors[part]));
      value.textContent = text.percent(factorOf(mix, part));
      root.classList.toggle('off', !check.checked);
    }
    this.reset.hidden = changedParts(mix, parts).length === 0;
  }
}
