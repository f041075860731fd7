import { Bake } from '../core/bake';
import { clampEv } from '../core/exposure';
import type { FalseColour } from '../core/false_colour';
import { titleOf } from '../core/layer_colours';
import { changedParts, wholeLight, withFactor, withPartOn, type LightMix } from '../core/light_parts';
import { LoadError } from '../core/load_error';
import { clampMoment, formatInstant, momentLabel } from '../core/moment';
import { isMeasure, showsLight, type Mode, type Picture } from '../core/pictures';
import { text } from '../core/text';
import { parseViewState, type ViewState } from '../core/view_state';
import { Viewer } from '../three/viewer';
import { element } from '../ui/element';
import { HelpDialog } from '../ui/help_dialog';
import { Legend } from '../ui/legend';
import { ProgressNotice, showError } from '../ui/notices';
import { Panel } from '../ui/panel';
import { Remarks } from '../ui/remarks';
import { touchStick } from '../ui/stick';
import { Address } from './address';
import { listenForClicks } from './clicks';
import { Comparing } from './comparing';
import { listenForKeys } from './keys';
import { differenceLegend, legendOf } from './legends';
import { MapCorner } from './map_corner';
import { Measuring } from './measuring';
import { MouseLook } from './mouse_look';
import { airNote, sunNote } from './notes';
import { Player } from './player';
import { luxScale, Ranges } from './ranges';
import { Views } from './views';

