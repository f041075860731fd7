import type { FalseColour } from '../core/false_colour';
import { text } from '../core/text';
import { element } from './element';

/** A scale, ready to be shown. */
export interface LegendContent {
  title: string;
  /** CSS background of the bar, from left to right. */
  background: string;
  /** Places 0…1 of the bar with what stands there. */
  ticks: readonly { place: number; label: string }[];
  /** The range that the user may change; null where it is fixed. */
  scale: FalseColour | null;
  /** What must not be overlooked: that light was scaled or left out. */
  warning: string | null;
  note: string;
}

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
  private readonly warning = element('p', { class: 'warning' });
  private readonly note = element('p', { class: 'note', role: 'status' });

  constructor(onChange: (scale: FalseColour) => void) {
    const field = (id: string): HTMLInputElement => element('input', { type: 'text', inputmode: 'decimal', id, size: '7' });
    this.low = field('scale-low');
    this.high = field('scale-high');
    this.log = element('input', { type: 'checkbox', id: 'scale-log' });
    const read = (): void => {
      const scale = { low: Number(this.low.value.replace(',', '.')), high: Number(this.high.value.replace(',', '.')), isLogarithmic: this.log.checked };
      const isGood = Number.isFinite(scale.low) && Number.isFinite(scale.high) && scale.low < scale.high && (!scale.isLogarithmic || scale.low > 0);
      this.note.textContent = isGood ? '' : text.legendBad;
      if (isGood) onChange(scale);
    };
    for (const input of [this.low, this.high, this.log]) input.addEventListener('change', read);
    this.row.append(
      element('label', { for: 'scale-low' }, [text.legendLow]), this.low,
      element('label', { for: 'scale-high' }, [text.legendHigh]), this.high,
      this.log, element('label', { for: 'scale-log' }, [text.legendLog]),
    );
    this.root = element('section', { class: 'legend', hidden: '' }, [this.title, this.bar, this.ticks, this.row, this.warning, this.note]);
  }

  /** @param content null: nothing to explain */
  show(content: LegendContent | null): void {
    this.root.hidden = content === null;
    document.body.classList.toggle('has-legend', content !== null);
    if (!content) return;
    this.title.textContent = content.title;
    this.root.setAttribute('aria-label', content.title);
    this.bar.style.background = content.background;
    this.ticks.replaceChildren(...content.ticks.map(({ place, label }) => {
      const tick = element('span', {}, [label]);
      tick.style.left = `${(100 * place).toFixed(2)}%`;
      return tick;
    }));
    const { scale } = content;
    this.row.hidden = scale === null;
    if (scale) {
      this.low.value = String(scale.low);
      this.high.value = String(scale.high);
      this.log.checked = scale.isLogarithmic;
    }
    this.warning.textContent = content.warning;
    this.warning.hidden = content.warning === null;
    this.note.textContent = content.note;
  }
}
