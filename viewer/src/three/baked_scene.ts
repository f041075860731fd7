import * as THREE from 'three';
import type { Bake, LampLight } from '../core/bake';
import { exposureFactor } from '../core/exposure';
import type { FalseColour } from '../core/false_colour';
import type { OnBytes } from '../core/fetch';
import type { LightMix } from '../core/light_parts';
import { LoadError } from '../core/load_error';
import type { Picture } from '../core/pictures';
import { text } from '../core/text';
import { makeSharedUniforms, setFalseColour, setNumbersPicture, setParts, setPicture, type SharedUniforms } from './city_material';
import { loadCity, type City } from './city';
import { CityRays } from './city_rays';
import { Ground } from './ground';
import { applyLight, makeLampTextures, makeLightTextures, type LightTextures } from './light';
import { MeasurePages } from './measure_pages';
import { SkyDome } from './sky';

const cityUri = 'city.glb';
/** Instants kept on the graphics card: the two of a fade, and the one that was left last. */
const instantsKept = 3;

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
  private readonly kept = new Map<number, LightTextures>(); // the one used last stands last
  private readonly measures: MeasurePages;
  private raysBuilt: CityRays | null = null;
  private groundBuilt: Ground | null = null;
  private readonly pending = new Map<number, { light: Promise<LightTextures>; abort: AbortController }>();
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
    private readonly lamps: LampLight | null,
    private readonly lampTextures: readonly THREE.Texture[],
  ) {
    this.sky = new SkyDome(shared);
    this.measures = new MeasurePages(bake, city.pages, shared);
    city.pages.forEach((page, p) => (page.uLampPage.value = lampTextures[p] ?? null));
    this.scene.add(this.sky.mesh, city.group);
  }

  /** Loads the city; the light comes with showMoment(). Throws LoadError. */
  static async open(bake: Bake, maxAnisotropy: number, onBytes: OnBytes): Promise<BakedScene> {
    const shared = makeSharedUniforms();
    const bytes = await bake.fetch(cityUri, onBytes);
    const city = await loadCity(bake.url(cityUri), bytes, bake.manifest.pages, shared, maxAnisotropy);
    if (city.chartCount > bake.manifest.charts) throw new LoadError(bake.url(cityUri), text.error.tooManyCharts(city.chartCount, bake.manifest.charts));
    const lamps = await bake.loadLamps(onBytes);
    return new BakedScene(bake, city, shared, lamps, lamps ? await makeLampTextures(lamps) : []);
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
    let bytes = 0;
    for (const light of this.kept.values()) bytes += light.bytes;
    const lampTexels = this.lampTextures.length > 0 ? this.bake.manifest.pages.reduce((sum, { width, height }) => sum + width * height, 0) : 0;
    return bytes + Math.round((16 / 3) * lampTexels);
  }

  /**
   * Loads what a moment needs and shows it: an instant, or the cross-fade of its two neighbours. A later call overtakes an earlier one;
   * false when this one was overtaken. Throws LoadError.
   */
  async showMoment(moment: number, onBytes: OnBytes): Promise<boolean> {
    this.wantedMoment = moment;
    const needed = instantsOf(moment);
    for (const [index, { abort }] of this.pending) {
      if (needed.includes(index)) continue;
      abort.abort();
      this.pending.delete(index);
    }
    try {
      const pair = await Promise.all(needed.map((index) => this.lightOf(index, onBytes)));
      if (this.wantedMoment !== moment) return false;
      pair.forEach((light, k) => this.applyInstant(k === 0 ? 0 : 1, needed[k] ?? 0, light));
      this.shared.uBlend.value = moment - Math.floor(moment);
      this.shownMoment = moment;
      this.forgetOld();
      this.applyDisplay();
      return true;
    } catch (error) {
      if (this.wantedMoment !== moment) return false;
      this.wantedMoment = this.shownMoment;
      throw error;
    }
  }

  /** Which instants would have to be fetched for a moment. */
  missingFor(moment: number): number[] {
    return instantsOf(moment).filter((index) => !this.kept.has(index));
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
    for (const { abort } of this.pending.values()) abort.abort();
    this.city.dispose();
    for (const light of this.kept.values()) light.dispose();
    for (const texture of this.lampTextures) texture.dispose();
    this.measures.dispose();
    this.sky.dispose();
  }

  private instantsOnShow(): number[] {
    return this.shownMoment < 0 ? [] : instantsOf(this.shownMoment);
  }

  private async lightOf(index: number, onBytes: OnBytes): Promise<LightTextures> {
    const known = this.kept.get(index);
    if (known) {
      this.kept.delete(index);
      this.kept.set(index, known);
      return known;
    }
    const underWay = this.pending.get(index);
    if (underWay) return underWay.light;
    const abort = new AbortController();
    const load = async (): Promise<LightTextures> => {
      try {
        const files = await this.bake.loadInstant(index, this.bake.manifest.charts, onBytes, abort.signal);
        const light = await makeLightTextures(files, this.lamps?.scales ?? null);
        if (abort.signal.aborted) {
          light.dispose();
          throw new DOMException('overtaken', 'AbortError');
        }
        this.kept.set(index, light);
        return light;
      } finally {
        if (this.pending.get(index)?.abort === abort) this.pending.delete(index);
      }
    };
    const light = load();
    this.pending.set(index, { light, abort });
    return light;
  }

  private applyInstant(slot: 0 | 1, index: number, light: LightTextures): void {
    const instant = this.bake.instant(index);
    applyLight(slot, light, instant, this.shared, this.city.pages);
    this.sky.apply(slot, light.panorama, instant, this.bake.manifest.bounds.min[2] ?? 0);
  }

  private forgetOld(): void {
    const onShow = this.instantsOnShow();
    for (const [index, light] of this.kept) {
      if (this.kept.size <= instantsKept) return;
      if (onShow.includes(index)) continue;
      light.dispose();
      this.kept.delete(index);
    }
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
}