/** The settings would cover most of a page that is narrower, CSS pixels. */
const narrowPage = 520;
/** On smaller pages the map waits until it is asked for, CSS pixels. */
const widePage = 900;
const highPage = 560;

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
  private readonly mouseLook = new MouseLook(this.canvas, this.remarks.tell);
  private bake: Bake | null = null;
  private panel: Panel | null = null;
  private views: Views | null = null;
  private map: MapCorner | null = null;
  private helpDialog: HelpDialog | null = null;

  /** Throws LoadError when the browser has no WebGL 2. */
  constructor(readonly manifestUrl: string, antialias: boolean) {
    document.body.append(this.canvas, this.progress.root, this.remarks.notice, this.remarks.said, this.help, this.mouseLook.crosshair);
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

    this.views = new Views(bake, this.viewer, this.remarks.tell);
    this.views.takeFrom(location.hash);
    this.viewer.layer = manifest.layers?.[0]?.id ?? null;
    this.panel = this.makePanel(title, bake, this.views);
    this.map = new MapCorner(this.viewer, manifest.convergence_deg, this.remarks.tell, () => this.refresh());
    this.helpDialog = new HelpDialog(this.comparing !== null);
    const stick = touchStick({ steer: (along, aside) => this.viewer.steer(along, aside), step: (along, aside) => this.viewer.walkBy(along, aside, 0.5) });
    document.body.append(
      this.panel.opener, this.panel.root, this.map.root, this.measuring.panel.root, this.legend.root, stick, ...(this.comparing?.roots ?? []), this.measuring.marker,
      this.helpDialog.root);
    const isPhone = matchMedia('(pointer: coarse)').matches && innerWidth < narrowPage;
    if (isPhone) this.panel.show(false); // a phone shows the city first
    this.restore(this.address.read);
    listenForClicks(this.canvas, (at) => void this.measuring.at(this.mouseLook.isOn ? this.middle : at, false)); // who sees the first pages may walk
    listenForKeys(this);
    window.addEventListener('hashchange', () => this.restoreFromLink());
    await this.showMoment(this.address.read.moment ?? 0);
    if (!isPhone && innerWidth >= widePage && innerHeight >= highPage) this.showMap(true);
  }

  private makePanel(title: string, { manifest }: Bake, views: Views): Panel {
    const panel = new Panel(
      {
        title,
        instants: manifest.instants.map((instant) => formatInstant(instant.label)),
        views: views.names,
        layers: (manifest.layers ?? []).map((layer) => ({ id: layer.id, title: titleOf(layer) })),
        texelM: manifest.texel_m,
      },
      {
        moment: (moment) => {
          this.player.play(false); // the user's hand goes first
          void this.showMoment(moment);
        },
        play: () => this.player.play(!this.player.isPlaying),
        picture: (picture) => this.setPicture(picture),
        layer: (id) => this.showLayer(id),
        mode: (mode) => this.setMode(mode),
        mouseLook: () => this.lookByMouse(),
        view: (index) => this.showView(index),
        saveView: (name) => {
          views.save(name, this.address.link ?? '');
          panel.showOwnViews(views.ownList);
        },
        ownView: (name) => this.restoreView(views.ownLink(name) ?? ''),
        deleteView: (name) => {
          views.delete(name);
          panel.showOwnViews(views.ownList);
        },
        copyView: (name) => void this.address.copyWith(views.ownLink(name) ?? '', text.ownViews.copied(name)),
        copyAllViews: () => void this.address.copyWith(views.withOwn(this.address.link ?? ''), text.ownViews.allCopied),
        copyLink: () => void this.address.copy(),
        savePicture: () => void this.savePicture(),
        ev: (ev) => this.setEv(ev),
        air: (isSeen) => this.setAir(isSeen),
        part: (part, isOn) => this.setMix(withPartOn(this.viewer.mix, part, isOn)),
        factor: (part, factor) => this.setMix(withFactor(this.viewer.mix, part, factor)),
        wholeLight: () => this.setMix(wholeLight),
        map: (isShown) => this.showMap(isShown),
        help: () => this.showHelp(),
      },
    );
    panel.showOwnViews(views.ownList);
    return panel;
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

  get hasLayers(): boolean {
    return (this.bake?.manifest.layers?.length ?? 0) > 0;
  }

  /** Shows a layer of the study. */
  showLayer(id: string): void {
    this.viewer.layer = id;
    this.setPicture('layer');
  }

  /** Range of the false colours of the picture on show. */
  setScale(scale: FalseColour): void {
    this.ranges.choose(this.viewer, scale);
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

  /** How much of each part of the light is shown. */
  setMix(mix: LightMix): void {
    this.viewer.mix = mix;
    this.refresh();
  }

  setMode(mode: Mode): void {
    if (mode === this.viewer.mode) return;
    this.mouseLook.end();
    if (mode === 'orbit') this.viewer.leaveWalk();
    else if (!this.viewer.walkFrom(null)) this.remarks.tell(text.noGround);
    this.panel?.showView(null);
    this.refresh();
    this.canvas.focus({ preventScroll: true });
  }

  /** The mouse looks without being held, on foot, until Escape. */
  lookByMouse(): void {
    if (this.viewer.mode !== 'walk') this.setMode('walk');
    if (this.viewer.mode === 'walk') void this.mouseLook.begin();
  }

  /** Flies to one of the bake's views. */
  showView(index: number): void {
    if (!this.views?.show(index, true)) return;
    this.panel?.showView(index);
    this.refresh();
  }

  get isMapShown(): boolean {
    return this.map?.isShown ?? false;
  }

  showMap(isShown: boolean): void {
    this.map?.show(isShown);
    this.refresh();
  }

  showHelp(): void {
    this.mouseLook.end();
    this.helpDialog?.show();
  }

  private get middle(): { x: number; y: number } {
    return { x: this.canvas.clientWidth / 2, y: this.canvas.clientHeight / 2 };
  }

  measureMiddle(): void {
    void this.measuring.at(this.middle, true);
  }

  togglePanel(): void {
    this.panel?.show(!this.panel.isShown);
  }

  private restore(state: Partial<ViewState>, isFlying = false): void {
    const layer = this.bake?.layer(state.layer ?? null);
    if (layer) this.viewer.layer = layer.id;
    if (state.picture && (state.picture !== 'layer' || layer)) this.viewer.picture = state.picture;
    else if (state.picture) this.remarks.tell(text.noLayer(state.layer ?? ''));
    if (state.scale && isMeasure(this.viewer.picture)) this.ranges.choose(this.viewer, state.scale);
    if (state.ev !== undefined) this.viewer.ev = clampEv(state.ev);
    if (state.air !== undefined) this.viewer.air = state.air;
    this.viewer.mix = state.mix ?? wholeLight;
    if (state.comparison) this.comparing?.set(state.comparison);
    if (state.position && state.target) {
      const view = { position: state.position, target: state.target };
      const isWalking = state.mode === 'walk' && this.viewer.walkFrom(view);
      if (!isWalking && isFlying) this.viewer.flyTo(view.position, view.target);
      else if (!isWalking) this.viewer.lookAt(view.position, view.target);
      this.panel?.showView(null);
    } else {
      const index = state.mode === 'walk' ? (this.views?.onFoot ?? 0) : 0;
      this.views?.show(index, false);
      this.panel?.showView(index);
    }
  }

  private restoreFromLink(): void {
    this.views?.takeFrom(location.hash);
    this.panel?.showOwnViews(this.views?.ownList ?? []);
    const state = this.address.read;
    if (Object.keys(state).length === 0) return;
    this.restore(state);
    void this.showMoment(state.moment ?? 0);
  }

  /** One of the user's own views, with its time and light. */
  private restoreView(link: string): void {
    const { comparison, ...state } = parseViewState(link);
    this.restore(comparison && this.comparing ? { ...state, comparison } : state, true);
    void this.showMoment(state.moment ?? this.viewer.moment);
  }

  /** The user's range, or one that suits the light on show. */
  private applyScale(): void {
    if (this.bake && isMeasure(this.viewer.picture)) this.viewer.scale = this.ranges.of(this.viewer, this.bake, this.viewer.moment);
  }

  private refresh(): void {
    const { viewer, bake } = this;
    if (!bake) return;
    const moment = Math.max(0, viewer.moment);
    const parts = bake.partsOf(Math.round(moment));
    const { picture, layer, mode, mix, scale } = viewer;
    this.panel?.update({
      moment, label: momentLabel(bake.manifest.instants, moment), picture, layer, mode, ev: viewer.ev, exposure: viewer.exposure, air: viewer.air, parts, mix, isMapShown: this.isMapShown,
    });
    let legend = legendOf(bake, { picture, scale, layer, mix, parts });
    if (this.comparing) {
      // A tenth of the range of lux: what a planned building takes from a street is seen.
      const range = luxScale(bake, moment).high / 10;
      this.comparing.show(viewer, range);
      if (this.comparing.shown.shown === 'difference') legend = differenceLegend(range, mix, parts);
    }
    this.legend.show(legend);
    this.measuring.viewChanged(changedParts(mix, parts).length > 0 && showsLight(picture));
    this.help.textContent = text.help[mode] + (this.comparing ? text.compare.keys : '') + text.help.more;
    document.body.dataset['mode'] = mode;
    this.viewChanged();
  }

  private viewChanged(): void {
    this.measuring.moveMarker();
    this.map?.update();
    this.address.changed();
  }

  /** What is seen now, as a link restores it. */
  private state(): ViewState | null {
    const { viewer } = this;
    if (viewer.moment < 0) return null;
    return {
      ...viewer.view, mode: viewer.mode, picture: viewer.picture, moment: viewer.moment, ev: viewer.ev, air: viewer.air, mix: viewer.mix,
      layer: viewer.picture === 'layer' ? viewer.layer : null, scale: this.ranges.chosenFor(viewer), comparison: this.comparing?.shown ?? null,
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
