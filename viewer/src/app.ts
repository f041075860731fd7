import { Bake, type BakedInstant } from './core/bake';
import type { Comparison } from './core/comparison';
import { clampEv } from './core/exposure';
import { autoScale, skyViewScale, type FalseColour } from './core/false_colour';
import { lightParts, type LightPart } from './core/light_parts';
import { LoadError } from './core/load_error';
import { clampMoment, formatInstant, momentLabel } from './core/moment';
import { isMeasure, pictures, type Mode, type Picture } from './core/pictures';
import { text } from './core/text';
import { luminance, type Vec3 } from './core/units';
import { formatViewState, parseViewState, type ViewState } from './core/view_state';
import { Measuring } from './measuring';
import type { ViewerStats } from './three/stats';
import { Viewer } from './three/viewer';
import type { WalkKey } from './three/walk';
import { element } from './ui/element';
import { CompareBar } from './ui/compare_bar';
import { Legend } from './ui/legend';
import { ProgressNotice, showError } from './ui/notices';
import { Panel } from './ui/panel';

/** A view whose eye stands this low over the ground is meant to be walked from, metres. */
const highestWalker = 4;
const linkIntervalMs = 300;
const noticeMs = 5000;
/** A baked time lasts two and a half seconds while they play. */
const playStep = 0.04;
const playIntervalMs = 100;
/** The settings would cover most of a page that is narrower, CSS pixels. */
const narrowPage = 520;
/** A pointer that moved less than this between down and up has clicked, CSS pixels. */
const clickSlack = 4;

type NamedView = { name: string; position: Vec3; target: Vec3 } | 'birds-eye' | 'on-foot';

/** Koschmieder's sight: where a contrast of one fiftieth is left. */
function airNote({ air }: BakedInstant): string | null {
  if (!air) return null;
  const green = (air.molecules_per_m[1] ?? 0) + (air.haze_per_m[1] ?? 0);
  return text.airNote(air.turbidity, Math.log(50) / green / 1000);
}

/** Joins the bake, the drawing and the page. */
export class App {
  readonly viewer: Viewer;
  readonly measuring: Measuring;
  private readonly legend = new Legend((scale) => this.setScale(scale));
  /** Ranges that the user chose. */
  private readonly scales = new Map<Picture, FalseColour>();
  private bake: Bake | null = null;
  private compareBar: CompareBar | null = null;
  private comparison: { shown: Comparison; divider: number } = { shown: 'swipe', divider: 0.5 };
  private panel: Panel | null = null;
  private views: NamedView[] = [];
  private readonly canvas: HTMLCanvasElement;
  private readonly progress = new ProgressNotice();
  private readonly said = element('p', { class: 'said', role: 'status' });
  private readonly notice = element('p', { class: 'progress', role: 'alert', hidden: '' });
  private noticeTimer: number | null = null;
  private playTimer: number | null = null;
  private readonly help = element('p', { class: 'help' });
  private linkTimer: number | null = null;

  /** Throws LoadError when the browser has no WebGL 2. */
  constructor(readonly manifestUrl: string, antialias: boolean) {
    this.canvas = element('canvas', { tabindex: '0', role: 'application', 'aria-label': text.canvasLabel });
    document.body.append(this.canvas, this.progress.root, this.notice, this.said, this.help);
    try {
      this.viewer = new Viewer(this.canvas, {
        antialias,
        onViewChange: () => this.viewChanged(),
        onContextLost: () => showError(new Error(text.error.contextLost)),
        onError: showError,
      });
    } catch {
      throw new Error(text.error.noWebGl);
    }
    this.measuring = new Measuring(this.viewer, (words) => this.tell(words), (words) => (this.said.textContent = words), showError);
  }

