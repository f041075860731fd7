import { text } from '../core/text';
import { element } from '../ui/element';

/** The mouse looks without a button held down, until Escape: the browser's pointer lock, which it may refuse. */
export class MouseLook {
  /** Marks the middle of the picture, which a click measures. */
  readonly crosshair = element('div', { class: 'crosshair', 'aria-hidden': 'true', hidden: '' });

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly tell: (words: string) => void,
  ) {
    document.addEventListener('pointerlockchange', () => {
      this.crosshair.hidden = !this.isOn;
      if (this.isOn) tell(text.mouseLook.on);
    });
    document.addEventListener('pointerlockerror', () => tell(text.mouseLook.refused));
  }

  get isOn(): boolean {
    return document.pointerLockElement === this.canvas;
  }

  async begin(): Promise<void> {
    if (this.isOn) return;
    if (typeof this.canvas.requestPointerLock !== 'function') return this.tell(text.mouseLook.refused); // phones
    this.canvas.focus({ preventScroll: true });
    try {
      await this.canvas.requestPointerLock(); // nothing in browsers that answer by events alone
    } catch {
      this.tell(text.mouseLook.refused);
    }
  }

  end(): void {
    if (this.isOn) document.exitPointerLock();
  }
}
