import { Bake } from '../core/bake';
import { clampEv } from '../core/exposure';
import type { FalseColour } from '../core/false_colour';
import { lightParts, type LightPart } from '../core/light_parts';
import { LoadError } from '../core/load_error';
import { clampMoment, formatInstant, momentLabel } from '../core/moment';
import { isMeasure, type Mode, type Picture } from '../core/pictures';
import { text } from '../core/text';
import type { Vec3 } from '../core/units';
import type { ViewState } from '../core/view_state';
import { Viewer } from '../three/viewer';
import { element } from '../ui/element';
import { Legend } from '../ui/legend';
import { movePad } from '../ui/move_pad';
import { ProgressNotice, showError } from '../ui/notices';
import { Panel } from '../ui/panel';
import { Remarks } from '../ui/remarks';
import { Address } from './address';
import { listenForClicks } from './clicks';
import { Comparing } from './comparing';
import { listenForKeys } from './keys';
import { Measuring } from './measuring';
import { airNote, sunNote } from './notes';
import { Player } from './player';
import { luxScale, Ranges } from './ranges';

/** A view whose eye stands this low over the ground is meant to be walked from, metres. */
const highestWalker = 4;
/** The settings would cover most of a page that is narrower, CSS pixels. */
const narrowPage = 520;

type NamedView = { name: string; position: Vec3; target: Vec3 } | 'birds-eye' | 'on-foot';

/** Joins the bake, the drawing and the page. */
export class App {
  readonly viewer: Viewer;
  readonly measuring: Measuring;
  comparing: Comparing | null = null;
  private readonly canvas = element('canvas', { tabindex: '0', role: 'application', 'aria-label': text.canvasLabel });
  private readonly progress = new ProgressNotice();
  private readonly remarks = new Remarks();
  private readonly help = element('p', { class: 'help' });
  private readonly legend = new Legend((scale) => this.setScale(scale));
  private readonly ranges = new Ranges();
  private readonly address = new Address(() => this.state(), this.remarks.tell);
  private readonly player: Player;
  private bake: Bake | null = null;
  private panel: Panel | null = null;
  private views: NamedView[] = [];

  /** Throws LoadError when the browser has no WebGL 2. */
  constructor(readonly manifestUrl: string, antialias: boolean) {
    document.body.append(this.canvas, this.progress.root, this.remarks.notice, this.remarks.said, this.help);
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
    this.measuring = new Measuring(this.viewer, this.remarks.tell, this.remarks.say, showError);
    this.player = new Player({
      moment: () => this.viewer.moment,
      last: () => (this.bake?.manifest.instants.length ?? 1) - 1,
      show: (moment) => this.showMoment(moment),
      changed: (isPlaying) => this.panel?.showPlaying(isPlaying),
    });
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
    if (compared !== null) {
      const url = new URL('manifest.json', new URL(compared, document.baseURI));
      this.comparing = await Comparing.open(url, bake, this.viewer, this.progress, () => this.refresh());
    }

    this.views = [...manifest.views, 'birds-eye', 'on-foot'];
    this.panel = this.makePanel(title, bake);
    const pad = movePad({ press: (way, isDown) => this.viewer.pressWalkKey(way, isDown), step: (along, aside) => this.viewer.walkBy(along, aside, 0.5) });
    document.body.append(this.panel.opener, this.panel.root, this.measuring.panel.root, this.legend.root, pad, this.measuring.marker);
    if (innerWidth < narrowPage && matchMedia('(pointer: coarse)').matches) this.panel.show(false); // a phone shows the city first
    this.restore(this.address.read);
    await this.showMoment(this.address.read.moment ?? 0);
    listenForClicks(this.canvas, (at) => void this.measuring.at(at, false));
    listenForKeys(this);
    window.addEventListener('hashchange', () => this.restoreFromLink());
  }

