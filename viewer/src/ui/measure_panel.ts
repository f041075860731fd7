import { text } from '../core/text';
import { element } from './element';

/** What was measured, ready to be read. */
export interface Reading {
  /** Of the study's layer on show. */
  layer: { name: string; value: string } | null;
  lx: number;
  parts: { name: string; lx: number }[];
  facts: { name: string; value: string }[];
  attributes: { name: string; value: string }[];
  notes: string[];
  chart: SVGElement | null;
  chartNote: string;
}

/** Numbers of the place that was clicked. It shows what it is told. */
export class MeasurePanel {
  readonly root: HTMLElement;
  private readonly content = element('div', {});
  private readonly warning = element('p', { class: 'warning', hidden: '' });
  private readonly close: HTMLButtonElement;
  private returnFocus: HTMLElement | null = null;

  constructor(private readonly actions: { close(): void; copyPoint(): void }) {
    this.close = element('button', { type: 'button', title: `${text.measure.close} (Esc)` }, [text.measure.close]);
    this.close.addEventListener('click', () => actions.close());
    this.root = element('section', { class: 'panel measure', 'aria-label': text.measure.heading, hidden: '' }, [
      element('header', {}, [element('h2', {}, [text.measure.heading]), this.close]),
      this.warning,
      this.content,
    ]);
  }

  /** @param takesFocus asked for by key: the keyboard goes on in the panel */
  showReading(reading: Reading | null, takesFocus = false): void {
    if (this.root.hidden && takesFocus) this.returnFocus = document.activeElement instanceof HTMLElement ? document.activeElement : null;
    this.root.hidden = false;
    document.body.classList.add('measures');
    this.content.replaceChildren(...(reading ? this.body(reading) : [element('p', { class: 'note' }, [text.measure.reading])]));
    this.content.dataset['lx'] = reading ? String(reading.lx) : '';
    if (takesFocus) this.close.focus();
  }

  /** What must not be overlooked about the numbers. */
  showWarning(words: string | null): void {
    this.warning.textContent = words;
    this.warning.hidden = words === null;
  }

  hide(): void {
    const hadFocus = this.root.contains(document.activeElement);
    this.root.hidden = true;
    document.body.classList.remove('measures');
    if (hadFocus) this.returnFocus?.focus();
    this.returnFocus = null;
  }

  private body({ layer, lx, parts, facts, attributes, notes, chart, chartNote }: Reading): Node[] {
    const copy = element('button', { type: 'button', title: text.measure.copyPointHint }, [text.measure.copyPoint]);
    copy.addEventListener('click', () => this.actions.copyPoint());
    const table = (entries: { name: string; value: string }[]): HTMLElement =>
      element('dl', {}, entries.flatMap(({ name, value }) => [element('dt', {}, [name]), element('dd', {}, [value])]));
    return [
      ...(layer ? [element('p', { class: 'lux' }, [layer.value]), element('p', { class: 'note under' }, [layer.name])] : []),
      element('p', { class: layer ? 'lux second' : 'lux' }, [text.measure.lux(lx)]),
      element('table', { class: 'parts' }, [
        element('caption', {}, [text.measure.parts]),
        ...parts.map((part) => {
          const share = lx > 0 ? part.lx / lx : 0;
          const bar = element('span', { class: 'bar' });
          bar.style.width = `${(100 * share).toFixed(1)}%`;
          return element('tr', {}, [
            element('th', { scope: 'row' }, [part.name]),
            element('td', {}, [text.measure.lux(part.lx)]),
            element('td', { class: 'share' }, [bar, element('span', {}, [text.measure.share(share)])]),
          ]);
        }),
      ]),
      table(facts),
      ...notes.map((note) => element('p', { class: 'note' }, [note])),
      ...(attributes.length > 0 ? [element('details', {}, [element('summary', {}, [`${text.measure.attributes} (${attributes.length})`]), table(attributes)])] : []),
      ...(chart ? [element('h3', {}, [text.measure.sunPath]), chart, element('p', { class: 'note' }, [chartNote])] : []),
      copy,
    ];
  }
}
