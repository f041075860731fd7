import * as THREE from 'three';
import type { BakedInstant, EncodedPage, InstantLight, LampLight } from '../core/bake';
import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import { applyAir } from './air';
import type { PageUniforms, SharedUniforms } from './city_material';
import { scalesWidth } from './city_material';

/** The textures of one instant on the graphics card; dispose() gives their memory back. */
export interface LightTextures {
  scales: THREE.DataTexture;
  pages: { sky: THREE.Texture; sun: THREE.Texture; indirect: THREE.Texture | null }[];
  panorama: THREE.DataTexture;
  /** On the graphics card, with the mip levels, bytes. */
  bytes: number;
  air: { molecules: THREE.DataTexture; haze: THREE.DataTexture } | null;
  dispose(): void;
}

/** The lamps' pages on the graphics card. Throws LoadError. */
export async function makeLampTextures(lamps: LampLight): Promise<THREE.Texture[]> {
  const textures = await Promise.all(lamps.pages.map(decodePage));
  for (const texture of textures) texture.colorSpace = THREE.SRGBColorSpace;
  return textures;
}

/** Linear 8-bit shares (the sky view factor) on the graphics card. Throws LoadError. */
export async function makeShareTextures(pages: readonly EncodedPage[]): Promise<THREE.Texture[]> {
  const textures = await Promise.all(pages.map(decodePage));
  for (const texture of textures) {
    texture.colorSpace = THREE.NoColorSpace;
    texture.format = THREE.RedFormat;
  }
  return textures;
}

/** Decodes the pages of an instant. `lampScales`: of the lamps, that every instant shows too. Throws LoadError when a page is not the picture that the manifest announces. */
export async function makeLightTextures(light: InstantLight, lampScales: Float32Array<ArrayBuffer> | null): Promise<LightTextures> {
  const pages = await Promise.all(
    light.pages.map(async ({ sky, sun, indirect }) => {
      const [skyTexture, sunTexture, indirectTexture] = await Promise.all([decodePage(sky), decodePage(sun), indirect ? decodePage(indirect) : null]);
      skyTexture.colorSpace = THREE.SRGBColorSpace;
      sunTexture.colorSpace = THREE.NoColorSpace;
      sunTexture.format = THREE.RedFormat;
      if (indirectTexture) indirectTexture.colorSpace = THREE.SRGBColorSpace;
      return { sky: skyTexture, sun: sunTexture, indirect: indirectTexture };
    }),
  );
  const scales = makeScalesTexture(light.scales, light.indirectScales, lampScales);
  const { width, height, halves } = light.panorama;
  const panorama = makeTurnTexture(halves, width, height);
  const { airlight } = light;
  const air = airlight && {
    molecules: makeTurnTexture(airlight.molecules, airlight.columns, airlight.rows),
    haze: makeTurnTexture(airlight.haze, airlight.columns, airlight.rows),
  };
  const texels = light.pages.reduce((sum, { sky }) => sum + sky.width * sky.height, 0);
  const bytesATexel = 4 + 1 + (light.indirectScales ? 4 : 0);
  return {
    scales,
    pages,
    panorama,
    air,
    bytes: Math.round((4 / 3) * texels * bytesATexel) + 16 * (light.scales.length / 2) + 8 * width * height,
    dispose() {
      scales.dispose();
      panorama.dispose();
      air?.molecules.dispose();
      air?.haze.dispose();
      for (const { sky, sun, indirect } of pages) {
        sky.dispose();
        sun.dispose();
        indirect?.dispose();
      }
    },
  };
}

/** Puts an instant's light into the uniforms that the city's materials share: as the one on show (slot 0), or the one that it fades into. */
export function applyLight(slot: 0 | 1, textures: LightTextures, instant: BakedInstant, shared: SharedUniforms, pages: readonly PageUniforms[]): void {
  (slot === 0 ? shared.uScales : shared.uScalesB).value = textures.scales;
  shared.uSunKlx.value[slot].fromArray(instant.sun.normal_illuminance_klx);
  if (instant.air && textures.air) applyAir(shared, slot, instant.air, instant.sun.direction as [number, number, number], textures.air);
  pages.forEach((page, p) => {
    (slot === 0 ? page.uSkyPage : page.uSkyPageB).value = textures.pages[p]?.sky ?? null;
    (slot === 0 ? page.uSunPage : page.uSunPageB).value = textures.pages[p]?.sun ?? null;
    (slot === 0 ? page.uIndirectPage : page.uIndirectPageB).value = textures.pages[p]?.indirect ?? null;
  });
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

async function decodePage(page: EncodedPage): Promise<THREE.Texture> {
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
  const texture = new THREE.Texture(bitmap);
  texture.flipY = false;
  texture.minFilter = THREE.LinearMipmapLinearFilter; // the shader keeps to levels 0 and 1
  texture.magFilter = THREE.LinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  texture.onUpdate = () => bitmap.close(); // the card has its copy
  return texture;
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
