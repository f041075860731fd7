import type { Vec3 } from '../core/units';
import { text } from '../core/text';
import type { Picked } from '../three/bake_pair';
import type { Viewer } from '../three/viewer';
import { element } from '../ui/element';
import { MeasurePanel } from '../ui/measure_panel';
import { readPlace, type Measured } from './reading';

/** Measures the place that is clicked: light, object, sun path. */
export class Measuring {
  readonly panel: MeasurePanel;
  readonly marker = element('div', { class: 'marker', hidden: '', 'aria-hidden': 'true' });
  last: Measured | null = null;
  private place: Vec3 | null = null;
  private picked: Picked | null = null;
  private shownKey = '';
  private question = 0;

  /**
   * @param tell shows a remark for a while
   * @param say for screen readers alone
   */
  constructor(
    private readonly viewer: Viewer,
    private readonly tell: (words: string) => void,
    private readonly say: (words: string) => void,
    private readonly onError: (error: unknown) => void,
  ) {
    this.panel = new MeasurePanel({ close: () => this.close(), copyPoint: () => void this.copyPoint() });
  }

  /** @param at CSS pixels from the canvas's upper left corner */
  async at(at: { x: number; y: number }, isByKey: boolean): Promise<void> {
    const picked = this.viewer.pick(at.x, at.y);
    if (!picked) {
      this.close();
      if (isByKey) this.tell(text.measure.nothing);
      return;
    }
    this.picked = picked;
    this.place = picked.world;
    this.moveMarker();
    this.panel.showReading(null, isByKey);
    await this.read(picked);
  }

  /** The view has changed: another time or layer has other numbers at the same place. `isMixed`: the picture scales parts of the light. */
  viewChanged(isMixed: boolean): void {
    this.panel.showWarning(isMixed ? text.measure.mixNote : null);
    if (this.isOpen && this.picked && this.key() !== this.shownKey) void this.read(this.picked);
  }

  private get layer(): string | null {
    return this.viewer.picture === 'layer' ? this.viewer.layer : null;
  }

  private key(): string {
    return `${Math.round(this.viewer.moment)} ${this.layer}`;
  }

  private async read(picked: Picked): Promise<void> {
    const { viewer } = this;
    const question = ++this.question;
    this.shownKey = this.key();
    try {
      const { reading, measured } = await readPlace(picked, { twin: viewer.pickTwin(picked), layer: this.layer });
      if (question !== this.question) return;
      this.last = measured;
      this.panel.showReading(reading);
      this.say(text.measure.announced(reading.layer ? `${reading.layer.name} ${reading.layer.value}` : text.measure.lux(reading.lx)));
    } catch (error) {
      this.close();
      this.onError(error);
    }
  }

  get isOpen(): boolean {
    return !this.panel.root.hidden;
  }

  close(): void {
    ++this.question;
    this.place = null;
    this.picked = null;
    this.marker.hidden = true;
    this.panel.hide();
  }

  /** Keeps the ring over the place as the view moves. */
  moveMarker(): void {
    const at = this.place && this.viewer.project(this.place);
    this.marker.hidden = !at;
    if (at) this.marker.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }

  private async copyPoint(): Promise<void> {
    if (!this.last) return;
    try {
      await navigator.clipboard.writeText(this.last.pointCsv);
      this.tell(text.measure.pointCopied);
    } catch {
      this.tell(text.linkNotCopied);
    }
  }
}
