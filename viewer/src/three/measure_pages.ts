import * as THREE from 'three';
import type { Bake, EncodedPage } from '../core/bake';
import type { FalseColour } from '../core/false_colour';
import { rampOf, rampSize, type Layer } from '../core/layer_colours';
import type { PageUniforms, SharedUniforms } from './city_material';
import { makeShareTextures } from './light';

/** Of a surface that this bake has no number for. */
const noNumber = 150;

/** Pages of numbers instead of light: the sky view, and a study's layers. One of them is on the graphics card. */
export class MeasurePages {
  private wanted: string | null = null;
  private shown: string | null = null;
  private textures: readonly THREE.Texture[] = [];
  private ramp: THREE.DataTexture | null = null;
  private rampKey = '';

  constructor(
    private readonly bake: Bake,
    private readonly pages: readonly PageUniforms[],
    private readonly shared: SharedUniforms,
  ) {}

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
    for (const texture of this.textures) texture.dispose();
    this.ramp?.dispose();
  }

  private async load(key: string, uris: readonly string[]): Promise<void> {
    if (this.shown === key) return;
    const page = async (uri: string, p: number): Promise<EncodedPage> => {
      const { width, height } = this.bake.manifest.pages[p] ?? { width: 0, height: 0 };
      return { url: this.bake.url(uri), bytes: await this.bake.fetch(uri, () => {}), width, height };
    };
    this.wanted = key;
    const textures = await makeShareTextures(await Promise.all(uris.map(page)));
    if (this.wanted !== key || this.shown === key) return textures.forEach((texture) => texture.dispose()); // overtaken, or asked for twice
    for (const texture of this.textures) texture.dispose();
    this.textures = textures;
    this.shown = key;
    this.pages.forEach((uniforms, p) => (uniforms.uMeasurePage.value = textures[p] ?? null));
  }

  private setRamp(layer: Layer | null, scale: FalseColour): void {
    const key = layer ? `${layer.id} ${scale.low} ${scale.high} ${scale.isLogarithmic}` : '';
    if (this.ramp && key === this.rampKey) return;
    this.rampKey = key;
    this.ramp?.dispose();
    const colours = layer ? rampOf(layer, scale) : new Uint8Array([noNumber, noNumber, noNumber, 255]);
    this.ramp = new THREE.DataTexture(colours, layer ? rampSize : 1, 1, THREE.RGBAFormat);
    this.ramp.needsUpdate = true; // codes of sRGB, read one by one
    this.shared.uRamp.value = this.ramp;
  }
}
