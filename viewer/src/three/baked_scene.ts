import * as THREE from 'three';
import type { Bake } from '../core/bake';
import { exposureFactor } from '../core/exposure';
import type { FalseColour } from '../core/false_colour';
import type { OnBytes } from '../core/fetch';
import { bytesNeededOfGlb, closeGlb } from '../core/glb';
import type { LightMix } from '../core/light_parts';
import { LoadError } from '../core/load_error';
import type { Picture } from '../core/pictures';
import { text } from '../core/text';
import { makeSharedUniforms, mostPages, setFalseColour, setNumbersPicture, setParts, setPicture, type SharedUniforms } from './city_material';
import { cityAttributes, loadCity, type City } from './city';
import { CityRays } from './city_rays';
import { Ground } from './ground';
import { Instants } from './instants';
import { PageLayers, type LayerPainter } from './layers';
import { applyLight, decodePage, type InstantTextures } from './light';
import { MeasurePages } from './measure_pages';
import { pagesByNearness } from './page_order';
import { SkyDome } from './sky';

const cityUri = 'city.glb';

/** The instants that a moment shows: one, or the two that it fades between. */
function instantsOf(moment: number): number[] {
  const first = Math.floor(moment);
  return moment > first ? [first, first + 1] : [first];
}

/** How the light is shown. */
export interface Display {
  picture: Picture;
  ev: number;
  /** The air between the eye and the city is drawn. */
  isAirSeen: boolean;
  mix: LightMix;
  /** Range of the false colours. */
  scale: FalseColour;
  /** Id of the study's layer, where that is the picture. */
  layer: string | null;
}

/** One bake as a scene: its city, and the light of the moment on show. */
export class BakedScene {
  readonly scene = new THREE.Scene();
  private readonly sky: SkyDome;
  private readonly instants: Instants;
  private lamps: Promise<void> | null = null;
  private readonly measures: MeasurePages;
  private lampLayers: PageLayers | null = null;
  private raysBuilt: CityRays | null = null;
  private groundBuilt: Ground | null = null;
  private wantedMoment = -1;
  private shownMoment = -1;
  /** Another bake whose exposure this one takes, so that both can be compared. */
  exposedAs: BakedScene | null = null;
  private isAirSeen = true;
  private picture: Picture = 'lit';
  private ev = 0;

  private constructor(
    readonly bake: Bake,
    readonly city: City,
    private readonly shared: SharedUniforms,
    private readonly lampScales: Float32Array<ArrayBuffer> | null,
    private readonly painter: LayerPainter,
    private readonly onChange: () => void,
  ) {
    const { pages } = bake.manifest;
    this.sky = new SkyDome(shared);
    this.measures = new MeasurePages(bake, painter, shared);
    this.instants = new Instants(bake, lampScales, painter, onChange);
    shared.uPageSize.value.set(Math.max(...pages.map(({ width }) => width)), Math.max(...pages.map(({ height }) => height)));
    this.scene.add(this.sky.mesh, city.group);
  }

  /** Loads the city; the light comes with showMoment(). `onChange`: what is on show changed by itself. Throws LoadError. */
  static async open(bake: Bake, painter: LayerPainter, maxAnisotropy: number, onBytes: OnBytes, onChange: () => void): Promise<BakedScene> {
    const shared = makeSharedUniforms();
    const bytes = await bake.fetchStart(cityUri, onBytes, (soFar) => bytesNeededOfGlb(soFar, cityAttributes));
    closeGlb(bytes);
    const city = await loadCity(bake.url(cityUri), bytes, bake.manifest.pages, shared, painter, maxAnisotropy);
    if (bake.manifest.pages.length > Math.min(mostPages, painter.mostLayers)) throw new LoadError(bake.manifestUrl, text.error.tooManyPages(bake.manifest.pages.length, painter.mostLayers));
    if (city.chartCount > bake.manifest.charts) throw new LoadError(bake.url(cityUri), text.error.tooManyCharts(city.chartCount, bake.manifest.charts));
    return new BakedScene(bake, city, shared, await bake.loadLampScales(onBytes), painter, onChange);
  }

  /** Number of the instant on show; between two of them while they fade; −1 before the first. */
  get moment(): number {
    return this.shownMoment;
  }

  get exposure(): number {
    return this.shared.uExposure.value;
  }

  /** Bytes of light on the graphics card. */
  get lightBytes(): number {
    return this.instants.bytes + (this.lampLayers?.bytes ?? 0) + this.measures.bytes;
  }

