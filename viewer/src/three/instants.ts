import type { Bake } from '../core/bake';
import type { OnBytes } from '../core/fetch';
import { InstantTextures } from './light';
import type { LayerPainter } from './layers';

/** Instants that are not on show stay on the graphics card as far as this goes, bytes. */
const keptBytes = 256 * 2 ** 20;
/** Pages that are fetched and decoded at a time: the network is not idle, and the nearest still come first. */
const pagesAtOnce = 3;

/** An instant whose light is on the graphics card, or on the way there. */
export interface LoadingInstant {
  index: number;
  /** Null before all but pages is there. */
  textures: InstantTextures | null;
  /** Resolves with the first page. */
  started: Promise<void>;
  /** Resolves with the last page. */
  whole: Promise<void>;
  isWhole: boolean;
  abort: AbortController;
}

/** The instants of a bake on the graphics card. */
export class Instants {
  private readonly all = new Map<number, LoadingInstant>(); // the one used last stands last

  /** @param onPage a page has come */
  constructor(
    private readonly bake: Bake,
    private readonly lampScales: Float32Array<ArrayBuffer> | null,
    private readonly painter: LayerPainter,
    private readonly onPage: () => void,
  ) {}

  /** An instant, that is loaded if it is not there: its pages in the order that is given. Its promises throw LoadError. */
  use(index: number, order: readonly number[], onBytes: OnBytes): LoadingInstant {
    const instant = this.all.get(index) ?? this.load(index, order, onBytes);
    this.all.delete(index);
    this.all.set(index, instant);
    return instant;
  }

  isWhole(index: number): boolean {
    return this.all.get(index)?.isWhole ?? false;
  }

  /** On the graphics card. */
  get bytes(): number {
    let bytes = 0;
    for (const { textures } of this.opened()) bytes += textures.bytes;
    return bytes;
  }

  /** Frees what is neither named nor worth keeping: all that is under way, and the instants used longest ago. */
  forgetBut(indices: readonly number[]): void {
    for (const { index, isWhole } of [...this.all.values()]) {
      if (!isWhole && !indices.includes(index)) this.forget(index);
    }
    let kept = 0;
    for (const { index, textures } of this.opened().reverse()) {
      if (indices.includes(index)) continue;
      kept += textures.bytes;
      if (kept > keptBytes) this.forget(index);
    }
  }

  dispose(): void {
    for (const index of [...this.all.keys()]) this.forget(index);
  }

  private opened(): { index: number; textures: InstantTextures }[] {
    return [...this.all.values()].flatMap(({ index, textures }) => (textures ? [{ index, textures }] : []));
  }

  private forget(index: number): void {
    const instant = this.all.get(index);
    this.all.delete(index);
    instant?.abort.abort();
    instant?.textures?.dispose();
  }

  private load(index: number, order: readonly number[], onBytes: OnBytes): LoadingInstant {
    const abort = new AbortController();
    const { signal } = abort;
    const open = async (): Promise<InstantTextures> => {
      const files = await this.bake.loadInstant(index, onBytes, signal);
      signal.throwIfAborted();
      return (instant.textures = new InstantTextures(files, this.lampScales, this.bake.manifest.pages, this.painter));
    };
    const queue = [...order];
    let begun = (): void => {};
    const firstPage = new Promise<void>((resolve) => (begun = resolve));
    const fetchPages = async (): Promise<void> => {
      const textures = await opened;
      for (let page = queue.shift(); page !== undefined; page = queue.shift()) {
        await textures.put(page, await this.bake.loadInstantPage(index, page, onBytes, signal), signal);
        begun();
        this.onPage();
      }
    };
    const fetchAll = async (): Promise<void> => {
      try {
        await Promise.all(Array.from({ length: pagesAtOnce }, fetchPages));
        instant.isWhole = true;
      } catch (error) {
        if (this.all.get(index) === instant) this.forget(index); // the next question asks again
        throw error;
      }
    };
    const instant: LoadingInstant = { index, textures: null, started: firstPage, whole: firstPage, isWhole: false, abort };
    const opened = open();
    instant.whole = fetchAll();
    instant.started = Promise.race([firstPage, instant.whole]);
    for (const promise of [instant.started, instant.whole]) promise.catch(() => {}); // told by those who wait for them
    return instant;
  }
}
