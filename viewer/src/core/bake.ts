import { parseAirlight, type Airlight } from './air';
import { ExrFile } from './exr';
import { fetchBytes, fetchRange, fetchStart, type OnBytes } from './fetch';
import type { Manifest } from './generated/manifest';
import validateManifest from './generated/validate_manifest.js';
import type { Layer } from './layer_colours';
import { lightParts, type LightPart } from './light_parts';
import { LoadError } from './load_error';
import { CityObjects } from './objects';
import { Panorama } from './panorama';
import { text } from './text';

export type BakedInstant = Manifest['instants'][number];

/** The light of one instant as it stands in the files, without its pages. */
export interface InstantLight {
  /** Two a chart: scale of the sky's page (klx), scale of the sun's page (cosine). */
  scales: Float32Array<ArrayBuffer>;
  /** One a chart: scale of the page of reflected light (klx); null in a bake without it. */
  indirectScales: Float32Array<ArrayBuffer> | null;
  panorama: Panorama;
  /** Null in a bake without a sky. */
  airlight: Airlight | null;
}

/** A page of an instant; the PNGs are still encoded. */
export interface InstantPage {
  sky: EncodedPage;
  /** Null without a beam. */
  sun: EncodedPage | null;
  /** Null in a bake without reflected light. */
  indirect: EncodedPage | null;
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

  /** Download size of what an instant alone needs, or null when the manifest does not list all of its files. */
  bytesOfInstant(index: number): number | null {
    const { scales, indirect_scales: indirectScales, sky, air, pages } = this.instant(index);
    return this.bytesOfAll([
      scales.uri, sky.panorama.uri, indirectScales?.uri, air?.airlight.uri,
      ...pages.flatMap((page) => [page.sky, this.hasBeam(index) ? page.sun : undefined, page.indirect]),
    ]);
  }

  /** Download size of the lamps' pages, or null when the manifest does not list them. */
  bytesOfLamps(): number | null {
    return this.bytesOfAll(this.manifest.pages.map(({ lamps }) => lamps));
  }

  private bytesOfAll(uris: readonly (string | undefined)[]): number | null {
    return uris.reduce<number | null>((sum, uri) => {
      const bytes = uri === undefined ? 0 : this.bytesOf(uri);
      return sum === null || bytes === null ? null : sum + bytes;
    }, 0);
  }

  /** Whether the sun shines. */
  private hasBeam(index: number): boolean {
    const { sun } = this.instant(index);
    return sun.shape !== 'none' && sun.normal_illuminance_klx.some((klx) => klx > 0);
  }

  fetch(uri: string, onBytes: OnBytes, signal?: AbortSignal): Promise<Uint8Array<ArrayBuffer>> {
    return fetchBytes(this.url(uri), this.bytesOf(uri), onBytes, signal);
  }

  fetchStart(uri: string, onBytes: OnBytes, needed: (soFar: readonly Uint8Array[]) => number | null): Promise<Uint8Array<ArrayBuffer>> {
    return fetchStart(this.url(uri), this.bytesOf(uri), onBytes, needed);
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
    const has: Record<LightPart, boolean> = {
      sun: this.hasBeam(index),
      sky: true,
      indirect: this.instant(index).indirect_scales !== undefined,
      lamps: this.manifest.lamp_scales !== undefined,
    };
    return lightParts.filter((part) => has[part]);
  }

  /** Scales of the lamps' pages, one a chart (klx), the same at all instants; null in a bake without lamps. Throws LoadError. */
  async loadLampScales(onBytes: OnBytes): Promise<Float32Array<ArrayBuffer> | null> {
    const { lamp_scales: scales, charts } = this.manifest;
    return scales ? parseScales(this.url(scales.uri), await this.fetch(scales.uri, onBytes), charts) : null;
  }

  /** A page of the lamps' light. Throws LoadError. */
  async loadLampPage(page: number, onBytes: OnBytes): Promise<EncodedPage> {
    const uri = this.manifest.pages[page]?.lamps;
    if (uri === undefined) throw new LoadError(this.manifestUrl, text.error.noLampPage);
    return this.loadPage(uri, page, onBytes);
  }

  /** What an instant needs before its pages. Throws LoadError; rejects when `signal` aborts. */
  async loadInstant(index: number, onBytes: OnBytes, signal?: AbortSignal): Promise<InstantLight> {
    const instant = this.instant(index);
    const { charts } = this.manifest;
    const scalesOf = (uri: string, count: number): Promise<Float32Array<ArrayBuffer>> =>
      this.fetch(uri, onBytes, signal).then((bytes) => parseScales(this.url(uri), bytes, count));
    const [scales, indirectScales, panorama, airlight] = await Promise.all([
      scalesOf(instant.scales.uri, 2 * charts),
      instant.indirect_scales ? scalesOf(instant.indirect_scales.uri, charts) : null,
      this.fetch(instant.sky.panorama.uri, onBytes, signal).then((bytes) =>
        Panorama.fromBytes(this.url(instant.sky.panorama.uri), bytes, instant.sky.panorama.width, instant.sky.panorama.height),
      ),
      instant.air ? this.loadAirlight(instant.air.airlight, onBytes, signal) : null,
    ]);
    return { scales, indirectScales, panorama, airlight };
  }

  /** A page of an instant. Throws LoadError; rejects when `signal` aborts. */
  async loadInstantPage(index: number, page: number, onBytes: OnBytes, signal?: AbortSignal): Promise<InstantPage> {
    const files = this.instant(index).pages[page];
    if (!files) throw new RangeError('no such page');
    const [sky, sun, indirect] = await Promise.all([
      this.loadPage(files.sky, page, onBytes, signal),
      this.hasBeam(index) ? this.loadPage(files.sun, page, onBytes, signal) : null,
      files.indirect ? this.loadPage(files.indirect, page, onBytes, signal) : null,
    ]);
    return { sky, sun, indirect };
  }

  async loadPage(uri: string, page: number, onBytes: OnBytes, signal?: AbortSignal): Promise<EncodedPage> {
    const { width, height } = this.manifest.pages[page] ?? { width: 0, height: 0 };
    return { url: this.url(uri), bytes: await this.fetch(uri, onBytes, signal), width, height };
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
