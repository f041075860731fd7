import { colourOf, differenceColours, placeOf, ticksOf, type FalseColour } from '../core/false_colour';
import { text } from '../core/text';
import { language } from '../core/text/language';
import { element } from './element';

const steps = 64;

/** The scale of a picture of numbers: a bar of its colours with round values, and its range to change. */
export class Legend {
  readonly root: HTMLElement;
  private readonly title = element('h2', {});
  private readonly bar = element('div', { class: 'bar', 'aria-hidden': 'true' });
  private readonly ticks = element('div', { class: 'ticks' });
  private readonly low: HTMLInputElement;
  private readonly high: HTMLInputElement;
  private readonly log: HTMLInputElement;
  private readonly row = element('div', { class: 'row' });
  private readonly fault = element('p', { class: 'note', role: 'status' });

  constructor(onChange: (scale: FalseColour) => void) {
    const field = (id: string): HTMLInputElement => element('input', { type: 'text', inputmode: 'decimal', id, size: '7' });
    this.low = field('scale-low');
    this.high = field('scale-high');
    this.log = element('input', { type: 'checkbox', id: 'scale-log' });
    const read = (): void => {
      const scale = { low: Number(this.low.value.replace(',', '.')), high: Number(this.high.value.replace(',', '.')), isLogarithmic: this.log.checked };
      const isGood = Number.isFinite(scale.low) && Number.isFinite(scale.high) && scale.low < scale.high && (!scale.isLogarithmic || scale.low > 0);
      this.fault.textContent = isGood ? '' : text.legendBad;
      if (isGood) onChange(scale);
    };
    for (const input of [this.low, this.high, this.log]) input.addEventListener('change', read);
    this.row.append(
      element('label', { for: 'scale-low' }, [text.legendLow]), this.low,
      element('label', { for: 'scale-high' }, [text.legendHigh]), this.high,
      this.log, element('label', { for: 'scale-log' }, [text.legendLog]),
    );
    this.root = element('section', { class: 'legend', hidden: '' }, [this.title, this.bar, this.ticks, this.row, this.fault]);
  }

  /** The scale of a difference: from −range over 0 to +range, which only its end says. */
  showDifference(title: string, note: string, range: number): void {
    this.show(title, { low: -range, high: range, isLogarithmic: false });
    this.bar.style.background = `linear-gradient(to right, ${differenceColours.map((code) => `rgb(${code.join(' ')})`).join(', ')})`;
    this.row.hidden = true;
    this.fault.textContent = note;
  }

  /** @param title null: nothing to explain */
  show(title: string | null, scale: FalseColour): void {
    this.root.hidden = title === null;
    this.row.hidden = false;
    if (title === null) return;
    this.title.textContent = title;
    this.root.setAttribute('aria-label', title);
    const stops = Array.from({ length: steps + 1 }, (_, i) => {
      const share = i / steps;
      const value = scale.isLogarithmic ? scale.low * (scale.high / scale.low) ** share : scale.low + share * (scale.high - scale.low);
      return `rgb(${colourOf(scale, value).map((code) => code.toFixed(1)).join(' ')}) ${(100 * share).toFixed(2)}%`;
    });
    this.bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    const plain = new Intl.NumberFormat(language, { maximumSignificantDigits: 6 });
    this.ticks.replaceChildren(...ticksOf(scale).map((value) => {
      const tick = element('span', {}, [plain.format(value)]);
      tick.style.left = `${(100 * placeOf(scale, value)).toFixed(2)}%`;
      return tick;
    }));
    this.low.value = String(scale.low);
    this.high.value = String(scale.high);
    this.log.checked = scale.isLogarithmic;
    this.fault.textContent = '';
  }
}
