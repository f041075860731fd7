import * as THREE from 'three';
import type { Bake } from '../core/bake';
import type { FalseColour } from '../core/false_colour';
import { rampOf, rampSize, type Layer } from '../core/layer_colours';
import type { SharedUniforms } from './city_material';
import { PageLayers, type LayerPainter } from './layers';
import { decodePage } from './light';

/** Of a surface that this bake has no number for. */
const noNumber = 150;

/** Pages of numbers instead of light: the sky view, and a study's layers. One of them is on the graphics card. */
export class MeasurePages {
  private wanted: string | null = null;
  private shown: string | null = null;
  private pages: PageLayers | null = null;
  private ramp: THREE.DataTexture | null = null;
  private rampKey: string | null = null;

  constructor(
    private readonly bake: Bake,
    private readonly painter: LayerPainter,
    private readonly shared: SharedUniforms,
  ) {}

  /** On the graphics card. */
  get bytes(): number {
    return this.pages?.bytes ?? 0;
  }

  /** Throws LoadError. */
  async showSkyView(): Promise<void> {
    await this.load('sky view', this.bake.manifest.pages.map(({ svf }) => svf));
  }

  /** A layer that this bake does not have is shown as one grey. Throws LoadError. */
  async showLayer(id: string | null, scale: FalseColour): Promise<void> {
    const layer = this.bake.layer(id);
    if (layer) await this.load(`layer ${layer.id}`, layer.pages.map(({ png }) => png));
    this.setRamp(layer, scale);
  }

  dispose(): void {
    this.pages?.dispose();
    this.ramp?.dispose();
  }

  /** What was on show stays until all pages have come: half of them would be wrong numbers. */
  private async load(key: string, uris: readonly string[]): Promise<void> {
    if (this.shown === key) return;
    this.wanted = key;
    const pictures = await Promise.all(uris.map(async (uri, page) => decodePage(await this.bake.loadPage(uri, page, () => {}))));
    if (this.wanted !== key || this.shown === key) return pictures.forEach((picture) => picture.close()); // overtaken, or asked for twice
    const pages = new PageLayers(this.painter, this.bake.manifest.pages, 'share');
    pictures.forEach((picture, page) => pages.put(page, picture, null));
    this.pages?.dispose();
    this.pages = pages;
    this.shown = key;
    this.shared.uMeasure.value = pages.texture;
  }

  private setRamp(layer: Layer | null, scale: FalseColour): void {
    const key = layer && `${layer.id} ${scale.low} ${scale.high} ${scale.isLogarithmic}`;
    if (this.ramp && key === this.rampKey) return;
    this.rampKey = key;
    this.ramp?.dispose();
    const colours = layer ? rampOf(layer, scale) : new Uint8Array([noNumber, noNumber, noNumber, 255]);
    this.ramp = new THREE.DataTexture(colours, layer ? rampSize : 1, 1, THREE.RGBAFormat);
    this.ramp.needsUpdate = true; // codes of sRGB, read one by one
    this.shared.uRamp.value = this.ramp;
  }
}
