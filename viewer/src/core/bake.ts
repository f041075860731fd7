import { parseAirlight, type Airlight } from './air';
import { ExrFile } from './exr';
import { fetchBytes, fetchRange, type OnBytes } from './fetch';
import type { Manifest } from './generated/manifest';
import validateManifest from './generated/validate_manifest.js';
import type { Layer } from './layer_colours';
import { lightParts, type LightPart } from './light_parts';
import { LoadError } from './load_error';
import { CityObjects } from './objects';
import { Panorama } from './panorama';
import { text } from './text';

export type BakedInstant = Manifest['instants'][number];

/** The light of one instant as it stands in the files; the PNG pages are still encoded. */
export interface InstantLight {
  /** Two a chart: scale of the sky's page (klx), scale of the sun's page (cosine). */
  scales: Float32Array<ArrayBuffer>;
  /** One a chart: scale of the page of reflected light (klx); null in a bake without it. */
  indirectScales: Float32Array<ArrayBuffer> | null;
  panorama: Panorama;
  /** Null in a bake without a sky. */
  airlight: Airlight | null;
  pages: { sky: EncodedPage; sun: EncodedPage; indirect: EncodedPage | null }[];
}

/** Direct light of lamps, the same at all instants. */
export interface LampLight {
  /** One a chart: scale of the lamps' page (klx). */
  scales: Float32Array<ArrayBuffer>;
  pages: EncodedPage[];
}

export interface EncodedPage {
  url: string;
  bytes: Uint8Array<ArrayBuffer>;
  width: number;
  height: number;
}

const maxProblemsShown = 4;

/** Checks what a file claims to be a manifest against the schema. Throws LoadError with the first problems and their places. */
export function parseManifest(url: string, source: string): Manifest {
  let data: unknown;
  try {
    data = JSON.parse(source);
  } catch {
    throw new LoadError(url, text.error.notJson);
  }
  const version = (data as { version?: unknown } | null)?.version;
  if (version !== undefined && version !== 1) throw new LoadError(url, text.error.otherVersion(version));
  if (!validateManifest(data)) {
    const problems = (validateManifest.errors ?? []).map((e) => `${e.instancePath || '/'} ${e.message ?? ''}`);
    const shown = problems.slice(0, maxProblemsShown).join('; ');
    throw new LoadError(url, text.error.schema(problems.length > maxProblemsShown ? `${shown}; …` : shown));
  }
  return data as Manifest;
}

/** A bake folder: its manifest, and the way to its files. */
export class Bake {
  private readonly sizes = new Map<string, number>();
  private readonly archives = new Map<string, Promise<ExrFile>>();
  private objectsRead: Promise<CityObjects> | null = null;

  constructor(
    readonly manifest: Manifest,
    readonly manifestUrl: string,
  ) {
    for (const file of manifest.files) this.sizes.set(file.name, file.bytes);
  }

  static async load(manifestUrl: string, onBytes: OnBytes): Promise<Bake> {
    const bytes = await fetchBytes(manifestUrl, null, onBytes);
    return new Bake(parseManifest(manifestUrl, new TextDecoder().decode(bytes)), manifestUrl);
  }

  url(uri: string): string {
    return new URL(uri, this.manifestUrl).href;
  }

  /** Size by the manifest, or null when it lists no such file. */
  bytesOf(uri: string): number | null {
    return this.sizes.get(uri) ?? null;
  }

  instant(index: number): BakedInstant {
    const instant = this.manifest.instants[index];
    if (!instant) throw new RangeError(`instant ${index} of ${this.manifest.instants.length}`);
    return instant;
  }

  /** Download size of an instant, or null when the manifest does not list all of its files. */
  bytesOfInstant(index: number): number | null {
    const instant = this.instant(index);
    const uris = [instant.scales.uri, instant.sky.panorama.uri, ...instant.pages.flatMap((page) => [page.sky, page.sun])];
    if (instant.indirect_scales) uris.push(instant.indirect_scales.uri);
    if (instant.air) uris.push(instant.air.airlight.uri);
    for (const page of instant.pages) if (page.indirect) uris.push(page.indirect);
    let sum = 0;
    for (const uri of uris) {
      const bytes = this.bytesOf(uri);
      if (bytes === null) return null;
      sum += bytes;
    }
    return sum;
  }

  fetch(uri: string, onBytes: OnBytes, signal?: AbortSignal): Promise<Uint8Array<ArrayBuffer>> {
    return fetchBytes(this.url(uri), this.bytesOf(uri), onBytes, signal);
  }

  /** The archive of an instant's light on a page: lx, 32-bit. Only what is asked of it is fetched. */
  lightFile(index: number, page: number): Promise<ExrFile> {
    return this.archive(this.instant(index).pages[page]?.exr);
  }

  /** A study's layer; null when the bake has none of that name. */
  layer(id: string | null): Layer | null {
    return this.manifest.layers?.find((layer) => layer.id === id) ?? null;
  }