  private makePanel(title: string, { manifest }: Bake): Panel {
    return new Panel(
      {
        title,
        instants: manifest.instants.map((instant) => formatInstant(instant.label)),
        views: this.views.map((view) => (view === 'birds-eye' ? text.birdsEye : view === 'on-foot' ? text.onFoot : view.name)),
        texelM: manifest.texel_m,
      },
      {
        moment: (moment) => {
          this.player.play(false); // the user's hand goes first
          void this.showMoment(moment);
        },
        picture: (picture) => this.setPicture(picture),
        mode: (mode) => this.setMode(mode),
        view: (index) => this.showView(index),
        ev: (ev) => this.setEv(ev),
        copyLink: () => void this.address.copy(),
        play: () => this.player.play(!this.player.isPlaying),
        savePicture: () => void this.savePicture(),
        air: (isSeen) => this.setAir(isSeen),
        part: (part, isOn) => this.switchPart(part, isOn),
      },
    );
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
      const sizes = missing.map((index) => bake.bytesOfInstant(index));
      const total = sizes.reduce<number | null>((sum, bytes) => (sum === null || bytes === null ? null : sum + bytes), 0);
      this.progress.begin(text.loading(text.loadingParts.light(missing.map((index) => formatInstant(instants[index]?.label ?? '')).join(', '))), total);
    }
    try {
      if (!(await this.viewer.showMoment(moment, this.progress.advance))) return; // overtaken: the later call ends the progress
    } catch (error) {
      showError(error);
      throw error;
    }
    this.progress.end();
    this.remarks.say(text.nowShowing(label));
    const nearest = bake.instant(Math.round(moment));
    this.panel?.showSun(Number.isInteger(moment) ? sunNote(nearest, bake.manifest.convergence_deg) : text.moment(label));
    this.panel?.setAirNote(airNote(nearest));
    this.applyScale();
    this.refresh();
  }

  setPicture(picture: Picture): void {
    this.viewer.picture = picture;
    this.applyScale();
    this.refresh();
  }

  /** Range of the false colours of the picture on show. */
  setScale(scale: FalseColour): void {
    this.ranges.choose(this.viewer.picture, scale);
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
    else if (!this.viewer.walkFrom(null)) this.remarks.tell(text.noGround);
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
      if (!this.viewer.walkFrom(null)) this.remarks.tell(text.noGround);
    } else {
      this.look(view.position, view.target);
    }
    this.panel?.showView(index);
    this.refresh();
  }

  measureMiddle(): void {
    void this.measuring.at({ x: this.canvas.clientWidth / 2, y: this.canvas.clientHeight / 2 }, true);
  }

  togglePanel(): void {
    this.panel?.show(!this.panel.isShown);
  }

  private restore(state: Partial<ViewState>): void {
    if (state.picture) this.viewer.picture = state.picture;
    if (state.scale && isMeasure(this.viewer.picture)) this.ranges.choose(this.viewer.picture, state.scale);
    if (state.ev !== undefined) this.viewer.ev = clampEv(state.ev);
    if (state.air !== undefined) this.viewer.air = state.air;
    this.viewer.off = state.off ?? [];
    if (state.comparison) this.comparing?.set(state.comparison);
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

  private restoreFromLink(): void {
    const state = this.address.read;
    if (Object.keys(state).length === 0) return;
    this.restore(state);
    void this.showMoment(state.moment ?? 0);
  }

  /** The user's range, or one that suits the light on show. */
  private applyScale(): void {
    const { picture, moment } = this.viewer;
    if (this.bake && isMeasure(picture)) this.viewer.scale = this.ranges.of(picture, this.bake, moment);
  }

  private refresh(): void {
    const { viewer, bake } = this;
    if (!bake) return;
    const moment = Math.max(0, viewer.moment);
    this.panel?.update({
      moment, label: momentLabel(bake.manifest.instants, moment), picture: viewer.picture, mode: viewer.mode, ev: viewer.ev, exposure: viewer.exposure, air: viewer.air,
      parts: bake.partsOf(Math.round(moment)), off: viewer.off,
    });
    this.legend.show(viewer.picture === 'illuminance' || viewer.picture === 'sky-view' ? text.legendTitle[viewer.picture] : null, viewer.scale);
    if (this.comparing) {
      // A tenth of the range of lux: what a planned building takes from a street is seen.
      const range = luxScale(bake, moment).high / 10;
      this.comparing.show(viewer, range);
      if (this.comparing.shown.shown === 'difference') this.legend.showDifference(text.compare.legend, text.compare.legendNote, range);
    }
    this.help.textContent = text.help[viewer.mode] + (this.comparing ? text.compare.keys : '');
    this.canvas.dataset['mode'] = viewer.mode;
    this.viewChanged();
  }

  private viewChanged(): void {
    this.measuring.moveMarker();
    this.address.changed();
  }

  /** What is seen now, as a link restores it. */
  private state(): ViewState | null {
    const { viewer } = this;
    if (viewer.moment < 0) return null;
    return {
      ...viewer.view, mode: viewer.mode, picture: viewer.picture, moment: viewer.moment, ev: viewer.ev, air: viewer.air, off: viewer.off,
      scale: this.ranges.chosenFor(viewer.picture), comparison: this.comparing?.shown ?? null,
    };
  }

  /** Offers what is seen as a PNG. */
  private async savePicture(): Promise<void> {
    const picture = await this.viewer.picturePng();
    const link = element('a', { download: `${document.title.replace(/[^\p{L}\p{N}]+/gu, '-')}.png`, href: URL.createObjectURL(picture) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // the browser has its copy long before
  }
}