  /** Loads the bake and shows its first picture. Throws LoadError. */
  async start(): Promise<void> {
    this.progress.begin(text.loading(text.loadingParts.manifest), null);
    const bake = await Bake.load(this.manifestUrl, this.progress.advance);
    this.bake = bake;
    const { manifest } = bake;
    if (manifest.instants.length === 0) throw new LoadError(this.manifestUrl, text.error.noInstants);
    const title = manifest.title || text.untitled;
    document.title = text.pageTitle(title);

    this.progress.begin(text.loading(text.loadingParts.city), bake.bytesOf('city.glb'));
    await this.viewer.open(bake, this.progress.advance);

    const compared = new URLSearchParams(location.search).get('compare');
    if (compared !== null) await this.openOther(new URL('manifest.json', new URL(compared, document.baseURI)), title);

    this.views = [...manifest.views, 'birds-eye', 'on-foot'];
    this.panel = new Panel(
      {
        title,
        instants: manifest.instants.map((instant) => formatInstant(instant.label)),
        views: this.views.map((view) => (view === 'birds-eye' ? text.birdsEye : view === 'on-foot' ? text.onFoot : view.name)),
        texelM: manifest.texel_m,
      },
      {
        moment: (moment) => {
          this.play(false); // the user's hand goes first
          void this.showMoment(moment);
        },
        picture: (picture) => this.setPicture(picture),
        mode: (mode) => this.setMode(mode),
        view: (index) => this.showView(index),
        ev: (ev) => this.setEv(ev),
        copyLink: () => void this.copyLink(),
        play: () => this.play(this.playTimer === null),
        savePicture: () => void this.savePicture(),
        air: (isSeen) => this.setAir(isSeen),
        part: (part, isOn) => this.switchPart(part, isOn),
      },
    );
    document.body.append(this.panel.opener, this.panel.root, this.measuring.panel.root, this.legend.root, this.makePad(), this.measuring.marker);
    if (innerWidth < narrowPage && matchMedia('(pointer: coarse)').matches) this.panel.show(false); // a phone shows the city first
    this.restore(parseViewState(location.hash));
    this.listenForClicks(); // who sees the first pages may walk
    window.addEventListener('keydown', (event) => this.key(event));
    window.addEventListener('hashchange', () => this.restoreFromLink());
    await this.showMoment(this.momentOfLink());
  }

  /** Loads the bake to compare with. Throws LoadError. */
  private async openOther(url: URL, ownTitle: string): Promise<void> {
    if (url.origin !== location.origin) throw new LoadError(url.href, text.error.otherOrigin);
    this.progress.begin(text.loading(text.compare.part), null);
    const other = await Bake.load(url.href, this.progress.advance);
    if (other.manifest.instants.length === 0) throw new LoadError(url.href, text.error.noInstants);
    this.progress.begin(text.loading(text.compare.part), other.bytesOf('city.glb'));
    await this.viewer.openOther(other, this.progress.advance);
    this.compareBar = new CompareBar({ a: ownTitle, b: other.manifest.title || text.untitled }, {
      show: (shown) => this.compare({ shown, divider: this.comparison.divider }),
      divide: (divider) => this.compare({ shown: this.comparison.shown, divider }),
    });
    document.body.append(this.compareBar.root, this.compareBar.divider);
    document.body.classList.add('compares');
  }

  /** What is shown of two bakes. */
  compare(comparison: { shown: Comparison; divider: number }): void {
    this.comparison = comparison;
    this.refresh();
  }

  /** Shows a baked instant, or the cross-fade of two for a moment between them. */
  async showMoment(wanted: number): Promise<void> {
    const { bake } = this;
    if (!bake) return;
    const { instants } = bake.manifest;
    const moment = clampMoment(wanted, instants.length);
    const missing = this.viewer.missingFor(moment);
    const label = momentLabel(instants, moment);
    if (missing.length > 0) {
      const total = this.viewer.bytesMissingFor(moment);
      this.progress.begin(text.loading(text.loadingParts.light(missing.map((index) => formatInstant(instants[index]?.label ?? '')).join(', '))), total);
    }
    try {
      if (!(await this.viewer.showMoment(moment, this.progress.advance))) return; // overtaken: the later call ends the progress
    } catch (error) {
      showError(error);
      throw error;
    }
    this.progress.end();
    this.said.textContent = text.nowShowing(label);
    const nearest = Math.round(moment);
    this.panel?.showSun(Number.isInteger(moment) ? this.sunNote(nearest) : text.moment(label));
    this.panel?.setAirNote(airNote(bake.instant(nearest)));
    this.applyScale();
    this.refresh();
  }