  /**
   * Loads what a moment needs and shows it: an instant, or the cross-fade of its two neighbours. The very first is on show with its first
   * page, those nearest to `eye` (scene coordinates) first. A later call overtakes an earlier one; false when this one was overtaken. Throws LoadError.
   */
  async showMoment(moment: number, eye: THREE.Vector3, onBytes: OnBytes): Promise<boolean> {
    this.wantedMoment = moment;
    const needed = instantsOf(moment);
    const order = this.missingFor(moment).length > 0 ? pagesByNearness(this.city, this.bake.manifest.pages.length, eye) : [];
    const loading = needed.map((index) => this.instants.use(index, order, onBytes));
    this.instants.forgetBut([...needed, ...this.instantsOnShow()]);
    try {
      if (this.shownMoment < 0) {
        await loading[0]?.started;
        if (this.wantedMoment !== moment) return false;
        this.present(Math.floor(moment), loading.slice(0, 1).flatMap(({ textures }) => textures ?? []));
      }
      await Promise.all([...loading.map(({ whole }) => whole), this.loadLamps(onBytes)]);
      if (this.wantedMoment !== moment) return false;
      this.present(moment, loading.flatMap(({ textures }) => textures ?? []));
      this.instants.forgetBut(needed);
      return true;
    } catch (error) {
      if (this.wantedMoment !== moment) return false;
      this.wantedMoment = this.shownMoment;
      throw error;
    }
  }

  private present(moment: number, light: readonly InstantTextures[]): void {
    const needed = instantsOf(moment);
    light.forEach((textures, k) => this.applyInstant(k === 0 ? 0 : 1, needed[k] ?? 0, textures));
    this.shared.uBlend.value = moment - Math.floor(moment);
    this.shownMoment = moment;
    this.applyDisplay();
    this.onChange();
  }

  /** Which instants would have to be fetched for a moment. */
  missingFor(moment: number): number[] {
    return instantsOf(moment).filter((index) => !this.instants.isWhole(index));
  }

  /** Download size of what a moment still needs; null when the manifest does not list it. */
  bytesMissingFor(moment: number): number | null {
    const sizes = this.missingFor(moment).map((index) => this.bake.bytesOfInstant(index));
    if (this.lampScales && !this.lamps) sizes.push(this.bake.bytesOfLamps());
    return sizes.reduce<number | null>((sum, bytes) => (sum === null || bytes === null ? null : sum + bytes), 0);
  }

  /** How the light is shown. Throws LoadError when the picture needs a file that cannot be read. */
  async show({ picture, ev, isAirSeen, mix, scale, layer }: Display): Promise<void> {
    if (picture === 'sky-view') await this.measures.showSkyView();
    if (picture === 'layer') await this.measures.showLayer(layer, scale);
    this.picture = picture;
    this.ev = ev;
    this.isAirSeen = isAirSeen;
    setPicture(this.shared, picture);
    setParts(this.shared, mix);
    setFalseColour(this.shared, scale);
    this.applyDisplay();
  }

  /** Draws the scene, or its lux and distances, from a camera in the frame of this bake. */
  draw(renderer: THREE.WebGLRenderer, camera: THREE.Camera, what: 'picture' | 'numbers' = 'picture'): void {
    if (what === 'numbers') setNumbersPicture(this.shared);
    renderer.render(this.scene, camera);
    setPicture(this.shared, this.picture);
  }

  /** Whether the moment on show has air. */
  get hasAir(): boolean {
    return this.instantsOnShow().every((index) => this.bake.instant(index).air !== undefined) && this.shownMoment >= 0;
  }

  /** Rays against the city; the first call builds their tree. */
  get rays(): CityRays {
    return (this.raysBuilt ??= CityRays.build(this.city));
  }

  get ground(): Ground {
    return (this.groundBuilt ??= new Ground(this.rays, this.city.bounds));
  }

  dispose(): void {
    this.city.dispose();
    this.instants.dispose();
    this.lampLayers?.dispose();
    this.measures.dispose();
    this.sky.dispose();
  }

  private instantsOnShow(): number[] {
    return this.shownMoment < 0 ? [] : instantsOf(this.shownMoment);
  }

  private applyInstant(slot: 0 | 1, index: number, light: InstantTextures): void {
    const instant = this.bake.instant(index);
    applyLight(slot, light, instant, this.shared);
    this.sky.apply(slot, light.panorama, instant, this.bake.manifest.bounds.min[2] ?? 0);
  }

  private applyDisplay(): void {
    const onShow = this.instantsOnShow();
    if (onShow.length === 0) return;
    this.shared.uHasAir.value = this.isAirSeen && this.hasAir;
    if (this.exposedAs) {
      this.shared.uExposure.value = this.exposedAs.exposure;
      return;
    }
    const [a, b] = onShow.map((index) => this.bake.instant(index).exposure_hint);
    const blend = this.shared.uBlend.value;
    const hint = (a ?? 1) ** (1 - blend) * (b ?? 1) ** blend; // even in stops
    this.shared.uExposure.value = exposureFactor(hint, this.ev, this.picture);
  }

  private async loadLamps(onBytes: OnBytes): Promise<void> {
    if (!this.lampScales) return;
    this.lamps ??= this.loadLampPages(onBytes).catch((error: unknown) => {
      this.lamps = null; // the next question asks again
      throw error;
    });
    await this.lamps;
  }

  /** The lamps' pages, on show as they come. Throws LoadError. */
  private async loadLampPages(onBytes: OnBytes): Promise<void> {
    const layers = (this.lampLayers ??= new PageLayers(this.painter, this.bake.manifest.pages, 'light'));
    this.shared.uLamps.value = layers.texture;
    await Promise.all(this.bake.manifest.pages.map(async (_, page) => {
      layers.put(page, await decodePage(await this.bake.loadLampPage(page, onBytes)), null);
      this.onChange();
    }));
  }
}