  /** The archive of a layer's exact numbers on a page. */
  layerFile(layer: Layer, page: number): Promise<ExrFile> {
    return this.archive(layer.pages[page]?.exr);
  }

  /** The archive of what all instants share on a page. */
  baseFile(page: number): Promise<ExrFile> {
    return this.archive(this.manifest.pages[page]?.base);
  }

  /** Objects of the city with their attributes; null in bakes of older versions. Throws LoadError. */
  async objects(): Promise<CityObjects | null> {
    const { objects, charts } = this.manifest;
    if (!objects) return null;
    this.objectsRead ??= this.fetch(objects.uri, () => {}).then((bytes) => CityObjects.parse(this.url(objects.uri), bytes, charts));
    return this.objectsRead;
  }

  private archive(uri: string | undefined): Promise<ExrFile> {
    if (uri === undefined) throw new RangeError('no such page');
    let file = this.archives.get(uri);
    if (!file) {
      const url = this.url(uri);
      let whole: Uint8Array<ArrayBuffer> | null = null; // of a host that knows no ranges
      file = ExrFile.open(url, async (first, count) => {
        if (whole) return whole.slice(first, first + count);
        const got = await fetchRange(url, first, Math.min(count, (this.bytesOf(uri) ?? Infinity) - first));
        whole = got.whole;
        return got.bytes;
      });
      this.archives.set(uri, file);
      file.catch(() => this.archives.delete(uri)); // the next question asks again
    }
    return file;
  }

  /** The parts of light that are in the files of an instant, or of all. */
  partsOf(index: number): LightPart[] {
    const instant = this.instant(index);
    const has: Record<LightPart, boolean> = {
      sun: instant.sun.shape !== 'none' && instant.sun.normal_illuminance_klx.some((klx) => klx > 0),
      sky: true,
      indirect: instant.indirect_scales !== undefined,
      lamps: this.manifest.lamp_scales !== undefined,
    };
    return lightParts.filter((part) => has[part]);
  }

  /** The lamps' light; null in a bake without lamps. Throws LoadError. */
  async loadLamps(onBytes: OnBytes): Promise<LampLight | null> {
    const { lamp_scales: scales, pages, charts } = this.manifest;
    if (!scales) return null;
    return {
      scales: parseScales(this.url(scales.uri), await this.fetch(scales.uri, onBytes), charts),
      pages: await Promise.all(pages.map(async ({ lamps, width, height }) => {
        if (lamps === undefined) throw new LoadError(this.manifestUrl, text.error.noLampPage);
        return { url: this.url(lamps), bytes: await this.fetch(lamps, onBytes), width, height };
      })),
    };
  }

  /** All files of an instant at once. Throws LoadError; rejects when `signal` aborts. */
  async loadInstant(index: number, chartCount: number, onBytes: OnBytes, signal?: AbortSignal): Promise<InstantLight> {
    const instant = this.instant(index);
    const page = async (uri: string, pageIndex: number): Promise<EncodedPage> => {
      const { width, height } = this.manifest.pages[pageIndex] ?? { width: 0, height: 0 };
      return { url: this.url(uri), bytes: await this.fetch(uri, onBytes, signal), width, height };
    };
    const scalesOf = (uri: string, count: number): Promise<Float32Array<ArrayBuffer>> =>
      this.fetch(uri, onBytes, signal).then((bytes) => parseScales(this.url(uri), bytes, count));
    const [scales, indirectScales, panorama, airlight, pages] = await Promise.all([
      scalesOf(instant.scales.uri, 2 * chartCount),
      instant.indirect_scales ? scalesOf(instant.indirect_scales.uri, chartCount) : null,
      this.fetch(instant.sky.panorama.uri, onBytes, signal).then((bytes) =>
        Panorama.fromBytes(this.url(instant.sky.panorama.uri), bytes, instant.sky.panorama.width, instant.sky.panorama.height),
      ),
      instant.air ? this.loadAirlight(instant.air.airlight, onBytes, signal) : null,
      Promise.all(
        instant.pages.map(async (files, p) => {
          const [sky, sun, indirect] = await Promise.all([page(files.sky, p), page(files.sun, p), files.indirect ? page(files.indirect, p) : null]);
          return { sky, sun, indirect };
        }),
      ),
    ]);
    return { scales, indirectScales, panorama, airlight, pages };
  }

  private async loadAirlight({ uri, columns, rows }: { uri: string; columns: number; rows: number }, onBytes: OnBytes, signal?: AbortSignal): Promise<Airlight> {
    return parseAirlight(this.url(uri), await this.fetch(uri, onBytes, signal), columns, rows);
  }
}

/** `count` little-endian float32. */
export function parseScales(url: string, bytes: Uint8Array<ArrayBuffer>, count: number): Float32Array<ArrayBuffer> {
  if (bytes.byteLength !== count * 4) throw new LoadError(url, text.error.size(bytes.byteLength, count * 4));
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const scales = new Float32Array(count);
  for (let i = 0; i < scales.length; ++i) scales[i] = view.getFloat32(4 * i, true);
  return scales;
}
