// Single texels of an EXR file, by reading only the piece of the file that holds them: scan lines, uncompressed or ZIP, as src/io/exr
// writes them. Based on: "OpenEXR File Layout" (openexr.com); ZIP's predictor and interleaving as in its ImfZip.
import { LoadError } from './load_error';
import { text } from './text';

/** Bytes [first, first + count) of a file; fewer only where the file ends. */
export type ReadBytes = (first: number, count: number) => Promise<Uint8Array<ArrayBuffer>>;

interface Channel {
  name: string;
  isInteger: boolean;
}

const magic = 20000630;
const headBytes = 8192; // header and the offsets of a page of 2048 rows fit easily
const linesOfCompression: Record<number, number> = { 0: 1, 2: 1, 3: 16 }; // none, ZIPS, ZIP
const channelBytes = 4; // 32-bit numbers only

/** An EXR file of 32-bit channels, opened: its header is read, its pixels are not. */
export class ExrFile {
  private constructor(
    private readonly url: string,
    private readonly read: ReadBytes,
    readonly width: number,
    readonly height: number,
    private readonly channels: readonly Channel[],
    private readonly compression: number,
    private readonly tableOffset: number,
  ) {}

  /** Throws LoadError when the file is not an EXR of the kind that a bake holds. */
  static async open(url: string, read: ReadBytes): Promise<ExrFile> {
    const bytes = await read(0, headBytes);
    const fail = (): never => {
      throw new LoadError(url, text.error.notAnExr);
    };
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    let at = 8;
    const name = (): string => {
      const end = bytes.indexOf(0, at);
      if (end < 0) fail();
      const found = new TextDecoder().decode(bytes.subarray(at, end));
      at = end + 1;
      return found;
    };
    try {
      if (view.getUint32(0, true) !== magic || (view.getUint32(4, true) & 0x1e00) !== 0) fail(); // tiled, deep or of several parts
      const channels: Channel[] = [];
      let compression = -1;
      let size: [number, number] | null = null;
      for (let attribute = name(); attribute !== ''; attribute = name()) {
        name(); // its type
        const length = view.getUint32(at, true);
        const end = at + 4 + length;
        at += 4;
        if (attribute === 'compression') compression = view.getUint8(at);
        if (attribute === 'dataWindow') size = [view.getInt32(at + 8, true) - view.getInt32(at, true) + 1, view.getInt32(at + 12, true) - view.getInt32(at + 4, true) + 1];
        if (attribute === 'channels') {
          for (let channel = name(); channel !== ''; channel = name()) {
            const type = view.getUint32(at, true);
            if (type !== 0 && type !== 2) fail(); // half floats
            channels.push({ name: channel, isInteger: type === 0 });
            at += 16;
          }
        }
        at = end;
      }
      if (!size || channels.length === 0 || !(compression in linesOfCompression)) return fail();
      return new ExrFile(url, read, size[0], size[1], channels, compression, at);
    } catch (error) {
      if (error instanceof RangeError) return fail(); // the header ends early
      throw error;
    }
  }

  /** The numbers of one texel by channel; row 0 is on top. Throws LoadError when the file is damaged. */
  async texel(column: number, row: number): Promise<Map<string, number>> {
    const lines = linesOfCompression[this.compression] ?? 1;
    const block = Math.floor(row / lines);
    const rows = Math.min(lines, this.height - block * lines);
    const entry = await this.read(this.tableOffset + 8 * block, 8);
    if (entry.byteLength !== 8) throw new LoadError(this.url, text.error.notAnExr);
    const offset = Number(new DataView(entry.buffer, entry.byteOffset, 8).getBigUint64(0, true));
    const head = await this.read(offset, 8);
    if (head.byteLength !== 8) throw new LoadError(this.url, text.error.notAnExr);
    const size = new DataView(head.buffer, head.byteOffset, 8).getUint32(4, true);
    const packed = await this.read(offset + 8, size);
    const rawSize = rows * this.width * this.channels.length * channelBytes;
    const raw = size < rawSize ? await inflate(this.url, packed, rawSize) : packed;
    if (raw.byteLength !== rawSize) throw new LoadError(this.url, text.error.notAnExr);
    const view = new DataView(raw.buffer, raw.byteOffset, raw.byteLength);
    const values = new Map<string, number>();
    this.channels.forEach(({ name, isInteger }, c) => {
      const at = (((row - block * lines) * this.channels.length + c) * this.width + column) * channelBytes;
      values.set(name, isInteger ? view.getUint32(at, true) : view.getFloat32(at, true));
    });
    return values;
  }
}

/** ZIP of EXR: zlib, then sums of differences, then the bytes of odd places behind those of even ones. */
async function inflate(url: string, packed: Uint8Array<ArrayBuffer>, rawSize: number): Promise<Uint8Array<ArrayBuffer>> {
  let mixed: Uint8Array<ArrayBuffer>;
  try {
    mixed = new Uint8Array(await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer());
  } catch {
    throw new LoadError(url, text.error.notAnExr);
  }
  for (let i = 1; i < mixed.length; ++i) mixed[i] = (mixed[i - 1] ?? 0) + (mixed[i] ?? 0) - 128;
  const raw = new Uint8Array(rawSize);
  const half = Math.ceil(rawSize / 2);
  for (let i = 0; i < mixed.length && i < rawSize; ++i) raw[i] = mixed[(i & 1) * half + (i >> 1)] ?? 0;
  return raw;
}