  /** Runs through the baked times, again and again; a step waits until the one before is shown. */
  private play(isPlaying: boolean): void {
    if (this.playTimer !== null) clearTimeout(this.playTimer);
    this.playTimer = null;
    this.panel?.showPlaying(isPlaying);
    if (!isPlaying) return;
    const last = (this.bake?.manifest.instants.length ?? 1) - 1;
    const step = async (): Promise<void> => {
      const { moment } = this.viewer;
      await this.showMoment(moment >= last ? 0 : Math.min(last, moment + playStep));
      if (this.playTimer !== null) this.playTimer = window.setTimeout(() => void step(), playIntervalMs);
    };
    this.playTimer = window.setTimeout(() => void step(), playIntervalMs);
  }

  setPicture(picture: Picture): void {
    this.viewer.picture = picture;
    this.applyScale();
    this.refresh();
  }

  /** Range of the false colours of the picture on show. */
  setScale(scale: FalseColour): void {
    this.scales.set(this.viewer.picture, scale);
    this.applyScale();
    this.refresh();
  }

  setEv(ev: number): void {
    this.viewer.ev = clampEv(ev);
    this.refresh();
  }

  setAir(isSeen: boolean): void {
    this.viewer.air = isSeen;
    this.refresh();
  }

  switchPart(part: LightPart, isOn: boolean): void {
    this.viewer.off = lightParts.filter((other) => (other === part ? !isOn : this.viewer.off.includes(other)));
    this.refresh();
  }

  setMode(mode: Mode): void {
    if (mode === this.viewer.mode) return;
    if (mode === 'orbit') this.viewer.leaveWalk();
    else if (!this.viewer.walkFrom(null)) this.tell(text.noGround);
    this.panel?.showView(null);
    this.refresh();
    this.canvas.focus({ preventScroll: true });
  }

  /** Looks from a place; on foot when the eye is near the ground. */
  look(position: Vec3, target: Vec3): void {
    const height = this.viewer.heightOverGround(position);
    const isLow = height !== null && height >= 0 && height <= highestWalker;
    if (!isLow || !this.viewer.walkFrom({ position, target })) this.viewer.lookAt(position, target);
    this.refresh();
  }

  showView(index: number): void {
    const view = this.views[index];
    if (view === undefined) return;
    if (view === 'birds-eye') {
      const { position, target } = this.viewer.birdsEye();
      this.viewer.lookAt(position, target);
    } else if (view === 'on-foot') {
      this.viewer.leaveWalk();
      if (!this.viewer.walkFrom(null)) this.tell(text.noGround);
    } else {
      this.look(view.position, view.target);
    }
    this.panel?.showView(index);
    this.refresh();
  }

  stats(): ViewerStats {
    return this.viewer.stats();
  }

  /** A remark that goes by itself. */
  private tell(words: string): void {
    this.notice.textContent = words;
    this.notice.hidden = false;
    if (this.noticeTimer !== null) clearTimeout(this.noticeTimer);
    this.noticeTimer = window.setTimeout(() => (this.notice.hidden = true), noticeMs);
  }

