import * as THREE from 'three';
import type { BakedInstant, EncodedPage, InstantLight, InstantPage } from '../core/bake';
import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import { applyAir } from './air';
import { mostPages, scalesWidth, type SharedUniforms } from './city_material';
import { PageLayers, type LayerPainter } from './layers';

/** The light of one instant on the graphics card; dispose() gives its memory back. */
export class InstantTextures {
  /** A bit a page that is here. */
  readonly pagesHere = new Int32Array(mostPages / 32);
  readonly scales: THREE.DataTexture;
  /** Skylight, and in alpha the sun's cosine. */
  readonly light: PageLayers;
  readonly indirect: PageLayers | null;
  readonly panorama: THREE.DataTexture;
  readonly air: { molecules: THREE.DataTexture; haze: THREE.DataTexture } | null;

  /** @param lampScales of the lamps, that every instant shows too */
  constructor(files: InstantLight, lampScales: Float32Array<ArrayBuffer> | null, pages: readonly { width: number; height: number }[], painter: LayerPainter) {
    this.scales = makeScalesTexture(files.scales, files.indirectScales, lampScales);
    this.light = new PageLayers(painter, pages, 'light');
    this.indirect = files.indirectScales && new PageLayers(painter, pages, 'light');
    const { width, height, halves } = files.panorama;
    this.panorama = makeTurnTexture(halves, width, height);
    const { airlight } = files;
    this.air = airlight && {
      molecules: makeTurnTexture(airlight.molecules, airlight.columns, airlight.rows),
      haze: makeTurnTexture(airlight.haze, airlight.columns, airlight.rows),
    };
  }

  /** Decodes a page and shows it. Throws LoadError when it is not the picture that the manifest announces. */
  async put(page: number, { sky, sun, indirect }: InstantPage, signal: AbortSignal): Promise<void> {
    const [skyPicture, sunPicture, indirectPicture] = await Promise.all([decodePage(sky), sun && decodePage(sun), indirect && decodePage(indirect)]);
    signal.throwIfAborted(); // its layers are gone
    this.light.put(page, skyPicture, sunPicture);
    if (indirectPicture) this.indirect?.put(page, indirectPicture, null);
    this.pagesHere[page >> 5] = (this.pagesHere[page >> 5] ?? 0) | (1 << (page & 31));
  }

  /** On the graphics card. */
  get bytes(): number {
    const { width, height } = this.panorama.image;
    return this.light.bytes + (this.indirect?.bytes ?? 0) + 8 * width * height + 16 * this.scales.image.width * this.scales.image.height;
  }

  dispose(): void {
    for (const part of [this.scales, this.light, this.indirect, this.panorama, this.air?.molecules, this.air?.haze]) part?.dispose();
  }
}

/** Puts an instant's light into the uniforms that the city's materials share: as the one on show (slot 0), or the one that it fades into. */
export function applyLight(slot: 0 | 1, textures: InstantTextures, instant: BakedInstant, shared: SharedUniforms): void {
  (slot === 0 ? shared.uScales : shared.uScalesB).value = textures.scales;
  (slot === 0 ? shared.uLight : shared.uLightB).value = textures.light.texture;
  (slot === 0 ? shared.uIndirect : shared.uIndirectB).value = textures.indirect?.texture ?? null;
  if (slot === 0) shared.uPagesHere.value = textures.pagesHere;
  shared.uSunKlx.value[slot].fromArray(instant.sun.normal_illuminance_klx);
  if (instant.air && textures.air) applyAir(shared, slot, instant.air, instant.sun.direction as [number, number, number], textures.air);
}

/** RGBA half floats, bilinear, whose columns go round. */
function makeTurnTexture(halves: Uint16Array<ArrayBuffer>, columns: number, rows: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(halves, columns, rows, THREE.RGBAFormat, THREE.HalfFloatType);
  texture.minFilter = THREE.LinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.wrapS = THREE.RepeatWrapping;
  texture.wrapT = THREE.ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}

/** Decodes a page. Throws LoadError when it is not the picture that the manifest announces. */
export async function decodePage(page: EncodedPage): Promise<ImageBitmap> {
  let bitmap: ImageBitmap;
  try {
    // Neither colour management nor premultiplication may touch the numbers: they are light, not a photograph.
    bitmap = await createImageBitmap(new Blob([page.bytes], { type: 'image/png' }), { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  } catch {
    throw new LoadError(page.url, text.error.notAPicture);
  }
  if (bitmap.width !== page.width || bitmap.height !== page.height) {
    throw new LoadError(page.url, text.error.pageSize(`${bitmap.width} × ${bitmap.height}`, `${page.width} × ${page.height}`));
  }
  return bitmap;
}

/** A pixel a chart: scales of sky, sun, reflected light and lamps; without the last two their scale is 0, and no page is needed. */
function makeScalesTexture(
  scales: Float32Array<ArrayBuffer>,
  indirectScales: Float32Array<ArrayBuffer> | null,
  lampScales: Float32Array<ArrayBuffer> | null,
): THREE.DataTexture {
  const charts = scales.length / 2;
  const height = Math.max(1, Math.ceil(charts / scalesWidth));
  const padded = new Float32Array(scalesWidth * height * 4);
  for (let chart = 0; chart < charts; ++chart) {
    padded.set([scales[2 * chart] ?? 0, scales[2 * chart + 1] ?? 0, indirectScales?.[chart] ?? 0, lampScales?.[chart] ?? 0], 4 * chart);
  }
  const texture = new THREE.DataTexture(padded, scalesWidth, height, THREE.RGBAFormat, THREE.FloatType);
  texture.minFilter = THREE.NearestFilter;
  texture.magFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  return texture;
}
