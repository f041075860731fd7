/** A baked time lasts two and a half seconds while they play. */
const step = 0.04;
const intervalMs = 100;

/** Runs through the baked times, again and again; a step waits until the one before is shown. */
export class Player {
  private timer: number | null = null;

  constructor(private readonly actions: { moment(): number; last(): number; show(moment: number): Promise<void>; changed(isPlaying: boolean): void }) {}

  get isPlaying(): boolean {
    return this.timer !== null;
  }

  play(isPlaying: boolean): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = isPlaying ? window.setTimeout(() => void this.advance(), intervalMs) : null;
    this.actions.changed(isPlaying);
  }

  private async advance(): Promise<void> {
    const [moment, last] = [this.actions.moment(), this.actions.last()];
    await this.actions.show(moment >= last ? 0 : Math.min(last, moment + step));
    if (this.timer !== null) this.timer = window.setTimeout(() => void this.advance(), intervalMs);
  }
}