  private restore(state: Partial<ViewState>): void {
    if (state.picture) this.viewer.picture = state.picture;
    if (state.scale && isMeasure(this.viewer.picture)) this.scales.set(this.viewer.picture, state.scale);
    if (state.ev !== undefined) this.viewer.ev = clampEv(state.ev);
    if (state.air !== undefined) this.viewer.air = state.air;
    this.viewer.off = state.off ?? [];
    if (state.comparison) this.comparison = state.comparison;
    if (state.position && state.target) {
      const isWalking = state.mode === 'walk' && this.viewer.walkFrom({ position: state.position, target: state.target });
      if (!isWalking) this.viewer.lookAt(state.position, state.target);
      this.panel?.showView(null);
    } else if (state.mode === 'walk') {
      this.showView(this.views.indexOf('on-foot'));
    } else {
      this.showView(0);
    }
  }

  private momentOfLink(): number {
    return parseViewState(location.hash).moment ?? 0;
  }

  /** The user's range, or one that suits the light on show. */
  private applyScale(): void {
    const { picture } = this.viewer;
    if (!this.bake || !isMeasure(picture)) return;
    this.viewer.scale = this.scales.get(picture) ?? (picture === 'sky-view' ? skyViewScale : this.luxScale(this.bake));
  }

  /** A range of lux that suits the moment. */
  private luxScale(bake: Bake): FalseColour {
    const { exposure_hint: hint, sun } = bake.instant(Math.max(0, Math.round(this.viewer.moment)));
    return autoScale(hint, sun.shape === 'none' ? 0 : luminance(sun.normal_illuminance_klx));
  }

  /** A click that is no drag measures. */
  private listenForClicks(): void {
    let down: PointerEvent | null = null;
    this.canvas.addEventListener('pointerdown', (event) => (down = event.isPrimary && event.button === 0 ? event : null));
    this.canvas.addEventListener('pointerup', (event) => {
      const isClick = down !== null && down.pointerId === event.pointerId && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) <= clickSlack;
      down = null;
      if (isClick) void this.measuring.at({ x: event.offsetX, y: event.offsetY }, false);
    });
  }

  private restoreFromLink(): void {
    const state = parseViewState(location.hash);
    if (Object.keys(state).length === 0) return;
    this.restore(state);
    void this.showMoment(this.momentOfLink());
  }

  private refresh(): void {
    const { viewer } = this;
    const moment = Math.max(0, viewer.moment);
    const instants = this.bake?.manifest.instants ?? [];
    this.panel?.update({
      moment, label: momentLabel(instants, moment), picture: viewer.picture, mode: viewer.mode, ev: viewer.ev, exposure: viewer.exposure, air: viewer.air,
      parts: this.bake?.partsOf(Math.round(moment)) ?? [], off: viewer.off,
    });
    this.legend.show(viewer.picture === 'illuminance' || viewer.picture === 'sky-view' ? text.legendTitle[viewer.picture] : null, viewer.scale);
    this.showComparison();
    this.help.textContent = text.help[viewer.mode] + (this.compareBar ? text.compare.keys : '');
    this.canvas.dataset['mode'] = viewer.mode;
    this.viewChanged();
  }

  private showComparison(): void {
    if (!this.compareBar || !this.bake) return;
    const { shown, divider } = this.comparison;
    // A tenth of the range of lux: what a planned building takes from a street is seen.
    const range = this.luxScale(this.bake).high / 10;
    this.compareBar.update(shown, divider);
    this.viewer.compare(shown, divider, range);
    if (shown === 'difference') this.legend.showDifference(text.compare.legend, text.compare.legendNote, range);
  }

  private sunNote(index: number): string {
    if (!this.bake) return '';
    const { sun } = this.bake.instant(index);
    const azimuth = (sun.azimuth_deg + this.bake.manifest.convergence_deg + 720) % 360;
    return sun.shape === 'none' ? text.noSun : text.sun(azimuth, sun.elevation_deg, luminance(sun.normal_illuminance_klx));
  }

  /** The part of the address that restores what is seen now. */
  private link(): string {
    const { viewer } = this;
    return formatViewState({ ...viewer.view, mode: viewer.mode, picture: viewer.picture, moment: viewer.moment, ev: viewer.ev, air: viewer.air, off: viewer.off, scale: this.scales.get(viewer.picture) ?? null, comparison: this.compareBar ? this.comparison : null });
  }

  private async copyLink(): Promise<void> {
    const address = new URL(this.link(), location.href).href;
    history.replaceState(null, '', address);
    try {
      await navigator.clipboard.writeText(address);
      this.tell(text.linkCopied);
    } catch {
      this.tell(text.linkNotCopied); // no clipboard over plain http, or the user forbade it
    }
  }

  /** Offers what is seen as a PNG. */
  private async savePicture(): Promise<void> {
    const picture = await this.viewer.picturePng();
    const link = element('a', { download: `${document.title.replace(/[^\p{L}\p{N}]+/gu, '-')}.png`, href: URL.createObjectURL(picture) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // the browser has its copy long before
  }

  /** Writes the link at most a few times a second: browsers refuse more. */
  private viewChanged(): void {
    if (this.viewer.moment < 0) return;
    this.measuring.moveMarker();
    this.linkTimer ??= window.setTimeout(() => {
      this.linkTimer = null;
      history.replaceState(null, '', this.link());
    }, linkIntervalMs);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof Element && event.target.matches('select, textarea, input:not([type=range])')) return;
    const picture = pictures[Number(event.key) - 1];
    if (picture) this.setPicture(picture);
    else if (event.key === ',') void this.showMoment(Math.ceil(this.viewer.moment) - 1);
    else if (event.key === '.') void this.showMoment(Math.floor(this.viewer.moment) + 1);
    else if (event.key === 'Escape' && this.measuring.isOpen) this.measuring.close();
    else if (this.compareBar && event.code === 'KeyB') this.compare({ ...this.comparison, shown: this.comparison.shown === 'b' ? 'a' : 'b' });
    else if (this.compareBar && event.code === 'KeyC') this.compare({ ...this.comparison, shown: this.comparison.shown === 'swipe' ? 'difference' : 'swipe' });
    else if (event.code === 'KeyM') void this.measuring.at({ x: this.canvas.clientWidth / 2, y: this.canvas.clientHeight / 2 }, true);
    else if (event.key === '+' || event.key === '=') this.setEv(this.viewer.ev + 0.5);
    else if (event.key === '-') this.setEv(this.viewer.ev - 0.5);
    else if (event.code === 'KeyF') this.setAir(!this.viewer.air);
    else if (event.code === 'KeyO') this.setMode('orbit');
    else if (event.code === 'KeyP') this.setMode('walk');
    else if (event.code === 'KeyR') this.showView(0);
    else if (event.code === 'KeyH') this.panel?.show(!this.panel.isShown);
    else return;
    event.preventDefault();
  }

  /** Arrows for fingers: shown on touch screens, in walk mode. */
  private makePad(): HTMLElement {
    const signs: [WalkKey & keyof typeof text.movePadButtons, string][] = [['forward', '↑'], ['left', '←'], ['back', '↓'], ['right', '→']];
    const pad = element('div', { class: 'pad', role: 'group', 'aria-label': text.movePad });
    for (const [key, sign] of signs) {
      const button = element('button', { type: 'button', 'aria-label': text.movePadButtons[key] }, [sign]);
      button.addEventListener('pointerdown', () => this.viewer.pressWalkKey(key, true));
      for (const name of ['pointerup', 'pointercancel', 'pointerleave'] as const) {
        button.addEventListener(name, () => this.viewer.pressWalkKey(key, false));
      }
      // Keyboards and screen readers click: half a step at a time.
      button.addEventListener('click', (event) => {
        if (event.detail !== 0) return;
        const [along, aside] = { forward: [1, 0], back: [-1, 0], left: [0, -1], right: [0, 1] }[key] as [number, number];
        this.viewer.walkBy(along, aside, 0.5);
      });
      pad.append(button);
    }
    return pad;
  }
}
